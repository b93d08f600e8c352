// SPDX-License-Identifier: MIT
#include "classes.h"

#include "base/memory.h"
#include "image/color.h"
#include "render/light_pilot.h"
#include "render/radiance_training.h"
#include "world/light/light_cells.h"

#include <stdlib.h>

/* Samples of a pixel, a multiple of SAMPLE_BLOCK. */
#define SPP 64

/* Light of a pixel that is dark counts as this part of the picture's mean. */
#define DARK 0.1

/* Training paths of the radiance cells. */
#define TRAINING 262144

enum { ALL, WITHOUT_PATHS, WITHOUT_CELLS, RADIANCE, STEPS };

/* Adds up the samples of a pixel. */
static void add_pixel(const struct world *w, const struct cpu_kernel *paths,
                      uint32_t x, uint32_t y, double *sum, double *square)
{
    struct sample_id ids[SAMPLE_BLOCK];
    struct path_sample samples[SAMPLE_BLOCK];
    struct first_surface surfaces[SAMPLE_BLOCK];

    *sum = *square = 0;
    for (uint32_t first = 0; first < SPP; first += SAMPLE_BLOCK) {
        for (uint32_t i = 0; i < SAMPLE_BLOCK; i++)
            ids[i] = (struct sample_id){x, y, first + i};
        paths->samples(w, ids, SAMPLE_BLOCK, samples, surfaces, NULL);
        for (uint32_t i = 0; i < SAMPLE_BLOCK; i++) {
            double light = color_mean(samples[i].radiance);

            *sum += light / SPP;
            *square += light * light / SPP;
        }
    }
}

/* Returns the sum of the pixels' variances, each over the square of its mean,
 * which `means` has. The first step sets them. */
static double measure_step(const struct world *w,
                           const struct cpu_kernel *paths, bool is_first,
                           double *means)
{
    uint32_t width = (uint32_t)w->settings.camera.width;
    uint32_t count = width * (uint32_t)w->settings.camera.height;
    double *variances = alloc_array(count, sizeof *variances);
    double mean = 0, all = 0;

    if (variances == NULL)
        return -1;
    for (uint32_t i = 0; i < count; i++) {
        double sum, square;

        add_pixel(w, paths, i % width, i / width, &sum, &square);
        variances[i] = square - sum * sum;
        if (is_first)
            means[i] = sum;
        mean += means[i] / count;
    }
    for (uint32_t i = 0; i < count; i++)
        all += variances[i] /
               (means[i] * means[i] + DARK * DARK * mean * mean) / count;
    free(variances);
    return all;
}

/* Trains radiance cells for a world, and lends them to it. */
static bool add_radiance(struct light_cells *cells, struct world *w)
{
    static const struct cancel never;
    struct error err;
    struct pool *pool = pool_create(1, &err);
    bool ok = pool != NULL && light_cells_begin(cells, w, 0, 1, pool) &&
              radiance_training_run(cells, w, 0, TRAINING, pool, &never) &&
              light_cells_end(cells, 1, pool, &never);

    pool_destroy(pool);
    if (ok)
        radiance_training_lend(w, cells);
    return ok;
}

bool class_variance_measure(const struct world *world,
                            const struct cpu_kernel *paths,
                            struct class_variance *v, struct error *err)
{
    /* grids of a width of 0 have no cells */
    static const struct light_cells none;
    struct light_cells cells = {.cells = NULL};
    struct world w = *world;
    const struct camera *c = &world->settings.camera;
    double *means =
        alloc_array((size_t)c->width * (size_t)c->height, sizeof *means);
    double left[STEPS];
    bool ok = means != NULL;

    for (int i = 0; ok && i < STEPS; i++) {
        if (i == WITHOUT_PATHS || i == WITHOUT_CELLS)
            w = light_pilot_world(world, i == WITHOUT_CELLS ? &none : NULL);
        ok = i != RADIANCE || add_radiance(&cells, &w);
        left[i] = measure_step(&w, paths, i == ALL, means);
        ok = ok && left[i] >= 0;
    }
    light_cells_free(&cells);
    free(means);
    if (!ok)
        return fail(err, "out of memory for the classes of paths");
    *v = (struct class_variance){left[ALL] - left[WITHOUT_PATHS],
                                 left[WITHOUT_PATHS] - left[WITHOUT_CELLS],
                                 left[WITHOUT_CELLS] - left[RADIANCE],
                                 left[RADIANCE]};
    return true;
}
