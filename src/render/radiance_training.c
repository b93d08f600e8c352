// SPDX-License-Identifier: MIT
#include "render/radiance_training.h"

#include <math.h>

#include "render/cpu_dispatch.h"
#include "render/light_pilot.h"
#include "kernels/rng.h"

/* Training paths for each sample, and most for all samples of a number. Fewer
 * leave cells empty, more cost more than they save: .03 to .25 are within 20 %
 * in rooms. */
#define TRAINING_SHARE 0.1
#define TRAINING_MAX   65536

/* Index of the first training path in its pixel, beyond all samples. */
#define TRAINING_INDEX ((uint64_t)1 << 48)

struct training {
    struct light_cells *cells;
    const struct cpu_kernel *kernel;
    struct world world;
    uint64_t first;
    uint32_t count;
};

uint64_t radiance_training_before(const struct camera *c, uint64_t sample)
{
    double pixels = (double)c->width * (double)c->height;

    return sample * (uint64_t)fmin(ceil(TRAINING_SHARE * pixels), TRAINING_MAX);
}

void radiance_training_lend(struct world *w, const struct light_cells *cells)
{
    w->settings.has_radiance_cells = 1;
    w->settings.features |= FEATURE_RADIANCE_CELLS;
    w->light_grids = cells->grids;
    w->light_cells = cells->cells;
}

static struct sample_id path_id(const struct settings *s, uint64_t number)
{
    const struct camera *c = &s->camera;
    uint32_t key = hash_u32(s->seed ^ hash_u32((uint32_t)(number >> 32)));
    uint32_t x = hash_u32(key ^ (uint32_t)number);
    uint32_t y = hash_u32(x + 1u);

    return (struct sample_id){
        (uint32_t)((uint64_t)x * (uint64_t)c->width >> 32),
        (uint32_t)((uint64_t)y * (uint64_t)c->height >> 32),
        TRAINING_INDEX + number,
    };
}

static void train(void *context, uint32_t block, int worker)
{
    const struct training *t = context;
    const struct world *w = &t->world;
    struct sample_id ids[SAMPLE_BLOCK] = {{0, 0, 0}};
    struct path_sample samples[SAMPLE_BLOCK];
    struct first_surface surfaces[SAMPLE_BLOCK];
    struct cell_estimates estimates[SAMPLE_BLOCK];
    const struct sample_options options = {.estimates = estimates};
    uint32_t begin = block * SAMPLE_BLOCK, n = t->count - begin;

    n = n < SAMPLE_BLOCK ? n : SAMPLE_BLOCK;
    for (uint32_t i = 0; i < n; i++)
        ids[i] = path_id(&w->settings, t->first + begin + i);
    t->kernel->samples(w, ids, n, samples, surfaces, &options);
    for (uint32_t i = 0; i < n; i++)
        light_cells_estimate(t->cells, worker, (int)(i & 1), begin + i,
                             &estimates[i]);
}

bool radiance_training_run(struct light_cells *cells, const struct world *world,
                           uint64_t first, uint32_t count, struct pool *pool,
                           const struct cancel *cancel)
{
    struct training t = {
        .cells = cells,
        .kernel = cpu_kernel_fit(cpu_kernel_best(), world->settings.features |
                                                        FEATURE_RADIANCE_CELLS),
        .world = *world,
        .first = first,
        .count = count,
    };

    radiance_training_lend(&t.world, cells);
    t.world.settings.has_light_cells = 0;
    return pool_run(pool, (count + SAMPLE_BLOCK - 1) / SAMPLE_BLOCK, train, &t,
                    cancel);
}

/* ---- the pilot ---- */

/* Training paths of the pilot. */
#define PILOT_TRAINING 2048

/* Width of its cells in those of pictures: they have so few estimates. */
#define PILOT_WIDER 3.0

/* Least number of rays of paths that go on, by that of paths that end at
 * radiance cells. Measured: 1.08 and more in rooms, 1.00 to 1.04 elsewhere. */
#define RAYS_SAVED_MIN 1.08

struct pilot {
    const struct cpu_kernel *kernel;
    struct world without, with;
    uint64_t rays[PILOT_PIXELS][2];
};

static void pilot_pixel(void *context, uint32_t pixel, int worker)
{
    struct pilot *p = context;
    struct sample_id ids[SAMPLE_BLOCK];
    struct path_sample samples[2][SAMPLE_BLOCK];
    struct first_surface surfaces[SAMPLE_BLOCK];

    (void)worker;
    for (uint32_t i = 0; i < SAMPLE_BLOCK; i++)
        ids[i] =
            (struct sample_id){pixel % PILOT_WIDTH, pixel / PILOT_WIDTH, i};
    p->kernel->samples(&p->without, ids, SAMPLE_BLOCK, samples[0], surfaces,
                       NULL);
    p->kernel->samples(&p->with, ids, SAMPLE_BLOCK, samples[1], surfaces, NULL);
    for (int k = 0; k < 2; k++) {
        p->rays[pixel][k] = 0;
        for (int i = 0; i < SAMPLE_BLOCK; i++)
            p->rays[pixel][k] += samples[k][i].rays;
    }
}

/* Returns the world of the pilot, without radiance cells, and with light cells
 * that are empty. */
static struct world pilot_world(const struct backend_picture *picture,
                                bool has_light_paths,
                                const struct light_cells *cells)
{
    struct world w = *picture->world;
    struct camera *c = &w.settings.camera;

    *c = light_pilot_camera(c);
    if (has_light_paths)
        w = light_pilot_world(&w, cells);
    return w;
}

static enum pass_result pilot_run(struct pilot *p, struct light_cells *cells,
                                  struct pool *pool,
                                  const struct cancel *cancel)
{
    if (!light_cells_begin(cells, &p->without, 0, PILOT_WIDER, pool))
        return PASS_FAILED;
    if (!radiance_training_run(cells, &p->without, 0, PILOT_TRAINING, pool,
                               cancel))
        return PASS_CANCELLED;
    if (!light_cells_end(cells, 1, pool, cancel))
        return cancel_requested(cancel) ? PASS_CANCELLED : PASS_FAILED;
    p->without.light_cells = cells->cells;
    p->with = p->without;
    radiance_training_lend(&p->with, cells);
    p->kernel = cpu_kernel_fit(cpu_kernel_best(), p->with.settings.features);
    return pool_run(pool, PILOT_PIXELS, pilot_pixel, p, cancel)
               ? PASS_DONE
               : PASS_CANCELLED;
}

enum pass_result radiance_training_pays(const struct backend_picture *picture,
                                        bool has_light_paths, struct pool *pool,
                                        const struct cancel *cancel, bool *pays)
{
    struct light_cells cells = {.cells = NULL};
    struct pilot p = {
        .without = pilot_world(picture, has_light_paths, &cells),
    };
    enum pass_result result = pilot_run(&p, &cells, pool, cancel);
    uint64_t rays[2] = {0, 0};

    for (int i = 0; i < PILOT_PIXELS; i++)
        for (int k = 0; k < 2; k++)
            rays[k] += p.rays[i][k];
    *pays = (double)rays[0] > RAYS_SAVED_MIN * (double)rays[1];
    light_cells_free(&cells);
    return result;
}
