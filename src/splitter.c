// SPDX-License-Identifier: MIT
#include "glim/splitter.h"

#include <stdlib.h>

/* Where splits by cost end and halving by count begins: 32 more levels hold
 * any number of triangles, and all of them fit TRAVERSE_STACK. */
#define SAH_DEPTH 60

/* Of the area of all. Measured: the same from 1e-4 to 1e-3, but 1 % of memory
 * instead of 7. */
#define LARGE_PART 1e-3f

/* Boxes that a thread takes at once from a large range. */
#define CHUNK 4096

static uint32_t chunks_of(uint32_t count)
{
    return (count + CHUNK - 1) / CHUNK;
}

static uint32_t chunk_size(uint32_t count, uint32_t chunk)
{
    uint32_t rest = count - chunk * CHUNK;

    return rest < CHUNK ? rest : CHUNK;
}

/* ---- boxes ---- */

static void clear_bounds(struct box *bounds, struct box *centers)
{
    *bounds = box_empty();
    *centers = box_empty();
}

static void add_to_bounds(struct box *bounds, struct box *centers,
                          const struct box *box)
{
    struct box center = box_center(box);

    box_join(bounds, box);
    box_join(centers, &center);
}

static void fill_chunk(void *context, uint32_t chunk, int worker)
{
    struct splitter *s = context;
    const struct world *w = s->world;
    struct splitter_worker *own = &s->workers[worker];
    uint32_t first = chunk * CHUNK;
    uint32_t count = chunk_size(w->settings.tri_count, chunk);

    for (uint32_t i = first; i < first + count; i++) {
        struct box *box = &s->buffers[0][i];

        *box = box_empty();
        for (int k = 0; k < 3; k++) {
            struct box corner = box_of_point(w->positions[w->tris[i].v[k]]);

            box_join(box, &corner);
        }
        box_set_tri(box, i);
        add_to_bounds(&own->bounds, &own->centers[0], box);
    }
}

struct range splitter_all(struct splitter *s)
{
    struct range all = {.count = s->world->settings.tri_count};

    clear_bounds(&all.bounds, &all.centers);
    for (uint32_t i = 0; i < s->worker_count; i++)
        clear_bounds(&s->workers[i].bounds, &s->workers[i].centers[0]);
    pool_each(s->pool, chunks_of(all.count), fill_chunk, s);
    for (uint32_t i = 0; i < s->worker_count; i++) {
        box_join(&all.bounds, &s->workers[i].bounds);
        box_join(&all.centers, &s->workers[i].centers[0]);
    }
    s->large_area = LARGE_PART * box_area(&all.bounds);
    return all;
}

/* ---- by one thread ---- */

/* For blocks that are tested at once. */
static uint32_t bits_for(const struct splitter *s, const struct range *r)
{
    return box_area(&r->bounds) >= s->large_area ? s->leaves->large_bits
                                                 : s->leaves->block_bits;
}

static bool is_leaf(const struct splitter *s, const struct range *r,
                    const struct split *split)
{
    const struct bvh_leaves *leaves = s->leaves;
    float area = box_area(&r->bounds);
    float blocks = blocks_of(r->count, bits_for(s, r));

    return r->count <= leaves->most &&
           (split->axis < 0 ||
            leaves->block_cost * (blocks * area - split->cost) <= area);
}

/* False if the range is to be a leaf. Fills the counts and bounds of both
 * sides. */
static bool choose_split(const struct splitter *s, const struct range *r,
                         const struct bins *bins, struct split *split,
                         struct range sides[2])
{
    struct box bounds[2];
    uint32_t left;

    *split = bins_split(bins, r->count, bits_for(s, r), bounds);
    if (r->depth >= SAH_DEPTH)
        split->axis = -1;
    if (is_leaf(s, r, split))
        return false;
    left = split->axis < 0 ? r->count / 2 : bins_left(bins, split);
    for (uint32_t i = 0; i < 2; i++)
        sides[i] = (struct range){.first = r->first + i * left,
                                  .count = i == 0 ? left : r->count - left,
                                  .depth = r->depth + 1,
                                  .buffer = r->buffer ^ 1,
                                  .bounds = bounds[i],
                                  .centers = box_empty()};
    return true;
}

/* Copies boxes to the places of their sides, in order. Nothing is predicted:
 * that fails for every other box. */
static void part_boxes(const struct split *split, const struct box *from,
                       uint32_t count, struct box *to[2], struct box centers[2])
{
    const f4 limits[2] = {f4_all(-FLOAT_MAX), f4_all(FLOAT_MAX)};
    struct box *left = to[0], *right = to[1];
    f4 lo[2], hi[2];

    for (int k = 0; k < 2; k++) {
        lo[k] = f4_load(centers[k].planes);
        hi[k] = f4_load(centers[k].planes + 4);
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t side = split_goes_right(split, &from[i]);
        struct box center = box_center(&from[i]);

        *(side ? right : left) = from[i];
        right += side;
        left += side ^ 1;
        for (uint32_t k = 0; k < 2; k++) {
            lo[k] =
                f4_min(lo[k], f4_max(f4_load(center.planes), limits[side ^ k]));
            hi[k] = f4_min(hi[k], f4_max(f4_load(center.planes + 4),
                                         limits[side ^ k]));
        }
    }
    for (int k = 0; k < 2; k++) {
        f4_store(centers[k].planes, lo[k]);
        f4_store(centers[k].planes + 4, hi[k]);
    }
}

/* Nothing tells the boxes apart: the first half goes left. */
static void halve(const struct splitter *s, const struct range *r,
                  struct range sides[2])
{
    for (int k = 0; k < 2; k++) {
        struct range *side = &sides[k];

        clear_bounds(&side->bounds, &side->centers);
        for (uint32_t i = side->first; i < side->first + side->count; i++) {
            s->buffers[side->buffer][i] = s->buffers[r->buffer][i];
            add_to_bounds(&side->bounds, &side->centers,
                          &s->buffers[r->buffer][i]);
        }
    }
}

bool splitter_split(struct splitter *s, int worker, const struct range *r,
                    struct range sides[2])
{
    const struct box *boxes = s->buffers[r->buffer] + r->first;
    struct bins *bins = &s->workers[worker].bins;
    struct split split;

    bins_clear(bins, r->count, &r->centers);
    bins_add(bins, boxes, r->count);
    if (!choose_split(s, r, bins, &split, sides))
        return false;
    if (split.axis < 0) {
        halve(s, r, sides);
    } else {
        struct box *to = s->buffers[sides[0].buffer];
        struct box *places[2] = {to + sides[0].first, to + sides[1].first};
        struct box centers[2] = {box_empty(), box_empty()};

        part_boxes(&split, boxes, r->count, places, centers);
        sides[0].centers = centers[0];
        sides[1].centers = centers[1];
    }
    return true;
}

/* ---- by all threads ---- */

static void bin_chunk(void *context, uint32_t chunk, int worker)
{
    const struct splitter *s = context;
    const struct range *r = s->range;

    bins_add(&s->workers[worker].bins,
             s->buffers[r->buffer] + r->first + chunk * CHUNK,
             chunk_size(r->count, chunk));
}

static void count_chunk(void *context, uint32_t chunk, int worker)
{
    const struct splitter *s = context;
    const struct range *r = s->range;
    const struct box *boxes = s->buffers[r->buffer] + r->first + chunk * CHUNK;
    uint32_t count = chunk_size(r->count, chunk);
    uint32_t right = 0;

    (void)worker;
    for (uint32_t i = 0; i < count; i++)
        right += split_goes_right(&s->split, &boxes[i]);
    s->chunk_sides[chunk][0] = count - right;
    s->chunk_sides[chunk][1] = right;
}

static void part_chunk(void *context, uint32_t chunk, int worker)
{
    const struct splitter *s = context;
    const struct range *r = s->range;
    struct box *to = s->buffers[s->sides[0].buffer];
    struct box *places[2] = {to + s->chunk_sides[chunk][0],
                             to + s->chunk_sides[chunk][1]};

    part_boxes(&s->split, s->buffers[r->buffer] + r->first + chunk * CHUNK,
               chunk_size(r->count, chunk), places, s->workers[worker].centers);
}

static void part_range(struct splitter *s)
{
    uint32_t chunk_count = chunks_of(s->range->count);
    uint32_t at[2] = {s->sides[0].first, s->sides[1].first};

    pool_each(s->pool, chunk_count, count_chunk, s);
    for (uint32_t i = 0; i < chunk_count; i++)
        for (int k = 0; k < 2; k++) {
            uint32_t count = s->chunk_sides[i][k];

            s->chunk_sides[i][k] = at[k];
            at[k] += count;
        }
    for (uint32_t i = 0; i < s->worker_count; i++)
        clear_bounds(&s->workers[i].centers[0], &s->workers[i].centers[1]);
    pool_each(s->pool, chunk_count, part_chunk, s);
    for (uint32_t i = 0; i < s->worker_count; i++)
        for (int k = 0; k < 2; k++)
            box_join(&s->sides[k].centers, &s->workers[i].centers[k]);
}

void splitter_split_together(struct splitter *s, const struct range *r,
                             struct range sides[2])
{
    struct bins *bins = &s->workers[0].bins;

    s->range = r;
    s->sides = sides;
    for (uint32_t i = 0; i < s->worker_count; i++)
        bins_clear(&s->workers[i].bins, r->count, &r->centers);
    pool_each(s->pool, chunks_of(r->count), bin_chunk, s);
    for (uint32_t i = 1; i < s->worker_count; i++)
        bins_join(bins, &s->workers[i].bins);
    choose_split(s, r, bins, &s->split, sides);
    if (s->split.axis < 0)
        halve(s, r, sides);
    else
        part_range(s);
}

/* ---- the whole ---- */

bool splitter_init(struct splitter *s, const struct world *w,
                   const struct bvh_leaves *leaves, struct pool *pool)
{
    uint32_t count = w->settings.tri_count;

    *s = (struct splitter){.leaves = leaves, .pool = pool, .world = w};
    s->worker_count = pool != NULL ? (uint32_t)pool_thread_count(pool) : 1;
    s->workers = alloc_aligned(s->worker_count, sizeof *s->workers);
    s->chunk_sides = alloc_array(chunks_of(count), sizeof *s->chunk_sides);
    for (int i = 0; i < 2; i++)
        s->buffers[i] = alloc_aligned(count, sizeof *s->buffers[i]);
    return s->workers != NULL && s->chunk_sides != NULL &&
           s->buffers[0] != NULL && s->buffers[1] != NULL;
}

void splitter_free(struct splitter *s)
{
    free(s->workers);
    free(s->chunk_sides);
    free(s->buffers[0]);
    free(s->buffers[1]);
}
