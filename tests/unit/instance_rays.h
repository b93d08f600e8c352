// SPDX-License-Identifier: MIT
/*
 * instance_rays.h - rays through instances must find the hits of brute force
 * over copies
 *
 * The header included before this one declares hit_closest(), hits_closest()
 * and hit_any().
 *
 * Units:     file units of the scenes, whose size is about 2; else normalised
 * Threads:   one
 * Errors:    a wrong hit ends the test
 */
#ifndef TESTS_INSTANCE_RAYS_H
#define TESTS_INSTANCE_RAYS_H

#include <stdlib.h>

#include "tests/unit/brute.h"
#include "tests/unit/instanced.h"
#include "world/world.h"

#define GROUP 8

/* A scene of instances, and its copies as plain triangles. */
struct instance_test {
    struct scene scene;
    struct host_world host;
    struct world w;
    struct world copies;
    struct vec3 *positions, *normals;
    struct tri *tris;
};

/* Text of a floor, and of a mesh of so many random triangles of this size,
 * which has the unit cube. */
static inline char *random_faces(uint64_t *seed, int count, double size)
{
    char *text = calloc(1, 400 + 200 * (size_t)count);
    char *at = text;

    assert_non_null(text);
    at += sprintf(at, "v -1 -1 -1\nv 1 -1 -1\nv 1 -1 1\nv -1 -1 1\n"
                      "f 1 2 3 4\no mesh\n");
    for (int i = 0; i < count; i++) {
        double p[3];

        for (int k = 0; k < 3; k++)
            p[k] = check_random(seed) * 2 - 1;
        for (int c = 0; c < 3; c++)
            at += sprintf(at, "v %.9g %.9g %.9g\n",
                          p[0] + size * check_random(seed),
                          p[1] + size * check_random(seed),
                          p[2] + size * check_random(seed));
        at += sprintf(at, "f -3 -2 -1\n");
    }
    return text;
}

/* Makes the plain copies of all triangles. */
static inline void make_copies(struct instance_test *t)
{
    uint32_t count = scene_tri_total(&t->scene);

    t->positions = calloc(3 * (size_t)count, sizeof *t->positions);
    t->tris = calloc(count, sizeof *t->tris);
    t->normals = calloc(3 * (size_t)count, sizeof *t->normals);
    assert_true(t->positions != NULL && t->tris != NULL && t->normals != NULL);
    for (uint32_t i = 0; i < count; i++) {
        struct placed_tri placed = tri_placed(&t->w, i);

        t->tris[i] = placed.t;
        for (uint32_t k = 0; k < 3; k++) {
            t->positions[3 * i + k] = placed.p[k];
            t->tris[i].v[k] = 3 * i + k;
            if (placed.t.vn[k] == NO_INDEX)
                continue;
            t->normals[3 * i + k] =
                normal_at(&t->w, placed.t.vn[k], instance_of(&t->w, i));
            t->tris[i].vn[k] = 3 * i + k;
        }
    }
    t->copies = t->w;
    t->copies.positions = t->positions;
    t->copies.normals = t->normals;
    t->copies.tris = t->tris;
    t->copies.instances = NULL;
    t->copies.settings.tri_count = count;
    t->copies.settings.instance_count = 0;
    t->copies.settings.features &= ~FEATURE_INSTANCES;
}

/* Finishes a parsed scene, all of whose meshes are kept. */
static inline void instance_test_finish(struct instance_test *t)
{
    struct warnings report = {0};
    struct view view;
    struct error err;

    t->scene.instances.copied_tris = 0;
    view_init(&view);
    view.pose.eye[2] = 5;
    view.width_px = 320;
    view.height_px = 240;
    check_or_say(scene_finish(&t->scene, &report, &err) &&
                     world_init(&t->host, &t->scene, 1, &report, &err) &&
                     world_lend(&t->host, &t->scene, &view, 1, &t->w, &err) &&
                     world_ensure_tree(&t->host, &t->w, NULL, &err),
                 err.text);
    assert_true(t->scene.placed_count > 0);
    make_copies(t);
    view_free(&view);
    warnings_free(&report);
}

static inline void instance_test_free(struct instance_test *t)
{
    world_free(&t->host);
    scene_free(&t->scene);
    free(t->positions);
    free(t->normals);
    free(t->tris);
}

/* Returns a ray to a point of a random triangle: to a vertex, to an edge, or
 * inside. Some begin far away, some on another triangle, some are along an
 * axis, some graze the triangle. */
static inline struct ray random_instance_ray(const struct instance_test *t,
                                             uint64_t *seed, int i)
{
    uint32_t count = t->copies.settings.tri_count;
    uint32_t tri = (uint32_t)(check_random(seed) * count);
    const struct vec3 *p = &t->positions[3 * tri];
    float u = i % 3 == 0 ? 0.0f : (float)check_random(seed);
    float v = i % 5 < 2 ? 0.0f : (float)check_random(seed);
    struct vec3 at = v3_lerp(v3_lerp(p[0], p[1], u), p[2], v);
    struct ray r = {random_point(seed, i % 4 == 0 ? 50.0f : 1.2f),
                    {0, 0, 0},
                    FLOAT_MAX,
                    (uint32_t)i,
                    0};

    if (i % 8 == 5)
        return grazing_ray(p, seed);
    if (i % 16 == 7) {
        r.from = 1 + (uint32_t)(check_random(seed) * count);
        r.o = t->positions[3 * (r.from - 1)];
    }
    r.d = v3_unit(v3_sub(at, r.o));
    if (i % 8 == 3) {
        r.o = v3(at.x, i & 16 ? 2.0f : -2.0f, at.z);
        r.d = v3(i & 32 ? 0.0f : -0.0f, i & 16 ? -1.0f : 1.0f, 0.0f);
    }
    return r;
}

/* The hit of brute force with the rule of coverage. */
static inline void hit_of_copies(const struct instance_test *t, struct ray r,
                                 struct hit *best)
{
    struct shear s = shear_of(r);

    *best = (struct hit){r.t_max, 0, 0, 0, NO_INDEX};
    for (uint32_t i = 0; i < t->copies.settings.tri_count; i++) {
        const struct vec3 *p = &t->positions[3 * i];

        tri_hit(&t->copies, r, s, (struct leaf_tri){p[0], p[1], p[2], i}, best);
    }
}

static inline void check_ray(const struct instance_test *t, struct ray r,
                             int *hits)
{
    struct hit want, got;

    hit_of_copies(t, r, &want);
    hit_closest(&t->w, r, &got);
    assert_memory_equal(&got, &want, sizeof want);
    assert_true(hit_any(&t->w, r, NO_INDEX) == (want.tri != NO_INDEX));
    if (want.tri == NO_INDEX)
        return;
    ++*hits;
    r.t_max = want.t;
    assert_true(hit_closest(&t->w, r, &got) && got.tri == want.tri);
    assert_true(hit_any(&t->w, r, NO_INDEX));
    assert_false(hit_any(&t->w, r, want.tri));
    r.t_max = nextafterf(want.t, 0.0f);
    assert_false(hit_any(&t->w, r, NO_INDEX));
}

static inline void check_group(const struct instance_test *t, struct ray first,
                               uint64_t *seed)
{
    struct ray rays[GROUP];
    struct hit got[GROUP], want;

    for (uint32_t k = 0; k < GROUP; k++) {
        rays[k] = first;
        rays[k].d = v3_unit(v3_add(first.d, random_point(seed, 2e-3f)));
    }
    hits_closest(&t->w, rays, GROUP, got);
    for (uint32_t k = 0; k < GROUP; k++) {
        hit_of_copies(t, rays[k], &want);
        assert_memory_equal(&got[k], &want, sizeof want);
    }
}

static inline void check_rays(struct instance_test *t, int rays, uint64_t seed)
{
    int hits = 0;

    instance_test_finish(t);
    for (int i = 0; i < rays; i++) {
        struct ray r = random_instance_ray(t, &seed, i);

        check_ray(t, r, &hits);
        if (i % 10 == 0)
            check_group(t, r, &seed);
    }
    assert_true(hits > rays / 4);
    instance_test_free(t);
}

#define RAYS (check_is_thorough() ? 20000 : 8000)

static void instances_have_the_hits_of_copies(void **state)
{
    (void)state;
    for (int i = 0; i < 6; i++) {
        struct instance_test t = {.positions = NULL};
        uint64_t seed = 1 + (uint64_t)i;
        char *faces = random_faces(&seed, 20 << i % 3, i < 3 ? 0.3 : 1.0);

        instanced_parse(&t.scene, "", faces);
        for (int k = 0; k < 12; k++) {
            struct affine a = random_affine(&seed, 0.4, i % 2 == 0);

            instanced_place(&t.scene, 0, &a);
        }
        check_rays(&t, RAYS, seed);
        free(faces);
    }
}

/* Scales of 1 to 1e-6, one of which differs by axis, and a mesh with extents
 * that differ as much. */
static void sizes_may_differ(void **state)
{
    struct instance_test t = {.positions = NULL};
    uint64_t seed = 3;
    char *faces = random_faces(&seed, 40, 0.5);

    (void)state;
    instanced_parse(&t.scene, "", faces);
    for (int k = 0; k <= 12; k++) {
        struct affine a = random_affine(&seed, pow(10, -k / 2.0), k % 2 == 0);

        for (int i = 0; k % 3 == 0 && i < 3; i++)
            a.m[i][k % 2] *= 1e-3;
        instanced_place(&t.scene, 0, &a);
    }
    check_rays(&t, RAYS, seed);
    free(faces);
}

/* Instances in the same place, mirrored and not: the first one wins. */
static void coincident_instances_tie(void **state)
{
    static const struct affine same = {
        {{.5, 0, 0, 0}, {0, .5, 0, 0}, {0, 0, .5, 0}}};
    struct instance_test t = {.positions = NULL};
    uint64_t seed = 8;
    char *faces = random_faces(&seed, 40, 0.7);

    (void)state;
    instanced_parse(&t.scene, "", faces);
    for (int k = 0; k < 4; k++)
        instanced_place(&t.scene, 0, &same);
    check_rays(&t, RAYS, seed);
    free(faces);
}

static void instances_have_coverage(void **state)
{
    struct instance_test t = {.positions = NULL};
    uint64_t seed = 21;
    char *faces = random_faces(&seed, 60, 0.7);
    char *mesh = strstr(faces, "o mesh");
    char *all = malloc(strlen(faces) + 100);

    (void)state;
    assert_non_null(all);
    sprintf(all, "%.*susemtl veil\n%s", (int)(mesh - faces), faces, mesh);
    instanced_parse(&t.scene, "newmtl veil\nd .5\n", all);
    for (int k = 0; k < 8; k++) {
        struct affine a = random_affine(&seed, 0.4, true);

        instanced_place(&t.scene, 0, &a);
    }
    check_rays(&t, RAYS, seed);
    free(all);
    free(faces);
}

/* A scene may have nothing but instances. */
static void scenes_may_have_instances_only(void **state)
{
    struct instance_test t = {.positions = NULL};
    uint64_t seed = 2;

    (void)state;
    instanced_parse(&t.scene, "",
                    "o mesh\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
                    "o mesh2\nv 0 0 1\nv 1 0 0\nv 0 1 0\nf 4 5 6\n");
    for (uint32_t k = 0; k < 9; k++) {
        struct affine a = random_affine(&seed, 1, k < 4);

        instanced_place(&t.scene, k % 2, &a);
    }
    check_rays(&t, RAYS, seed);
}

static void rays_that_are_no_numbers_miss_instances(void **state)
{
    static const float wrong[] = {NAN, INFINITY, -INFINITY};
    struct instance_test t = {.positions = NULL};
    uint64_t seed = 2;
    char *faces = random_faces(&seed, 40, 0.5);
    struct affine a = random_affine(&seed, 1, true);

    (void)state;
    instanced_parse(&t.scene, "", faces);
    instanced_place(&t.scene, 0, &a);
    instanced_place(&t.scene, 0, &a);
    instance_test_finish(&t);
    for (int i = 0; i < 18; i++) {
        struct ray r = random_instance_ray(&t, &seed, i);
        struct hit h;

        (i < 9 ? &r.o.x : &r.d.x)[i % 3] = wrong[i / 3 % 3];
        assert_false(hit_closest(&t.w, r, &h));
        assert_false(hit_any(&t.w, r, NO_INDEX));
    }
    instance_test_free(&t);
    free(faces);
}

static int run_instance_rays(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(instances_have_the_hits_of_copies),
        cmocka_unit_test(sizes_may_differ),
        cmocka_unit_test(coincident_instances_tie),
        cmocka_unit_test(instances_have_coverage),
        cmocka_unit_test(scenes_may_have_instances_only),
        cmocka_unit_test(rays_that_are_no_numbers_miss_instances),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}

#endif
