// SPDX-License-Identifier: MIT
#include "opencl/cl_probe.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "base/child.h"
#include "base/file.h"
#include "base/memory.h"
#include "opencl/cl_source.h"
#include "opencl/selftest.h"
#include "render/cpu_dispatch.h"

/* Limit of processor time: compilers take seconds, a hanging driver takes
 * forever. */
#define ANSWER_NS UINT64_C(60000000000)

/* Limit for the copy's output, more than a compiler prints. */
#define OUTPUT_BYTES_MAX ((size_t)1 << 20)

/* ---- cache ---- */

/* Returns the path of the cached result, for free(); NULL without a cache
 * folder, or if memory is out. */
static char *memory_path(const struct cl_request *r)
{
    const char *folder = getenv("POCL_CACHE_DIR");
    struct error ignored;
    char *text, *key, *path;

    if (folder == NULL || *folder == '\0')
        return NULL;
    text = cl_source_text(r->kernels_path, &ignored);
    if (text == NULL)
        return NULL;
    key = format_text("%s %u %s", r->device != NULL ? r->device : "",
                      r->features, text);
    path = key != NULL
               ? format_text("%s/glim-%016" PRIx64, folder, cl_source_hash(key))
               : NULL;
    free(key);
    free(text);
    return path;
}

/* Removes the last line from the text and returns it, for free(); NULL if there
 * is none, or memory is out. */
static char *cut_last_line(char *text)
{
    size_t length = strlen(text);
    char *line;

    while (length > 0 && text[length - 1] == '\n')
        text[--length] = '\0';
    if (length == 0)
        return NULL;
    line = strrchr(text, '\n');
    if (line == NULL) {
        char *copy = strdup(text);

        *text = '\0';
        return copy;
    }
    *line = '\0';
    return strdup(line + 1);
}

/* Parses a good answer, whose last lines are the device and the verdict. Takes
 * ownership of the text. */
static bool take_answer(struct cl_probe *probe, char *text)
{
    *probe = (struct cl_probe){.log = text};
    probe->verdict = cut_last_line(text);
    probe->device = cut_last_line(text);
    return probe->device != NULL && probe->verdict != NULL;
}

bool cl_probe_recall(struct cl_probe *probe, const struct cl_request *r)
{
    char *path = memory_path(r);
    char *text = NULL;
    size_t size_bytes;
    struct error ignored;
    bool ok = path != NULL && file_read(path, &text, &size_bytes, &ignored);

    free(path);
    if (ok && take_answer(probe, text))
        return true;
    if (ok)
        cl_probe_free(probe);
    return false;
}

static void remember(const struct cl_probe *probe, const struct cl_request *r)
{
    char *path = memory_path(r);
    char *text = format_text("%s\n%s\n", probe->device, probe->verdict);
    struct error ignored;

    if (path != NULL && text != NULL)
        file_write(path, text, strlen(text), false, NULL, &ignored);
    free(text);
    free(path);
}

/* ---- the copy ---- */

bool cl_probe_answer(struct cl_probe *probe, const struct cl_request *r,
                     struct error *err)
{
    char verdict[SELFTEST_VERDICT_BYTES];
    struct backend *device, *cpu;
    bool ok = false;

    *probe = (struct cl_probe){0};
    device = backend_cl_create(r, &probe->log, err);
    if (device == NULL)
        return false;
    cpu = backend_cpu_create(1, cpu_kernel_best(), err);
    if (cpu != NULL) {
        ok = selftest_run(cpu, device, r->features, verdict, err);
        cpu->destroy(cpu);
    }
    if (ok) {
        probe->device = cl_probe_device(device);
        probe->verdict = strdup(verdict);
        ok = (probe->device != NULL && probe->verdict != NULL) ||
             fail(err, "OpenCL: out of memory");
    }
    device->destroy(device);
    return ok;
}

char *cl_probe_device(const struct backend *backend)
{
    return format_text("%s, %s", backend->device, backend->driver);
}

/* ---- its parent ---- */

/* Runs the copy with both outputs in one text. */
static enum child_end run_copy(const struct cl_request *r,
                               const atomic_bool *is_unwanted,
                               struct child_result *result)
{
    char features[16];
    const char *arguments[10] = {"glim", "--probe", features, "--backend",
                                 r->needs_gpu ? "auto" : "opencl"};
    struct child_task task = {
        .program = r->program,
        .arguments = arguments,
        .has_errors = true,
        .is_cut = true, /* the cause is at the beginning */
        .time_ns = ANSWER_NS,
        .size_bytes = OUTPUT_BYTES_MAX,
        .is_unwanted = is_unwanted,
    };
    int count = 5;

    snprintf(features, sizeof features, "%u", r->features);
    if (r->device != NULL) {
        arguments[count++] = "--device";
        arguments[count++] = r->device;
    }
    if (r->kernels_path != NULL) {
        arguments[count++] = "--kernels";
        arguments[count++] = r->kernels_path;
    }
    return child_run(&task, result);
}

/* Reports the failure of the copy: its last line, or the signal that killed
 * it. */
static bool fail_copy(struct cl_probe *probe, char *output, int status,
                      struct error *err)
{
    char *line = cut_last_line(output);
    const char *said = line != NULL ? line : "";
    static const char prefix[] = "glim: ";

    if (strncmp(said, prefix, sizeof prefix - 1) == 0)
        said += sizeof prefix - 1;
    if (WIFSIGNALED(status))
        fail(err, "OpenCL: the driver crashed (%s)%s%s",
             strsignal(WTERMSIG(status)), *said != '\0' ? ": " : "", said);
    else if (*said != '\0')
        fail(err, "%s", said);
    else
        fail(err, "OpenCL: the self-test ended with status %d",
             WEXITSTATUS(status));
    *probe = (struct cl_probe){.log = output};
    free(line);
    return false;
}

static bool take_output(struct cl_probe *probe, char *output, int status,
                        struct error *err)
{
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return fail_copy(probe, output, status, err);
    if (take_answer(probe, output))
        return true;
    cl_probe_free(probe);
    return fail(err, "OpenCL: the self-test gave no verdict");
}

bool cl_probe_run(struct cl_probe *probe, const struct cl_request *r,
                  const atomic_bool *is_unwanted, struct error *err)
{
    struct child_result result;

    *probe = (struct cl_probe){0};
    switch (run_copy(r, is_unwanted, &result)) {
    case CHILD_NOT_RUN:
        return fail(err, "OpenCL: %s: cannot run the self-test: %s", r->program,
                    strerror(result.reason));
    case CHILD_UNKNOWN:
        return fail(err, "OpenCL: how the self-test ended is not known: %s",
                    strerror(result.reason));
    case CHILD_LATE:
    case CHILD_TOO_LONG:
    case CHILD_NO_MEMORY:
        return fail(err, "OpenCL: the driver does not answer");
    case CHILD_ENDED: break;
    }
    if (!take_output(probe, result.output, result.status, err))
        return false;
    remember(probe, r);
    return true;
}

void cl_probe_free(struct cl_probe *probe)
{
    free(probe->device);
    free(probe->verdict);
    free(probe->log);
    *probe = (struct cl_probe){0};
}
