// SPDX-License-Identifier: MIT
#include "bvh/bvh8.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <sys/mman.h>

#include "base/memory.h"
#include "bvh/bvh8_collapse.h"

/* Alignment to cache lines, and to large pages: misses in the table of pages
 * cost rays through a million triangles 5 %. */
#define ALIGNMENT  64
#define LARGE_PAGE ((size_t)2 << 20)

/* Triangles of a part, of which one thread builds the tree. */
#define PART_TRIS 4096

/* Measured: rays take up to 5 % less time the finer the binary tree is, up to a
 * block cost of 4. Large triangles are split to leaves of two, so that a node
 * can hold them with others: rooms save 5 to 15 %. Small ones would cost as
 * much by the memory. */
const struct bvh_leaves bvh8_leaves = {2, 1, 4.0f, BVH8_LEAF_TRIS};

/* Children of a node: their nodes in the binary tree, and the node, first block
 * or part that each becomes. */
struct plan {
    uint32_t count;
    uint32_t from[BVH8_CHILDREN];
    uint32_t to[BVH8_CHILDREN];
};

/* A subtree that one thread plans and fills, or the top of the tree. */
struct part {
    uint32_t root; /* its node in the binary tree */
    struct plan *plans;
    size_t plan_capacity;
    uint32_t node_count, block_count;
    uint32_t first_node, first_block; /* its first node and block in the tree */
    bool failed;
};

struct builder {
    const struct world *world;
    const struct bvh *bvh;
    struct bvh8 *wide;
    struct bvh8_collapse collapse;
    struct part top;
    struct part *parts; /* subtrees below the top */
    uint32_t part_count;
    size_t part_capacity;
};

/* ---- plans ---- */

static uint32_t tris_below(const struct builder *b, uint32_t node)
{
    return b->collapse.costs[node].tri_count;
}

static uint32_t plan_leaf(const struct builder *b, struct part *part,
                          uint32_t node)
{
    uint32_t first = part->block_count;

    part->block_count += bvh8_blocks(tris_below(b, node));
    return first;
}

static bool is_part(const struct builder *b, uint32_t node)
{
    return tris_below(b, node) <= PART_TRIS;
}

static bool add_part(struct builder *b, uint32_t root, uint32_t *index)
{
    void *parts = b->parts;

    if (!grow_array(&parts, &b->part_capacity, (size_t)b->part_count + 1,
                    sizeof *b->parts))
        return false;
    b->parts = parts;
    b->parts[b->part_count] = (struct part){.root = root};
    *index = b->part_count++;
    return true;
}

/* Plans the node. Recursion is as deep as the tree, at most. */
static bool plan(struct builder *b, struct part *part, uint32_t node,
                 uint32_t *index)
{
    void *plans = part->plans;
    struct plan p;

    *index = part->node_count++;
    if (!grow_array(&plans, &part->plan_capacity, part->node_count,
                    sizeof *part->plans))
        return false;
    part->plans = plans;
    p.count = bvh8_collapse_children(&b->collapse, node, p.from);
    for (uint32_t i = 0; i < p.count; i++) {
        bool ok = true;

        if (bvh8_collapse_leaf(&b->collapse, p.from[i]))
            p.to[i] = plan_leaf(b, part, p.from[i]);
        else if (part == &b->top && is_part(b, p.from[i]))
            ok = add_part(b, p.from[i], &p.to[i]);
        else
            ok = plan(b, part, p.from[i], &p.to[i]);
        if (!ok)
            return false;
    }
    part->plans[*index] = p;
    return true;
}

static void plan_part(void *context, uint32_t item, int worker)
{
    struct builder *b = context;
    struct part *part = &b->parts[item];
    uint32_t root;

    (void)worker;
    part->failed = !plan(b, part, part->root, &root);
}

static void place_part(struct bvh8 *wide, struct part *part)
{
    part->first_node = wide->node_count;
    part->first_block = wide->block_count;
    wide->node_count += part->node_count;
    wide->block_count += part->block_count;
}

static bool plan_all(struct builder *b, struct pool *pool)
{
    bool ok = true;
    uint32_t root;

    if (!plan(b, &b->top, 0, &root))
        return false;
    pool_each(pool, b->part_count, plan_part, b);
    place_part(b->wide, &b->top);
    for (uint32_t i = 0; i < b->part_count; i++) {
        place_part(b->wide, &b->parts[i]);
        ok = ok && !b->parts[i].failed;
    }
    b->wide->block_count++; /* the empty block */
    return ok;
}

/* ---- nodes and blocks ---- */

static void fill_tri(const struct world *w, struct tri_block *block,
                     uint32_t at, uint32_t tri)
{
    const struct vec3 none = {NAN, NAN, NAN};

    for (int k = 0; k < 3; k++) {
        struct vec3 corner =
            tri == NO_INDEX ? none : w->positions[w->tris[tri].v[k]];

        block->corners[k][0][at] = corner.x;
        block->corners[k][1][at] = corner.y;
        block->corners[k][2][at] = corner.z;
    }
    block->tri[at] = tri;
}

/* Offset by which a child names a node or, with BVH8_LEAF, a block. */
static uint32_t child_at(const struct bvh8 *wide, const void *place)
{
    ptrdiff_t distance = (const char *)place - (const char *)wide->nodes;

    return (uint32_t)(distance / BVH8_UNIT * 8);
}

/* Triangles below a node of the binary tree, which are consecutive. */
static const uint32_t *first_tri(const struct builder *b, uint32_t node)
{
    while (b->bvh->nodes[node].count == 0)
        node++;
    return &b->bvh->tris[b->bvh->nodes[node].next];
}

static uint32_t fill_leaf(const struct builder *b, uint32_t node,
                          struct tri_block *blocks)
{
    const uint32_t *tris = first_tri(b, node);
    uint32_t count = tris_below(b, node);
    uint32_t block_count = bvh8_blocks(count);

    for (uint32_t i = 0; i < block_count * BLOCK_TRIS; i++)
        fill_tri(b->world, &blocks[i / BLOCK_TRIS], i % BLOCK_TRIS,
                 i < count ? tris[i] : NO_INDEX);
    return child_at(b->wide, blocks) | BVH8_LEAF | (block_count - 1);
}

static void fill_box(struct bvh8_node *n, uint32_t i, struct vec3 lo,
                     struct vec3 hi)
{
    n->planes[0][0][i] = lo.x;
    n->planes[1][0][i] = lo.y;
    n->planes[2][0][i] = lo.z;
    n->planes[0][1][i] = hi.x;
    n->planes[1][1][i] = hi.y;
    n->planes[2][1][i] = hi.z;
}

static uint32_t fill_child(const struct builder *b, const struct part *part,
                           uint32_t from, uint32_t to)
{
    if (bvh8_collapse_leaf(&b->collapse, from))
        return fill_leaf(b, from, &b->wide->blocks[part->first_block + to]);
    if (part == &b->top && is_part(b, from))
        to = b->parts[to].first_node;
    else
        to += part->first_node;
    return child_at(b->wide, &b->wide->nodes[to]);
}

static void fill_node(const struct builder *b, const struct part *part,
                      uint32_t index)
{
    const struct vec3 nowhere = {INFINITY, INFINITY, INFINITY};
    const struct plan *p = &part->plans[index];
    struct bvh8_node *n = &b->wide->nodes[part->first_node + index];

    for (uint32_t i = 0; i < p->count; i++) {
        const struct node *from = &b->bvh->nodes[p->from[i]];

        fill_box(n, i, from->lo, from->hi);
        n->child[i] = fill_child(b, part, p->from[i], p->to[i]);
    }
    for (uint32_t i = p->count; i < BVH8_CHILDREN; i++) {
        fill_box(n, i, nowhere, nowhere);
        n->child[i] =
            child_at(b->wide, &b->wide->blocks[b->wide->block_count - 1]) |
            BVH8_LEAF;
    }
}

/* Prefetches the triangles of a node's leaves, which are scattered in memory.
 * Measured: one node ahead this saves 3 % of the time of a build. */
static void fetch_tris(const struct builder *b, const struct plan *p)
{
    for (uint32_t i = 0; i < p->count; i++) {
        const uint32_t *tris;

        if (!bvh8_collapse_leaf(&b->collapse, p->from[i]))
            continue;
        tris = first_tri(b, p->from[i]);
        for (uint32_t k = 0; k < tris_below(b, p->from[i]); k++)
            __builtin_prefetch(&b->world->tris[tris[k]]);
    }
}

/* Fills a part. The top is the last item. */
static void fill_part(void *context, uint32_t item, int worker)
{
    const struct builder *b = context;
    const struct part *part = item < b->part_count ? &b->parts[item] : &b->top;

    (void)worker;
    for (uint32_t i = 0; i < part->node_count; i++) {
        if (i + 1 < part->node_count)
            fetch_tris(b, &part->plans[i + 1]);
        fill_node(b, part, i);
    }
}

/* ---- the whole ---- */

/* Allocates nodes and blocks. Returns NULL if memory is out, or if the tree is
 * too large for the offsets of children. */
static void *alloc_tree(size_t node_count, size_t block_count)
{
    size_t size = node_count * sizeof(struct bvh8_node) +
                  block_count * sizeof(struct tri_block);
    size_t alignment = size < LARGE_PAGE ? ALIGNMENT : LARGE_PAGE;
    void *p;

    if (size / BVH8_UNIT >= UINT32_MAX / 8)
        return NULL;
    size = (size + alignment - 1) / alignment * alignment;
    p = aligned_alloc(alignment, size);
    if (p != NULL && alignment == LARGE_PAGE)
        madvise(p, size, MADV_HUGEPAGE);
    return p;
}

static bool build(struct builder *b, struct pool *pool)
{
    struct bvh8 *wide = b->wide;

    if (!bvh8_collapse_init(&b->collapse, b->bvh, pool) || !plan_all(b, pool))
        return false;
    wide->nodes = alloc_tree(wide->node_count, wide->block_count);
    if (wide->nodes == NULL)
        return false;
    wide->blocks = (void *)(wide->nodes + wide->node_count);
    for (uint32_t i = 0; i < BLOCK_TRIS; i++)
        fill_tri(b->world, &wide->blocks[wide->block_count - 1], i, NO_INDEX);
    pool_each(pool, b->part_count + 1, fill_part, b);
    return true;
}

static void end(struct builder *b)
{
    for (uint32_t i = 0; i < b->part_count; i++)
        free(b->parts[i].plans);
    free(b->parts);
    free(b->top.plans);
    bvh8_collapse_free(&b->collapse);
}

bool bvh8_build(struct bvh8 *wide, const struct world *w, struct pool *pool,
                struct error *err)
{
    struct bvh bvh = {0};
    struct builder b = {.world = w, .bvh = &bvh, .wide = wide};
    bool ok;

    bvh8_free(wide);
    if (!bvh_build_nodes(&bvh, w, &bvh8_leaves, pool, err))
        return false;
    ok = bvh.node_count == 0 || build(&b, pool);
    end(&b);
    bvh_free(&bvh);
    if (!ok) {
        bvh8_free(wide);
        return fail(err, "out of memory for the tree of %u triangles",
                    w->settings.tri_count);
    }
    return true;
}

uint64_t bvh8_bytes(const struct bvh8 *wide)
{
    return wide->node_count * (uint64_t)sizeof *wide->nodes +
           wide->block_count * (uint64_t)sizeof *wide->blocks;
}

void bvh8_free(struct bvh8 *wide)
{
    free(wide->nodes);
    *wide = (struct bvh8){NULL, 0, NULL, 0};
}
