// SPDX-License-Identifier: MIT
#include "bvh/bvh8.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "base/memory.h"
#include "bvh/bvh8_collapse.h"
#include "bvh/instance_trees.h"

/* Largest number of triangles in a subtree that one thread builds. */
#define SUBTREE_TRIS 4096

/* Measured: rays take up to 5 % less time the finer the binary tree is, up to a
 * block cost of 4. Large triangles are split to leaves of two, so that a node
 * can hold them with others: rooms save 5 to 15 %. Small ones would cost as
 * much by the memory. */
const struct bvh_leaves bvh8_leaves = {2, 1, 4.0f, BVH8_LEAF_TRIS};

/* Every stand-in has a leaf, so that rays enter only meshes whose box they
 * meet.
 */
static const struct bvh_leaves stand_in_leaves = {0, 0, 1.0f, 1};

/* Node of the wide tree: the binary nodes that are its children, and the index
 * of the node, first block or subtree that each of them becomes. */
struct collapsed_node {
    uint32_t count;
    uint32_t from[BVH8_CHILDREN];
    uint32_t to[BVH8_CHILDREN];
};

/* Subtree that one thread collapses and fills, or the top of the tree. */
struct subtree {
    uint32_t root; /* its node in the binary tree */
    struct collapsed_node *nodes;
    size_t node_capacity;
    uint32_t node_count, block_count;
    uint32_t first_node, first_block; /* its first node and block in the tree */
    bool failed;
};

struct builder {
    const struct world *world;
    const struct bvh *bvh;
    struct bvh8 *wide;
    struct bvh8_collapse collapse;
    struct subtree top;
    struct subtree *subtrees; /* subtrees below the top */
    uint32_t subtree_count;
    size_t subtree_capacity;
};

/* ---- collapsing the binary tree ---- */

static uint32_t tris_below(const struct builder *b, uint32_t node)
{
    return b->collapse.costs[node].tri_count;
}

static uint32_t collapse_leaf(const struct builder *b, struct subtree *subtree,
                              uint32_t node)
{
    uint32_t first = subtree->block_count;

    subtree->block_count += bvh8_blocks(tris_below(b, node));
    return first;
}

static bool is_subtree(const struct builder *b, uint32_t node)
{
    return tris_below(b, node) <= SUBTREE_TRIS;
}

static bool add_subtree(struct builder *b, uint32_t root, uint32_t *index)
{
    void *subtrees = b->subtrees;

    if (!grow_array(&subtrees, &b->subtree_capacity,
                    (size_t)b->subtree_count + 1, sizeof *b->subtrees))
        return false;
    b->subtrees = subtrees;
    b->subtrees[b->subtree_count] = (struct subtree){.root = root};
    *index = b->subtree_count++;
    return true;
}

/* Plans the node. Recursion is as deep as the tree, at most. */
static bool collapse_node(struct builder *b, struct subtree *subtree,
                          uint32_t node, uint32_t *index)
{
    void *nodes = subtree->nodes;
    struct collapsed_node p;

    *index = subtree->node_count++;
    if (!grow_array(&nodes, &subtree->node_capacity, subtree->node_count,
                    sizeof *subtree->nodes))
        return false;
    subtree->nodes = nodes;
    p.count = bvh8_collapse_children(&b->collapse, node, p.from);
    for (uint32_t i = 0; i < p.count; i++) {
        bool ok = true;

        if (bvh8_collapse_leaf(&b->collapse, p.from[i]))
            p.to[i] = collapse_leaf(b, subtree, p.from[i]);
        else if (subtree == &b->top && is_subtree(b, p.from[i]))
            ok = add_subtree(b, p.from[i], &p.to[i]);
        else
            ok = collapse_node(b, subtree, p.from[i], &p.to[i]);
        if (!ok)
            return false;
    }
    subtree->nodes[*index] = p;
    return true;
}

static void collapse_subtree(void *context, uint32_t item, int worker)
{
    struct builder *b = context;
    struct subtree *subtree = &b->subtrees[item];
    uint32_t root;

    (void)worker;
    subtree->failed = !collapse_node(b, subtree, subtree->root, &root);
}

static void place_subtree(struct bvh8 *wide, struct subtree *subtree)
{
    subtree->first_node = wide->node_count;
    subtree->first_block = wide->block_count;
    wide->node_count += subtree->node_count;
    wide->block_count += subtree->block_count;
}

static bool collapse_all(struct builder *b, struct pool *pool)
{
    bool ok = true;
    uint32_t root;

    if (!collapse_node(b, &b->top, 0, &root))
        return false;
    pool_each(pool, b->subtree_count, collapse_subtree, b);
    place_subtree(b->wide, &b->top);
    for (uint32_t i = 0; i < b->subtree_count; i++) {
        place_subtree(b->wide, &b->subtrees[i]);
        ok = ok && !b->subtrees[i].failed;
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

static uint32_t fill_child(const struct builder *b,
                           const struct subtree *subtree, uint32_t from,
                           uint32_t to)
{
    if (bvh8_collapse_leaf(&b->collapse, from))
        return fill_leaf(b, from, &b->wide->blocks[subtree->first_block + to]);
    if (subtree == &b->top && is_subtree(b, from))
        to = b->subtrees[to].first_node;
    else
        to += subtree->first_node;
    return child_at(b->wide, &b->wide->nodes[to]);
}

static void fill_node(const struct builder *b, const struct subtree *subtree,
                      uint32_t index)
{
    const struct vec3 nowhere = {INFINITY, INFINITY, INFINITY};
    const struct collapsed_node *p = &subtree->nodes[index];
    struct bvh8_node *n = &b->wide->nodes[subtree->first_node + index];

    for (uint32_t i = 0; i < p->count; i++) {
        const struct node *from = &b->bvh->nodes[p->from[i]];

        fill_box(n, i, from->lo, from->hi);
        n->child[i] = fill_child(b, subtree, p->from[i], p->to[i]);
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
static void fetch_tris(const struct builder *b, const struct collapsed_node *p)
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

/* Fills the nodes of a subtree, or of the top for the last item. */
static void fill_subtree(void *context, uint32_t item, int worker)
{
    const struct builder *b = context;
    const struct subtree *subtree =
        item < b->subtree_count ? &b->subtrees[item] : &b->top;

    (void)worker;
    for (uint32_t i = 0; i < subtree->node_count; i++) {
        if (i + 1 < subtree->node_count)
            fetch_tris(b, &subtree->nodes[i + 1]);
        fill_node(b, subtree, i);
    }
}

/* ---- the whole ---- */

/* Allocates nodes and blocks. Returns NULL if memory is out, or if the tree is
 * too large for the offsets of children. */
static void *alloc_tree(size_t node_count, size_t block_count)
{
    size_t size = node_count * sizeof(struct bvh8_node) +
                  block_count * sizeof(struct tri_block);

    return size / BVH8_UNIT < UINT32_MAX / 8 ? alloc_aligned(size, 1) : NULL;
}

static bool build(struct builder *b, uint32_t leaf_tris, struct pool *pool)
{
    struct bvh8 *wide = b->wide;

    if (!bvh8_collapse_init(&b->collapse, b->bvh, leaf_tris, pool) ||
        !collapse_all(b, pool))
        return false;
    wide->nodes = alloc_tree(wide->node_count, wide->block_count);
    if (wide->nodes == NULL)
        return false;
    wide->blocks = (void *)(wide->nodes + wide->node_count);
    for (uint32_t i = 0; i < BLOCK_TRIS; i++)
        fill_tri(b->world, &wide->blocks[wide->block_count - 1], i, NO_INDEX);
    pool_each(pool, b->subtree_count + 1, fill_subtree, b);
    return true;
}

static void end(struct builder *b)
{
    for (uint32_t i = 0; i < b->subtree_count; i++)
        free(b->subtrees[i].nodes);
    free(b->subtrees);
    free(b->top.nodes);
    bvh8_collapse_free(&b->collapse);
}

static bool fail_for(struct bvh8 *wide, const struct world *w,
                     struct error *err)
{
    bvh8_free(wide);
    return fail(err, "out of memory for the tree of %u triangles",
                w->settings.tri_count);
}

static bool build_one(struct bvh8 *wide, const struct world *w,
                      const struct bvh_leaves *leaves, struct pool *pool,
                      struct error *err)
{
    struct bvh bvh = {0};
    struct builder b = {.world = w, .bvh = &bvh, .wide = wide};
    bool ok;

    if (!bvh_build_nodes(&bvh, w, leaves, pool, err))
        return false;
    wide->lacks_copies |= bvh.leaf_tri_count < w->settings.tri_count;
    ok = bvh.node_count == 0 || build(&b, leaves->most, pool);
    end(&b);
    bvh_free(&bvh);
    return ok || fail_for(wide, w, err);
}

static bool build_all(struct bvh8 *wide, const struct instance_trees *t,
                      struct pool *pool, struct error *err)
{
    wide->meshes = alloc_array(t->mesh_count, sizeof *wide->meshes);
    if (wide->meshes == NULL)
        return fail_for(wide, &t->stand_ins, err);
    wide->mesh_count = t->mesh_count;
    for (uint32_t i = 0; i < t->mesh_count; i++)
        if (!build_one(&wide->meshes[i], &t->meshes[i], &bvh8_leaves, pool,
                       err))
            return false;
    for (uint32_t i = 0; i < t->mesh_count; i++)
        wide->lacks_copies |= wide->meshes[i].lacks_copies;
    return build_one(wide, &t->stand_ins, &stand_in_leaves, pool, err);
}

bool bvh8_build(struct bvh8 *wide, const struct world *w, struct pool *pool,
                struct error *err)
{
    struct instance_trees trees;
    bool ok;

    bvh8_free(wide);
    if (w->settings.instance_count == 0)
        return build_one(wide, w, &bvh8_leaves, pool, err);
    if (!instance_trees_init(&trees, w, pool))
        return fail_for(wide, w, err);
    ok = build_all(wide, &trees, pool, err);
    instance_trees_free(&trees);
    if (!ok)
        bvh8_free(wide);
    return ok;
}

uint64_t bvh8_bytes(const struct bvh8 *wide)
{
    uint64_t sum = wide->node_count * (uint64_t)sizeof *wide->nodes +
                   wide->block_count * (uint64_t)sizeof *wide->blocks;

    for (uint32_t i = 0; i < wide->mesh_count; i++)
        sum += bvh8_bytes(&wide->meshes[i]);
    return sum;
}

void bvh8_free(struct bvh8 *wide)
{
    for (uint32_t i = 0; i < wide->mesh_count; i++)
        free(wide->meshes[i].nodes);
    free(wide->meshes);
    free(wide->nodes);
    wide->nodes = NULL;
    wide->blocks = NULL;
    wide->meshes = NULL;
    wide->node_count = wide->block_count = wide->mesh_count = 0;
    wide->lacks_copies = false;
}
