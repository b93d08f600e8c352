// SPDX-License-Identifier: MIT
/*
 * test_gltf_scenes.c - pictures of glTF scenes against Cycles and Mitsuba:
 * means of a 4x4 grid of regions, with standard errors and a tolerance
 *
 * The scenes are not in this repository; without them the tests are skipped.
 */
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "session/session.h"

#include "base/clock.h"
#include "terminal/xmalloc.h"
#include "tests/unit/check.h"

#define SEEDS   8
#define REGIONS 48 /* 4 x 4 regions, 3 channels */
#define SIDE    64 /* of the pictures, in pixels */

/* Multiple of our standard error that is allowed: Student's t with 7 degrees of
 * freedom exceeds it once in 5,000. The seeds are fixed. */
#define T_LIMIT 7.0

/* The other renderer's means. Surfaces that keep the light of multiple
 * scattering are between both. */
struct truth {
    double low[REGIONS], high[REGIONS], error[REGIONS];
    double tolerance;
    char *background; /* statement of a view file */
};

static void read_grid(const json_t *regions, const char *key,
                      double numbers[REGIONS])
{
    const json_t *grid = json_object_get(regions, key);

    for (size_t i = 0; i < REGIONS; i++)
        numbers[i] = json_number_value(json_array_get(
            json_array_get(json_array_get(grid, i / 12), i / 3 % 4), i % 3));
}

static void read_truth(const char *path, struct truth *t)
{
    json_error_t why;
    json_t *regions = json_load_file(path, 0, &why);
    const json_t *back;
    double multi[REGIONS];

    assert_non_null(regions);
    assert_true(json_is_true(json_object_get(regions, "gate")));
    read_grid(regions, "mean", t->low);
    read_grid(regions, "standard_error", t->error);
    read_grid(regions, "mean", multi);
    if (json_is_array(json_object_get(regions, "mean_multi")))
        read_grid(regions, "mean_multi", multi);
    for (int i = 0; i < REGIONS; i++) {
        t->high[i] = fmax(t->low[i], multi[i]);
        t->low[i] = fmin(t->low[i], multi[i]);
    }
    t->tolerance = json_number_value(json_object_get(regions, "tolerance"));
    back = json_object_get(regions, "background");
    t->background = xformat("background %g %g %g\n",
                            json_number_value(json_array_get(back, 0)),
                            json_number_value(json_array_get(back, 1)),
                            json_number_value(json_array_get(back, 2)));
    json_decref(regions);
}

static void add_means(const float *rgb, double sums[REGIONS],
                      double squares[REGIONS])
{
    double means[REGIONS] = {0};

    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            for (int c = 0; c < 3; c++)
                means[3 * (4 * (y * 4 / SIDE) + x * 4 / SIDE) + c] +=
                    (double)rgb[3 * (y * SIDE + x) + c] * 16 / (SIDE * SIDE);
    for (int i = 0; i < REGIONS; i++) {
        sums[i] += means[i];
        squares[i] += means[i] * means[i];
    }
}

static void render(const char *scene, const struct truth *t, int spp,
                   uint32_t seed, float *rgb)
{
    static struct session s;
    struct error err = {""};
    struct options o = {.scene_path = scene,
                        .width_px = SIDE,
                        .height_px = SIDE,
                        .max_bounces = 64,
                        .view_lines = t->background,
                        .seed = seed,
                        .batch = true};

    if (!session_open(&s, &o, clock_ns(), &err) ||
        !session_restart(&s, (struct render_limits){.spp = (uint64_t)spp},
                         &err))
        print_error("%s\n", err.text);
    assert_string_equal(err.text, "");
    render_wait(s.render, -1);
    film_linear(render_film(s.render), rgb);
    session_close(&s);
}

/* Returns the number of regions that miss. */
static int compare(const struct truth *t, const double sums[REGIONS],
                   const double squares[REGIONS])
{
    double top = 0;
    int failures = 0;

    for (int i = 0; i < REGIONS; i++)
        top = fmax(top, t->high[i]);
    for (int i = 0; i < REGIONS; i++) {
        double mean = sums[i] / SEEDS;
        double own = fmax(squares[i] / SEEDS - mean * mean, 0) / (SEEDS - 1);
        double miss = fmax(fmax(t->low[i] - mean, mean - t->high[i]), 0);
        double allowed = t->tolerance * fmax(t->low[i], 0.02 * top) +
                         T_LIMIT * sqrt(own) + 3 * t->error[i];

        if (miss <= allowed)
            continue;
        print_error("region %d channel %d: got %.6g, want %.6g to %.6g, off "
                    "by %.2g, allowed %.2g\n",
                    i / 3, i % 3, mean, t->low[i], t->high[i], miss, allowed);
        failures++;
    }
    return failures;
}

static void check_scene(const char *name, int spp)
{
    const char *root = getenv("GLIM_SHARED");
    double sums[REGIONS] = {0}, squares[REGIONS] = {0};
    static float rgb[3 * SIDE * SIDE];
    char *scene, *regions;
    struct truth t;

    root = root != NULL ? root : "../shared";
    scene = xformat("%s/scenes-gltf/%s/%s.glb", root, name, name);
    regions = xformat("%s/scenes-gltf/%s/regions.json", root, name);
    if (access(scene, R_OK) != 0) {
        print_message("skipped: there is no %s\n", scene);
        free(scene);
        free(regions);
        skip();
    }
    read_truth(regions, &t);
    for (uint32_t seed = 1; seed <= SEEDS; seed++) {
        render(scene, &t, spp, seed, rgb);
        add_means(rgb, sums, squares);
    }
    free(t.background);
    free(scene);
    free(regions);
    assert_int_equal(compare(&t, sums, squares), 0);
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
