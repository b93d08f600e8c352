// SPDX-License-Identifier: MIT
#include "world/bvh/bvh8.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "world/bvh/instance_trees.h"
#include "world/bvh/sah_bins.h"

struct bvh8_cost {
    uint32_t tri_count;
    float costs[BVH8_CHILDREN]; /* [n - 1]: with at most n places */
};

struct bvh8_collapse {
    const struct bvh *bvh;
    struct bvh8_cost *costs; /* of each node */
    uint32_t leaf_tris;      /* most triangles of a leaf */
};

static inline uint32_t bvh8_blocks(uint32_t tri_count)
{
    return (tri_count + BVH8_BLOCK_TRIS - 1) / BVH8_BLOCK_TRIS;
}

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

/* ---- costs of collapsed nodes ---- */

/*
 * The choice of least cost by the surface area heuristic (Ylitie, Karras and
 * Laine 2017, "Efficient incoherent ray traversal on GPUs through compressed
 * wide BVHs", 3.1): from the leaves up, the least cost of everything below a
 * node when it takes n places in its parent.
 */

/* Nodes of a span, whose costs one thread computes. */
#define SPAN_NODES 4096

/* A node and all nodes below it. */
struct span {
    uint32_t first, end;
};

struct cost_job {
    const struct bvh8_collapse *collapse;
    struct span *spans;
    uint32_t span_count;
    size_t span_capacity;
};

static float area_of(const struct node *n)
{
    struct box box = box_of_corners(n->lo, n->hi);

    return box_area(&box);
}

static float leaf_cost(const struct bvh8_collapse *f, uint32_t node)
{
    uint32_t tri_count = f->costs[node].tri_count;

    if (tri_count > f->leaf_tris)
        return INFINITY;
    return BVH8_BLOCK_COST * area_of(&f->bvh->nodes[node]) *
           (float)bvh8_blocks(tri_count);
}

/* The least costs of two nodes that share k + 1 places. */
static void share_places(const struct bvh8_cost *left,
                         const struct bvh8_cost *right,
                         float costs[BVH8_CHILDREN])
{
    for (uint32_t k = 0; k < BVH8_CHILDREN; k++) {
        costs[k] = INFINITY;
        for (uint32_t i = 0; i < k; i++)
            costs[k] =
                f_min(left->costs[i] + right->costs[k - 1 - i], costs[k]);
    }
}

static void cost_node(const struct bvh8_collapse *f, uint32_t node)
{
    const struct node *n = &f->bvh->nodes[node];
    struct bvh8_cost *cost = &f->costs[node];
    float shared[BVH8_CHILDREN];

    cost->tri_count = n->count;
    if (n->count != 0) {
        for (uint32_t k = 0; k < BVH8_CHILDREN; k++)
            cost->costs[k] = leaf_cost(f, node);
        return;
    }
    cost->tri_count = cost[1].tri_count + f->costs[n->next].tri_count;
    share_places(&cost[1], &f->costs[n->next], shared);
    cost->costs[0] =
        f_min(leaf_cost(f, node), area_of(n) + shared[BVH8_CHILDREN - 1]);
    for (uint32_t k = 1; k < BVH8_CHILDREN; k++)
        cost->costs[k] = f_min(cost->costs[k - 1], shared[k]);
}

/* Children are stored behind their parents, so the span is done backwards. */
static void cost_span(void *context, uint32_t item, int worker)
{
    const struct cost_job *f = context;
    struct span s = f->spans[item];

    (void)worker;
    while (s.end-- > s.first)
        cost_node(f->collapse, s.end);
}

static uint32_t right_of(const struct bvh8_collapse *f, uint32_t node)
{
    return f->bvh->nodes[node].next;
}

/* Divides the tree into spans. Recursion is as deep as the tree, at most. */
static bool find_spans(struct cost_job *f, struct span s)
{
    uint32_t right = right_of(f->collapse, s.first);
    void *spans = f->spans;

    if (s.end - s.first > SPAN_NODES)
        return find_spans(f, (struct span){s.first + 1, right}) &&
               find_spans(f, (struct span){right, s.end});
    if (!grow_array(&spans, &f->span_capacity, (size_t)f->span_count + 1,
                    sizeof *f->spans))
        return false;
    f->spans = spans;
    f->spans[f->span_count++] = s;
    return true;
}

static void cost_above_spans(const struct bvh8_collapse *f, struct span s)
{
    uint32_t right = right_of(f, s.first);

    if (s.end - s.first <= SPAN_NODES)
        return;
    cost_above_spans(f, (struct span){s.first + 1, right});
    cost_above_spans(f, (struct span){right, s.end});
    cost_node(f, s.first);
}

/* Computes the costs for a tree with at least one node, whose leaves may have
 * so many triangles. Returns false if memory is out. */
static bool bvh8_collapse_init(struct bvh8_collapse *f, const struct bvh *bvh,
                               uint32_t leaf_tris, struct pool *pool)
{
    const struct span all = {0, bvh->node_count};
    struct cost_job job = {.collapse = f};
    bool ok;

    *f =
        (struct bvh8_collapse){bvh,
                               alloc_aligned(bvh->node_count, sizeof *f->costs),
                               leaf_tris};
    ok = f->costs != NULL && find_spans(&job, all);
    if (ok) {
        pool_each(pool, job.span_count, cost_span, &job);
        cost_above_spans(f, all);
    }
    free(job.spans);
    return ok;
}

static void bvh8_collapse_free(struct bvh8_collapse *f)
{
    free(f->costs);
    *f = (struct bvh8_collapse){.costs = NULL};
}

/* ---- choices ---- */

/* Returns true if the node is to be a leaf. */
static bool bvh8_collapse_leaf(const struct bvh8_collapse *f, uint32_t node)
{
    return leaf_cost(f, node) <= f->costs[node].costs[0];
}

/* Finds how many of the places go to the left of two nodes. */
static uint32_t left_places(const struct bvh8_cost *left,
                            const struct bvh8_cost *right, uint32_t places)
{
    uint32_t lefts = 1;
    float least = INFINITY;

    for (uint32_t i = 1; i < places; i++) {
        float cost = left->costs[i - 1] + right->costs[places - i - 1];

        if (cost < least) {
            least = cost;
            lefts = i;
        }
    }
    return lefts;
}

/* Adds the nodes that fill so many places, from those below a node. Returns the
 * count of children. */
static uint32_t open_node(const struct bvh8_collapse *f, uint32_t node,
                          uint32_t places, uint32_t *children, uint32_t count)
{
    const uint32_t nodes[2] = {node + 1, right_of(f, node)};
    uint32_t lefts =
        left_places(&f->costs[nodes[0]], &f->costs[nodes[1]], places);

    for (int i = 0; i < 2; i++) {
        const float *costs = f->costs[nodes[i]].costs;
        uint32_t n = i == 0 ? lefts : places - lefts;

        while (n > 1 && costs[n - 2] <= costs[n - 1])
            n--;
        if (n == 1)
            children[count++] = nodes[i];
        else
            count = open_node(f, nodes[i], n, children, count);
    }
    return count;
}

/* Order of children. hit_any() visits the last one first: leaves, as they may
 * end the query, and large boxes. Measured: up to twice as many rays a second.
 * Areas are not negative, so that their bits have the same order. */
static uint32_t rank_of(const struct bvh8_collapse *f, uint32_t node)
{
    return float_bits(area_of(&f->bvh->nodes[node])) |
           (uint32_t)bvh8_collapse_leaf(f, node) << 31;
}

static void sort_children(const struct bvh8_collapse *f, uint32_t *children,
                          uint32_t count)
{
    uint32_t ranks[BVH8_CHILDREN];

    for (uint32_t i = 0; i < count; i++) {
        uint32_t node = children[i], rank = rank_of(f, node);
        uint32_t at = i;

        for (; at > 0 && rank < ranks[at - 1]; at--) {
            ranks[at] = ranks[at - 1];
            children[at] = children[at - 1];
        }
        ranks[at] = rank;
        children[at] = node;
    }
}

/* Finds the children of a node, in their order. Returns their count. Called for
 * a leaf only if that is the root. */
static uint32_t bvh8_collapse_children(const struct bvh8_collapse *f,
                                       uint32_t node,
                                       uint32_t children[BVH8_CHILDREN])
{
    uint32_t count = 1;

    children[0] = node;
    if (!bvh8_collapse_leaf(f, node))
        count = open_node(f, node, BVH8_CHILDREN, children, 0);
    sort_children(f, children, count);
    return count;
}

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

    for (uint32_t i = 0; i < block_count * BVH8_BLOCK_TRIS; i++)
        fill_tri(b->world, &blocks[i / BVH8_BLOCK_TRIS], i % BVH8_BLOCK_TRIS,
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

/* Allocates nodes and blocks. Returns false if memory is out, or if the tree is
 * too large for the places of children. */
static bool alloc_tree(struct bvh8 *wide)
{
    size_t size = wide->node_count * sizeof *wide->nodes +
                  wide->block_count * sizeof *wide->blocks;

    if (size / BVH8_UNIT < UINT32_MAX / 8)
        wide->nodes = alloc_aligned(size, 1);
    if (wide->nodes == NULL)
        return false;
    wide->size_bytes = size;
    wide->blocks = (void *)(wide->nodes + wide->node_count);
    return true;
}

static bool build(struct builder *b, uint32_t leaf_tris, struct pool *pool)
{
    struct bvh8 *wide = b->wide;

    if (!bvh8_collapse_init(&b->collapse, b->bvh, leaf_tris, pool) ||
        !collapse_all(b, pool) || !alloc_tree(wide))
        return false;
    for (uint32_t i = 0; i < BVH8_BLOCK_TRIS; i++)
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
    wide->lacks_copies = bvh.tri_count < w->settings.tri_count;
    ok = bvh.node_count == 0 || build(&b, leaves->most, pool);
    end(&b);
    bvh_free(&bvh);
    return ok || fail_for(wide, w, err);
}

/* ---- instances ---- */

/* Appends a tree to the allocation, which is large enough, and frees it.
 * Returns where it is, in units. */
static uint32_t append(struct bvh8 *wide, struct bvh8 *tree)
{
    size_t at = wide->size_bytes;

    if (tree->size_bytes > 0)
        memcpy((char *)wide->nodes + at, tree->nodes, tree->size_bytes);
    wide->size_bytes += tree->size_bytes;
    wide->lacks_copies |= tree->lacks_copies;
    bvh8_free(tree);
    return (uint32_t)(at / BVH8_UNIT);
}

/* Joins the tree of the stand-ins, which is the last, and those of meshes.
 * Returns false if memory is out, or if they are too large for roots. */
static bool join_trees(struct bvh8 *wide, const struct instance_trees *t,
                       const struct world *w, struct bvh8 *trees)
{
    struct bvh8 *stand_ins = &trees[t->mesh_count];
    uint32_t *places = alloc_array(t->mesh_count, sizeof *places);
    uint32_t instance_count = w->settings.instance_count;
    size_t size = 0;

    for (uint32_t i = 0; i <= t->mesh_count; i++)
        size += trees[i].size_bytes;
    wide->roots = alloc_array((size_t)instance_count + 1, sizeof *wide->roots);
    wide->nodes =
        size / BVH8_UNIT <= UINT32_MAX ? alloc_aligned(size, 1) : NULL;
    if (places == NULL || wide->roots == NULL || wide->nodes == NULL) {
        free(places);
        return false;
    }
    wide->root_count = instance_count + 1;
    wide->node_count = stand_ins->node_count;
    wide->block_count = stand_ins->block_count;
    wide->blocks = (void *)(wide->nodes + wide->node_count);
    append(wide, stand_ins);
    for (uint32_t i = 0; i < t->mesh_count; i++)
        places[i] = append(wide, &trees[i]);
    for (uint32_t i = 0; i < instance_count; i++)
        wide->roots[i] = places[w->instances[i].mesh];
    wide->roots[instance_count] = places[t->mesh_count - 1];
    free(places);
    return true;
}

static bool build_all(struct bvh8 *wide, const struct instance_trees *t,
                      const struct world *w, struct pool *pool,
                      struct error *err)
{
    struct bvh8 *trees = alloc_array((size_t)t->mesh_count + 1, sizeof *trees);
    bool ok = true;

    if (trees == NULL)
        return fail_for(wide, w, err);
    for (uint32_t i = 0; ok && i < t->mesh_count; i++)
        ok = build_one(&trees[i], &t->meshes[i], &bvh8_leaves, pool, err);
    ok = ok && build_one(&trees[t->mesh_count], &t->stand_ins, &stand_in_leaves,
                         pool, err);
    ok = ok && (join_trees(wide, t, w, trees) || fail_for(wide, w, err));
    for (uint32_t i = 0; i <= t->mesh_count; i++)
        bvh8_free(&trees[i]);
    free(trees);
    return ok;
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
    ok = build_all(wide, &trees, w, pool, err);
    instance_trees_free(&trees);
    return ok;
}

void bvh8_lend(const struct bvh8 *wide, struct world *w)
{
    w->nodes = wide->nodes;
    w->roots = wide->roots;
}

uint64_t bvh8_bytes(const struct bvh8 *wide)
{
    return wide->size_bytes + (uint64_t)wide->root_count * sizeof *wide->roots;
}

void bvh8_free(struct bvh8 *wide)
{
    free(wide->nodes);
    free(wide->roots);
    wide->nodes = NULL;
    wide->blocks = NULL;
    wide->roots = NULL;
    wide->size_bytes = 0;
    wide->node_count = wide->block_count = wide->root_count = 0;
    wide->lacks_copies = false;
}
