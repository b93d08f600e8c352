// SPDX-License-Identifier: MIT
/*
 * trees.h - ray queries through a tree must find the hits of brute force
 *
 * The header included before this one declares hit_closest(), hits_closest()
 * and hit_any().
 *
 * Units:     normalised scene units
 * Threads:   one
 * Errors:    a wrong hit ends the test
 */
#ifndef TESTS_TREES_H
#define TESTS_TREES_H

#include "tests/unit/brute.h"
#include "tests/unit/check.h"
#include "tests/unit/mesh.h"

#include "kernels/traverse_leaf.h"

#include <math.h>
#include <string.h>

/* Returns a random ray. Every fourth begins far outside, every eighth is along
 * an axis with zero components, every eighth grazes a triangle, every sixteenth
 * begins at a vertex, and every sixteenth so close to a triangle that its
 * distance may be lost in rounding. */
static struct ray random_ray(const struct mesh *m, uint64_t *seed, int i)
{
    struct ray r = {random_point(seed, i % 4 == 0 ? 50.0f : 1.2f),
                    {0, 0, 0},
                    FLOAT_MAX,
                    0,
                    0};
    struct vec3 at = random_point(seed, 0.8f);

    if (i % 8 == 5)
        return grazing_ray(
            &m->positions[3 * (uint32_t)(check_random(seed) * m->tri_count)],
            seed);
    if (i % 16 == 7)
        r.o = m->positions[(uint32_t)(check_random(seed) * 3 * m->tri_count)];
    if (i % 16 == 15)
        r.o = near_point(
            &m->positions[3 * (uint32_t)(check_random(seed) * m->tri_count)],
            seed);
    r.d = v3_unit(v3_sub(at, r.o));
    if (i % 8 == 3) {
        r.d = v3(i & 16 ? -0.0f : 0.0f, i & 32 ? 1.0f : -1.0f, 0.0f);
        if (i & 64) /* in a plane of the grid scenes */
            r.o.x = roundf(r.o.x * 8) / 8;
    }
    return r;
}

#define GROUP 8

/* Makes a group of rays close to a random ray, or all equal. Some begin at one
 * point, some are in a plane across an axis, some end, some begin on a
 * triangle. */
static uint32_t random_group(const struct mesh *m, uint64_t *seed, int i,
                             struct ray rays[GROUP])
{
    static const float spreads[] = {0.0f, 1e-4f, 2e-3f, 0.01f};
    float spread = spreads[i % 4];
    struct ray first = random_ray(m, seed, i / 4);
    uint32_t count = 1 + (uint32_t)(GROUP * check_random(seed));

    for (uint32_t k = 0; k < count; k++) {
        struct ray *r = &rays[k];

        *r = first;
        r->key = k;
        r->d = v3_add(first.d, random_point(seed, spread));
        if (i % 3 == 0)
            r->o = v3_add(first.o, random_point(seed, 0.2f * spread));
        if (i % 7 == 0)
            r->d.z = k % 2 == 0 ? 0.0f : -0.0f;
        if (i % 5 == 0)
            r->t_max = (float)check_random(seed);
        if (i % 9 == 0)
            r->from = 1 + (uint32_t)(check_random(seed) * m->tri_count);
        r->d = v3_unit(r->d);
    }
    return count;
}

/* Calls tri_hit() for every triangle. */
static void test_all_tris(const struct mesh *m, struct ray r, struct hit *best)
{
    struct shear s = shear_of(r);

    *best = (struct hit){r.t_max, 0, 0, 0, NO_INDEX};
    for (uint32_t i = 0; i < m->tri_count; i++) {
        const struct vec3 *p = &m->positions[3 * i];

        tri_hit(&m->world, r, s, (struct leaf_tri){p[0], p[1], p[2], i}, best);
    }
}

/* Compares rays in groups with single rays. */
static void compare_groups(const struct mesh *m, int groups, uint64_t seed)
{
    for (int i = 0; i < groups; i++) {
        struct ray rays[GROUP];
        struct hit got[GROUP];
        uint32_t count = random_group(m, &seed, i, rays);

        hits_closest(&m->world, rays, count, got);
        for (uint32_t k = 0; k < count; k++) {
            struct hit want;

            test_all_tris(m, rays[k], &want);
            assert_memory_equal(&got[k], &want, sizeof want);
        }
    }
}

static void compare(struct mesh *m, int rays, uint64_t seed)
{
    int hits = 0;

    mesh_finish(m);
    compare_groups(m, rays / 10, seed);
    assert_false(m->tree.lacks_copies);
    for (int i = 0; i < rays; i++) {
        struct ray r = random_ray(m, &seed, i);
        struct hit a, b;
        bool found = brute_force(&m->world, r, &a);

        assert_true(hit_closest(&m->world, r, &b) == found);
        assert_true(hit_any(&m->world, r, NO_INDEX) == found);
        if (!found)
            continue;
        hits++;
        assert_true(a.tri == b.tri && a.t == b.t && a.b0 == b.b0 &&
                    a.b1 == b.b1 && a.b2 == b.b2);
        r.t_max = a.t;
        assert_true(hit_closest(&m->world, r, &b) && b.tri == a.tri);
        assert_true(hit_any(&m->world, r, NO_INDEX));
        assert_false(hit_any(&m->world, r, a.tri));
        assert_true(hit_any(&m->world, r, a.tri + 1));
        r.t_max = nextafterf(a.t, 0.0f);
        assert_false(hit_any(&m->world, r, NO_INDEX));
    }
    assert_true(hits > rays / 20);
    mesh_free(m);
}

#define RAYS (check_is_thorough() ? 200000 : 25000)

static void soup_agrees(void **state)
{
    struct mesh m = {0};
    uint64_t seed = 11;

    (void)state;
    for (int i = 0; i < 150; i++) {
        struct vec3 a = random_point(&seed, 0.7f);

        mesh_add(&m, a, v3_add(a, random_point(&seed, 0.4f)),
                 v3_add(a, random_point(&seed, 0.4f)), 0);
    }
    compare(&m, RAYS, 1);
}

static void sphere_in_box_agrees(void **state)
{
    struct mesh m = {0};

    (void)state;
    mesh_add_box(&m, v3(-1, -1, -1), v3(1, 1, 1), 0);
    mesh_add_sphere(&m, v3(0.1f, -0.2f, 0), 0.5f, 10, 16, 0);
    compare(&m, RAYS, 2);
}

/* The same quads occur three times, and boxes share faces, so hits tie. */
static void ties_agree(void **state)
{
    struct mesh m = {0};

    (void)state;
    for (int k = 0; k < 3; k++)
        for (int x = -2; x < 2; x++)
            for (int z = -2; z < 2; z++) {
                float h = 0.25f;
                float x0 = (float)x * h, z0 = (float)z * h;

                if (k < 2)
                    mesh_add_quad(&m, v3(x0, 0, z0), v3(x0, 0, z0 + h),
                                  v3(x0 + h, 0, z0 + h), v3(x0 + h, 0, z0), 0);
                else
                    mesh_add_box(&m, v3(x0, -h, z0), v3(x0 + h, 0, z0 + h), 0);
            }
    compare(&m, RAYS, 3);
}

/* Each triangle lets half of the rays pass. */
static void tris_with_holes_agree(void **state)
{
    struct mesh m = {0};
    uint64_t seed = 7;

    (void)state;
    m.materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.5f);
    m.materials[0].opacity = 0.5f;
    m.world.settings.features = FEATURE_COVERAGE;
    for (int i = 0; i < 100; i++) {
        struct vec3 a = random_point(&seed, 0.7f);

        mesh_add(&m, a, v3_add(a, random_point(&seed, 0.7f)),
                 v3_add(a, random_point(&seed, 0.7f)), 0);
    }
    mesh_finish(&m);
    compare_groups(&m, RAYS / 10, 8);
    mesh_free(&m);
}

/* STRESS G4, G19: needles of aspect 1e2 to 1e6. */
static void needles_agree(void **state)
{
    struct mesh m = {0};
    uint64_t seed = 5;

    (void)state;
    for (int i = 0; i < 200; i++) {
        struct vec3 a = random_point(&seed, 0.9f);
        struct vec3 b = random_point(&seed, 0.9f);
        float width = powf(10.0f, -2.0f - 4.0f * (float)check_random(&seed));

        mesh_add(&m, a, b, v3_add(a, random_point(&seed, width)), 0);
    }
    /* Larger triangles, so that rays hit something. */
    for (int i = 0; i < 6; i++)
        mesh_add(&m, random_point(&seed, 1.0f), random_point(&seed, 1.0f),
                 random_point(&seed, 1.0f), 0);
    compare(&m, RAYS, 4);
}

/* STRESS G7, G9: sizes of 2^-k around one point, as of a teapot in a
 * stadium. */
static void nested_sizes_agree(void **state)
{
    struct mesh m = {0};

    (void)state;
    for (int k = 0; k < 60; k++) {
        float s = ldexpf(1.0f, -k);

        mesh_add(&m, v3(s, 0, 0), v3(0, s, 0), v3(0, 0, s), 0);
        mesh_add(&m, v3(-s, -s, s), v3(s, -s, s), v3(0, s, s), 0);
    }
    compare(&m, RAYS, 6);
}

/* STRESS G7, G8: no plane divides the triangles. */
static void identical_triangles_build(void **state)
{
    struct mesh m = {0};
    struct ray r = {{0.1f, 0.1f, 1}, {0, 0, -1}, FLOAT_MAX, 0, 0};
    struct hit h;

    (void)state;
    for (int i = 0; i < 70000; i++)
        mesh_add(&m, v3(0, 0, 0), v3(1, 0, 0), v3(0, 1, 0), 0);
    mesh_finish(&m);
    assert_true(hit_closest(&m.world, r, &h));
    assert_int_equal(h.tri, 0);
    mesh_free(&m);
}

/* Values that are invalid in a ray. */
static const float wrong[] = {NAN, -NAN, INFINITY, -INFINITY};

#define WRONG (sizeof wrong / sizeof *wrong)

/* Makes a ray that would hit the mesh but for invalid numbers in it. There are
 * WRONGS combinations. */
#define WRONGS 15625 /* (1 + WRONG)^6 */

static struct ray wrong_ray(struct ray r, uint32_t way)
{
    for (int i = 0; i < 6; i++, way /= 1 + WRONG)
        if (way % (1 + WRONG) != 0)
            (i < 3 ? &r.o.x : &r.d.x)[i % 3] = wrong[way % (1 + WRONG) - 1];
    return r;
}

static void check_misses(const struct mesh *m, uint32_t way)
{
    const struct ray right = {
        {0.5f, 0.1f, 2}, v3_unit(v3(-0.2f, -0.1f, -1)), 9, 0, 0};
    struct ray rays[GROUP];
    struct hit hits[GROUP];
    uint32_t at = way % GROUP;

    for (uint32_t k = 0; k < GROUP; k++)
        rays[k] = right;
    assert_true(hit_closest(&m->world, right, &hits[0]));
    rays[at] = wrong_ray(right, way);
    assert_false(hit_closest(&m->world, rays[at], &hits[0]));
    assert_int_equal(hits[0].tri, NO_INDEX);
    assert_false(hit_any(&m->world, rays[at], NO_INDEX));
    hits_closest(&m->world, rays, GROUP, hits);
    assert_int_equal(hits[at].tri, NO_INDEX);
    rays[at] = right;
    rays[at].t_max = NAN;
    assert_false(hit_closest(&m->world, rays[at], &hits[0]));
    assert_false(hit_any(&m->world, rays[at], NO_INDEX));
}

/* Tests trees of one node to many, most of them with nodes that lack
 * children. */
static void rays_that_are_no_numbers_miss(void **state)
{
    (void)state;
    for (int boxes = 1; boxes <= 27; boxes *= 3) {
        struct mesh m = {0};

        for (int k = 1; k <= boxes; k++) {
            float s = (float)k / (float)boxes;

            mesh_add_box(&m, v3(-s, -s, -s), v3(s, s, s), 0);
        }
        mesh_finish(&m);
        for (uint32_t way = 1; way < WRONGS; way++)
            check_misses(&m, way);
        mesh_free(&m);
    }
}

/* Depth of the binary tree, of which that of eight is made. */
static uint32_t depth_of(const struct mesh *m)
{
    struct bvh bvh = {0};
    struct error err;
    uint32_t depth;

    assert_true(bvh_build_nodes(&bvh, &m->world, &bvh8_leaves, NULL, &err));
    depth = bvh.depth;
    bvh_free(&bvh);
    return depth;
}

/* STRESS G9: a chain of 209 halvings, from the largest scale to the smallest
 * float, does not overflow the stack. */
static void deep_chains_stay_bounded(void **state)
{
    struct mesh m = {0};

    (void)state;
    for (int k = 0; k <= 209; k++) {
        float x = ldexpf(1.0f, 60 - k);

        mesh_add(&m, v3(x, 0, 0), v3(x, x, 0), v3(x, 0, x), 0);
    }
    mesh_finish(&m);
    assert_true(depth_of(&m) < TRAVERSE_STACK);
    bvh8_free(&m.tree);
    for (int k = 0; k < 100000; k++)
        mesh_add(&m, v3(1e-42f, 0, 0), v3(0, 1e-42f, 0), v3(0, 0, 1e-42f), 0);
    mesh_finish(&m);
    assert_true(depth_of(&m) < TRAVERSE_STACK);
    mesh_free(&m);
}

static void empty_worlds_are_missed(void **state)
{
    struct mesh m = {0};
    struct ray r = {{0, 0, 1}, {0, 0, -1}, FLOAT_MAX, 0, 0};
    struct hit h;

    (void)state;
    mesh_finish(&m);
    assert_false(hit_closest(&m.world, r, &h));
    assert_false(hit_any(&m.world, r, NO_INDEX));
    hits_closest(&m.world, &r, 1, &h);
    assert_int_equal(h.tri, NO_INDEX);
    mesh_free(&m);
}

static int run_trees(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(soup_agrees),
        cmocka_unit_test(sphere_in_box_agrees),
        cmocka_unit_test(ties_agree),
        cmocka_unit_test(tris_with_holes_agree),
        cmocka_unit_test(needles_agree),
        cmocka_unit_test(nested_sizes_agree),
        cmocka_unit_test(identical_triangles_build),
        cmocka_unit_test(deep_chains_stay_bounded),
        cmocka_unit_test(rays_that_are_no_numbers_miss),
        cmocka_unit_test(empty_worlds_are_missed),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}

#endif
