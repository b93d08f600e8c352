// SPDX-License-Identifier: MIT
#include "render/light_pilot.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "image/color.h"
#include "render/cpu_dispatch.h"
#include "render/projection.h"
#include "world/light/light_paths.h"

/* Samples of a pixel of the pilot, a multiple of SAMPLE_BLOCK, and its light
 * paths of each half. */
#define PILOT_SPP   16
#define PILOT_PATHS 2048

/* Time of a ray of a light path in those of samples; measured 1.8 to 2.5. */
#define LIGHT_RAY_COST 2.3

/* Least and greatest number of light paths for each sample: powers of two, so
 * that chance in the pilot seldom changes it. The first sample of a pixel has
 * at most one, so that the first picture does not wait. */
#define PATHS_MIN (1.0 / 64)
#define PATHS_MAX 4.0

/* Share of the light that light paths find, below which paths from the eye have
 * missed some of it, and do not know their own noise. */
#define FOUND_MIN 0.7

/* Share of all light that is worth light paths. */
#define SHARE_MIN 0.002

/* Number of light paths for each sample where the pilot has seen none of their
 * light, and no other path finds it. */
#define PATHS_UNSEEN 0.25

/* ---- samples ---- */

/* Sums over the samples of a pixel: light that paths from the eye find, alone
 * and beside light paths, and the squares; light of cells, of each half. */
struct pilot_pixel {
    double whole, whole_square, rest, rest_square, cells[2];
    uint64_t rays; /* beside light paths */
    bool is_done;
};

/* Worlds of the pilot: paths from the eye alone, beside light paths whose cells
 * are empty, and if it may have cells, with these. */
enum { WORLD_ALONE, WORLD_BESIDE, WORLD_CELLS, PILOT_WORLDS };

struct light_pilot {
    const struct cpu_kernel *kernel;
    struct world worlds[PILOT_WORLDS];
    struct light_cells cells, none;
    struct light_image image;
    const struct light_paths *paths;
    bool has_cells; /* the world may have light cells */
    bool has_paths; /* light paths have been traced */
    struct pilot_pixel pixels[PILOT_PIXELS];
};

static void pilot_pixel(void *context, uint32_t pixel, int worker)
{
    struct light_pilot *p = context;
    struct pilot_pixel *to = &p->pixels[pixel];
    struct sample_id ids[PILOT_SPP];
    struct path_sample samples[PILOT_WORLDS][PILOT_SPP];
    struct first_surface surfaces[SAMPLE_BLOCK];
    int worlds = p->has_cells ? PILOT_WORLDS : WORLD_CELLS;

    (void)worker;
    if (to->is_done)
        return;
    for (uint32_t i = 0; i < PILOT_SPP; i++)
        ids[i] =
            (struct sample_id){pixel % PILOT_WIDTH, pixel / PILOT_WIDTH, i};
    for (int i = 0; i < worlds * PILOT_SPP; i += SAMPLE_BLOCK)
        p->kernel->samples(&p->worlds[i / PILOT_SPP], ids + i % PILOT_SPP,
                           SAMPLE_BLOCK, samples[i / PILOT_SPP] + i % PILOT_SPP,
                           surfaces, NULL);
    for (uint32_t i = 0; i < PILOT_SPP; i++) {
        double whole = color_mean(samples[WORLD_ALONE][i].radiance);
        double rest = color_mean(samples[WORLD_BESIDE][i].radiance);

        to->whole += whole;
        to->whole_square += whole * whole;
        to->rest += rest;
        to->rest_square += rest * rest;
        if (p->has_cells)
            to->cells[i % 2] +=
                color_mean(samples[WORLD_CELLS][i].radiance) - rest;
        to->rays += samples[WORLD_BESIDE][i].rays;
    }
    to->is_done = true;
}

/* Returns the variance of a sample. */
static double variance_of(double sum, double square)
{
    return fmax(square - sum * sum / PILOT_SPP, 0) / (PILOT_SPP - 1);
}

/* Returns the light that a half of the light paths brings to a pixel. */
static double light_of(const struct light_pilot *p, const float *means,
                       int half, int pixel)
{
    const float *rgb = means + 3 * (half * PILOT_PIXELS + pixel);

    return color_mean(v3(rgb[0], rgb[1], rgb[2])) +
           p->pixels[pixel].cells[half] / (PILOT_SPP / 2.);
}

static bool cells_help(const struct light_pilot *p)
{
    double light = 0;

    for (int i = 0; i < PILOT_PIXELS; i++)
        light += p->pixels[i].cells[0] + p->pixels[i].cells[1];
    return light > 0;
}

/* ---- the choice ---- */

/* Chooses the number of light paths for each sample by the noise of both, each
 * relative to the light of its pixel. */
static double choose(const struct light_pilot *p, const float *means,
                     bool has_points)
{
    double light[PILOT_PIXELS], all = 0, brought = 0, found = 0, dark;
    double alone = 0, rest = 0, paths = 0, rays = 0, cost, number;

    for (int i = 0; i < PILOT_PIXELS; i++) {
        light[i] = (light_of(p, means, 0, i) + light_of(p, means, 1, i)) / 2;
        brought += light[i];
        found += (p->pixels[i].whole - p->pixels[i].rest) / PILOT_SPP;
        light[i] += p->pixels[i].rest / PILOT_SPP;
        all += light[i];
        rays += (double)p->pixels[i].rays;
    }
    cost = LIGHT_RAY_COST * (double)p->image.rays / (2.0 * PILOT_PATHS) /
           fmax(rays / (PILOT_PIXELS * PILOT_SPP), 1);
    dark = 0.01 * (all / PILOT_PIXELS) * (all / PILOT_PIXELS);
    for (int i = 0; i < PILOT_PIXELS; i++) {
        const struct pilot_pixel *x = &p->pixels[i];
        double difference =
            (light_of(p, means, 0, i) - light_of(p, means, 1, i)) / 2;
        double weight = 1 / (light[i] * light[i] + dark);

        if (!(all > 0))
            continue;
        alone += weight * variance_of(x->whole, x->whole_square);
        rest += weight * variance_of(x->rest, x->rest_square);
        paths += weight * difference * difference *
                 (2.0 * PILOT_PATHS / PILOT_PIXELS);
    }
    if (!(brought > 0) && has_points)
        return PATHS_UNSEEN;
    if (!(brought > SHARE_MIN * all))
        return 0;
    number = sqrt(paths / (cost * fmax(rest, 1e-30)));
    if (found > FOUND_MIN * brought &&
        !(pow(sqrt(rest) + sqrt(cost * paths), 2) < alone))
        return 0;
    return fmin(fmax(exp2(rint(log2(number))), PATHS_MIN), PATHS_MAX);
}

/* True if lamps have no size: only light paths bring their light by way of
 * smooth surfaces. */
static bool has_points(const struct world *w)
{
    bool has = w->settings.sphere_count < w->settings.point_light_count;

    for (uint32_t i = 0; i < w->settings.directional_light_count && !has; i++)
        has = !(w->directional_lights[i].size > 0.0f);
    return has;
}

/* ---- the run ---- */

struct world light_pilot_world(const struct world *world,
                               const struct light_cells *cells)
{
    struct world w = *world;

    w.settings.has_light_paths = 1;
    w.settings.features |= FEATURE_LIGHT_PATHS;
    w.settings.has_light_cells = cells != NULL;
    if (cells != NULL) {
        w.light_grids = cells->grids;
        w.light_cells = cells->cells;
    }
    return w;
}

struct camera light_pilot_camera(const struct camera *c)
{
    struct projection_part part = {.width = (int)c->width,
                                   .height = (int)c->height,
                                   .shown_width = PILOT_WIDTH,
                                   .shown_height = PILOT_HEIGHT};

    return projection_camera(c, &part);
}

void light_pilot_free(struct light_pilot *p)
{
    if (p == NULL)
        return;
    light_cells_free(&p->cells);
    light_cells_free(&p->none);
    light_image_free(&p->image);
    free(p);
}

struct light_pilot *light_pilot_begin(const struct backend_picture *picture)
{
    struct light_pilot *p = alloc_array(1, sizeof *p);
    struct world w = *picture->world;
    struct camera *c = &w.settings.camera;

    if (p == NULL)
        return NULL;
    *c = light_pilot_camera(c);
    w.settings.smoke_steps_max = SMOKE_STEPS_FEW;
    if (!light_image_init(&p->image, PILOT_WIDTH, PILOT_HEIGHT)) {
        light_pilot_free(p);
        return NULL;
    }
    for (int i = 0; i < PILOT_WORLDS; i++)
        p->worlds[i] = w;
    p->paths = &picture->host->light_paths;
    p->has_cells = w.settings.has_light_cells != 0 &&
                   w.settings.max_vertices >= CELL_VERTICES_MIN;
    return p;
}

/* Traces the light paths of the pilot. */
static enum pass_result pilot_light(struct light_pilot *p, struct pool *pool,
                                    const struct cancel *cancel)
{
    const struct world *w = &p->worlds[WORLD_ALONE];
    struct light_film film = {&p->image, p->has_cells ? &p->cells : NULL};

    light_image_clear(&p->image);
    if (!light_cells_begin(&p->none, w, 0, 1, pool) ||
        !light_cells_begin(&p->cells, w, 0, 1, pool))
        return PASS_FAILED;
    if (!light_paths_trace(p->paths, w, 0, PILOT_PATHS, pool, cancel, film))
        return PASS_CANCELLED;
    if (!light_cells_end(&p->none, PILOT_PATHS, pool, cancel) ||
        !light_cells_end(&p->cells, PILOT_PATHS, pool, cancel))
        return cancel_requested(cancel) ? PASS_CANCELLED : PASS_FAILED;
    p->worlds[WORLD_BESIDE] =
        light_pilot_world(w, p->has_cells ? &p->none : NULL);
    p->worlds[WORLD_CELLS] =
        light_pilot_world(w, p->has_cells ? &p->cells : NULL);
    p->kernel = cpu_kernel_fit(cpu_kernel_best(),
                               p->worlds[WORLD_CELLS].settings.features);
    p->has_paths = true;
    return PASS_DONE;
}

static struct light_choice choice_of(const struct light_pilot *p)
{
    const struct world *w = &p->worlds[WORLD_ALONE];
    float means[6 * PILOT_PIXELS];
    struct light_choice choice = {.has_cells = p->has_cells && cells_help(p)};

    light_image_means(&p->image, PILOT_PATHS, means);
    choice.paths = choose(p, means, has_points(w));
    return choice;
}

enum pass_result light_pilot_run(struct light_pilot *p, struct pool *pool,
                                 const struct cancel *cancel,
                                 struct light_choice *choice, struct error *err)
{
    enum pass_result result =
        p->has_paths ? PASS_DONE : pilot_light(p, pool, cancel);

    if (result == PASS_DONE &&
        !pool_run(pool, PILOT_PIXELS, pilot_pixel, p, cancel))
        result = PASS_CANCELLED;
    if (result == PASS_DONE)
        *choice = choice_of(p);
    if (result == PASS_FAILED)
        fail(err, "out of memory for a pilot");
    return result;
}
