// SPDX-License-Identifier: MIT
#include "glim/wide.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <sys/mman.h>

/* Of what is read at once, and of memory in large pages: misses of their table
 * cost rays through a million triangles 5 %. */
#define ALIGNMENT  64
#define LARGE_PAGE ((size_t)2 << 20)

/* Nodes that a thread fills at once. */
#define CHUNK 256

/* More triangles of a leaf than a child can name. */
#define LEAF_TRIS_MAX ((WIDE_MORE + 1) * BLOCK_TRIS)

/* Measured: rays take up to 5 % less time the finer the binary tree is, up to a
 * cost of 4. Large triangles that would share a block are better apart, where a
 * node can hold them with others: rooms save 5 to 15 %; small ones cost as much
 * by the memory. */
const struct bvh_leaves wide_leaves = {2, 1, 4.0f, LEAF_TRIS_MAX};

/* What it costs to have a node of the binary tree, and what is below it, as so
 * many children. */
struct fit {
    uint32_t tri_count;
    float costs[WIDE_CHILDREN]; /* [n - 1]: as n children, or fewer */
};

/* Which nodes of the binary tree are the children of a node, and which nodes,
 * or first blocks, these become. */
struct plan {
    uint32_t count;
    uint32_t from[WIDE_CHILDREN];
    uint32_t to[WIDE_CHILDREN];
};

struct builder {
    const struct world *world;
    const struct bvh *bvh;
    struct wide *wide;
    struct fit *fits; /* of each node of the binary tree */
    struct plan *plans;
    size_t plan_capacity;
};

static float area_of(const struct node *n)
{
    float x = n->hi.x - n->lo.x, y = n->hi.y - n->lo.y, z = n->hi.z - n->lo.z;

    return x * y + y * z + z * x;
}

static uint32_t blocks_for(uint32_t tri_count)
{
    return (tri_count + BLOCK_TRIS - 1) / BLOCK_TRIS;
}

static float leaf_cost(const struct builder *b, uint32_t node)
{
    uint32_t tri_count = b->fits[node].tri_count;

    if (tri_count > LEAF_TRIS_MAX)
        return INFINITY;
    return WIDE_BLOCK_COST * area_of(&b->bvh->nodes[node]) *
           (float)blocks_for(tri_count);
}

static bool is_leaf(const struct builder *b, uint32_t node)
{
    return leaf_cost(b, node) <= b->fits[node].costs[0];
}

/* The least cost of two nodes as so many children, and how many of them are
 * the left one's. */
static float share_places(const struct fit *left, const struct fit *right,
                          uint32_t places, uint32_t *lefts)
{
    float least = INFINITY;

    for (uint32_t i = 1; i < places; i++) {
        float cost = left->costs[i - 1] + right->costs[places - i - 1];

        if (cost < least) {
            least = cost;
            *lefts = i;
        }
    }
    return least;
}

/* Children lie behind their parents. */
static void fill_fits(struct builder *b)
{
    const struct node *nodes = b->bvh->nodes;

    for (uint32_t i = b->bvh->node_count; i-- > 0;) {
        const struct fit *left = &b->fits[i + 1];
        const struct fit *right = &b->fits[nodes[i].next];
        struct fit *f = &b->fits[i];
        uint32_t lefts;

        f->tri_count = nodes[i].count;
        if (nodes[i].count != 0) {
            for (uint32_t k = 0; k < WIDE_CHILDREN; k++)
                f->costs[k] = leaf_cost(b, i);
            continue;
        }
        f->tri_count = left->tri_count + right->tri_count;
        f->costs[0] =
            fminf(leaf_cost(b, i),
                  area_of(&nodes[i]) +
                      share_places(left, right, WIDE_CHILDREN, &lefts));
        for (uint32_t k = 1; k < WIDE_CHILDREN; k++)
            f->costs[k] = fminf(f->costs[k - 1],
                                share_places(left, right, k + 1, &lefts));
    }
}

/* Shares the places below a node. */
static void open_node(const struct builder *b, uint32_t node, uint32_t places,
                      struct plan *p)
{
    uint32_t right = b->bvh->nodes[node].next;
    uint32_t lefts[2] = {0, 0};
    const uint32_t nodes[2] = {node + 1, right};

    share_places(&b->fits[node + 1], &b->fits[right], places, &lefts[0]);
    lefts[1] = places - lefts[0];
    for (int i = 0; i < 2; i++) {
        const float *costs = b->fits[nodes[i]].costs;
        uint32_t n = lefts[i];

        while (n > 1 && costs[n - 2] <= costs[n - 1])
            n--;
        if (n == 1)
            p->from[p->count++] = nodes[i];
        else
            open_node(b, nodes[i], n, p);
    }
}

/* Rays that look for any hit take the last child first: leaves, for they may
 * end it, and what is large. Measured: up to twice as many a second. */
static bool is_before(const struct builder *b, uint32_t x, uint32_t y)
{
    if (is_leaf(b, x) != is_leaf(b, y))
        return is_leaf(b, y);
    return area_of(&b->bvh->nodes[x]) < area_of(&b->bvh->nodes[y]);
}

static void sort_children(const struct builder *b, struct plan *p)
{
    for (uint32_t i = 1; i < p->count; i++) {
        uint32_t node = p->from[i];
        uint32_t at = i;

        for (; at > 0 && is_before(b, node, p->from[at - 1]); at--)
            p->from[at] = p->from[at - 1];
        p->from[at] = node;
    }
}

static uint32_t plan_leaf(struct builder *b, uint32_t node)
{
    uint32_t first = b->wide->block_count;

    b->wide->block_count += blocks_for(b->fits[node].tri_count);
    return first;
}

/* Recursion is as deep as the tree, at most. */
static bool plan(struct builder *b, uint32_t node, uint32_t *index)
{
    void *plans = b->plans;
    struct plan p = {.count = 0};

    *index = b->wide->node_count++;
    if (!grow_array(&plans, &b->plan_capacity, (size_t)*index + 1,
                    sizeof *b->plans))
        return false;
    b->plans = plans;
    if (is_leaf(b, node))
        p.from[p.count++] = node; /* the root */
    else
        open_node(b, node, WIDE_CHILDREN, &p);
    sort_children(b, &p);
    for (uint32_t i = 0; i < p.count; i++) {
        if (is_leaf(b, p.from[i]))
            p.to[i] = plan_leaf(b, p.from[i]);
        else if (!plan(b, p.from[i], &p.to[i]))
            return false;
    }
    b->plans[*index] = p;
    return true;
}

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

/* What names a node or a block as a child. */
static uint32_t child_at(const struct wide *wide, const void *place)
{
    ptrdiff_t distance = (const char *)place - (const char *)wide->nodes;

    return (uint32_t)(distance / WIDE_UNIT * 8);
}

/* The triangles below a node lie side by side. */
static uint32_t fill_leaf(const struct builder *b, uint32_t node,
                          struct tri_block *blocks)
{
    uint32_t count = b->fits[node].tri_count;
    uint32_t block_count = blocks_for(count);
    const uint32_t *tris;

    while (b->bvh->nodes[node].count == 0)
        node++;
    tris = &b->bvh->tris[b->bvh->nodes[node].next];
    for (uint32_t i = 0; i < block_count * BLOCK_TRIS; i++)
        fill_tri(b->world, &blocks[i / BLOCK_TRIS], i % BLOCK_TRIS,
                 i < count ? tris[i] : NO_INDEX);
    return child_at(b->wide, blocks) | WIDE_LEAF | (block_count - 1);
}

static void fill_box(struct wide_node *n, uint32_t i, struct vec3 lo,
                     struct vec3 hi)
{
    n->planes[0][0][i] = lo.x;
    n->planes[1][0][i] = lo.y;
    n->planes[2][0][i] = lo.z;
    n->planes[0][1][i] = hi.x;
    n->planes[1][1][i] = hi.y;
    n->planes[2][1][i] = hi.z;
}

static void fill_node(const struct builder *b, uint32_t index)
{
    const struct vec3 nowhere = {INFINITY, INFINITY, INFINITY};
    const struct plan *p = &b->plans[index];
    struct wide_node *n = &b->wide->nodes[index];

    for (uint32_t i = 0; i < p->count; i++) {
        const struct node *from = &b->bvh->nodes[p->from[i]];

        fill_box(n, i, from->lo, from->hi);
        n->child[i] = is_leaf(b, p->from[i])
                          ? fill_leaf(b, p->from[i], &b->wide->blocks[p->to[i]])
                          : child_at(b->wide, &b->wide->nodes[p->to[i]]);
    }
    for (uint32_t i = p->count; i < WIDE_CHILDREN; i++) {
        fill_box(n, i, nowhere, nowhere);
        n->child[i] = 0;
    }
}

static void fill_chunk(void *context, uint32_t chunk, int worker)
{
    const struct builder *b = context;
    uint32_t first = chunk * CHUNK;

    (void)worker;
    for (uint32_t i = first; i < first + CHUNK && i < b->wide->node_count; i++)
        fill_node(b, i);
}

/* NULL if there is none, or if children could not name all of it. */
static void *alloc_tree(size_t node_count, size_t block_count)
{
    size_t size = node_count * sizeof(struct wide_node) +
                  block_count * sizeof(struct tri_block);
    size_t alignment = size < LARGE_PAGE ? ALIGNMENT : LARGE_PAGE;
    void *p;

    if (size / WIDE_UNIT >= UINT32_MAX / 8)
        return NULL;
    size = (size + alignment - 1) / alignment * alignment;
    p = aligned_alloc(alignment, size);
    if (p != NULL && alignment == LARGE_PAGE)
        madvise(p, size, MADV_HUGEPAGE);
    return p;
}

static bool build(struct builder *b, struct pool *pool)
{
    struct wide *wide = b->wide;
    uint32_t root;

    b->fits = alloc_aligned(b->bvh->node_count, sizeof *b->fits);
    if (b->fits == NULL)
        return false;
    fill_fits(b);
    if (!plan(b, 0, &root))
        return false;
    wide->nodes = alloc_tree(wide->node_count, wide->block_count);
    if (wide->nodes == NULL)
        return false;
    wide->blocks = (void *)(wide->nodes + wide->node_count);
    pool_each(pool, (wide->node_count + CHUNK - 1) / CHUNK, fill_chunk, b);
    return true;
}

bool wide_build(struct wide *wide, const struct world *w, struct pool *pool,
                struct error *err)
{
    struct bvh bvh = {0};
    struct builder b = {.world = w, .bvh = &bvh, .wide = wide};
    bool ok;

    wide_free(wide);
    if (!bvh_build_nodes(&bvh, w, &wide_leaves, pool, err))
        return false;
    ok = bvh.node_count == 0 || build(&b, pool);
    free(b.fits);
    free(b.plans);
    bvh_free(&bvh);
    if (!ok) {
        wide_free(wide);
        return fail(err, "out of memory for the tree of %u triangles",
                    w->settings.tri_count);
    }
    return true;
}

uint64_t wide_bytes(const struct wide *wide)
{
    return wide->node_count * (uint64_t)sizeof *wide->nodes +
           wide->block_count * (uint64_t)sizeof *wide->blocks;
}

void wide_free(struct wide *wide)
{
    free(wide->nodes);
    *wide = (struct wide){NULL, 0, NULL, 0};
}
