// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"
#include "tests/unit/mesh.h"

#include <math.h>

#include "tests/unit/paths.h"
#include "world/light/lights.h"

/* Mean radiance of n paths along one ray, and its standard error. */
struct estimate {
    double mean, error;
};

static struct estimate look(const struct world *w, struct vec3 eye,
                            struct vec3 at, int n)
{
    double sum = 0, squares = 0;
    struct estimate e;

    for (int i = 0; i < n; i++) {
        struct ray r = {eye, v3_unit(v3_sub(at, eye)), FLOAT_MAX, 0, 0};
        struct path_sample s =
            trace_path(w, r, sampler_start(1, 2, (uint64_t)i, w->settings.seed),
                       NULL);

        assert_int_equal(s.cut, 0);
        sum += (double)s.radiance.x;
        squares += (double)s.radiance.x * (double)s.radiance.x;
    }
    e.mean = sum / n;
    e.error = sqrt(fmax(squares / n - e.mean * e.mean, 0) / (n - 1));
    return e;
}

/* Chance exceeds 4.9 standard errors once in a million; the seed is fixed.
 * `rounding` is the relative error of floats. */
static void check_estimate(struct estimate e, double truth, double rounding)
{
    check_close(e.mean, truth, 4.9 * e.error + rounding * truth);
}

/* Returns the error of an object in a constant sky of 1. White objects are
 * invisible, exactly or up to rounding. */
static double furnace_error(struct material material, int n)
{
    struct mesh m = {0};
    uint64_t seed = 9;
    double worst = 0;

    m.materials[0] = material;
    m.world.settings.sky.color = v3(1, 1, 1);
    mesh_add_sphere(&m, v3(0, 0, 0), 0.5f, 24, 40, 0);
    mesh_finish(&m);
    for (int i = 0; i < n; i++) {
        struct vec3 at = v3((float)check_random(&seed) - 0.5f,
                            (float)check_random(&seed) - 0.5f, 0);
        struct estimate e = look(&m.world, v3(0, 0, 3), at, 1);

        worst = fmax(worst, fabs(e.mean - 1));
    }
    mesh_free(&m);
    return worst;
}

static void white_diffuse_vanishes(void **state)
{
    (void)state;
    assert_true(furnace_error(mesh_material(MATERIAL_DIFFUSE, 1.0f), 50000) ==
                0);
}

static void white_paper_vanishes(void **state)
{
    struct material paper = mesh_material(MATERIAL_DIFFUSE, 1.0f);

    (void)state;
    paper.back_color = v3(1, 1, 1);
    paper.translucency = 0.3f;
    check_at_most(furnace_error(paper, 50000), 1e-5);
}

static void smooth_glass_vanishes(void **state)
{
    (void)state;
    check_at_most(furnace_error(mesh_material(MATERIAL_GLASS, 1.0f), 50000),
                  1e-6);
}

static void thin_glass_vanishes(void **state)
{
    (void)state;
    assert_true(
        furnace_error(mesh_material(MATERIAL_THIN_GLASS, 1.0f), 50000) == 0);
}

/* Averages many rays. The tolerance is 3e-3 for each table on the way; a ray
 * meets glass about four times. */
static void white_rough_things_vanish(void **state)
{
    const struct {
        uint32_t kind;
        double meetings;
    } things[] = {{MATERIAL_METAL, 1},
                  {MATERIAL_PLASTIC, 1},
                  {MATERIAL_ROUGH_DIFFUSE, 1},
                  {MATERIAL_GLASS, 4},
                  {MATERIAL_PRINCIPLED, 4}};

    (void)state;
    for (int i = 0; i < 5; i++) {
        struct mesh m = {0};

        m.materials[0] = mesh_material(things[i].kind, 1.0f);
        m.materials[0].alpha = 0.4f;
        m.materials[0].specular = v3(0.04f, 0.04f, 0.04f);
        m.materials[0].metalness = 0.3f;
        m.materials[0].transmission = 0.5f;
        m.materials[0].coat = 0.5f;
        m.materials[0].coat_alpha = 0.2f;
        m.world.settings.sky.color = v3(1, 1, 1);
        mesh_add_sphere(&m, v3(0, 0, 0), 0.5f, 24, 40, 0);
        mesh_finish(&m);
        check_estimate(look(&m.world, v3(0, 0, 3), v3(0.2f, 0.1f, 0.1f),
                            100000),
                       1, 3e-3 * things[i].meetings);
        mesh_free(&m);
    }
}

static void white_mirrors_vanish(void **state)
{
    (void)state;
    assert_true(furnace_error(mesh_material(MATERIAL_METAL, 1.0f), 50000) == 0);
}

/* n clear sheets of ior 1.5 before a lamp transmit T = 1 / (1 + 2 n R / (1 -
 * R)), with R = .04 per face. */
static void sheets_transmit_their_share(void **state)
{
    (void)state;
    for (int n = 1; n <= 4; n++) {
        struct mesh m = {0};
        double r = 0.04;

        m.materials[0] = mesh_material(MATERIAL_GLASS, 1.0f);
        m.materials[1] = mesh_material(MATERIAL_DIFFUSE, 0.0f);
        m.materials[1].emission = v3(1, 1, 1);
        for (int i = 0; i < n; i++)
            mesh_add_box(&m, v3(-1, -1, -0.2f * (float)i - 0.1f),
                         v3(1, 1, -0.2f * (float)i), 0);
        mesh_add_quad(&m, v3(-1, -1, -1), v3(1, -1, -1), v3(1, 1, -1),
                      v3(-1, 1, -1), 1);
        mesh_finish(&m);
        check_estimate(look(&m.world, v3(0.1f, 0.2f, 1), v3(0.1f, 0.2f, 0),
                            200000),
                       1 / (1 + 2 * n * r / (1 - r)), 1e-5);
        mesh_free(&m);
    }
}

/* Radiance inside glass is eta^2 times that outside: a lamp is seen from inside
 * through one face. */
static void radiance_scales_across_a_face(void **state)
{
    struct mesh m = {0};

    (void)state;
    m.materials[0] = mesh_material(MATERIAL_GLASS, 1.0f);
    m.materials[1] = mesh_material(MATERIAL_DIFFUSE, 0.0f);
    m.materials[1].emission = v3(1, 1, 1);
    /* The eye is below the face, in glass, and the lamp above it. */
    mesh_add_quad(&m, v3(-1, 0, 1), v3(1, 0, 1), v3(1, 0, -1), v3(-1, 0, -1),
                  0);
    mesh_add_quad(&m, v3(-9, 1, 9), v3(9, 1, 9), v3(9, 1, -9), v3(-9, 1, -9),
                  1);
    mesh_finish(&m);
    check_estimate(look(&m.world, v3(0, -0.5f, 0), v3(0, 0, 0), 100000),
                   0.96 * 1.5 * 1.5, 1e-5);
    mesh_free(&m);
}

/* STRESS M6: paths from a camera inside glass under total reflection end. */
static void total_reflection_ends(void **state)
{
    struct mesh m = {0};
    struct estimate e;

    (void)state;
    m.materials[0] = mesh_material(MATERIAL_GLASS, 1.0f);
    m.world.settings.sky.color = v3(1, 1, 1);
    mesh_add_box(&m, v3(-0.5f, -0.5f, -0.5f), v3(0.5f, 0.5f, 0.5f), 0);
    mesh_finish(&m);
    for (int i = 0; i < 1000; i++) {
        struct ray r = {v3(0.1f, 0.2f, 0.3f), v3_unit(v3(0.5f, 0.6f, 0.624f)),
                        FLOAT_MAX, 0, 0};
        struct path_sample s =
            trace_path(&m.world, r, sampler_start(0, 0, (uint64_t)i, 0), NULL);

        assert_true(s.rays <= PATH_HARD_STOP);
        /* Never leaves the glass. */
        assert_true(s.radiance.x == 0 && s.cut == 1);
    }
    e = look(&m.world, v3(0.1f, 0.1f, 0), v3(0.1f, 0.1f, 1), 10000);
    check_estimate(e, 1.5 * 1.5, 1e-5); /* everything is sky times eta^2 */
    mesh_free(&m);
}

/* A constant opacity passes its share of rays, independently at every
 * bounce. */
static void opacity_passes_its_share(void **state)
{
    struct mesh m = {0};

    (void)state;
    m.materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.0f);
    m.materials[0].opacity = 0.25f;
    m.world.settings.sky.color = v3(1, 1, 1);
    m.world.settings.features = FEATURE_COVERAGE;
    for (int i = 0; i < 2; i++)
        mesh_add_quad(&m, v3(-1, -1, (float)i), v3(1, -1, (float)i),
                      v3(1, 1, (float)i), v3(-1, 1, (float)i), 0);
    mesh_finish(&m);
    check_estimate(look(&m.world, v3(0.1f, 0.2f, 3), v3(0.1f, 0.2f, 0), 200000),
                   0.75 * 0.75, 0);
    mesh_free(&m);
}

/* Sets the normals of the sphere or the plane that the mesh approximates. */
static void smooth(struct mesh *m, struct vec3 *normals, struct vec3 plane)
{
    for (uint32_t t = 0; t < m->tri_count; t++)
        for (int k = 0; k < 3; k++) {
            uint32_t i = m->tris[t].v[k];

            normals[i] = v3_is_zero(plane) ? v3_unit(m->positions[i]) : plane;
            m->tris[t].vn[k] = m->tris[t].material == 0 ? i : NO_INDEX;
        }
    m->world.normals = normals;
}

/* A coarse ball with normals of a sphere under a small distant lamp is as
 * bright as the sphere, up to the terminator, by the cosine law. Faces that are
 * turned away from the lamp would be black. */
static void coarse_balls_have_smooth_shade(void **state)
{
    static struct vec3 normals[4096];
    /* A face that begins 72 degrees from the lamp is turned away by 95
     * degrees. */
    const struct vec3 lamp = {177.4f, 0, -92.36f};
    const struct vec3 aside = {0.04618f, 0, 0.0887f};
    const struct vec3 above = {0, 0.1f, 0};
    const double lamp_area = 0.2 * 0.2, radiance = 1e7;
    struct mesh m = {0};
    struct lights lights = {0};
    struct error err;
    int seen = 0, turned_away = 0;

    (void)state;
    m.materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.5f);
    m.materials[1] = mesh_material(MATERIAL_DIFFUSE, 0);
    m.materials[1].emission = v3(1e7f, 1e7f, 1e7f);
    mesh_add_sphere(&m, v3(0, 0, 0), 1, 8, 8, 0);
    mesh_add_quad(&m, v3_sub(v3_sub(lamp, aside), above),
                  v3_sub(v3_add(lamp, aside), above),
                  v3_add(v3_add(lamp, aside), above),
                  v3_add(v3_sub(lamp, aside), above), 1);
    m.world.settings.max_vertices = 2;
    assert_true(3 * m.tri_count < 4096);
    smooth(&m, normals, v3(0, 0, 0));
    mesh_finish(&m);
    assert_true(lights_build(&lights, &m.world, &err));
    lights_lend(&lights, &m.world);
    for (int i = 0; i < 400; i++) {
        double angle = M_PI * i / 400;
        struct vec3 at = v3((float)cos(angle), 0.1f, (float)sin(angle));
        struct ray r = {v3_scale(at, 3), v3_unit(v3_neg(at)), FLOAT_MAX, 0, 0};
        struct vec3 to_lamp;
        struct surface_point v;
        struct hit h;
        double cosine, truth, got = 0;

        assert_true(hit_closest(&m.world, r, &h));
        assert_true(surface_at(&m.world, &m.materials[0], r, h, &v));
        to_lamp = v3_sub(lamp, v.p);
        cosine = (double)v3_dot(v.n, v3_unit(to_lamp));
        if (cosine < 0.1)
            continue;
        for (uint32_t k = 0; k < 16; k++)
            got +=
                (double)trace_path(&m.world, r, sampler_start(0, 0, k, 0), NULL)
                    .radiance.x /
                16;
        truth = 0.5 / M_PI * radiance * lamp_area * cosine /
                (double)v3_dot(to_lamp, to_lamp);
        /* The vertex moves by up to .15 of 200, and the cosine is at least
         * .1. */
        check_close(got / truth, 1, 0.15 / 200 / 0.1 + 0.0015);
        turned_away += v3_dot(v.ng, to_lamp) < 0.0f;
        seen++;
    }
    assert_true(seen > 100);
    assert_true(turned_away > 10);
    lights_free(&lights);
    mesh_free(&m);
}

/* Normals that lean towards a light behind a wall do not let it through. */
static void leaning_normals_leak_nothing(void **state)
{
    static struct vec3 normals[64];
    struct mesh m = {0};
    struct ray r = {{0.2f, 0.1f, 1}, {0, 0, -1}, FLOAT_MAX, 0, 0};

    (void)state;
    m.materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.9f);
    m.materials[1] = mesh_material(MATERIAL_DIFFUSE, 0);
    m.materials[1].emission = v3(5, 5, 5);
    mesh_add_quad(&m, v3(-9, -9, 0), v3(9, -9, 0), v3(9, 9, 0), v3(-9, 9, 0),
                  0);
    mesh_add_quad(&m, v3(-9, -9, -1), v3(9, -9, -1), v3(9, 9, -1),
                  v3(-9, 9, -1), 1);
    smooth(&m, normals, v3_unit(v3(3, 0, 1)));
    mesh_finish(&m);
    for (uint32_t i = 0; i < 20000; i++)
        assert_true(v3_is_zero(
            trace_path(&m.world, r, sampler_start(0, 0, i, 0), NULL).radiance));
    mesh_free(&m);
}

/* Returns true if a face moves whose vertex normals lean outwards, along x and
 * y, by these tangents. */
static bool moves(float along_x, float along_y)
{
    struct vec3 normals[6];
    struct mesh m = {0};
    struct ray r = {{0.3f, 0.2f, 1}, {0, 0, -1}, FLOAT_MAX, 0, 0};
    struct surface_point v, before;
    struct hit h;

    m.materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.5f);
    mesh_add_quad(&m, v3(-1, -1, 0), v3(1, -1, 0), v3(1, 1, 0), v3(-1, 1, 0),
                  0);
    assert_true(3 * m.tri_count <= 6);
    smooth(&m, normals, v3(0, 0, 1));
    for (uint32_t i = 0; i < 3 * m.tri_count; i++)
        normals[i] = v3_unit(
            v3(along_x * m.positions[i].x, along_y * m.positions[i].y, 1));
    mesh_finish(&m);
    assert_true(hit_closest(&m.world, r, &h));
    assert_true(surface_at(&m.world, &m.materials[0], r, h, &v));
    before = v;
    surface_lift(&m.world, h.tri, h, &v);
    assert_int_equal(v.is_lifted, v.p.z > 0.0f);
    assert_true(v.is_lifted || (v3_is_zero(v3_sub(v.p, before.p)) &&
                                v3_is_zero(v3_sub(v.above, before.above))));
    mesh_free(&m);
    return v.is_lifted;
}

/* A face of a pipe of eight sides moves to the round pipe. A face of a box with
 * smoothed edges or corners stays, as light would pass through the corners of
 * things that touch it. */
static void faces_of_boxes_stay(void **state)
{
    const float pipe = tanf((float)M_PI / 8);

    (void)state;
    assert_true(moves(pipe, 0));
    assert_true(moves(pipe, pipe));
    assert_false(moves(1, 0));
    assert_false(moves(1, 1));
    assert_false(moves(0, 0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coarse_balls_have_smooth_shade),
        cmocka_unit_test(leaning_normals_leak_nothing),
        cmocka_unit_test(faces_of_boxes_stay),
        cmocka_unit_test(white_diffuse_vanishes),
        cmocka_unit_test(white_paper_vanishes),
        cmocka_unit_test(smooth_glass_vanishes),
        cmocka_unit_test(thin_glass_vanishes),
        cmocka_unit_test(white_mirrors_vanish),
        cmocka_unit_test(white_rough_things_vanish),
        cmocka_unit_test(sheets_transmit_their_share),
        cmocka_unit_test(radiance_scales_across_a_face),
        cmocka_unit_test(total_reflection_ends),
        cmocka_unit_test(opacity_passes_its_share),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
