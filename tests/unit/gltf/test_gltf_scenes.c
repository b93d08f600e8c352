// SPDX-License-Identifier: MIT
/*
 * test_gltf_scenes.c - pictures of glTF scenes against Cycles and Mitsuba:
 * means of a 4x4 grid of regions, with standard errors and a tolerance
 *
 * The scenes are not in this repository; without them the tests are skipped.
 */

#include "tests/unit/regions.h"
#include "tests/unit/shared.h"

#define SEEDS 8
#define SIDE  64 /* of the pictures, in pixels */

/* Multiple of our standard error that is allowed: Student's t with 7 degrees of
 * freedom exceeds it once in 5,000. The seeds are fixed. */
#define T_LIMIT 7.0

static void check_scene(const char *name, int spp)
{
    struct region_sums sums = {.count = 0};
    char file[128], *scene, *regions;
    struct region_truth t;

    snprintf(file, sizeof file, "scenes-gltf/%s/%s.glb", name, name);
    scene = shared_path(file);
    snprintf(file, sizeof file, "scenes-gltf/%s/regions.json", name);
    regions = shared_path(file);
    region_truth_read(regions, &t);
    for (uint32_t seed = 1; seed <= SEEDS; seed++)
        region_render(scene, &t, SIDE, spp, seed, &sums);
    free(scene);
    free(regions);
    assert_int_equal(region_misses(&t, &sums, T_LIMIT), 0);
    region_truth_free(&t);
}

static void masks_coverage_and_textured_lamps(void **state)
{
    (void)state;
    check_scene("alpha_emission", 32);
}

static void walls(void **state)
{
    (void)state;
    check_scene("cornell", 32);
}

static void clear_bodies(void **state)
{
    (void)state;
    check_scene("glass", 32);
}

static void lights_without_size(void **state)
{
    (void)state;
    check_scene("lights", 32);
}

static void metals(void **state)
{
    (void)state;
    check_scene("metal", 32);
}

static void textures(void **state)
{
    (void)state;
    check_scene("textured", 32);
}

/* Boxes whose vertex normals are means over their edges. */
static void cities(void **state)
{
    (void)state;
    check_scene("macross_city", 16);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(masks_coverage_and_textured_lamps),
        cmocka_unit_test(walls),
        cmocka_unit_test(clear_bodies),
        cmocka_unit_test(lights_without_size),
        cmocka_unit_test(metals),
        cmocka_unit_test(textures),
        cmocka_unit_test(cities),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
