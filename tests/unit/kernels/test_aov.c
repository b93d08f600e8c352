// SPDX-License-Identifier: MIT
/*
 * test_aov.c - previews and features of camera rays against closed forms
 */
#include "base/memory.h"
#include "tests/unit/check.h"
#include "tests/unit/mesh.h"

#include <math.h>

#include "tests/unit/paths.h"

#define SIDE 32

static struct mesh mesh;

/* Half the width of the picture at distance 1 from the eye. */
static double half_width = 1;

/* The camera looks along -z from z = 3. */
static void look_down(struct world *w, double half)
{
    half_width = half;
    w->settings.camera = (struct camera){.eye = {0, 0, 3},
                                         .width = SIDE,
                                         .forward = {0, 0, -1},
                                         .height = SIDE,
                                         .right = {(float)half, 0, 0},
                                         .up = {0, (float)half, 0}};
}

static struct vec3 sample_of(enum sample_kind kind, uint32_t x, uint32_t y,
                             uint64_t index)
{
    struct sample_id place = {x, y, index};
    struct path_sample s;

    mesh.world.settings.sample = kind;
    trace_samples(&mesh.world, &place, 1, &s, NULL);
    assert_int_equal(s.rays, 1);
    assert_int_equal(s.cut, 0);
    return s.radiance;
}

/* Returns the direction through the middle of a pixel, by definition. */
static void direction_of(uint32_t x, uint32_t y, double d[3])
{
    double sx = half_width * (2 * (x + 0.5) / SIDE - 1);
    double sy = half_width * (1 - 2 * (y + 0.5) / SIDE);
    double length = sqrt(sx * sx + sy * sy + 1);

    d[0] = sx / length;
    d[1] = sy / length;
    d[2] = -1 / length;
}

static void check_vector(struct vec3 got, const double want[3], double bound)
{
    check_close((double)got.x, want[0], bound);
    check_close((double)got.y, want[1], bound);
    check_close((double)got.z, want[2], bound);
}

/* Facets have the sphere's normals at their vertices, so that interpolated
 * normals point exactly away from the centre. Normals that would point away
 * from the eye are not used. The face's own normal is near. */
static void normals_are_those_of_the_sphere(void **state)
{
    const float radius = 0.5f;
    struct vec3 *normals;
    int seen = 0;

    (void)state;
    mesh = (struct mesh){0};
    mesh.materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.5f);
    mesh_add_sphere(&mesh, v3(0, 0, 0), radius, 9, 11, 0);
    normals = alloc_array(3u * mesh.tri_count, sizeof *normals);
    assert_non_null(normals);
    for (uint32_t i = 0; i < 3 * mesh.tri_count; i++) {
        normals[i] = v3_scale(mesh.positions[i], 1.0f / radius);
        mesh.tris[i / 3].vn[i % 3] = i;
    }
    mesh.world.normals = normals;
    look_down(&mesh.world, 0.2);
    mesh_finish(&mesh);
    for (uint32_t y = 0; y < SIDE; y++) {
        for (uint32_t x = 0; x < SIDE; x++) {
            struct vec3 numbers = sample_of(SAMPLE_NORMAL, x, y, 0);
            double t = (double)sample_of(SAMPLE_DEPTH, x, y, 0).x;
            double d[3], p[3], want[3];
            struct vec3 face;

            direction_of(x, y, d);
            if (t == 0) {
                /* The sky appears only outside of the sphere. */
                assert_true(v3_is_zero(numbers));
                continue;
            }
            seen++;
            for (int k = 0; k < 3; k++)
                p[k] = (k == 2 ? 3 : 0) + t * d[k];
            double length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
            assert_true(length <= 0.5000001);
            for (int k = 0; k < 3; k++)
                want[k] = 0.5 + 0.5 * p[k] / length;
            if (p[0] * d[0] + p[1] * d[1] + p[2] * d[2] < -1e-3 * length)
                check_vector(numbers, want, 1e-5);
            /* Facets of 20 x 33 degrees are close to the sphere. */
            face = sample_of(SAMPLE_FACE, x, y, 0);
            face = v3_sub(v3_scale(face, 2), v3(1, 1, 1));
            check_close((double)v3_length(face), 1, 1e-6);
            check_at_most(cos(0.45), (double)face.x * p[0] / length +
                                         (double)face.y * p[1] / length +
                                         (double)face.z * p[2] / length);
        }
    }
    /* A sphere would have pi (16 / 0.2)^2 / (3^2 / 0.5^2 - 1) = 574 pixels. */
    assert_in_range(seen, 500, 574);
    free(normals);
    mesh_free(&mesh);
}

/* A floor is perpendicular to the view: distances, uvs and material numbers are
 * known at every pixel, for any sample, seed and lens. */
static void features_of_a_wall_are_exact(void **state)
{
    static const struct vec2 uvs[] = {{-3, -3}, {3, -3}, {3, 3}, {-3, 3}};

    (void)state;
    mesh = (struct mesh){0};
    for (uint32_t i = 0; i < 2; i++)
        mesh.materials[i] = mesh_material(MATERIAL_DIFFUSE, 0.5f);
    mesh_add_quad(&mesh, v3(-4, -4, 1), v3(4, -4, 1), v3(4, 4, 1), v3(-4, 4, 1),
                  1);
    for (uint32_t i = 0; i < 3; i++) {
        mesh.tris[0].vt[i] = i;
        mesh.tris[1].vt[i] = i == 0 ? 0 : i + 1;
    }
    mesh.world.uvs = uvs;
    look_down(&mesh.world, 1);
    mesh.world.settings.camera.lens_radius = 0.5f;
    mesh.world.settings.camera.focus = 1;
    mesh_finish(&mesh);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        uint32_t x = i % SIDE, y = i / SIDE;
        double d[3], u, v;
        struct vec3 uv;

        mesh.world.settings.seed = i;
        direction_of(x, y, d);
        check_close((double)sample_of(SAMPLE_DEPTH, x, y, i).x, -2 / d[2],
                    1e-6);
        assert_true(sample_of(SAMPLE_MATERIAL, x, y, i).x == 2.0f);
        check_vector(sample_of(SAMPLE_FACE, x, y, i), (double[3]){0.5, 0.5, 1},
                     1e-7);
        u = 0.75 * 2 * d[0] / -d[2];
        v = 0.75 * 2 * d[1] / -d[2];
        uv = sample_of(SAMPLE_UV, x, y, i);
        check_close((double)uv.x, u - floor(u), 1e-5);
        check_close((double)uv.y, v - floor(v), 1e-5);
        assert_true(uv.z == 1.0f);
    }
    mesh_free(&mesh);
}

/* From behind, the face normal keeps the winding, and the shading normal turns
 * to the eye. */
static void faces_keep_their_winding(void **state)
{
    (void)state;
    mesh = (struct mesh){0};
    mesh.materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.5f);
    mesh_add_quad(&mesh, v3(-4, -4, 1), v3(-4, 4, 1), v3(4, 4, 1), v3(4, -4, 1),
                  0);
    look_down(&mesh.world, 1);
    mesh_finish(&mesh);
    check_vector(sample_of(SAMPLE_FACE, 3, 4, 0), (double[3]){0.5, 0.5, 0}, 0);
    check_vector(sample_of(SAMPLE_NORMAL, 3, 4, 0), (double[3]){0.5, 0.5, 1},
                 0);
    assert_true(v3_is_zero(sample_of(SAMPLE_UV, 3, 4, 0)));
    mesh_free(&mesh);
}

/* Colours are multiplied by the cosine towards the eye, lamps have their hue,
 * and the sky is unchanged. */
static void previews_show_colours_times_the_cosine(void **state)
{
    (void)state;
    mesh = (struct mesh){0};
    mesh.materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.8f);
    mesh.materials[1] = mesh_material(MATERIAL_DIFFUSE, 0);
    mesh.materials[1].emission = v3(40, 20, 10);
    mesh.world.settings.sky.color = v3(0.1f, 0.2f, 7);
    mesh_add_quad(&mesh, v3(-2, -1, 1), v3(0, -1, 1), v3(0, 1, 1), v3(-2, 1, 1),
                  0);
    mesh_add_quad(&mesh, v3(0, -1, 1), v3(2, -1, 1), v3(2, 1, 1), v3(0, 1, 1),
                  1);
    look_down(&mesh.world, 1);
    mesh_finish(&mesh);
    for (uint32_t x = 0; x < SIDE / 2; x++) {
        double d[3], shade;

        direction_of(x, SIDE / 2, d);
        shade = 0.8 * (0.25 - 0.75 * d[2]);
        check_vector(sample_of(SAMPLE_PREVIEW, x, SIDE / 2, 0),
                     (double[3]){shade, shade, shade}, 1e-6);
    }
    check_vector(sample_of(SAMPLE_PREVIEW, SIDE / 2, SIDE / 2, 0),
                 (double[3]){1, 0.5, 0.25}, 1e-6);
    mesh.materials[1].emission = v3(0, 0, 0);
    mesh.materials[1].back_color = v3(1, 0.5f, 0.25f);
    mesh.materials[1].translucency = 1;
    check_vector(sample_of(SAMPLE_PREVIEW, SIDE / 2, SIDE / 2, 0),
                 (double[3]){1, 0.5, 0.25}, 1e-3);
    assert_true(sample_of(SAMPLE_PREVIEW, 0, 0, 0).z == 7.0f);
    assert_true(v3_is_zero(sample_of(SAMPLE_DEPTH, 0, 0, 0)));
    assert_true(v3_is_zero(sample_of(SAMPLE_MATERIAL, 0, 0, 0)));
    mesh_free(&mesh);
}

/* Spheres and discs have their hue; what is before them hides them. */
static void previews_show_spheres_and_discs(void **state)
{
    struct point_light sphere = {.p = {0, 0, 0},
                                 .radius = 0.1f,
                                 .cone_offset = 1,
                                 .emission = {8, 4, 2}};
    struct directional_light disc = {.size = 1e-4f,
                                     .emission = {50, 100, 0},
                                     .power = 1};
    double d[3];

    (void)state;
    mesh = (struct mesh){0};
    mesh.materials[0] = mesh_material(MATERIAL_DIFFUSE, 0);
    mesh_add_quad(&mesh, v3(-2, -1, 1), v3(0, -1, 1), v3(0, 1, 1), v3(-2, 1, 1),
                  0);
    look_down(&mesh.world, 1);
    direction_of(SIDE - 1, SIDE / 2, d);
    disc.d = v3((float)d[0], (float)d[1], (float)d[2]);
    mesh.world.point_lights = &sphere;
    mesh.world.settings.point_light_count = 1;
    mesh.world.settings.sphere_count = 1;
    mesh.world.directional_lights = &disc;
    mesh.world.settings.directional_light_count = 1;
    mesh_finish(&mesh);
    direction_of(SIDE / 2, SIDE / 2, d);
    sphere.p = v3_add(mesh.world.settings.camera.eye,
                      v3((float)d[0], (float)d[1], (float)d[2]));
    check_vector(sample_of(SAMPLE_PREVIEW, SIDE / 2, SIDE / 2, 0),
                 (double[3]){1, 0.5, 0.25}, 1e-6);
    check_vector(sample_of(SAMPLE_PREVIEW, SIDE - 1, SIDE / 2, 0),
                 (double[3]){0.5, 1, 0}, 1e-6);
    assert_true(v3_is_zero(sample_of(SAMPLE_PREVIEW, SIDE - 1, 0, 0)));
    assert_true(v3_is_zero(sample_of(SAMPLE_DEPTH, SIDE - 1, SIDE / 2, 0)));
    direction_of(2, SIDE / 2, d);
    sphere.p =
        v3_add(mesh.world.settings.camera.eye,
               v3((float)(20 * d[0]), (float)(20 * d[1]), (float)(20 * d[2])));
    assert_true(v3_is_zero(sample_of(SAMPLE_PREVIEW, 2, SIDE / 2, 0)));
    mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normals_are_those_of_the_sphere),
        cmocka_unit_test(features_of_a_wall_are_exact),
        cmocka_unit_test(faces_keep_their_winding),
        cmocka_unit_test(previews_show_colours_times_the_cosine),
        cmocka_unit_test(previews_show_spheres_and_discs),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
