// SPDX-License-Identifier: MIT
/*
 * test_filter_cl.c - kernels/filter.h computes the CPU's bits on PoCL
 */
#include <stdlib.h>

#include "tests/unit/check.h"

#include "render/opencl/cl_api.h"
#include "render/opencl/cl_device.h"
#include "kernels/filter.h"

#define COUNT  4096
#define INPUTS 6

/* Computes each function of the filter from six numbers. */
#define RESULTS 5

static const char text[] =
    "#include \"kernels/filter.h\"\n"
    "__kernel void compute(__global const float *in, __global float *out)\n"
    "{\n"
    "    uint i = get_global_id(0);\n"
    "    in += 6 * i;\n"
    "    out += 5 * i;\n"
    "    out[0] = filter_variance(in[0], 1.0f + in[5]);\n"
    "    out[1] = filter_pixel_distance(in[0], in[2], in[3]);\n"
    "    out[2] = filter_light_distance(in[4]);\n"
    "    out[3] = filter_feature_distance(in[0], in[2], in[3]);\n"
    "    out[4] = filter_weight(0.125f, in[0], in[5]);\n"
    "}\n";

static void compute(const float *in, float *out)
{
    out[0] = filter_variance(in[0], 1.0f + in[5]);
    out[1] = filter_pixel_distance(in[0], in[2], in[3]);
    out[2] = filter_light_distance(in[4]);
    out[3] = filter_feature_distance(in[0], in[2], in[3]);
    out[4] = filter_weight(0.125f, in[0], in[5]);
}

/* Numbers of all sizes that the filter meets, with many near the edge of the
 * weight, and zeros. Denormal numbers, which devices may flush, do not occur in
 * light that is scaled. */
static void fill(float in[COUNT][INPUTS])
{
    uint64_t seed = 11;

    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < INPUTS; k++) {
            double scale = i % 3 == 0 ? 16 : i % 3 == 1 ? 1 : 0x1p54;

            in[i][k] = check_random(&seed) < 0.05
                           ? 0.0f
                           : (float)(scale * check_random(&seed));
        }
    for (int i = 0; i < COUNT; i++)
        in[i][4] -= 8;
}

static cl_kernel build(const struct cl_machine *m, cl_program *program)
{
    const char *source = text;
    cl_int code;
    cl_kernel kernel;
    struct error err;

    *program =
        m->api->CreateProgramWithSource(m->context, 1, &source, NULL, &code);
    check_or_say(cl_machine_check(m, code, "clCreateProgramWithSource", &err),
                 err.text);
    code = m->api->BuildProgram(
        *program, 1, &m->device->id,
        "-cl-std=CL1.2 -I. -cl-fp32-correctly-rounded-divide-sqrt", NULL, NULL);
    check_or_say(cl_machine_check(m, code, "clBuildProgram", &err), err.text);
    kernel = m->api->CreateKernel(*program, "compute", &code);
    check_or_say(cl_machine_check(m, code, "clCreateKernel", &err), err.text);
    return kernel;
}

static void functions_have_the_same_bits(void **state)
{
    static float in[COUNT][INPUTS], out[COUNT][RESULTS], want[RESULTS];
    struct cl_machine m;
    cl_program program;
    cl_mem buffers[2];
    cl_kernel kernel;
    struct error err;

    (void)state;
    cl_environment_prepare(2);
    if (!cl_machine_open(&m, "Portable", NULL, &err)) {
        print_message("skipped: %s\n", err.text);
        return;
    }
    fill(in);
    kernel = build(&m, &program);
    buffers[0] = cl_machine_buffer(&m, in, sizeof in, false, &err);
    buffers[1] = cl_machine_buffer(&m, out, sizeof out, false, &err);
    assert_true(buffers[0] && buffers[1]);
    check_or_say(cl_machine_set(&m, kernel, 0, buffers, 2, &err) &&
                     cl_machine_enqueue(&m, kernel, COUNT, &err),
                 err.text);
    assert_int_equal(m.api->EnqueueReadBuffer(m.queue, buffers[1], CL_TRUE, 0,
                                              sizeof out, out, 0, NULL, NULL),
                     CL_SUCCESS);
    for (int i = 0; i < COUNT; i++) {
        compute(in[i], want);
        assert_memory_equal(out[i], want, sizeof want);
    }
    m.api->ReleaseKernel(kernel);
    m.api->ReleaseProgram(program);
    cl_machine_drop(&m, &buffers[0]);
    cl_machine_drop(&m, &buffers[1]);
    cl_machine_close(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(functions_have_the_same_bits),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
