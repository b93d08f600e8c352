// SPDX-License-Identifier: MIT
#include "engine/scene_load.h"

#include <math.h>

#include "tests/unit/check.h"
#include "kernels/instance.h"

/* A scene with instances. */
#define FOREST "scenes/forest.glb"

/* Triangles between those that are compared. */
#define STEP 4999

static void open_forest(struct scene *s, enum scene_up up)
{
    struct warnings report = {0};
    struct error err;

    check_or_say(scene_load(s, FOREST, up, &report, &err), err.text);
    assert_true(s->placed_count > 100);
    warnings_free(&report);
}

/* Returns the distance from a point to the nearest corner of a triangle, in
 * file units. */
static double corner_distance(const struct scene *s, uint32_t tri,
                              const double p[3])
{
    const struct world w = scene_shape(s);
    struct placed_tri placed = tri_placed(&w, tri);
    double nearest = INFINITY;

    for (int k = 0; k < 3; k++) {
        double corner[3];

        scene_file_point(s, placed.p[k], corner);
        nearest = fmin(nearest, hypot(hypot(corner[0] - p[0], corner[1] - p[1]),
                                      corner[2] - p[2]));
    }
    return nearest;
}

/* With the z axis up (x, y, z) is (x, z, -y), also in instances. */
static void instances_turn_with_their_scene(void **state)
{
    struct scene y_up = {.thread_count = 1}, z_up = {.thread_count = 1};
    struct world w;

    (void)state;
    open_forest(&y_up, SCENE_UP_Y);
    open_forest(&z_up, SCENE_UP_Z);
    w = scene_shape(&y_up);
    assert_int_equal(scene_tri_total(&y_up), scene_tri_total(&z_up));
    for (uint32_t i = 0; i < scene_tri_total(&y_up); i += STEP) {
        struct placed_tri placed = tri_placed(&w, i);

        for (int k = 0; k < 3; k++) {
            double p[3];
            double want[3];

            scene_file_point(&y_up, placed.p[k], p);
            want[0] = p[0];
            want[1] = p[2];
            want[2] = -p[1];
            check_at_most(corner_distance(&z_up, i, want) * y_up.scale, 1e-6);
        }
    }
    scene_free(&y_up);
    scene_free(&z_up);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(instances_turn_with_their_scene),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
