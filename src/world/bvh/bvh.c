// SPDX-License-Identifier: MIT
/*
 * All threads together split the large ranges of triangles at the top. Each
 * smaller range becomes a subtree, which one thread builds. Only the size of a
 * range decides this, so the tree does not depend on the number of threads.
 *
 * No triangle is in two leaves. Measured: after reinsertion, spatial splits
 * (Stich, Friedrich and Dietrich 2009) make rooms slower: rays take 0 to 30 %
 * longer.
 */
#include "world/bvh/bvh.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "world/bvh/bvh_reinsert.h"
#include "world/bvh/sah_splitter.h"
#include "kernels/traverse_leaf.h"

/* Largest number of triangles in a subtree: they stay in the cache of a core.
 */
#define SUBTREE_TRIS_MAX 16384

/* Subtree that one thread builds, or a single node at the top. */
struct subtree {
    struct range range;
    uint32_t right; /* index of a top node's right child; 0 for a subtree */
    uint32_t node_count, depth;
    uint32_t tri_count;  /* triangles in its leaves */
    uint32_t first_node; /* index of its first node in the bvh */
    uint32_t first_tri;  /* likewise, of its leaves' triangles */
};

struct builder {
    struct splitter splitter;
    struct bvh *bvh;
    struct subtree *subtrees; /* depth-first */
    uint32_t subtree_count;
    size_t subtree_capacity;
};

/* ---- subtrees ---- */

static void fill_leaf(const struct builder *b, struct subtree *subtree,
                      const struct range *r, struct node *n)
{
    const struct box *boxes = b->splitter.buffers[r->buffer] + r->first;
    uint32_t *tris = b->bvh->tris + subtree->range.first + subtree->tri_count;

    n->next = subtree->tri_count; /* place_subtree() adds first_tri */
    n->count = r->count;
    for (uint32_t i = 0; i < r->count; i++)
        tris[i] = box_tri(&boxes[i]);
    subtree->tri_count += r->count;
}

static struct node node_of(const struct range *r)
{
    const float *p = r->extent.bounds.planes;
    struct node n = {
        .lo = v3(p[0] - BOX_PAD, p[1] - BOX_PAD, p[2] - BOX_PAD),
        .hi = v3(BOX_PAD - p[4], BOX_PAD - p[5], BOX_PAD - p[6]),
    };

    return n;
}

/* Returns the memory for a subtree, which has fewer than two nodes per
 * triangle. The nodes of the top fit before the first subtree, so that
 * place_subtree() moves all of them forwards. */
static struct node *nodes_of(const struct builder *b,
                             const struct subtree *subtree)
{
    return b->bvh->nodes + b->subtree_count + 2 * (size_t)subtree->range.first;
}

/* Builds the tree of a range. Recursion is as deep as the tree, below
 * TRAVERSE_STACK. */
static void build_tree(struct builder *b, struct subtree *subtree, int worker,
                       struct range *r)
{
    uint32_t index = subtree->node_count++;
    struct node *n = &nodes_of(b, subtree)[index];
    struct range sides[2];

    *n = node_of(r);
    if (r->depth > subtree->depth)
        subtree->depth = r->depth;
    if (!splitter_split(&b->splitter, worker, r, sides)) {
        fill_leaf(b, subtree, r, n);
        return;
    }
    build_tree(b, subtree, worker, &sides[0]);
    n->next = subtree->node_count;
    build_tree(b, subtree, worker, &sides[1]);
}

static void build_subtree(void *context, uint32_t item, int worker)
{
    struct builder *b = context;
    struct subtree *subtree = &b->subtrees[item];

    struct range range = subtree->range;

    if (subtree->right == 0)
        build_tree(b, subtree, worker, &range);
}

/* ---- the top ---- */

/* Appends a subtree. Boxes are aligned, so grow_array() cannot be used. */
static bool add_subtree(struct builder *b, const struct range *r)
{
    if (b->subtree_count == b->subtree_capacity) {
        size_t capacity = 2 * b->subtree_capacity + 1;
        struct subtree *subtrees = alloc_aligned(capacity, sizeof *subtrees);

        if (subtrees == NULL)
            return false;
        if (b->subtrees != NULL)
            memcpy(subtrees, b->subtrees, b->subtree_count * sizeof *subtrees);
        free(b->subtrees);
        b->subtrees = subtrees;
        b->subtree_capacity = capacity;
    }
    b->subtrees[b->subtree_count++] = (struct subtree){.range = *r};
    return true;
}

static bool build_top(struct builder *b, const struct range *r)
{
    uint32_t index = b->subtree_count;
    struct range sides[2];

    if (!add_subtree(b, r))
        return false;
    if (r->count <= SUBTREE_TRIS_MAX)
        return true;
    splitter_split_together(&b->splitter, r, sides);
    if (!build_top(b, &sides[0]))
        return false;
    b->subtrees[index].right = b->subtree_count;
    return build_top(b, &sides[1]);
}

/* ---- the whole ---- */

/* Moves the nodes of a subtree, or a node at the top, to their place in the
 * tree, which is not behind the present one. */
static void place_subtree(const struct builder *b,
                          const struct subtree *subtree)
{
    struct node *to = b->bvh->nodes + subtree->first_node;

    if (subtree->right != 0) {
        *to = node_of(&subtree->range);
        to->next = b->subtrees[subtree->right].first_node;
        return;
    }
    for (uint32_t i = 0; i < subtree->node_count; i++) {
        to[i] = nodes_of(b, subtree)[i];
        to[i].next +=
            to[i].count == 0 ? subtree->first_node : subtree->first_tri;
    }
}

static void join_subtrees(const struct builder *b)
{
    struct bvh *bvh = b->bvh;

    for (uint32_t i = 0; i < b->subtree_count; i++) {
        struct subtree *subtree = &b->subtrees[i];

        subtree->first_node = bvh->node_count;
        bvh->node_count += subtree->right != 0 ? 1 : subtree->node_count;
        subtree->first_tri = bvh->tri_count;
        bvh->tri_count += subtree->tri_count;
        if (subtree->first_tri < subtree->range.first) /* copies are dropped */
            memmove(bvh->tris + subtree->first_tri,
                    bvh->tris + subtree->range.first,
                    subtree->tri_count * sizeof *bvh->tris);
        if (subtree->depth > bvh->depth)
            bvh->depth = subtree->depth;
    }
    for (uint32_t i = 0; i < b->subtree_count; i++)
        place_subtree(b, &b->subtrees[i]);
}

static bool begin(struct builder *b, const struct world *w,
                  const struct bvh_leaves *leaves, struct pool *pool)
{
    uint32_t count = w->settings.tri_count;

    if (!splitter_init(&b->splitter, w, leaves, pool))
        return false;
    b->bvh->tris = alloc_aligned(count, sizeof *b->bvh->tris);
    return b->bvh->tris != NULL;
}

static void end(struct builder *b)
{
    free(b->subtrees);
    splitter_free(&b->splitter);
}

static bool build(struct builder *b)
{
    struct range all = splitter_all(&b->splitter);

    if (!build_top(b, &all))
        return false;
    b->bvh->nodes = alloc_aligned(2 * (size_t)all.count + b->subtree_count,
                                  sizeof *b->bvh->nodes);
    if (b->bvh->nodes == NULL)
        return false;
    pool_each(b->splitter.pool, b->subtree_count, build_subtree, b);
    join_subtrees(b);
    return true;
}

static bool fail_for(struct bvh *bvh, const struct world *w, struct error *err)
{
    bvh_free(bvh);
    return fail(err, "out of memory for the tree of %u triangles",
                w->settings.tri_count);
}

bool bvh_split(struct bvh *bvh, const struct world *w,
               const struct bvh_leaves *leaves, struct pool *pool,
               struct error *err)
{
    struct builder b = {.bvh = bvh};
    bool ok;

    bvh_free(bvh);
    if (w->settings.tri_count == 0)
        return true;
    ok = begin(&b, w, leaves, pool) && build(&b);
    end(&b);
    assert(bvh->depth < TRAVERSE_STACK);
    return ok || fail_for(bvh, w, err);
}

bool bvh_build_nodes(struct bvh *bvh, const struct world *w,
                     const struct bvh_leaves *leaves, struct pool *pool,
                     struct error *err)
{
    if (!bvh_split(bvh, w, leaves, pool, err))
        return false;
    if (!bvh_reinsert(bvh))
        return fail_for(bvh, w, err);
    assert(bvh->depth < TRAVERSE_STACK);
    return true;
}

void bvh_free(struct bvh *bvh)
{
    free(bvh->nodes);
    free(bvh->tris);
    memset(bvh, 0, sizeof *bvh);
}
