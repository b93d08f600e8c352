// SPDX-License-Identifier: MIT
#include "render/backend.h"

#include <stdlib.h>

#include "base/memory.h"
#include "base/min_max.h"
#include "render/cpu_dispatch.h"
#include "kernels/sobol.h"

/* Width and height of a block, in points of the pass's grid. */
#define BLOCK_SIDE 8

struct backend_cpu {
    struct backend base;
    const struct cpu_kernel *full_kernel; /* with all features */
    /* from begin() */
    const struct cpu_kernel *kernel; /* smallest build for the world */
    struct world world;
    struct film *film;
    int x0, y0;
};

/* Parameters of one pass, read by the workers. */
struct job {
    const struct backend_cpu *backend;
    const struct cancel *cancel;
    struct pass pass;
    uint32_t columns; /* blocks in a row */
    uint32_t count;   /* blocks in all */
    /* number of bits such that 2^bits is at least count */
    uint32_t bits;
};

/* Applies a bijection of the integers of `bits` bits. */
static uint32_t permute_bits(uint32_t i, uint32_t bits, uint32_t key)
{
    uint32_t mask = bits >= 32 ? 0xffffffffu : (1u << bits) - 1u;
    uint32_t shift = bits / 2 + 1;

    i = (i ^ key) & mask;
    i = (i * 0x2c1b3c6du) & mask;
    i ^= i >> shift;
    i = (i * 0x297a2d39u) & mask;
    i ^= i >> shift;
    return i;
}

/* Returns a permuted block index: repeats the bijection until the number is
 * below the count ("cycle walking"). */
static uint32_t permuted(const struct job *j, uint32_t item)
{
    uint32_t key = hash_u32(j->pass.order + 1u);

    do
        item = permute_bits(item, j->bits, key);
    while (item >= j->count);
    return item;
}

/* Most samples of a pixel that are added to the film together. */
#define ADDED_TOGETHER 32

/* The next samples of consecutive grid pixels in a row, in the order of the
 * pixels. */
struct row {
    int counts[BLOCK_SIDE];
    uint32_t count; /* total of the counts */
    bool has_more;  /* a pixel needs more samples than these */
    struct sample_id ids[BLOCK_SIDE * ADDED_TOGETHER];
    struct path_sample samples[BLOCK_SIDE * ADDED_TOGETHER];
    struct first_surface surfaces[BLOCK_SIDE * ADDED_TOGETHER];
};

/* Lists the next samples of pixels x, x + stride, ... of row y on the way to
 * the target. */
static void row_begin(struct row *r, const struct job *j, int x, int y,
                      int pixel_count)
{
    const struct backend_cpu *b = j->backend;
    size_t row = (size_t)y * (size_t)b->film->width;

    r->count = 0;
    r->has_more = false;
    for (int i = 0; i < pixel_count; i++) {
        int px = x + i * j->pass.stride;
        uint64_t target = pass_target(&j->pass, row + (size_t)px);
        uint64_t k = film_count(b->film, px, y);
        uint64_t first = b->film->first_sample;
        uint32_t before = r->count;

        if (target > k + ADDED_TOGETHER) {
            target = k + ADDED_TOGETHER;
            r->has_more = true;
        }
        for (; k < target; k++)
            r->ids[r->count++] =
                (struct sample_id){(uint32_t)(b->x0 + px),
                                   (uint32_t)(b->y0 + y), first + k};
        r->counts[i] = (int)(r->count - before);
    }
}

/* Returns the number of pixels all of whose samples are among the first
 * `done`. */
static int row_pixels(const struct row *r, uint32_t done, int pixel_count)
{
    int whole = 0;

    while (whole < pixel_count && (uint32_t)r->counts[whole] <= done)
        done -= (uint32_t)r->counts[whole++];
    return whole;
}

/* Adds the light of light paths to the first `count` samples. */
static void add_light(const struct job *j, struct row *r, uint32_t count)
{
    const struct backend_cpu *b = j->backend;
    const struct pass_light *light = j->pass.light;

    for (uint32_t i = 0; i < count; i++) {
        const struct sample_id *id = &r->ids[i];
        size_t at = (size_t)((int)id->y - b->y0) * (size_t)b->film->width +
                    (size_t)((int)id->x - b->x0);
        const float *from =
            light->pixels + 3 * (at + (id->index & 1) * light->pixel_count);

        r->samples[i].radiance =
            v3_add(r->samples[i].radiance, v3(from[0], from[1], from[2]));
    }
}

/* Renders the samples of a row. Returns false if cancelled; pixels that were
 * complete by then are in the film. */
static bool render_samples(const struct job *j, int x, int y, int pixel_count,
                           struct row *r)
{
    const struct backend_cpu *b = j->backend;
    uint32_t done = 0, n;

    for (; done < r->count && !cancel_requested(j->cancel); done += n) {
        n = u32_min(r->count - done, SAMPLE_STREAM);
        b->kernel->samples(&b->world, r->ids + done, n, r->samples + done,
                           r->surfaces + done, NULL);
    }
    if (j->pass.light != NULL && j->pass.light->pixel_count > 0)
        add_light(j, r, done);
    film_add_row(b->film,
                 (struct film_pixels){x, y, j->pass.stride,
                                      row_pixels(r, done, pixel_count)},
                 r->samples, r->surfaces, r->counts);
    return done == r->count;
}

/* Renders the pixels x, x + stride, ... of row y up to the target. Returns
 * false if cancelled. */
static bool render_row(const struct job *j, int x, int y, int pixel_count)
{
    struct row r;

    do {
        row_begin(&r, j, x, y, pixel_count);
        if (!render_samples(j, x, y, pixel_count, &r))
            return false;
    } while (r.has_more);
    return true;
}

static void render_block(void *context, uint32_t item, int worker)
{
    const struct job *j = context;
    const struct film *film = j->backend->film;
    uint32_t block = permuted(j, item);
    int stride = j->pass.stride;
    int side = BLOCK_SIDE * stride;
    int x = (int)(block % j->columns) * side;
    int y = (int)(block / j->columns) * side;
    int last = y + side < film->height ? y + side : film->height;
    int pixel_count = (film->width - x + stride - 1) / stride;

    (void)worker;
    if (pixel_count > BLOCK_SIDE)
        pixel_count = BLOCK_SIDE;
    for (; y < last; y += stride)
        if (!render_row(j, x, y, pixel_count))
            return;
}

static bool cpu_load(struct backend *base, struct host_world *host,
                     struct world *world, struct error *err)
{
    if (!world_ensure_tree(host, world, base->pool, err))
        return false;
    base->tree_bytes = bvh8_bytes(world_tree(host));
    return true;
}

static void cpu_unload(struct backend *base)
{
    base->tree_bytes = 0;
}

static bool cpu_begin(struct backend *base, const struct backend_picture *p,
                      struct error *err)
{
    struct backend_cpu *b = (struct backend_cpu *)base;

    (void)err;
    b->kernel = cpu_kernel_fit(b->full_kernel, p->world->settings.features);
    b->world = *p->world;
    b->film = p->film;
    b->x0 = p->x0;
    b->y0 = p->y0;
    return true;
}

static enum pass_result cpu_pass(struct backend *base, const struct pass *pass,
                                 const struct cancel *cancel, struct error *err)
{
    struct backend_cpu *b = (struct backend_cpu *)base;
    struct job j = {b, cancel, *pass, 0, 0, 1};
    int side = BLOCK_SIDE * pass->stride;

    (void)err;
    if (pass->light != NULL) {
        b->world.light_grids = pass->light->grids;
        b->world.light_cells = pass->light->cells;
    }
    j.columns = (uint32_t)((b->film->width + side - 1) / side);
    j.count = j.columns * (uint32_t)((b->film->height + side - 1) / side);
    while (j.bits < 32 && (1u << j.bits) < j.count)
        j.bits++;
    pool_run(base->pool, j.count, render_block, &j, cancel);
    /* blocks in progress may be incomplete after a cancel */
    return cancel_requested(cancel) ? PASS_CANCELLED : PASS_DONE;
}

static uint64_t cpu_cpu_ns(const struct backend *base, int thread)
{
    return pool_cpu_ns(base->pool, thread);
}

static void cpu_destroy(struct backend *base)
{
    struct backend_cpu *b = (struct backend_cpu *)base;

    pool_destroy(base->pool);
    free(b);
}

struct backend *backend_cpu_create(int thread_count,
                                   const struct cpu_kernel *paths,
                                   struct error *err)
{
    struct backend_cpu *b = alloc_array(1, sizeof *b);

    if (b == NULL) {
        fail(err, "render: out of memory");
        return NULL;
    }
    b->base.pool = pool_create(thread_count, err);
    if (b->base.pool == NULL) {
        free(b);
        return NULL;
    }
    b->full_kernel = paths;
    b->base.name = "cpu";
    b->base.thread_count = pool_thread_count(b->base.pool);
    b->base.load = cpu_load;
    b->base.unload = cpu_unload;
    b->base.begin = cpu_begin;
    b->base.takes_light = true;
    b->base.pass = cpu_pass;
    b->base.cpu_ns = cpu_cpu_ns;
    b->base.destroy = cpu_destroy;
    return &b->base;
}
