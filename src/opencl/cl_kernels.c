// SPDX-License-Identifier: MIT
#include "opencl/cl_kernels.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "kernels/features.h"

/* Returns the compiler's log, for free(), or NULL when memory is out. */
static char *build_log(const struct cl_kernels *k, const struct cl_machine *m)
{
    size_t size_bytes = 0;
    char *log;

    m->api->GetProgramBuildInfo(k->program, m->device->id, CL_PROGRAM_BUILD_LOG,
                                0, NULL, &size_bytes);
    log = alloc_array(1, size_bytes + 1);
    if (log == NULL)
        return NULL;
    m->api->GetProgramBuildInfo(k->program, m->device->id, CL_PROGRAM_BUILD_LOG,
                                size_bytes, log, NULL);
    return log;
}

/* Finds the first error message of a log; most compilers write "error". Returns
 * its length. */
static int first_message(const char *log, const char **line)
{
    const char *at = strstr(log, "error");

    if (at == NULL)
        at = log;
    while (at > log && at[-1] != '\n')
        at--;
    *line = at;
    return (int)strcspn(at, "\n");
}

static bool compile(struct cl_kernels *k, const struct cl_machine *m,
                    char **log, struct error *err)
{
    char options[128];
    const char *line;
    int length;
    cl_int code;

    /* rounds division and sqrt as IEEE 754 does, where the device can */
    snprintf(options, sizeof options, "-cl-std=CL1.2 -Werror -DFEATURES=%uu%s",
             k->features,
             m->device->has_correct_divide
                 ? " -cl-fp32-correctly-rounded-divide-sqrt"
                 : "");
    code = m->api->BuildProgram(k->program, 1, &m->device->id, options, NULL,
                                NULL);
    if (code == CL_SUCCESS)
        return true;
    *log = build_log(k, m);
    length = first_message(*log != NULL ? *log : "", &line);
    return fail(err, "OpenCL device %s: the kernels do not compile: %.*s",
                m->device->name, length, length > 0 ? line : "");
}

static bool find_kernel(struct cl_kernels *k, const struct cl_machine *m,
                        const char *name, cl_kernel *kernel, struct error *err)
{
    cl_int code;

    *kernel = m->api->CreateKernel(k->program, name, &code);
    return cl_machine_check(m, code, name, err);
}

/* Features that a build must have besides those asked for. NVIDIA's compiler
 * does not end on builds without texture and bump code (driver 580.159, H100);
 * with both it takes 5 to 15 s. */
static uint32_t features_needed(const struct cl_machine *m)
{
    return strstr(m->device->platform_name, "NVIDIA") != NULL
               ? FEATURE_TEXTURES | FEATURE_BUMPS
               : 0;
}

bool cl_kernels_build(struct cl_kernels *k, const struct cl_machine *m,
                      const char *text, uint32_t features, char **log,
                      struct error *err)
{
    cl_int code;

    *k = (struct cl_kernels){.features = features | features_needed(m)};
    *log = NULL;
    k->program =
        m->api->CreateProgramWithSource(m->context, 1, &text, NULL, &code);
    if (!cl_machine_check(m, code, "clCreateProgramWithSource", err))
        return false;
    if (compile(k, m, log, err) &&
        find_kernel(k, m, "clear_buffers", &k->clear, err) &&
        find_kernel(k, m, "generate_rays", &k->generate, err) &&
        find_kernel(k, m, "trace_paths", &k->trace, err) &&
        find_kernel(k, m, "add_samples", &k->add, err))
        return true;
    cl_kernels_free(k, m);
    return false;
}

void cl_kernels_free(struct cl_kernels *k, const struct cl_machine *m)
{
    const cl_kernel kernels[] = {k->clear, k->generate, k->trace, k->add};

    for (size_t i = 0; i < sizeof kernels / sizeof kernels[0]; i++)
        if (kernels[i] != NULL)
            m->api->ReleaseKernel(kernels[i]);
    if (k->program != NULL)
        m->api->ReleaseProgram(k->program);
    *k = (struct cl_kernels){0};
}
