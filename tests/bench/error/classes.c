// SPDX-License-Identifier: MIT
#include "classes.h"

#include "base/memory.h"
#include "image/color.h"
#include "render/light_pilot.h"
#include "world/light/light_cells.h"

#include <stdlib.h>

/* Samples of a pixel, a multiple of SAMPLE_BLOCK. */
#define SPP 64

/* Light of a pixel that is dark counts as this part of the picture's mean. */
#define DARK 0.1

enum { ALL, WITHOUT_PATHS, WITHOUT_CELLS, STEPS };

/* Adds up the samples of a pixel. */
static void add_pixel(const struct bvh8_world *w,
                      const struct cpu_kernel *paths, uint32_t x, uint32_t y,
                      double *sum, double *square)
{
    struct sample_id ids[SAMPLE_BLOCK];
    struct path_sample samples[SAMPLE_BLOCK];
    struct first_surface surfaces[SAMPLE_BLOCK];

    *sum = *square = 0;
    for (uint32_t first = 0; first < SPP; first += SAMPLE_BLOCK) {
        for (uint32_t i = 0; i < SAMPLE_BLOCK; i++)
            ids[i] = (struct sample_id){x, y, first + i};
        paths->samples(&w->world, ids, SAMPLE_BLOCK, samples, surfaces, NULL);
        for (uint32_t i = 0; i < SAMPLE_BLOCK; i++) {
            double light = color_mean(samples[i].radiance);

            *sum += light / SPP;
            *square += light * light / SPP;
        }
    }
}

/* Returns the sum of the pixels' variances, each over the square of its mean,
 * which `means` has. The first step sets them. */
static double measure_step(const struct bvh8_world *w,
                           const struct cpu_kernel *paths, bool is_first,
                           double *means)
{
    uint32_t width = (uint32_t)w->world.settings.camera.width;
    uint32_t count = width * (uint32_t)w->world.settings.camera.height;
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

bool class_variance_measure(const struct world *world,
                            const struct host_world *host,
                            const struct cpu_kernel *paths,
                            struct class_variance *v, struct error *err)
{
    /* grids of a width of 0 have no cells */
    static const struct light_cells none;
    struct bvh8_world w = {*world, world_tree(host)};
    const struct camera *c = &world->settings.camera;
    double *means =
        alloc_array((size_t)c->width * (size_t)c->height, sizeof *means);
    double left[STEPS];
    bool ok = means != NULL;

    for (int i = 0; ok && i < STEPS; i++) {
        if (i != ALL)
            w.world =
                light_pilot_world(world, i == WITHOUT_CELLS ? &none : NULL);
        left[i] = measure_step(&w, paths, i == ALL, means);
        ok = left[i] >= 0;
    }
    free(means);
    if (!ok)
        return fail(err, "out of memory for the classes of paths");
    *v = (struct class_variance){left[ALL] - left[WITHOUT_PATHS],
                                 left[WITHOUT_PATHS] - left[WITHOUT_CELLS],
                                 left[WITHOUT_CELLS]};
    return true;
}
