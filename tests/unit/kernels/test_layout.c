// SPDX-License-Identifier: MIT
/*
 * test_layout.c - structs that host and device share have the same members in
 * the same places, on this host, and on an OpenCL device that is asked
 */
#include <stdlib.h>

#include "base/error.h"
#include "base/memory.h"
#include "opencl/cl_environment.h"
#include "opencl/cl_machine.h"
#include "opencl/cl_source.h"
#include "tests/unit/check.h"
#include "kernels/camera.h"
#include "kernels/camera_sample.h"
#include "kernels/cl_task.h"
#include "kernels/pixel.h"

/* S(struct, size) M(struct, member, offset) */
/* clang-format off */
#define LAYOUT(S, M)                                                         \
    S(vec2, 8) M(vec2, x, 0) M(vec2, y, 4)                                   \
    S(vec3, 12) M(vec3, x, 0) M(vec3, y, 4) M(vec3, z, 8)                    \
    S(tri, 52) M(tri, v, 0) M(tri, vn, 12) M(tri, vt, 24)                    \
    M(tri, material, 36) M(tri, ng, 40)                                      \
    S(material, 96) M(material, color, 0) M(material, alpha, 12)             \
    M(material, emission, 16) M(material, ior, 28) M(material, kind, 32)     \
    M(material, color_texture, 36) M(material, emission_texture, 40)         \
    M(material, opacity, 44) M(material, coat, 48)                           \
    M(material, coat_texture, 60) M(material, alpha_texture, 64)             \
    M(material, metal_texture, 68) M(material, opacity_texture, 72)          \
    M(material, metalness, 76) M(material, normal_texture, 80)               \
    M(material, bump_texture, 84) M(material, bump_scale, 88)                \
    M(material, pad, 92)                                                     \
    S(texture, 40) M(texture, first, 0) M(texture, width, 4)                 \
    M(texture, height, 8) M(texture, has_holes, 12) M(texture, scale, 16)    \
    M(texture, offset, 24) M(texture, is_clamped, 32)                        \
    M(texture, is_data, 36)                                                  \
    S(sky, 32) M(sky, color, 0) M(sky, width, 12) M(sky, height, 16)         \
    M(sky, rotation_sin, 20) M(sky, rotation_cos, 24) M(sky, pad, 28)        \
    S(camera, 72) M(camera, eye, 0) M(camera, width, 12)                     \
    M(camera, forward, 16) M(camera, height, 28) M(camera, right, 32)        \
    M(camera, lens_radius, 44) M(camera, up, 48) M(camera, focus, 60)        \
    M(camera, left, 64) M(camera, top, 68)                                   \
    S(node, 32) M(node, lo, 0) M(node, next, 12) M(node, hi, 16)             \
    M(node, count, 28)                                                       \
    S(leaf_tri, 40) M(leaf_tri, p0, 0) M(leaf_tri, p1, 12)                   \
    M(leaf_tri, p2, 24) M(leaf_tri, tri, 36)                                 \
    S(light, 112) M(light, tris, 0) M(light, path, 8) M(light, texture, 16)  \
    M(light, turns, 20) M(light, corners, 28) M(light, twice, 76)            \
    M(light, emission, 100)                                                  \
    S(light_node, 320) M(light_node, x, 0) M(light_node, y, 32)              \
    M(light_node, z, 64) M(light_node, radius, 96) M(light_node, axis_x, 128)\
    M(light_node, axis_y, 160) M(light_node, axis_z, 192)                    \
    M(light_node, spread, 224) M(light_node, power, 256)                     \
    M(light_node, child, 288)                                                \
    S(guide_grid, 32) M(guide_grid, lo, 0) M(guide_grid, cells_a_unit, 12)   \
    M(guide_grid, width, 16) M(guide_grid, height, 20)                       \
    M(guide_grid, depth, 24) M(guide_grid, table_count, 28)                  \
    S(guide_cell, 8) M(guide_cell, ways, 0) M(guide_cell, sky, 4)            \
    S(settings, 208) M(settings, camera, 0) M(settings, sky, 72)             \
    M(settings, max_vertices, 104) M(settings, seed, 108)                    \
    M(settings, features, 112) M(settings, direct, 116)                      \
    M(settings, order, 120) M(settings, sample, 124)                         \
    M(settings, sky_share, 128) M(settings, light_share, 132)                \
    M(settings, tri_count, 136) M(settings, position_count, 140)             \
    M(settings, normal_count, 144) M(settings, uv_count, 148)                \
    M(settings, material_count, 152) M(settings, texture_count, 156)         \
    M(settings, texel_count, 160) M(settings, light_count, 164)              \
    M(settings, light_node_count, 168) M(settings, sky_sum_count, 172)       \
    M(settings, guide, 176)                                                  \
    S(ray, 36) M(ray, o, 0) M(ray, d, 12) M(ray, t_max, 24) M(ray, key, 28)  \
    M(ray, from, 32)                                                         \
    S(path_sample, 20) M(path_sample, radiance, 0) M(path_sample, rays, 12)  \
    M(path_sample, cut, 16)                                                  \
    S(sum, 16) M(sum, lo, 0) M(sum, hi, 8)                                   \
    S(tally, 20) M(tally, samples, 0) M(tally, rays, 4)                      \
    M(tally, non_finite, 8) M(tally, saturated, 12) M(tally, cut_paths, 16)  \
    S(task, 40) M(task, target, 0) M(task, samples, 8) M(task, first, 12)    \
    M(task, count, 16) M(task, columns, 20) M(task, stride, 24)              \
    M(task, width, 28) M(task, x0, 32) M(task, y0, 36)                       \
    S(path_start, 44) M(path_start, ray, 0) M(path_start, sampler, 36)
/* clang-format on */

#define ASSERT_SIZE(s, size) \
    _Static_assert(sizeof(struct s) == (size), "size of " #s);
#define ASSERT_OFFSET(s, m, offset) \
    _Static_assert(offsetof(struct s, m) == (offset), "offset of " #s "." #m);
LAYOUT(ASSERT_SIZE, ASSERT_OFFSET)

static const struct {
    const char *name;
    uint32_t value;
    const char *code; /* the kernel's statement that asks for it */
} facts[] = {
#define SIZE_FACT(s, size) \
    {"size of " #s, size, "out[i++] = sizeof(struct " #s ");\n"},
#define OFFSET_FACT(s, m, offset)                                    \
    {"offset of " #s "." #m, offset,                                 \
     "{ struct " #s " x; out[i++] = (uint)((__private char *)&x." #m \
     " - (__private char *)&x); }\n"},
    LAYOUT(SIZE_FACT, OFFSET_FACT)};

#define FACTS (sizeof facts / sizeof facts[0])

/* The kernels' text, and the questions behind it. */
static char *question(void)
{
    struct error err;
    char *kernels = cl_source_text(NULL, &err);
    char *text;

    assert_non_null(kernels);
    text = xformat("%s\n__kernel void layout(__global uint *out)\n{\n"
                   "uint i = 0;\n",
                   kernels);
    free(kernels);
    for (size_t i = 0; i < FACTS; i++) {
        char *longer =
            xformat("%s%s%s", text, facts[i].code, i + 1 == FACTS ? "}\n" : "");

        free(text);
        text = longer;
    }
    return text;
}

/* Builds and runs the kernel `layout`, which fills the answers. */
static void ask(const struct cl_machine *m, const char *text,
                uint32_t answers[FACTS])
{
    const struct cl_api *cl = m->api;
    struct error err;
    cl_int code;
    cl_program program =
        cl->CreateProgramWithSource(m->context, 1, &text, NULL, &code);
    cl_mem out =
        cl_machine_buffer(m, NULL, FACTS * sizeof *answers, false, &err);
    size_t one = 1;

    assert_int_equal(code, CL_SUCCESS);
    assert_non_null(out);
    assert_int_equal(cl->BuildProgram(program, 1, &m->device->id,
                                      "-cl-std=CL1.2", NULL, NULL),
                     CL_SUCCESS);
    cl_kernel kernel = cl->CreateKernel(program, "layout", &code);
    assert_int_equal(code, CL_SUCCESS);
    assert_int_equal(cl->SetKernelArg(kernel, 0, sizeof out, &out), CL_SUCCESS);
    assert_int_equal(cl->EnqueueNDRangeKernel(m->queue, kernel, 1, NULL, &one,
                                              NULL, 0, NULL, NULL),
                     CL_SUCCESS);
    assert_int_equal(cl->EnqueueReadBuffer(m->queue, out, CL_TRUE, 0,
                                           FACTS * sizeof *answers, answers, 0,
                                           NULL, NULL),
                     CL_SUCCESS);
    cl->ReleaseKernel(kernel);
    cl->ReleaseProgram(program);
    cl->ReleaseMemObject(out);
}

static void device(void **state)
{
    struct cl_machine m;
    struct error err;
    uint32_t answers[FACTS] = {0};
    char *text;

    (void)state;
    cl_environment_prepare(1);
    if (!cl_machine_open(&m, "Portable", &err)) {
        print_message("skipped: %s\n", err.text);
        return;
    }
    text = question();
    ask(&m, text, answers);
    for (size_t i = 0; i < FACTS; i++) {
        if (answers[i] != facts[i].value)
            print_error("%s: %u on the device, %u here\n", facts[i].name,
                        answers[i], facts[i].value);
        assert_int_equal(answers[i], facts[i].value);
    }
    free(text);
    cl_machine_close(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(device),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
