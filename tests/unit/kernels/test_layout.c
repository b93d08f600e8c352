// SPDX-License-Identifier: MIT
/*
 * test_layout.c - structs that host and device share have the same sizes and
 * the same offsets of their members on both
 */
#include <stdlib.h>

#include "base/error.h"
#include "render/opencl/cl_api.h"
#include "render/opencl/cl_device.h"
#include "render/opencl/cl_source.h"
#include "terminal/xmalloc.h"
#include "tests/unit/check.h"
#include "kernels/camera.h"
#include "kernels/cl_task.h"
#include "kernels/pixel.h"

/* Lists every struct that kernels and host share, with its members: S(struct)
 * M(struct, member). */
/* clang-format off */
#define LAYOUT(S, M)                                                          \
    S(vec2) M(vec2, x) M(vec2, y)                                             \
    S(vec3) M(vec3, x) M(vec3, y) M(vec3, z)                                  \
    S(tri) M(tri, v) M(tri, vn) M(tri, vt) M(tri, material) M(tri, ng)        \
    S(material) M(material, color) M(material, alpha)                         \
      M(material, emission) M(material, ior) M(material, kind)                \
      M(material, color_texture) M(material, emission_texture)                \
      M(material, opacity) M(material, specular)                              \
      M(material, specular_texture)                                           \
      M(material, alpha_texture) M(material, metal_texture)                   \
      M(material, opacity_texture) M(material, color_is_opaque)               \
      M(material, metalness)                                                  \
      M(material, normal_texture) M(material, bump_texture)                   \
      M(material, bump_scale) M(material, normal_strength)                    \
      M(material, normal_depth) M(material, coat_normal_texture)              \
      M(material, coat_normal_strength)                                       \
      M(material, specular_weight_texture)                                    \
      M(material, sheen_alpha_texture) M(material, film_texture)              \
      M(material, film_thickness_texture) M(material, film_thinnest)          \
      M(material, grain_texture)                                              \
      M(material, transmission) M(material, coat)                             \
      M(material, coat_alpha) M(material, sheen) M(material, sheen_alpha)     \
      M(material, anisotropy) M(material, grain)                              \
      M(material, medium) M(material, is_boundary) M(material, is_thin)                           \
      M(material, transmission_texture) M(material, coat_texture)             \
      M(material, coat_alpha_texture) M(material, sheen_texture)              \
      M(material, film) M(material, film_ior) M(material, film_thickness)     \
      M(material, cutoff) M(material, role) M(material, dispersion)           \
      M(material, subsurface) M(material, back_color)                         \
      M(material, translucency) M(material, back_texture)                     \
      M(material, translucency_texture) M(material, subsurface_texture)       \
    S(media) M(media, count) M(media, at)                                     \
    S(medium) M(medium, extinction) M(medium, scattering)                     \
      M(medium, anisotropy) M(medium, base) M(medium, falloff)                \
    S(texture) M(texture, first) M(texture, width) M(texture, height)         \
      M(texture, has_alpha) M(texture, scale) M(texture, offset)              \
      M(texture, flags) M(texture, is_data) M(texture, rotation)              \
      M(texture, channel) M(texture, pad)                                     \
    S(sky) M(sky, color) M(sky, width) M(sky, height) M(sky, rotation_sin)    \
      M(sky, rotation_cos) M(sky, pad)                                        \
    S(camera) M(camera, eye) M(camera, width) M(camera, forward)              \
      M(camera, height) M(camera, right) M(camera, lens_radius)               \
      M(camera, up) M(camera, focus) M(camera, left) M(camera, top)           \
    S(instance) M(instance, rows) M(instance, origin) M(instance, inverse)    \
      M(instance, pad) M(instance, inverse_error) M(instance, first_tri)      \
      M(instance, tri_count) M(instance, mesh_tri) M(instance, mesh)          \
      M(instance, material) M(instance, is_mirror)                            \
    S(bvh8_node) M(bvh8_node, planes) M(bvh8_node, child)                     \
    S(tri_block) M(tri_block, corners) M(tri_block, tri)                      \
    S(leaf_tri) M(leaf_tri, p0) M(leaf_tri, p1) M(leaf_tri, p2)               \
      M(leaf_tri, tri)                                                        \
    S(light) M(light, tris) M(light, path) M(light, texture)                  \
      M(light, rotation) M(light, corners) M(light, scaled_normals)           \
      M(light, emission)                                                      \
    S(point_light) M(point_light, p) M(point_light, radius)                   \
      M(point_light, axis) M(point_light, cone_scale)                         \
      M(point_light, cone_offset) M(point_light, emission)                    \
      M(point_light, path) M(point_light, profile)                            \
      M(point_light, profile_columns) M(point_light, side)                    \
    S(directional_light) M(directional_light, d) M(directional_light, size)   \
      M(directional_light, emission) M(directional_light, sine)               \
      M(directional_light, power)                                             \
    S(light_node) M(light_node, x) M(light_node, y) M(light_node, z)          \
      M(light_node, radius) M(light_node, axis_x) M(light_node, axis_y)       \
      M(light_node, axis_z) M(light_node, spread) M(light_node, power)        \
      M(light_node, child)                                                    \
    S(guide_grid) M(guide_grid, lo) M(guide_grid, cells_per_unit)             \
      M(guide_grid, width) M(guide_grid, height) M(guide_grid, depth)         \
      M(guide_grid, table_count)                                              \
    S(guide_cell) M(guide_cell, scatter) M(guide_cell, sky)                   \
    S(tangent) M(tangent, d) M(tangent, sign)                                 \
    S(settings) M(settings, camera) M(settings, sky)                          \
      M(settings, max_vertices) M(settings, seed) M(settings, features)       \
      M(settings, direct) M(settings, order) M(settings, sample)              \
      M(settings, has_light_paths) M(settings, has_light_cells)                   \
      M(settings, has_radiance_cells) M(settings, sky_level)                  \
      M(settings, sky_share) M(settings, light_share)                         \
      M(settings, sky_power) M(settings, fog) M(settings, camera_media)       \
      M(settings, has_boundaries) M(settings, point_light_count)                   \
      M(settings, sphere_count) M(settings, directional_light_count)          \
      M(settings, profile_value_count) M(settings, smoke_count)               \
      M(settings, voxel_place_count) M(settings, voxel_count)                 \
      M(settings, smoke_steps_max) M(settings, glow_count) M(settings, pad)   \
      M(settings, tri_count) M(settings, instance_count)                      \
      M(settings, position_count)                                             \
      M(settings, normal_count) M(settings, uv_count)                         \
      M(settings, uv2_count) M(settings, color_count)                         \
      M(settings, alpha_count) M(settings, tangent_count)                     \
      M(settings, material_count) M(settings, texture_count)                  \
      M(settings, texel_count) M(settings, light_count)                       \
      M(settings, light_node_count) M(settings, sky_cdf_count)                \
      M(settings, guide)                                                        \
    S(voxel_field) M(voxel_field, rows) M(voxel_field, origin)                \
      M(voxel_field, first) M(voxel_field, last) M(voxel_field, sides)        \
      M(voxel_field, first_place)                                             \
    S(voxel_place) M(voxel_place, brick) M(voxel_place, majorant)             \
    S(smoke_medium) M(smoke_medium, density) M(smoke_medium, temperature)     \
      M(smoke_medium, extinction) M(smoke_medium, scattering)                 \
      M(smoke_medium, anisotropy) M(smoke_medium, most)                       \
      M(smoke_medium, first_glow) M(smoke_medium, glow_scale)                 \
    S(ray) M(ray, o) M(ray, d) M(ray, t_max) M(ray, key) M(ray, from)         \
    S(path_sample) M(path_sample, radiance) M(path_sample, rays)              \
      M(path_sample, cut)                                                     \
    S(sum) M(sum, lo) M(sum, hi)                                              \
    S(tally) M(tally, samples) M(tally, rays) M(tally, non_finite)            \
      M(tally, saturated) M(tally, cut_paths)                                 \
    S(task) M(task, target) M(task, first_sample) M(task, samples)            \
      M(task, first) M(task, count)                                           \
      M(task, columns) M(task, stride) M(task, width) M(task, x0)             \
      M(task, y0) M(task, has_shares) M(task, light_pixels)                            \
    S(light_grid) M(light_grid, eye) M(light_grid, offset)                    \
      M(light_grid, facing) M(light_grid, distance_scale)                     \
      M(light_grid, width) M(light_grid, count_min)                           \
      M(light_grid, first) M(light_grid, mask)                                \
    S(light_cell) M(light_cell, key) M(light_cell, light) M(light_cell, d)     \
    S(camera_sample) M(camera_sample, ray) M(camera_sample, sampler)                           \
      M(camera_sample, half_number)
/* clang-format on */

struct fact {
    const char *name;
    uint32_t value;       /* value on the host */
    uint32_t member_size; /* 0 for the size of a struct */
    const char *code;     /* the kernel's statement that computes the value */
};

static const struct fact facts[] = {
#define SIZE_FACT(s) \
    {"size of " #s, sizeof(struct s), 0, "out[i++] = sizeof(struct " #s ");\n"},
#define OFFSET_FACT(s, m)                                            \
    {"offset of " #s "." #m, offsetof(struct s, m),                  \
     sizeof(((struct s *)NULL)->m),                                  \
     "{ struct " #s " x; out[i++] = (uint)((__private char *)&x." #m \
     " - (__private char *)&x); }\n"},
    LAYOUT(SIZE_FACT, OFFSET_FACT)};

#define FACTS (sizeof facts / sizeof facts[0])

/* Returns the kernels' text and a kernel `layout` that writes a value for each
 * fact, for free(). */
static char *layout_source(void)
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

/* Builds the text and runs its kernel `layout`. */
static void run_layout(const struct cl_machine *m, const char *text,
                       uint32_t values[FACTS])
{
    const struct cl_api *cl = m->api;
    struct error err;
    cl_int code;
    cl_program program =
        cl->CreateProgramWithSource(m->context, 1, &text, NULL, &code);
    cl_mem out =
        cl_machine_buffer(m, NULL, FACTS * sizeof *values, false, &err);
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
                                           FACTS * sizeof *values, values, 0,
                                           NULL, NULL),
                     CL_SUCCESS);
    cl->ReleaseKernel(kernel);
    cl->ReleaseProgram(program);
    cl->ReleaseMemObject(out);
}

/* The list contains all members, and padding has names. */
static void members_fill_structs(void **state)
{
    uint32_t total = 0;

    (void)state;
    for (size_t i = FACTS; i-- > 0;) {
        if (facts[i].member_size > 0) {
            total += facts[i].member_size;
            continue;
        }
        if (total != facts[i].value)
            print_error("%s: %u, its members have %u\n", facts[i].name,
                        facts[i].value, total);
        assert_int_equal(total, facts[i].value);
        total = 0;
    }
}

static void device_has_the_host_layout(void **state)
{
    struct cl_machine m;
    struct error err;
    uint32_t values[FACTS] = {0};
    char *text;

    (void)state;
    cl_environment_prepare(1);
    if (!cl_machine_open(&m, "Portable", NULL, &err)) {
        print_message("skipped: %s\n", err.text);
        return;
    }
    text = layout_source();
    run_layout(&m, text, values);
    for (size_t i = 0; i < FACTS; i++) {
        if (values[i] != facts[i].value)
            print_error("%s: %u on the device, %u here\n", facts[i].name,
                        values[i], facts[i].value);
        assert_int_equal(values[i], facts[i].value);
    }
    free(text);
    cl_machine_close(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(members_fill_structs),
        cmocka_unit_test(device_has_the_host_layout),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
