// SPDX-License-Identifier: MIT
/*
 * regions.h - pictures of glTF scenes beside those of Cycles and Mitsuba: means
 * of a 4x4 grid of regions, as regions.json of each scene has them
 *
 * Units:     linear radiance
 * Ownership: region_truth_free()
 * Threads:   one
 * Errors:    a failed check ends the test
 */
#ifndef TESTS_REGIONS_H
#define TESTS_REGIONS_H

#include <jansson.h>
#include <math.h>
#include <stdlib.h>

#include "session/session.h"

#include "base/clock.h"
#include "terminal/xmalloc.h"
#include "tests/unit/check.h"

#define REGIONS 48 /* 4 x 4 regions, 3 channels */

/* The other renderers' means. Surfaces that keep the light of multiple
 * scattering are between low and high. */
struct region_truth {
    double low[REGIONS], high[REGIONS], error[REGIONS];
    double cycles[REGIONS], cycles_high[REGIONS], mitsuba[REGIONS];
    double least; /* darker regions are compared as if they had this mean */
    double tolerance;
    char *background; /* statement of a view file */
};

static inline void region_grid_read(const json_t *regions, const char *key,
                                    double numbers[REGIONS])
{
    const json_t *grid = json_object_get(regions, key);

    for (size_t i = 0; i < REGIONS; i++)
        numbers[i] = json_number_value(json_array_get(
            json_array_get(json_array_get(grid, i / 12), i / 3 % 4), i % 3));
}

static inline void region_truth_read(const char *path, struct region_truth *t)
{
    json_error_t why;
    json_t *regions = json_load_file(path, 0, &why);
    const json_t *back;
    double multi[REGIONS];

    assert_non_null(regions);
    assert_true(json_is_true(json_object_get(regions, "gate")));
    region_grid_read(regions, "mean", t->low);
    region_grid_read(regions, "standard_error", t->error);
    region_grid_read(regions, "mean", multi);
    if (json_is_array(json_object_get(regions, "mean_multi")))
        region_grid_read(regions, "mean_multi", multi);
    region_grid_read(regions,
                     json_object_get(regions, "cycles") != NULL ? "cycles"
                                                                : "mean",
                     t->cycles);
    memcpy(t->cycles_high,
           json_is_array(json_object_get(regions, "mean_multi")) ? multi
                                                                 : t->cycles,
           sizeof t->cycles_high);
    region_grid_read(json_object_get(regions, "second"), "mean", t->mitsuba);
    t->least = 0;
    for (int i = 0; i < REGIONS; i++) {
        t->high[i] = fmax(t->low[i], multi[i]);
        t->low[i] = fmin(t->low[i], multi[i]);
        t->least = fmax(t->least, 0.02 * t->high[i]);
    }
    t->tolerance = json_number_value(json_object_get(regions, "tolerance"));
    back = json_object_get(regions, "background");
    t->background = xformat("background %g %g %g\n",
                            json_number_value(json_array_get(back, 0)),
                            json_number_value(json_array_get(back, 1)),
                            json_number_value(json_array_get(back, 2)));
    json_decref(regions);
}

static inline void region_truth_free(struct region_truth *t)
{
    free(t->background);
}

/* Sums over renders with different seeds. */
struct region_sums {
    double sums[REGIONS], squares[REGIONS];
    int count;
};

/* Renders a square picture of the scene and adds its means. */
static inline void region_render(const char *scene,
                                 const struct region_truth *t, int side_px,
                                 int spp, uint32_t seed, struct region_sums *to)
{
    static struct session s;
    struct error err = {""};
    struct options o = {.scene_path = scene,
                        .width_px = side_px,
                        .height_px = side_px,
                        .max_bounces = 64,
                        .view_lines = t->background,
                        .seed = seed,
                        .batch = true};
    float *rgb = xmalloc(sizeof(float[3]) * (size_t)(side_px * side_px));
    double means[REGIONS] = {0};

    if (!session_open(&s, &o, clock_ns(), &err) ||
        !session_restart(&s, (struct render_limits){.spp = (uint64_t)spp},
                         &err))
        print_error("%s\n", err.text);
    assert_string_equal(err.text, "");
    render_wait(s.engine.render, -1);
    film_linear(render_film(s.engine.render), rgb);
    session_close(&s);
    for (int y = 0; y < side_px; y++)
        for (int x = 0; x < side_px; x++)
            for (int c = 0; c < 3; c++)
                means[3 * (4 * (y * 4 / side_px) + x * 4 / side_px) + c] +=
                    (double)rgb[3 * (y * side_px + x) + c] * 16 /
                    (side_px * side_px);
    free(rgb);
    for (int i = 0; i < REGIONS; i++) {
        to->sums[i] += means[i];
        to->squares[i] += means[i] * means[i];
    }
    to->count++;
}

static inline double region_mean(const struct region_sums *s, int i)
{
    return s->sums[i] / s->count;
}

/* Returns the standard error of the mean. */
static inline double region_error(const struct region_sums *s, int i)
{
    double mean = region_mean(s, i);

    return sqrt(fmax(s->squares[i] / s->count - mean * mean, 0) /
                (s->count - 1));
}

/* Prints the regions that differ from the truth by more than its tolerance, 3
 * of its standard errors and `own` of ours. Returns their number. */
static inline int region_misses(const struct region_truth *t,
                                const struct region_sums *s, double own)
{
    int failures = 0;

    for (int i = 0; i < REGIONS; i++) {
        double mean = region_mean(s, i);
        double miss = fmax(fmax(t->low[i] - mean, mean - t->high[i]), 0);
        double allowed = t->tolerance * fmax(t->low[i], t->least) +
                         own * region_error(s, i) + 3 * t->error[i];

        if (miss <= allowed)
            continue;
        print_error("region %d channel %d: got %.6g, want %.6g to %.6g, off "
                    "by %.2g, allowed %.2g\n",
                    i / 3, i % 3, mean, t->low[i], t->high[i], miss, allowed);
        failures++;
    }
    return failures;
}

#endif
