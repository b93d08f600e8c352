// SPDX-License-Identifier: MIT
#include "render/light_block.h"

#include <math.h>
#include <stdlib.h>

#include "base/machine.h"
#include "base/memory.h"
#include "image/color.h"
#include "render/cpu_dispatch.h"
#include "render/projection.h"
#include "kernels/rng.h"

/* Size of the pilot, its samples, a multiple of SAMPLE_BLOCK, and its light
 * paths of each half. */
#define PILOT_WIDTH  24
#define PILOT_HEIGHT 14
#define PILOT_PIXELS (PILOT_WIDTH * PILOT_HEIGHT)
#define PILOT_SPP    16
#define PILOT_PATHS  2048

/* Time of a ray of a light path in those of samples; measured 1 to 2. */
#define LIGHT_RAY_COST 1.5

/* Least and greatest number of light paths for each sample: powers of two, so
 * that chance in the pilot seldom changes it. The first sample of a pixel has
 * at most one, so that the first picture does not wait. */
#define PATHS_MIN (1.0 / 64)
#define PATHS_MAX 4.0

/* Width of the first light cells of the halves in pixels. */
#define CELL_WIDE   2.4
#define CELL_NARROW 0.6

/* Least limit of vertices for light cells: light that comes to them by paths
 * near the limit is longer than paths from the eye are. */
#define CELL_VERTICES_MIN 32

/* Key of the places of grids. */
#define GRID_KEY 0x5be0cd19u

/* Share of the light that light paths find, below which paths from the eye have
 * missed some of it, and do not know their own noise. */
#define FOUND_MIN 0.7

/* Share of all light that is worth light paths. */
#define SHARE_MIN 0.002

/* Number of light paths for each sample where the pilot has seen none of their
 * light, and no other path finds it. */
#define PATHS_UNSEEN 0.25

/* ---- the pilot ---- */

/* Sums over the samples of a pixel: light that paths from the eye find, alone
 * and beside light paths, and the squares; light of cells, of each half. */
struct pilot_pixel {
    double whole, whole_square, rest, rest_square, cells[2];
    uint64_t rays; /* beside light paths */
    bool is_done;
};

/* Worlds of the pilot: paths from the eye alone, beside light paths whose cells
 * are empty, and with their cells. */
enum { WORLD_ALONE, WORLD_BESIDE, WORLD_CELLS, PILOT_WORLDS };

struct light_pilot {
    const struct cpu_kernel *kernel;
    struct bvh8_world worlds[PILOT_WORLDS];
    struct light_cells cells, none;
    struct light_image image;
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

    (void)worker;
    if (to->is_done)
        return;
    for (uint32_t i = 0; i < PILOT_SPP; i++)
        ids[i] =
            (struct sample_id){pixel % PILOT_WIDTH, pixel / PILOT_WIDTH, i};
    for (int i = 0; i < PILOT_WORLDS * PILOT_SPP; i += SAMPLE_BLOCK)
        p->kernel->samples(&p->worlds[i / PILOT_SPP].world, ids + i % PILOT_SPP,
                           SAMPLE_BLOCK, samples[i / PILOT_SPP] + i % PILOT_SPP,
                           surfaces);
    for (uint32_t i = 0; i < PILOT_SPP; i++) {
        double whole = color_mean(samples[WORLD_ALONE][i].radiance);
        double rest = color_mean(samples[WORLD_BESIDE][i].radiance);

        to->whole += whole;
        to->whole_square += whole * whole;
        to->rest += rest;
        to->rest_square += rest * rest;
        to->cells[i % 2] += color_mean(samples[WORLD_CELLS][i].radiance) - rest;
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

/* Bytes of a pixel: sums and means of two halves. */
#define LIGHT_PIXEL_BYTES (6 * (sizeof(struct sum) + sizeof(float)))

/* True if half of the memory holds the film and the light of light paths. A
 * picture too large for that is rendered without. */
static bool fits_memory(const struct film *f)
{
    uint64_t pixels = (uint64_t)f->width * (uint64_t)f->height;

    return pixels * (FILM_PIXEL_BYTES + LIGHT_PIXEL_BYTES) <
           cgroup_quota_memory("").size_bytes / 2;
}

static struct world beside_paths(const struct world *world,
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

static int thread_count(const struct pool *pool)
{
    return pool != NULL ? pool_thread_count(pool) : 1;
}

/* Begins the grids of a block of the camera's picture, the first sample of
 * which is `begin`. */
static bool begin_cells(struct light_cells *cells, const struct world *w,
                        uint64_t begin, const struct pool *pool)
{
    double finer = pow(1 + (double)begin / 32, -0.25);
    const double pixels[2] = {CELL_WIDE * finer, CELL_NARROW * finer};
    uint32_t key = hash_u32(w->settings.seed + GRID_KEY);

    key = hash_u32(key ^ (uint32_t)begin) ^ (uint32_t)(begin >> 32);
    return light_cells_begin(cells, &w->settings.camera, key, pixels,
                             thread_count(pool));
}

static void pilot_free(struct light_pilot *p)
{
    if (p == NULL)
        return;
    light_cells_free(&p->cells);
    light_cells_free(&p->none);
    light_image_free(&p->image);
    free(p);
}

/* Returns a pilot for a picture, or NULL when memory is out. */
static struct light_pilot *pilot_begin(const struct backend_picture *picture)
{
    struct light_pilot *p = alloc_array(1, sizeof *p);
    struct projection_part part = {.shown_width = PILOT_WIDTH,
                                   .shown_height = PILOT_HEIGHT};
    struct bvh8_world w = {*picture->world, world_tree(picture->host)};
    struct camera *c = &w.world.settings.camera;

    part.width = (int)c->width;
    part.height = (int)c->height;
    *c = projection_camera(c, &part);
    if (p == NULL || !light_image_init(&p->image, PILOT_WIDTH, PILOT_HEIGHT)) {
        pilot_free(p);
        return NULL;
    }
    for (int i = 0; i < PILOT_WORLDS; i++)
        p->worlds[i] = w;
    return p;
}

/* Traces the light paths of the pilot. */
static enum pass_result pilot_light(struct light_pilot *p,
                                    const struct host_world *host,
                                    bool has_cells, struct pool *pool,
                                    const struct cancel *cancel)
{
    const struct bvh8_world *w = &p->worlds[WORLD_ALONE];
    struct light_film film = {&p->image, has_cells ? &p->cells : NULL};

    light_image_clear(&p->image);
    if (!begin_cells(&p->none, &w->world, 0, pool) ||
        !light_cells_end(&p->none, 1, pool) ||
        !begin_cells(&p->cells, &w->world, 0, pool))
        return PASS_FAILED;
    if (!light_paths_trace(&host->light_paths, w, 0, PILOT_PATHS, pool, cancel,
                           film))
        return PASS_CANCELLED;
    if (!light_cells_end(&p->cells, PILOT_PATHS, pool))
        return PASS_FAILED;
    p->worlds[WORLD_BESIDE].world =
        beside_paths(&w->world, has_cells ? &p->none : NULL);
    p->worlds[WORLD_CELLS].world =
        beside_paths(&w->world, has_cells ? &p->cells : NULL);
    p->kernel = cpu_kernel_fit(cpu_kernel_best(),
                               p->worlds[WORLD_CELLS].world.settings.features);
    p->has_paths = true;
    return PASS_DONE;
}

/* Takes the decision of the pilot. */
static void take_pilot(struct light_block *b, bool has_cells)
{
    struct light_pilot *p = b->pilot;
    float means[6 * PILOT_PIXELS];

    light_image_means(&p->image, PILOT_PATHS, means);
    b->paths = choose(p, means, has_points(&p->worlds[WORLD_ALONE].world));
    b->has_cells = has_cells && cells_help(p);
    b->is_decided = true;
    pilot_free(p);
    b->pilot = NULL;
}

enum pass_result light_block_decide(struct light_block *b,
                                    const struct backend_picture *picture,
                                    struct pool *pool,
                                    const struct cancel *cancel,
                                    struct error *err)
{
    const struct settings *s = &picture->world->settings;
    bool has_cells =
        s->has_light_cells != 0 && s->max_vertices >= CELL_VERTICES_MIN;
    enum pass_result result = PASS_DONE;

    if (b->is_decided)
        return PASS_DONE;
    b->paths = 0;
    b->has_cells = false;
    if (picture->host->light_paths.sources == NULL ||
        world_tree(picture->host) == NULL || !fits_memory(picture->film)) {
        b->is_decided = true;
        return PASS_DONE;
    }
    if (b->pilot == NULL)
        b->pilot = pilot_begin(picture);
    if (b->pilot == NULL)
        result = PASS_FAILED;
    else if (!b->pilot->has_paths)
        result = pilot_light(b->pilot, picture->host, has_cells, pool, cancel);
    if (result == PASS_DONE &&
        !pool_run(pool, PILOT_PIXELS, pilot_pixel, b->pilot, cancel))
        result = PASS_CANCELLED;
    if (result == PASS_DONE)
        take_pilot(b, has_cells);
    if (result == PASS_FAILED)
        fail(err, "out of memory for a pilot");
    return result;
}

struct world light_block_world(const struct light_block *b,
                               const struct world *world)
{
    return b->paths > 0 ? beside_paths(world, b->has_cells ? &b->cells : NULL)
                        : *world;
}

/* ---- blocks ---- */

/* Samples of a pixel in the largest blocks, and of all pixels, unless a block
 * has one sample of each. */
#define BLOCK_SPP_MAX     64
#define BLOCK_SAMPLES_MAX 0x1p20

static uint64_t block_size_max(const struct camera *c)
{
    double pixels = (double)c->width * (double)c->height;
    uint64_t size = BLOCK_SPP_MAX;

    while (size > 1 && pixels * (double)size > BLOCK_SAMPLES_MAX)
        size /= 2;
    return size;
}

uint64_t light_block_end(const struct camera *c, uint64_t sample)
{
    uint64_t size = block_size_max(c), end = 1;

    if (sample >= size)
        return (sample / size + 1) * size;
    while (end <= sample)
        end *= 2;
    return end;
}

static uint64_t block_begin(const struct camera *c, uint64_t sample)
{
    uint64_t size = block_size_max(c), begin = 0;

    if (sample >= size)
        return sample / size * size;
    while (light_block_end(c, begin) <= sample)
        begin = light_block_end(c, begin);
    return begin;
}

/* Returns the light paths of a half before those of a sample. */
static uint64_t paths_before(const struct light_block *b,
                             const struct camera *c, uint64_t sample)
{
    double pixels = (double)c->width * (double)c->height;
    uint64_t first = (uint64_t)(0.5 * fmin(b->paths, 1) * pixels) + 1;
    uint64_t each = (uint64_t)(0.5 * b->paths * pixels) + 1;

    return sample == 0 ? 0 : first + each * (sample - 1);
}

static bool resize(struct light_block *b, const struct film *f,
                   struct error *err)
{
    size_t pixels = (size_t)f->width * (size_t)f->height;

    if (b->means != NULL && b->image.width == f->width &&
        b->image.height == f->height)
        return true;
    light_image_free(&b->image);
    free(b->means);
    b->means = alloc_array(pixels, 6 * sizeof *b->means);
    return (light_image_init(&b->image, f->width, f->height) &&
            b->means != NULL) ||
           fail(err, "out of memory for light paths to %dx%d pixels", f->width,
                f->height);
}

enum pass_result light_block_find(struct light_block *b,
                                  const struct backend_picture *p,
                                  uint64_t sample, struct pool *pool,
                                  const struct cancel *cancel,
                                  struct error *err)
{
    struct bvh8_world w = {*p->world, world_tree(p->host)};
    const struct camera *c = &w.world.settings.camera;
    uint64_t begin = block_begin(c, sample), end = light_block_end(c, sample);
    uint64_t count;
    struct light_film film = {&b->image, b->has_cells ? &b->cells : NULL};

    if (b->end == end)
        return PASS_DONE;
    b->end = 0;
    if (!resize(b, p->film, err))
        return PASS_FAILED;
    if (b->has_cells && !begin_cells(&b->cells, &w.world, begin, pool))
        return fail(err, "out of memory for light cells"), PASS_FAILED;
    count = paths_before(b, c, end) - paths_before(b, c, begin);
    light_image_clear(&b->image);
    b->image.x0 = p->x0;
    b->image.y0 = p->y0;
    if (!light_paths_trace(&p->host->light_paths, &w, paths_before(b, c, begin),
                           (uint32_t)count, pool, cancel, film))
        return PASS_CANCELLED;
    if (b->has_cells && !light_cells_end(&b->cells, count, pool))
        return fail(err, "out of memory for light cells"), PASS_FAILED;
    light_image_means(&b->image, count, b->means);
    b->light = (struct pass_light){.pixels = b->means,
                                   .pixel_count = (size_t)p->film->width *
                                                  (size_t)p->film->height,
                                   .version = end};
    if (b->has_cells) {
        b->light.grids = b->cells.grids;
        b->light.cells = b->cells.cells;
        b->light.cell_count = b->cells.slot_count;
    }
    b->end = end;
    return PASS_DONE;
}

void light_block_reset(struct light_block *b)
{
    pilot_free(b->pilot);
    b->pilot = NULL;
    b->is_decided = false;
    b->end = 0;
}

void light_block_free(struct light_block *b)
{
    light_block_reset(b);
    light_image_free(&b->image);
    light_cells_free(&b->cells);
    free(b->means);
    *b = (struct light_block){.means = NULL};
}
