// SPDX-License-Identifier: MIT
/*
 * test_path_record.c - a recorded path is the path of the render; scattered
 * directions against closed forms; costs of rays counted by hand
 */
#include "tests/unit/check.h"
#include "tests/unit/mesh.h"

#include <math.h>

#include "base/clock.h"
#include "inspect/path_record.h"
#include "inspect/traversal_cost.h"
#include "session/session.h"
#include "tests/unit/paths.h"
#include "world/world.h"

#define SIDE 24

static const char *const scenes[] = {
    "scenes/cornell.obj", "scenes/glass_mirror.obj", "scenes/materials.obj",
    "scenes/skylit.obj",  "scenes/fog.obj",          "scenes/milk.obj"};

static void check_steps(const struct path_record *t)
{
    double sums[3] = {0};

    assert_true(t->vertices >= 1);
    assert_int_equal(t->count, t->vertices < PATH_RECORD_STEPS
                                   ? t->vertices
                                   : PATH_RECORD_STEPS);
    assert_true(t->steps[0].throughput.x == 1.0f);
    for (int i = 0; i < t->count; i++) {
        const struct path_record_step *s = &t->steps[i];
        bool goes_on = s->way >= PATH_RECORD_SCATTERED;

        sums[0] += (double)s->light.x;
        sums[1] += (double)s->light.y;
        sums[2] += (double)s->light.z;
        assert_true(goes_on || i == t->vertices - 1);
        if (s->way == PATH_RECORD_SKY || s->way == PATH_RECORD_SCATTERED)
            assert_true(s->hit.tri == NO_INDEX);
        if (s->way > PATH_RECORD_SCATTERED)
            assert_true(s->hit.tri != NO_INDEX);
        /* The next ray begins here, except for rounding and the shadow
         * terminator. */
        if (i + 1 < t->count)
            check_at_most((double)v3_length(
                              v3_sub(t->steps[i + 1].from, s->to)),
                          0.01);
    }
    if (t->vertices > PATH_RECORD_STEPS)
        return;
    check_close(sums[0], (double)t->radiance.x, 1e-4 * (1 + sums[0]));
    check_close(sums[1], (double)t->radiance.y, 1e-4 * (1 + sums[1]));
    check_close(sums[2], (double)t->radiance.z, 1e-4 * (1 + sums[2]));
}

/* Compares recorded paths of samples in several pixels. */
static void check_recorded_paths(const struct world *w, uint32_t first,
                                 int *bright)
{
    struct sample_id places[SAMPLE_STREAM];
    struct path_sample want[SAMPLE_STREAM];
    struct first_surface surfaces[SAMPLE_STREAM];
    struct path_record t;

    for (uint32_t i = 0; i < SAMPLE_STREAM; i++) {
        uint32_t k = first + i;

        places[i] = (struct sample_id){k % SIDE, k / SIDE, k % 5};
    }
    trace_samples(w, places, SAMPLE_STREAM, want, surfaces);
    for (uint32_t i = 0; i < SAMPLE_STREAM; i++) {
        path_record_follow(&t, w, places[i].x, places[i].y, places[i].index);
        assert_memory_equal(&t.radiance, &want[i].radiance, sizeof t.radiance);
        *bright += !v3_is_zero(t.radiance);
        check_steps(&t);
    }
}

/* Recorded paths of shipped scenes of each kind have the bits of
 * path_samples(). */
static void recorded_paths_are_the_render_s(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        struct options options = {.scene_path = scenes[i],
                                  .width_px = SIDE,
                                  .height_px = SIDE,
                                  .max_bounces = -1,
                                  .thread_count = 1};
        struct session s;
        struct world w;
        struct error err;
        int bright = 0;

        check_or_say(session_open(&s, &options, clock_ns(), &err) &&
                         world_lend(&s.engine.world, &s.engine.scene,
                                    &s.edit.now.view, 3, &w, &err) &&
                         world_ensure_tree(&s.engine.world, &w, NULL, &err),
                     err.text);
        for (uint32_t k = 0; k < SIDE * SIDE; k += SAMPLE_STREAM)
            check_recorded_paths(&w, k, &bright);
        assert_true(bright > SIDE);
        session_close(&s);
    }
}

/* Returns a camera at +z that looks back. size: length of its right and up. */
static struct camera camera_of(float size)
{
    return (struct camera){.eye = {0, 0, 3},
                           .width = SIDE,
                           .forward = {0, 0, -1},
                           .height = SIDE,
                           .right = {size, 0, 0},
                           .up = {0, size, 0}};
}

/* Makes a wall across the view of a camera at +z. */
static void open_wall(struct mesh *m, struct material material)
{
    *m = (struct mesh){0};
    m->materials[0] = material;
    mesh_add_quad(m, v3(-4, -4, 1), v3(4, -4, 1), v3(4, 4, 1), v3(-4, 4, 1), 0);
    m->world.settings.camera = camera_of(1);
    mesh_finish(m);
}

/* A walk below a closed surface does not come to the sky. Where roulette ends
 * it at a collision, that is a place in the body. */
static void walks_end_in_their_body(void **state)
{
    struct material material = mesh_material(MATERIAL_DIFFUSE, 0.3f);
    struct mesh m = {0};
    int ended = 0;

    (void)state;
    material.subsurface = 1;
    material.medium.extinction = v3(5, 5, 5);
    m.materials[0] = material;
    mesh_add_box(&m, v3(-1, -1, -1), v3(1, 1, 1), 0);
    m.world.settings.camera = camera_of(0.1f);
    m.world.settings.max_vertices = 8;
    mesh_finish(&m);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        struct path_record t;

        path_record_follow(&t, &m.world, i % SIDE, i / SIDE, i);
        check_steps(&t);
        for (int k = 1; k < t.count; k++) {
            const struct path_record_step *s = &t.steps[k];

            if (t.steps[k - 1].way == PATH_RECORD_SCATTERED)
                assert_int_not_equal(s->way, PATH_RECORD_SKY);
            if (s->way != PATH_RECORD_ROULETTE || s->hit.tri != NO_INDEX)
                continue;
            ended++;
            check_at_most(fabs((double)s->to.x), 1.0);
            check_at_most(fabs((double)s->to.y), 1.0);
            check_at_most(fabs((double)s->to.z), 1.0);
        }
    }
    assert_in_range(ended, SIDE, SIDE * SIDE);
    mesh_free(&m);
}

static void check_frame(const struct path_record_lobes *l)
{
    const struct vec3 axes[] = {l->t, l->b, l->n};

    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            check_close((double)v3_dot(axes[i], axes[k]), i == k, 1e-6);
    assert_true(v3_dot(v3_cross(l->t, l->b), l->n) > 0);
    assert_true(l->n.z == 1.0f);
    check_close((double)l->p.z, 1, 1e-6);
    assert_true(l->wo.z > 0);
}

static void lambert_scatters_by_the_cosine(void **state)
{
    struct path_record_lobes l;
    struct mesh m;

    (void)state;
    open_wall(&m, mesh_material(MATERIAL_DIFFUSE, 0.25f));
    assert_true(path_record_scatter(&l, &m.world, 3, 7));
    check_frame(&l);
    assert_int_equal(l.count, PATH_RECORD_LOBES);
    for (int i = 0; i < l.count; i++) {
        check_close((double)l.pdf[i], (double)l.wi[i].z / acos(-1), 1e-6);
        check_close((double)l.weight[i].x, 0.25, 1e-6);
        check_close((double)v3_length(l.wi[i]), 1, 1e-6);
    }
    mesh_free(&m);
}

static void mirrors_scatter_one_way(void **state)
{
    struct material material = mesh_material(MATERIAL_METAL, 0.9f);
    struct path_record_lobes l;
    struct mesh m;

    (void)state;
    material.alpha = 0;
    open_wall(&m, material);
    assert_true(path_record_scatter(&l, &m.world, 3, 7));
    check_frame(&l);
    assert_int_equal(l.count, PATH_RECORD_LOBES);
    for (int i = 0; i < l.count; i++) {
        assert_true(l.pdf[i] == 0.0f);
        check_close((double)l.wi[i].x, -(double)l.wo.x, 1e-6);
        check_close((double)l.wi[i].y, -(double)l.wo.y, 1e-6);
        check_close((double)l.wi[i].z, (double)l.wo.z, 1e-6);
    }
    m.world.settings.camera.forward.z = 1;
    assert_false(path_record_scatter(&l, &m.world, 3, 7));
    mesh_free(&m);
}

static void count(const struct world *w, struct traversal_cost *costs)
{
    struct error err;
    struct pool *pool = pool_create(2, &err);

    check_or_say(pool, err.text);
    traversal_cost_of_pixels(pool, w, SIDE, SIDE, costs);
    pool_destroy(pool);
}

/* A tree of one leaf costs its node, and a block of two triangles if the ray
 * enters the box. Of two walls, one behind the other, only the leaves of the
 * nearer one are visited. */
static void costs_are_those_counted_by_hand(void **state)
{
    struct traversal_cost costs[SIDE * SIDE];
    struct mesh m;

    (void)state;
    open_wall(&m, mesh_material(MATERIAL_DIFFUSE, 0.5f));
    assert_int_equal(m.tree.node_count, 1);
    count(&m.world, costs);
    for (int i = 0; i < SIDE * SIDE; i++) {
        assert_int_equal(costs[i].nodes, 1);
        assert_int_equal(costs[i].blocks, 1);
    }
    m.world.settings.camera.forward.z = 1;
    count(&m.world, costs);
    for (int i = 0; i < SIDE * SIDE; i++) {
        assert_int_equal(costs[i].nodes, 1);
        assert_int_equal(costs[i].blocks, 0);
    }
    mesh_free(&m);
    m = (struct mesh){0};
    m.materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.5f);
    for (int i = 0; i < 9; i++) {
        mesh_add_quad(&m, v3(-4, -4, 1), v3(4, -4, 1), v3(4, 4, 1),
                      v3(-4, 4, 1), 0);
        mesh_add_quad(&m, v3(-4, -4, -9), v3(4, -4, -9), v3(4, 4, -9),
                      v3(-4, 4, -9), 0);
    }
    m.world.settings.camera = camera_of(0.1f);
    mesh_finish(&m);
    count(&m.world, costs);
    for (int i = 0; i < SIDE * SIDE; i++) {
        /* The leaves of all 18 triangles at z = 1, in blocks of up to four, and
         * none of those at -9. */
        assert_int_equal(costs[i].nodes, 1);
        assert_in_range(costs[i].blocks, 5, 9);
    }
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(recorded_paths_are_the_render_s),
        cmocka_unit_test(walks_end_in_their_body),
        cmocka_unit_test(lambert_scatters_by_the_cosine),
        cmocka_unit_test(mirrors_scatter_one_way),
        cmocka_unit_test(costs_are_those_counted_by_hand),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
