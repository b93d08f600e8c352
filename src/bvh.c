// SPDX-License-Identifier: MIT
/*
 * Large ranges of triangles are split by all threads together, chunk by chunk.
 * What is left are parts, each of which one thread makes a tree of. Where a
 * part ends depends on its size alone, and what threads join does not depend
 * on who came first.
 */
#include "glim/bvh.h"

#include <assert.h>
#include <stdlib.h>

#include "glim/split.h"
#include "kernels/traverse.h"

/* Where splits by cost end and halving by count begins: 32 more levels hold
 * any number of triangles, and all of them fit TRAVERSE_STACK. */
#define BVH_SAH_DEPTH 60

/* Triangles of a part: what stays in a core's cache. */
#define PART_MAX 16384

/* Triangles that a thread takes at once from a larger range. */
#define CHUNK 4096

/* Cost of a triangle's test in visits of a node. Measured: flat from 1 to 2. */
#define TRIANGLE_COST 1.5f

/* Boxes that lie side by side. */
struct range {
    uint32_t first, count, depth;
    uint32_t buffer;            /* which of the two they are in */
    struct box bounds, centers; /* joined */
};

/* A node at the top, or a whole tree. */
struct part {
    struct range range;
    uint32_t right; /* the part that is the node's right child; 0: a tree */
    struct node *nodes;
    uint32_t node_count, depth;
    uint32_t first_node; /* in the whole */
};

/* What a thread needs for itself. */
struct worker {
    struct bins bins;
    struct box bounds, centers[2]; /* of sides */
    struct node *nodes;            /* of a part */
    uint32_t node_count, depth;
};

struct builder {
    const struct world *world;
    const struct bvh_leaves *leaves;
    struct pool *pool;
    struct bvh *bvh;
    struct box *buffers[2]; /* a split goes from one to the other */
    struct worker *workers;
    uint32_t worker_count;
    struct part *parts; /* depth-first */
    uint32_t part_count;
    size_t part_capacity;
    /* what all threads work on */
    const struct range *range;
    struct split split;
    struct range *sides;
    uint32_t (*chunk_sides)[2]; /* how many go to each side, then where */
};

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
    struct builder *b = context;
    const struct world *w = b->world;
    struct worker *own = &b->workers[worker];
    uint32_t first = chunk * CHUNK;
    uint32_t count = chunk_size(w->settings.tri_count, chunk);

    for (uint32_t i = first; i < first + count; i++) {
        struct box *box = &b->buffers[0][i];

        *box = box_empty();
        for (int k = 0; k < 3; k++) {
            struct box corner = box_of_point(w->positions[w->tris[i].v[k]]);

            box_join(box, &corner);
        }
        box_set_tri(box, i);
        add_to_bounds(&own->bounds, &own->centers[0], box);
    }
}

static void fill_boxes(struct builder *b, struct range *all)
{
    *all = (struct range){.count = b->world->settings.tri_count};
    clear_bounds(&all->bounds, &all->centers);
    for (uint32_t i = 0; i < b->worker_count; i++)
        clear_bounds(&b->workers[i].bounds, &b->workers[i].centers[0]);
    pool_each(b->pool, chunks_of(all->count), fill_chunk, b);
    for (uint32_t i = 0; i < b->worker_count; i++) {
        box_join(&all->bounds, &b->workers[i].bounds);
        box_join(&all->centers, &b->workers[i].centers[0]);
    }
}

/* ---- splits ---- */

static bool is_leaf(const struct builder *b, const struct range *r,
                    const struct split *s)
{
    const struct bvh_leaves *leaves = b->leaves;
    float area = box_area(&r->bounds);
    float blocks = blocks_of(r->count, leaves->block_bits);

    return r->count <= leaves->most &&
           (s->axis < 0 ||
            leaves->block_cost * (blocks * area - s->cost) <= area);
}

/* False if the range is to be a leaf. Fills the counts and bounds of both
 * sides. */
static bool choose_split(const struct builder *b, const struct range *r,
                         const struct bins *bins, struct split *s,
                         struct range sides[2])
{
    struct box bounds[2];
    uint32_t left;

    *s = bins_split(bins, r->count, b->leaves->block_bits, bounds);
    if (r->depth >= BVH_SAH_DEPTH)
        s->axis = -1;
    if (is_leaf(b, r, s))
        return false;
    left = s->axis < 0 ? r->count / 2 : bins_left(bins, s);
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
static void part_boxes(const struct split *s, const struct box *from,
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
        uint32_t side = split_goes_right(s, &from[i]);
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
static void halve(const struct builder *b, const struct range *r,
                  struct range sides[2])
{
    for (int k = 0; k < 2; k++) {
        struct range *side = &sides[k];

        clear_bounds(&side->bounds, &side->centers);
        for (uint32_t i = side->first; i < side->first + side->count; i++) {
            b->buffers[side->buffer][i] = b->buffers[r->buffer][i];
            add_to_bounds(&side->bounds, &side->centers,
                          &b->buffers[r->buffer][i]);
        }
    }
}

/* ---- parts ---- */

static void fill_leaf(const struct builder *b, const struct range *r,
                      struct node *n)
{
    const struct box *boxes = b->buffers[r->buffer] + r->first;

    n->next = r->first;
    n->count = r->count;
    for (uint32_t i = 0; i < r->count; i++)
        b->bvh->tris[r->first + i] = box_tri(&boxes[i]);
}

static struct node node_of(const struct range *r)
{
    const float *p = r->bounds.planes;
    struct node n = {
        .lo = v3(p[0] - BOX_PAD, p[1] - BOX_PAD, p[2] - BOX_PAD),
        .hi = v3(BOX_PAD - p[4], BOX_PAD - p[5], BOX_PAD - p[6]),
    };

    return n;
}

/* Recursion is as deep as the tree: below TRAVERSE_STACK. */
static void build_tree(const struct builder *b, struct worker *own,
                       const struct range *r)
{
    const struct box *boxes = b->buffers[r->buffer] + r->first;
    uint32_t index = own->node_count++;
    struct range sides[2];
    struct split s;

    own->nodes[index] = node_of(r);
    if (r->depth > own->depth)
        own->depth = r->depth;
    bins_clear(&own->bins, r->count, &r->centers);
    bins_add(&own->bins, boxes, r->count);
    if (!choose_split(b, r, &own->bins, &s, sides)) {
        fill_leaf(b, r, &own->nodes[index]);
        return;
    }
    if (s.axis < 0) {
        halve(b, r, sides);
    } else {
        struct box *to = b->buffers[sides[0].buffer];
        struct box *places[2] = {to + sides[0].first, to + sides[1].first};
        struct box centers[2] = {box_empty(), box_empty()};

        part_boxes(&s, boxes, r->count, places, centers);
        sides[0].centers = centers[0];
        sides[1].centers = centers[1];
    }
    build_tree(b, own, &sides[0]);
    own->nodes[index].next = own->node_count;
    build_tree(b, own, &sides[1]);
}

static void build_part(void *context, uint32_t item, int worker)
{
    struct builder *b = context;
    struct part *part = &b->parts[item];
    struct worker *own = &b->workers[worker];

    if (part->right != 0)
        return;
    own->node_count = own->depth = 0;
    build_tree(b, own, &part->range);
    part->nodes = alloc_array(own->node_count, sizeof *part->nodes);
    if (part->nodes == NULL)
        return;
    memcpy(part->nodes, own->nodes, own->node_count * sizeof *part->nodes);
    part->node_count = own->node_count;
    part->depth = own->depth;
}

/* ---- the top ---- */

static void bin_chunk(void *context, uint32_t chunk, int worker)
{
    const struct builder *b = context;
    const struct range *r = b->range;

    bins_add(&b->workers[worker].bins,
             b->buffers[r->buffer] + r->first + chunk * CHUNK,
             chunk_size(r->count, chunk));
}

static void count_chunk(void *context, uint32_t chunk, int worker)
{
    const struct builder *b = context;
    const struct range *r = b->range;
    const struct box *boxes = b->buffers[r->buffer] + r->first + chunk * CHUNK;
    uint32_t count = chunk_size(r->count, chunk);
    uint32_t right = 0;

    (void)worker;
    for (uint32_t i = 0; i < count; i++)
        right += split_goes_right(&b->split, &boxes[i]);
    b->chunk_sides[chunk][0] = count - right;
    b->chunk_sides[chunk][1] = right;
}

static void part_chunk(void *context, uint32_t chunk, int worker)
{
    const struct builder *b = context;
    const struct range *r = b->range;
    struct box *to = b->buffers[b->sides[0].buffer];
    struct box *places[2] = {to + b->chunk_sides[chunk][0],
                             to + b->chunk_sides[chunk][1]};

    part_boxes(&b->split, b->buffers[r->buffer] + r->first + chunk * CHUNK,
               chunk_size(r->count, chunk), places, b->workers[worker].centers);
}

static void part_range(struct builder *b)
{
    uint32_t chunk_count = chunks_of(b->range->count);
    uint32_t at[2] = {b->sides[0].first, b->sides[1].first};

    pool_each(b->pool, chunk_count, count_chunk, b);
    for (uint32_t i = 0; i < chunk_count; i++)
        for (int k = 0; k < 2; k++) {
            uint32_t count = b->chunk_sides[i][k];

            b->chunk_sides[i][k] = at[k];
            at[k] += count;
        }
    for (uint32_t i = 0; i < b->worker_count; i++)
        clear_bounds(&b->workers[i].centers[0], &b->workers[i].centers[1]);
    pool_each(b->pool, chunk_count, part_chunk, b);
    for (uint32_t i = 0; i < b->worker_count; i++)
        for (int k = 0; k < 2; k++)
            box_join(&b->sides[k].centers, &b->workers[i].centers[k]);
}

/* By all threads. */
static void split_range(struct builder *b, const struct range *r,
                        struct range sides[2])
{
    struct bins *bins = &b->workers[0].bins;

    b->range = r;
    b->sides = sides;
    for (uint32_t i = 0; i < b->worker_count; i++)
        bins_clear(&b->workers[i].bins, r->count, &r->centers);
    pool_each(b->pool, chunks_of(r->count), bin_chunk, b);
    for (uint32_t i = 1; i < b->worker_count; i++)
        bins_join(bins, &b->workers[i].bins);
    choose_split(b, r, bins, &b->split, sides);
    if (b->split.axis < 0)
        halve(b, r, sides);
    else
        part_range(b);
}

/* Not by grow_array(): boxes are aligned. */
static bool add_part(struct builder *b, const struct range *r)
{
    if (b->part_count == b->part_capacity) {
        size_t capacity = 2 * b->part_capacity + 1;
        struct part *parts = alloc_aligned(capacity, sizeof *parts);

        if (parts == NULL)
            return false;
        if (b->parts != NULL)
            memcpy(parts, b->parts, b->part_count * sizeof *parts);
        free(b->parts);
        b->parts = parts;
        b->part_capacity = capacity;
    }
    b->parts[b->part_count++] = (struct part){.range = *r};
    return true;
}

static bool build_top(struct builder *b, const struct range *r)
{
    uint32_t index = b->part_count;
    struct range sides[2];

    if (!add_part(b, r))
        return false;
    if (r->count <= PART_MAX)
        return true;
    split_range(b, r, sides);
    if (!build_top(b, &sides[0]))
        return false;
    b->parts[index].right = b->part_count;
    return build_top(b, &sides[1]);
}

/* ---- the whole ---- */

static void place_part(void *context, uint32_t item, int worker)
{
    const struct builder *b = context;
    const struct part *part = &b->parts[item];
    struct node *to = b->bvh->nodes + part->first_node;

    (void)worker;
    if (part->right != 0) {
        *to = node_of(&part->range);
        to->next = b->parts[part->right].first_node;
        return;
    }
    for (uint32_t i = 0; i < part->node_count; i++) {
        to[i] = part->nodes[i];
        if (to[i].count == 0)
            to[i].next += part->first_node;
    }
}

static bool join_parts(struct builder *b)
{
    struct bvh *bvh = b->bvh;

    for (uint32_t i = 0; i < b->part_count; i++) {
        struct part *part = &b->parts[i];

        if (part->right == 0 && part->nodes == NULL)
            return false;
        part->first_node = bvh->node_count;
        bvh->node_count += part->right != 0 ? 1 : part->node_count;
        if (part->depth > bvh->depth)
            bvh->depth = part->depth;
    }
    bvh->nodes = alloc_array(bvh->node_count, sizeof *bvh->nodes);
    if (bvh->nodes == NULL)
        return false;
    pool_each(b->pool, b->part_count, place_part, b);
    return true;
}

/* For at most so many triangles. */
static bool begin(struct builder *b, uint32_t count)
{
    uint32_t part_max = count < PART_MAX ? count : PART_MAX;

    b->worker_count =
        b->pool != NULL ? (uint32_t)pool_thread_count(b->pool) : 1;
    b->workers = alloc_aligned(b->worker_count, sizeof *b->workers);
    b->chunk_sides = alloc_array(chunks_of(count), sizeof *b->chunk_sides);
    b->bvh->tris = alloc_array(count, sizeof *b->bvh->tris);
    for (int i = 0; i < 2; i++)
        b->buffers[i] = alloc_aligned(count, sizeof *b->buffers[i]);
    if (b->workers == NULL || b->chunk_sides == NULL || b->bvh->tris == NULL ||
        b->buffers[0] == NULL || b->buffers[1] == NULL)
        return false;
    for (uint32_t i = 0; i < b->worker_count; i++)
        b->workers[i].nodes = NULL;
    for (uint32_t i = 0; i < b->worker_count; i++) {
        b->workers[i].nodes =
            alloc_array(2 * part_max, sizeof *b->workers[i].nodes);
        if (b->workers[i].nodes == NULL)
            return false;
    }
    return true;
}

static void end(struct builder *b)
{
    for (uint32_t i = 0; b->workers != NULL && i < b->worker_count; i++)
        free(b->workers[i].nodes);
    for (uint32_t i = 0; i < b->part_count; i++)
        free(b->parts[i].nodes);
    free(b->workers);
    free(b->chunk_sides);
    free(b->buffers[0]);
    free(b->buffers[1]);
    free(b->parts);
}

static bool build(struct builder *b)
{
    struct range all;

    if (!begin(b, b->world->settings.tri_count))
        return false;
    fill_boxes(b, &all);
    if (!build_top(b, &all))
        return false;
    pool_each(b->pool, b->part_count, build_part, b);
    return join_parts(b);
}

bool bvh_build_nodes(struct bvh *bvh, const struct world *w,
                     const struct bvh_leaves *leaves, struct pool *pool,
                     struct error *err)
{
    struct builder b = {.world = w, .leaves = leaves, .pool = pool, .bvh = bvh};
    bool ok;

    bvh_free(bvh);
    if (w->settings.tri_count == 0)
        return true;
    ok = build(&b);
    end(&b);
    if (!ok) {
        bvh_free(bvh);
        return fail(err, "out of memory for the tree of %u triangles",
                    w->settings.tri_count);
    }
    bvh->leaf_tri_count = w->settings.tri_count;
    assert(bvh->depth < TRAVERSE_STACK);
    return true;
}

bool bvh_build(struct bvh *bvh, const struct world *w, struct pool *pool,
               struct error *err)
{
    const struct bvh_leaves leaves = {0, TRIANGLE_COST, 8};

    if (!bvh_build_nodes(bvh, w, &leaves, pool, err))
        return false;
    bvh->leaf_tris = alloc_array(bvh->leaf_tri_count, sizeof *bvh->leaf_tris);
    if (bvh->leaf_tris == NULL) {
        bvh_free(bvh);
        return fail(err, "out of memory for the leaves of %u triangles",
                    w->settings.tri_count);
    }
    for (uint32_t i = 0; i < bvh->leaf_tri_count; i++) {
        const struct tri *t = &w->tris[bvh->tris[i]];

        bvh->leaf_tris[i] =
            (struct leaf_tri){w->positions[t->v[0]], w->positions[t->v[1]],
                              w->positions[t->v[2]], bvh->tris[i]};
    }
    return true;
}

uint64_t bvh_bytes(const struct bvh *bvh)
{
    return bvh->node_count * (uint64_t)sizeof *bvh->nodes +
           bvh->leaf_tri_count *
               (uint64_t)(sizeof *bvh->tris + (bvh->leaf_tris != NULL
                                                   ? sizeof *bvh->leaf_tris
                                                   : 0));
}

void bvh_free(struct bvh *bvh)
{
    free(bvh->nodes);
    free(bvh->tris);
    free(bvh->leaf_tris);
    memset(bvh, 0, sizeof *bvh);
}
