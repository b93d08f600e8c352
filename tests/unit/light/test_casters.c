// SPDX-License-Identifier: MIT
/* test_casters.c - points on surfaces that cast: integrals over them, by any
 * weights, and where the points are */
#include "world/light/casters.h"

#include <math.h>

#include "tests/unit/check.h"
#include "tests/unit/mesh.h"

#define POINTS 200000

enum { MATTE, GLASS };

/* A matte sphere between two of glass, of radii 1 and .5. */
static void make_spheres(struct mesh *m)
{
    *m = (struct mesh){.world.settings.material_count = 2};
    m->materials[MATTE] = mesh_material(MATERIAL_DIFFUSE, 0.5f);
    m->materials[GLASS] = mesh_material(MATERIAL_GLASS, 1);
    m->materials[GLASS].role = ROLE_CASTS;
    mesh_add_sphere(m, v3(-3, 0, 0), 1, 16, 32, GLASS);
    mesh_add_sphere(m, v3(0, 0, 0), 1, 16, 32, MATTE);
    mesh_add_sphere(m, v3(3, 0, 0), .5f, 16, 32, GLASS);
    mesh_finish(m);
}

/* Integrals over the area of glass: of 1, and of a function. */
struct integrals {
    double area, x;
};

static double f(struct vec3 p)
{
    return (double)(p.x * p.y * p.y + p.z * p.z);
}

static struct integrals sampled(const struct casters *c, const struct world *w)
{
    struct integrals sum = {0, 0};
    uint64_t seed = 9;

    for (int i = 0; i < POINTS; i++) {
        double choice = check_random(&seed);
        struct vec2 u =
            v2((float)check_random(&seed), (float)check_random(&seed));
        struct caster_point at = casters_choose(c, w, choice, u);

        assert_int_equal(w->tris[at.tri].material, GLASS);
        assert_true(at.area > 0.0f);
        sum.area += (double)at.area / POINTS;
        sum.x += (double)at.area * f(at.p) / POINTS;
    }
    return sum;
}

/* By the middles of 64 parts of each triangle. */
static struct integrals summed(const struct world *w)
{
    struct integrals sum = {0, 0};

    for (uint32_t i = 0; i < w->settings.tri_count; i++)
        for (int k = 0; w->tris[i].material == GLASS && k < 64; k++) {
            struct vec2 u =
                v2(((float)(k % 8) + .5f) / 8, ((float)(k / 8) + .5f) / 8);

            sum.area += tri_area(w, i) / 64;
            sum.x += tri_area(w, i) / 64 * f(tri_point(w, i, u));
        }
    return sum;
}

/* Returns the mean of the radiance of points: the share in the large sphere. */
static double large_share(const struct casters *c, const struct world *w)
{
    int large = 0;

    for (int i = 0; i < 10000; i++)
        large += casters_choose(c, w, (i + .5) / 10000, v2(.5f, .5f)).p.x < 0;
    return large / 10000.;
}

static void weights_keep_integrals(void **state)
{
    struct mesh m;
    struct casters c;
    struct integrals truth;
    double light[512];

    (void)state;
    make_spheres(&m);
    truth = summed(&m.world);
    assert_true(casters_build(&c, &m.world));
    /* eight octants of two spheres, which the grid divides further */
    assert_in_range(c.cluster_count, 16, 512);
    check_close(sampled(&c, &m.world).area, truth.area, 1e-6 * truth.area);
    check_close(sampled(&c, &m.world).x, truth.x, .02 * fabs(truth.x));
    check_close(large_share(&c, &m.world), .8, .001);
    for (uint32_t i = 0; i < c.cluster_count; i++) {
        struct vec3 p = casters_choose_in(&c, &m.world, i, .5, v2(.5f, .5f)).p;

        light[i] = p.x > 0 ? 8 : p.y > 0 ? 1 : 0;
    }
    casters_weigh(&c, light);
    check_close(sampled(&c, &m.world).area, truth.area, .01 * truth.area);
    check_close(sampled(&c, &m.world).x, truth.x, .02 * fabs(truth.x));
    /* a mean of 2 by area, of which a fifth is added to all */
    check_close(large_share(&c, &m.world), .8 * .9 / (.8 * .9 + .2 * 8.4),
                .005);
    casters_free(&c);
    mesh_free(&m);
}

/* Samples of a cluster are in it, and those of all choices are the clusters',
 * one after the other. */
static void clusters_are_sampled(void **state)
{
    struct mesh m;
    struct casters c;

    (void)state;
    make_spheres(&m);
    assert_true(casters_build(&c, &m.world));
    for (uint32_t i = 0; i < c.cluster_count; i++)
        for (int k = 0; k < 16; k++) {
            double choice = (k + .5) / 16;
            uint32_t tri =
                casters_choose_in(&c, &m.world, i, choice, v2(.5f, .5f)).tri;
            uint32_t begin = i > 0 ? c.ends[i - 1] : 0;
            bool is_in = false;

            for (uint32_t n = begin; n < c.ends[i]; n++)
                is_in = is_in || c.list.tris[n] == tri;
            assert_true(is_in);
        }
    casters_free(&c);
    mesh_free(&m);
}

/* Light that is nowhere, or that has no number, changes nothing. */
static void no_light_changes_nothing(void **state)
{
    static const double values[] = {0, INFINITY, NAN};
    struct mesh m;
    struct casters c;
    double light[512];

    (void)state;
    make_spheres(&m);
    assert_true(casters_build(&c, &m.world));
    for (size_t k = 0; k < sizeof values / sizeof values[0]; k++) {
        for (uint32_t i = 0; i < c.cluster_count; i++)
            light[i] = values[k];
        casters_weigh(&c, light);
        check_close(large_share(&c, &m.world), .8, .001);
    }
    casters_free(&c);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weights_keep_integrals),
        cmocka_unit_test(clusters_are_sampled),
        cmocka_unit_test(no_light_changes_nothing),
    };

    return cmocka_run_group_tests_name("casters", tests, NULL, NULL);
}
