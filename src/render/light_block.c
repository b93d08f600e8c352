// SPDX-License-Identifier: MIT
#include "render/light_block.h"

#include <math.h>
#include <stdlib.h>

#include "base/machine.h"
#include "base/memory.h"
#include "render/radiance_training.h"

/* ---- the choice ---- */

/* Bytes of a pixel: sums and means of two halves. */
#define LIGHT_PIXEL_BYTES (6 * (sizeof(struct sum) + sizeof(float)))

/* Most bytes of estimates and radiance cells. */
#define RADIANCE_BYTES ((uint64_t)128 << 20)

/* True if half of the memory holds the film, the light of light paths and so
 * many bytes more. A picture too large for that is rendered without. */
static bool fits_memory(const struct film *f, uint64_t more_bytes)
{
    uint64_t pixels = (uint64_t)f->width * (uint64_t)f->height;

    return pixels * (FILM_PIXEL_BYTES + LIGHT_PIXEL_BYTES) + more_bytes <
           cgroup_quota_memory("").size_bytes / 2;
}

/* True if radiance cells may help. They would add light beyond a limit of
 * bounces. */
static bool may_train(const struct backend_picture *picture)
{
    const struct settings *s = &picture->world->settings;

    return s->has_light_cells != 0 && s->max_vertices >= CELL_VERTICES_MIN &&
           fits_memory(picture->film, RADIANCE_BYTES);
}

enum pass_result light_block_decide(struct light_block *b,
                                    const struct backend_picture *picture,
                                    struct pool *pool,
                                    const struct cancel *cancel,
                                    struct error *err)
{
    enum pass_result result = PASS_DONE;

    if (b->is_decided)
        return PASS_DONE;
    b->choice = (struct light_choice){.paths = 0};
    if (picture->host->light_paths.sources != NULL &&
        fits_memory(picture->film, 0)) {
        if (b->pilot == NULL)
            b->pilot = light_pilot_begin(picture);
        if (b->pilot == NULL)
            return fail(err, "out of memory for a pilot"), PASS_FAILED;
        result = light_pilot_run(b->pilot, pool, cancel, &b->choice, err);
    }
    if (result == PASS_DONE) {
        b->is_decided = true;
        b->may_train = may_train(picture);
        light_pilot_free(b->pilot);
        b->pilot = NULL;
    }
    return result;
}

struct world light_block_world(const struct light_block *b,
                               const struct world *world)
{
    struct world w = *world;

    if (b->choice.paths > 0)
        w = light_pilot_world(world, b->choice.has_cells ? &b->cells : NULL);
    if (b->has_radiance)
        radiance_training_lend(&w, &b->cells);
    return w;
}

bool light_block_is_needed(const struct light_block *b)
{
    return b->choice.paths > 0 || b->may_train;
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
    uint64_t first = (uint64_t)(0.5 * fmin(b->choice.paths, 1) * pixels) + 1;
    uint64_t each = (uint64_t)(0.5 * b->choice.paths * pixels) + 1;

    return sample == 0 ? 0 : first + each * (sample - 1);
}

static bool resize(struct light_block *b, const struct film *f)
{
    size_t pixels = (size_t)f->width * (size_t)f->height;

    if (b->means != NULL && b->image.width == f->width &&
        b->image.height == f->height)
        return true;
    light_image_free(&b->image);
    free(b->means);
    b->means = alloc_array(pixels, 6 * sizeof *b->means);
    return light_image_init(&b->image, f->width, f->height) && b->means != NULL;
}

/* Samples of a block, of each pixel. */
struct range {
    uint64_t begin, end;
};

/* Traces the light paths of a block, and takes their number. */
static enum pass_result trace_paths(struct light_block *b,
                                    const struct backend_picture *p,
                                    struct range samples, struct pool *pool,
                                    const struct cancel *cancel,
                                    uint64_t *count)
{
    struct world w = *p->world;
    const struct camera *c = &w.settings.camera;
    uint64_t first = paths_before(b, c, samples.begin);
    struct light_film film = {&b->image,
                              b->choice.has_cells ? &b->cells : NULL};

    *count = paths_before(b, c, samples.end) - first;
    if (!resize(b, p->film))
        return PASS_FAILED;
    light_image_clear(&b->image);
    b->image.x0 = p->x0;
    b->image.y0 = p->y0;
    if (!light_paths_trace(&p->host->light_paths, &w, first, (uint32_t)*count,
                           pool, cancel, film))
        return PASS_CANCELLED;
    light_image_means(&b->image, *count, b->means);
    b->light.pixels = b->means;
    b->light.pixel_count = (size_t)p->film->width * (size_t)p->film->height;
    return PASS_DONE;
}

/* True if a block has radiance cells, if any block has. */
static bool is_trained(const struct camera *c, struct range samples)
{
    return (double)samples.begin * (double)c->width * (double)c->height >=
           RADIANCE_SAMPLES_MIN;
}

/* Trains the radiance cells of a block. */
static bool train(struct light_block *b, const struct backend_picture *p,
                  struct range samples, struct pool *pool,
                  const struct cancel *cancel)
{
    struct world w = *p->world;
    const struct camera *c = &w.settings.camera;
    uint64_t first = radiance_training_before(c, samples.begin);
    uint64_t end = radiance_training_before(c, samples.end);

    if (!is_trained(c, samples))
        return true;
    if (b->choice.paths > 0)
        w = light_pilot_world(p->world, NULL);
    return radiance_training_run(&b->cells, &w, first, (uint32_t)(end - first),
                                 pool, cancel);
}

/* Decides on radiance cells before the first block that may have some. */
static enum pass_result decide_radiance(struct light_block *b,
                                        const struct backend_picture *p,
                                        struct range samples, struct pool *pool,
                                        const struct cancel *cancel)
{
    enum pass_result result;

    if (!b->may_train || b->has_radiance ||
        !is_trained(&p->world->settings.camera, samples))
        return PASS_DONE;
    result = radiance_training_pays(p, b->choice.paths > 0, pool, cancel,
                                    &b->has_radiance);
    b->has_radiance = b->has_radiance && result == PASS_DONE;
    b->may_train = b->has_radiance || result != PASS_DONE;
    return result;
}

static enum pass_result find(struct light_block *b,
                             const struct backend_picture *p,
                             struct range samples, struct pool *pool,
                             const struct cancel *cancel)
{
    bool has_cells = b->choice.has_cells || b->has_radiance;
    enum pass_result result = PASS_DONE;
    uint64_t path_count = 1;

    b->light = (struct pass_light){.version = samples.end};
    if (has_cells &&
        !light_cells_begin(&b->cells, p->world, samples.begin, 1, pool))
        return PASS_FAILED;
    if (b->choice.paths > 0)
        result = trace_paths(b, p, samples, pool, cancel, &path_count);
    if (result == PASS_DONE && b->has_radiance &&
        !train(b, p, samples, pool, cancel))
        result = PASS_CANCELLED;
    if (result != PASS_DONE || !has_cells)
        return result;
    if (!light_cells_end(&b->cells, path_count, pool, cancel))
        return cancel_requested(cancel) ? PASS_CANCELLED : PASS_FAILED;
    b->light.grids = b->cells.grids;
    b->light.cells = b->cells.cells;
    b->light.cell_count = b->cells.slot_count;
    return PASS_DONE;
}

enum pass_result light_block_find(struct light_block *b,
                                  const struct backend_picture *p,
                                  uint64_t sample, struct pool *pool,
                                  const struct cancel *cancel,
                                  struct error *err)
{
    const struct camera *c = &p->world->settings.camera;
    struct range samples = {block_begin(c, sample), light_block_end(c, sample)};
    enum pass_result result;

    if (b->end == samples.end)
        return PASS_DONE;
    b->end = 0;
    result = decide_radiance(b, p, samples, pool, cancel);
    if (result == PASS_DONE)
        result = find(b, p, samples, pool, cancel);
    if (result == PASS_DONE)
        b->end = samples.end;
    if (result == PASS_FAILED)
        fail(err, "out of memory for the light of %dx%d pixels", p->film->width,
             p->film->height);
    return result;
}

void light_block_reset(struct light_block *b)
{
    light_pilot_free(b->pilot);
    b->pilot = NULL;
    b->is_decided = false;
    b->may_train = false;
    b->has_radiance = false;
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
