// SPDX-License-Identifier: MIT
#include "kernels/light_tree.h"
#include "kernels/sphere_walk.h"

#include <math.h>
#include <stdlib.h>

#include "world/light/lights.h"

#include "tests/unit/check.h"
#include "tests/unit/chi_square.h"
#include "tests/unit/lambert.h"
#include "tests/unit/lamps.h"
#include "tests/unit/mesh.h"

static void probabilities_of_lights_sum_to_one(void **state)
{
    const int counts[] = {1, 2, 8, 9, 100, 3000};

    (void)state;
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        uint64_t seed = 11;
        struct mesh m = {0};
        struct lights lights;

        add_lamps(&m, counts[k], 0.1, &seed);
        finish(&m, &lights);
        assert_int_equal(lights.light_count, counts[k]);
        for (int i = 0; i < 20; i++) {
            struct receiver r = any_receiver(&seed);

            check_close(sum_of_probabilities(&m.world, &r), 1, 2e-5);
        }
        discard(&m, &lights);
    }
}

/* Chi-square test over the lights, from 20 receivers. */
static void choices_follow_probabilities(void **state)
{
    const int n = 200000;
    uint64_t seed = 5;
    struct mesh m = {0};
    struct lights lights;

    (void)state;
    add_lamps(&m, 100, 0.2, &seed);
    finish(&m, &lights);
    for (int k = 0; k < 20; k++) {
        struct receiver r = any_receiver(&seed);
        int counts[100] = {0};
        struct chi_square chi = chi_begin();

        for (int i = 0; i < n; i++) {
            uint32_t light;
            float p =
                light_tree_sample(&m.world, &r, any_choice(&seed), &light);

            assert_true(p == light_tree_pmf(&m.world, &r, light));
            counts[light]++;
        }
        for (uint32_t i = 0; i < 100; i++)
            chi_add(&chi, n * (double)light_tree_pmf(&m.world, &r, i),
                    counts[i]);
        chi_end(&chi);
        check_at_most(fabs(chi_deviate(&chi)), Z_LIMIT);
    }
    discard(&m, &lights);
}

/* Returns whether a part of the triangle is above the receiver's plane and the
 * triangle is not seen exactly edge-on. */
static bool contributes(const struct world *w, const struct receiver *r,
                        uint32_t tri)
{
    struct vec3 p[3], ng;
    float most = -1;

    for (int k = 0; k < 3; k++) {
        struct vec3 d;

        p[k] = w->positions[w->tris[tri].v[k]];
        d = v3_unit(v3_sub(p[k], r->p));
        most = f_max(most, v3_dot(d, r->n));
    }
    if (!triangle_normal(p[0], p[1], p[2], &ng))
        return false;
    return (most > 0 || r->transmits) &&
           fabsf(v3_dot(ng, v3_sub(p[0], r->p))) > 0;
}

static void no_contributing_light_is_left_out(void **state)
{
    uint64_t seed = 31;

    (void)state;
    for (int k = 0; k < 300; k++) {
        struct mesh m = {0};
        struct lights lights;

        add_lamps(&m, 32, k % 3 == 0 ? 0.5 : 0.02, &seed);
        add_quads(&m, 32, k % 3 == 0 ? 0.5 : 0.02, &seed);
        finish(&m, &lights);
        for (int i = 0; i < 50; i++) {
            struct receiver r = any_receiver(&seed);

            for (uint32_t t = 0; t < m.tri_count; t++)
                if (contributes(&m.world, &r, t))
                    assert_true(
                        light_tree_pmf(&m.world, &r, lights.tri_lights[t]) > 0);
        }
        discard(&m, &lights);
    }
}

/* The estimated power of a child node is at least 1/72 of that of the lamps
 * below it, seen from more than two of its radii away: cosines are at least a
 * quarter of their bounds, no lamp is nearer than half the distance to the
 * middle, and a quarter of the radius squared adds 1/16 of the middle's
 * distance squared. */
static void clusters_are_not_underrated(void **state)
{
    uint64_t seed = 90;
    struct mesh m = {0};
    struct lights lights;
    double area = 0;
    int checked = 0;

    (void)state;
    add_lamps(&m, 400, 0.1, &seed);
    finish(&m, &lights);
    for (uint32_t t = 0; t < m.tri_count; t++) {
        const struct vec3 *p = &m.positions[3 * t];

        area += (double)v3_length(
                    v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]))) /
                2;
    }
    for (int k = 0; k < 50; k++) {
        struct receiver r = any_receiver(&seed);
        double(*below)[LIGHT_WIDTH] = calloc(lights.node_count, sizeof *below);

        r.transmits = false;
        assert_non_null(below);
        for (uint32_t l = 0; l < lights.light_count; l++) {
            double e =
                lambert(&m.positions[3 * lights.lights[l].tris[0]], 3, &r);

            for (uint32_t at = 0, level = 0; (at & LIGHT_LEAF) == 0; level++) {
                uint32_t i = lights.lights[l].path[0] >> 3 * level & 7;

                below[at][i] += e / area;
                at = lights.nodes[at].child[i];
            }
        }
        for (uint32_t n = 0; n < lights.node_count; n++) {
            const struct light_node *node = &lights.nodes[n];
            float sums[LIGHT_WIDTH + 1];

            light_node_cdf(&m.world, n, &r, sums);
            for (int i = 0; i < LIGHT_WIDTH; i++) {
                struct vec3 to =
                    v3_sub(v3(node->x[i], node->y[i], node->z[i]), r.p);
                double share = (double)(sums[i + 1] - sums[i]);

                if (v3_length(to) < 2 * node->radius[i] || below[n][i] <= 0)
                    continue;
                check_at_most(below[n][i] / 72, share + 1e-6 * (double)sums[8]);
                checked++;
            }
        }
        free(below);
    }
    assert_true(checked > 5000);
    discard(&m, &lights);
}

/* All lamps have the same size and distance. The lamp seen edge-on is chosen
 * only by chance, whatever the winding of the others. */
static void orientation_counts_and_winding_does_not(void **state)
{
    struct receiver r = {{0, 0, 0}, {0, 1, 0}, false, false};
    struct mesh m = {0};
    struct lights lights;

    (void)state;
    mesh_add(&m, v3(-0.5f, 1, 0), v3(-0.49f, 1, 0), v3(-0.5f, 1, 0.01f), LAMP);
    mesh_add(&m, v3(0.5f, 1, 0), v3(0.5f, 1, 0.01f), v3(0.49f, 1, 0), LAMP);
    mesh_add(&m, v3(0.5f, 1, 0), v3(0.49f, 1, 0), v3(0.5f, 1, 0.01f), LAMP);
    mesh_add(&m, v3(-0.5f, 1, 0), v3(-0.505f, 1.01f, 0), v3(-0.5f, 1, 0.01f),
             LAMP);
    finish(&m, &lights);
    for (uint32_t l = 0; l < 3; l++)
        check_close(light_tree_pmf(&m.world, &r, l), 1.0 / 3, 0.02);
    check_at_most(light_tree_pmf(&m.world, &r, 3), 0.02);
    discard(&m, &lights);
}

/* The second random number chooses the lower levels of a deep tree, where the
 * first one has no digits left. */
static void both_random_numbers_choose(void **state)
{
    uint64_t seed = 70;
    struct mesh m = {0};
    struct lights lights;

    (void)state;
    add_lamps(&m, 5000, 0.01, &seed);
    finish(&m, &lights);
    for (int k = 0; k < 20; k++) {
        struct receiver r = any_receiver(&seed);
        uint32_t first, light;
        int others = 0;

        assert_true(light_tree_sample(&m.world, &r, v2(0.3f, 0), &first) > 0);
        for (int i = 1; i < 16; i++) {
            light_tree_sample(&m.world, &r, v2(0.3f, (float)i / 16), &light);
            others += light != first;
        }
        assert_true(others > 0);
    }
    discard(&m, &lights);
}

/* On a floor under a ceiling of 2500 lamps the variance of single estimates is
 * much less than with a uniform choice. */
static void tree_prefers_the_near_lights(void **state)
{
    uint64_t seed = 8;
    struct mesh m = {0};
    struct lights lights;
    double spread = 0, plain = 0;

    (void)state;
    for (int i = 0; i < 2500; i++) {
        float x = (float)(i % 50) / 25 - 1, z = (float)(i / 50) / 25 - 1;
        struct vec3 p = v3(x, 0.1f, z);

        mesh_add(&m, p, v3_add(p, v3(0.01f, 0, 0)), v3_add(p, v3(0, 0, 0.01f)),
                 LAMP);
    }
    finish(&m, &lights);
    for (int i = 0; i < 20; i++) {
        struct receiver r = {v3(between(&seed, -1, 1), 0,
                                between(&seed, -1, 1)),
                             v3(0, 1, 0), false, false};
        double error, truth = 0, squares = 0;

        irradiance(&m.world, &r, 2000, &seed, &error);
        for (uint32_t t = 0; t < m.tri_count; t++) {
            double e = lambert(&m.positions[3 * t], 3, &r);

            truth += e;
            squares += e * e;
        }
        spread += error / truth * sqrt(2000);
        plain += sqrt(2500 * squares / truth / truth - 1);
    }
    check_at_most(spread, plain / 4);
    discard(&m, &lights);
}

/* STRESS G7 to G9: no scene makes the path to a light too long. */
static void deep_trees_fit_into_the_path_s_bits(void **state)
{
    struct receiver r = {{0.3f, 0.2f, 0.1f}, {1, 0, 0}, true, false};
    struct mesh m = {0};
    struct lights lights;

    (void)state;
    for (int i = 0; i < 60; i++) {
        struct vec3 p = v3(ldexpf(1, -i / 2), 0, 0);
        float side = ldexpf(1, -i / 2 - 2);

        mesh_add(&m, p, v3_add(p, v3(side, 0, 0)), v3_add(p, v3(0, side, 0)),
                 LAMP);
    }
    finish(&m, &lights);
    check_close(sum_of_probabilities(&m.world, &r), 1, 1e-5);
    discard(&m, &lights);

    m = (struct mesh){0};
    for (int i = 0; i < 20000; i++)
        mesh_add(&m, v3(0, 0, 0), v3(0.1f, 0, 0), v3(0, 0.1f, 0), LAMP);
    finish(&m, &lights);
    check_close(sum_of_probabilities(&m.world, &r), 1, 1e-3);
    for (uint32_t l = 0; l < lights.light_count; l += 977)
        check_close(light_tree_pmf(&m.world, &r, l) * 20000, 1, 0.3);
    discard(&m, &lights);
}

/* Irradiance at a receiver by the definition of a point light. A sphere that
 * the horizon cuts has less than this. */
static double point_irradiance(const struct point_light *l,
                               const struct receiver *r)
{
    struct vec3 to = v3_sub(l->p, r->p);
    double square = (double)v3_dot(to, to), distance = sqrt(square);
    double spot = (double)l->cone_offset - (double)l->cone_scale *
                                               (double)v3_dot(l->axis, to) /
                                               distance;
    double area = l->radius > 0 ? M_PI * (double)(l->radius * l->radius) : 1;

    spot = fmin(fmax(spot, 0), 1);
    return (double)l->emission.x * area * spot * spot *
           fmax((double)v3_dot(to, r->n), 0) / distance / square;
}

/* Point lights are chosen beside area lights, each with the probability that
 * MIS weights use. */
static void trees_hold_points_and_lamps(void **state)
{
    const uint32_t areas[] = {0, 1, 40, 0, 40};
    const uint32_t counts[] = {1, 1, 1, 200, 300};

    (void)state;
    for (size_t k = 0; k < 5; k++) {
        uint64_t seed = 21;
        struct point_light points[300];
        struct mesh m = {0};
        struct lights lights;

        add_lamps(&m, (int)areas[k], 0.1, &seed);
        fill_points(points, counts[k], &seed);
        m.world.point_lights = points;
        m.world.settings.point_light_count = counts[k];
        finish(&m, &lights);
        assert_int_equal(lights.light_count, areas[k]);
        assert_int_equal(lights.point_light_count, counts[k]);
        for (int i = 0; i < 20; i++) {
            struct receiver r = any_receiver(&seed);
            int points_chosen = 0;

            check_close(sum_of_probabilities(&m.world, &r), 1, 2e-5);
            for (int n = 0; n < 2000; n++) {
                uint32_t light;
                float p =
                    light_tree_sample(&m.world, &r, any_choice(&seed), &light);

                assert_true(p > 0 && p == light_tree_pmf(&m.world, &r, light));
                points_chosen += light >= areas[k];
            }
            assert_true(areas[k] == 0 ? points_chosen == 2000
                                      : points_chosen > 0);
        }
        for (uint32_t i = 0; i < counts[k]; i++)
            assert_int_equal(lights.point_lights[i].radius > 0,
                             i < lights.sphere_count);
        discard(&m, &lights);
    }
}

/* 200 points and spots among 60 lamps: the mean of light samples is the sum
 * over all lights one by one, and the variance is much less than with a choice
 * by power alone. */
static void many_points_add_up(void **state)
{
    uint64_t seed = 33;
    struct point_light points[300], kept[200];
    struct mesh m = {0};
    struct lights lights;
    double spread = 0, plain = 0;
    uint32_t count = 0;

    (void)state;
    fill_points(points, 300, &seed);
    for (uint32_t i = 0; i < 300; i++)
        if (points[i].radius == 0)
            kept[count++] = points[i];
    assert_int_equal(count, 200);
    add_lamps(&m, 60, 0.1, &seed);
    m.world.point_lights = kept;
    m.world.settings.point_light_count = count;
    finish(&m, &lights);
    for (int i = 0; i < 40; i++) {
        struct receiver r = any_receiver(&seed);
        double truth = 0, squares = 0, power = 0, error, mean;

        r.transmits = false;
        for (uint32_t k = 0; k < count; k++)
            power += (double)kept[k].emission.x;
        for (uint32_t k = 0; k < count; k++) {
            double e = point_irradiance(&kept[k], &r);

            truth += e;
            squares += e * e * power / (double)kept[k].emission.x;
        }
        plain += sqrt(squares / truth / truth - 1);
        for (uint32_t t = 0; t < m.tri_count; t++)
            truth += lambert(&m.positions[3 * t], 3, &r);
        mean = irradiance(&m.world, &r, 40000, &seed, &error);
        check_close(mean, truth, Z_LIMIT * error + 1e-4 * truth);
        spread += error / truth * sqrt(40000);
    }
    check_at_most(spread, plain / 2);
    discard(&m, &lights);
}

/* The walk of a ray finds all spheres that it meets, and no light twice. */
static void rays_find_all_spheres(void **state)
{
    const uint32_t counts[] = {2, 9, 600};
    uint64_t seed = 51;
    uint32_t met = 0, visited = 0;

    (void)state;
    for (size_t k = 0; k < 3; k++) {
        struct point_light points[600];
        struct mesh m = {0};
        struct lights lights;

        fill_points(points, counts[k], &seed);
        for (uint32_t i = 0; i < counts[k]; i += 5) {
            points[i].radius = between(&seed, 2e-6, 1e-4);
            points[i].emission = v3(1e8f, 1e8f, 1e8f);
        }
        add_lamps(&m, 50, 0.1, &seed);
        m.world.point_lights = points;
        m.world.settings.point_light_count = counts[k];
        finish(&m, &lights);
        for (int n = 0; n < 5000; n++) {
            /* every second ray is aimed at a sphere */
            struct ray r = {v3_scale(point_between(&seed, -1, 1),
                                     n % 3 == 0 ? 50 : 1),
                            any_direction(&seed), FLOAT_MAX, 0, 0};
            const struct point_light *aim =
                &lights.point_lights[(uint32_t)n % lights.sphere_count];
            uint8_t found[650] = {0};
            struct sphere_walk walk;
            uint32_t light;

            if (n % 2 == 0)
                r.d =
                    v3_unit(v3_sub(v3_add(aim->p, v3_scale(any_direction(&seed),
                                                           aim->radius)),
                                   r.o));
            if (n % 4 < 2)
                r.t_max = between(&seed, 0, 2);
            sphere_walk_begin(&walk, &m.world, r);
            while ((light = sphere_walk_next(&walk, &m.world, r)) != NO_INDEX) {
                assert_int_equal(found[light]++, 0);
                visited++;
            }
            for (uint32_t i = 0; i < lights.sphere_count; i++) {
                float t;
                bool meets = sphere_meets(&m.world, i, r, &t);

                assert_true(found[50 + i] == 1 || !meets);
                met += meets;
            }
        }
        discard(&m, &lights);
    }
    assert_in_range(met, 2000, 1000000);
    assert_in_range(visited, met, 200000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(probabilities_of_lights_sum_to_one),
        cmocka_unit_test(choices_follow_probabilities),
        cmocka_unit_test(no_contributing_light_is_left_out),
        cmocka_unit_test(clusters_are_not_underrated),
        cmocka_unit_test(orientation_counts_and_winding_does_not),
        cmocka_unit_test(both_random_numbers_choose),
        cmocka_unit_test(tree_prefers_the_near_lights),
        cmocka_unit_test(trees_hold_points_and_lamps),
        cmocka_unit_test(many_points_add_up),
        cmocka_unit_test(rays_find_all_spheres),
        cmocka_unit_test(deep_trees_fit_into_the_path_s_bits),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
