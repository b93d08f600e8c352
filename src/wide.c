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

/* More triangles of a leaf than a child can name. */
#define LEAF_TRIS_MAX ((WIDE_MORE + 1) * BLOCK_TRIS)

struct builder {
    const struct bvh *bvh;
    struct wide *wide;
    uint32_t *tri_counts; /* below each node of the binary tree */
};

/* What names a node or a block as a child. */
static uint32_t child_at(const struct wide *wide, const void *place)
{
    ptrdiff_t distance = (const char *)place - (const char *)wide->nodes;

    return (uint32_t)(distance / WIDE_UNIT * 8);
}

static float area_of(const struct node *n)
{
    float x = n->hi.x - n->lo.x, y = n->hi.y - n->lo.y, z = n->hi.z - n->lo.z;

    return x * y + y * z + z * x;
}

/* Children lie behind their parents. */
static void count_tris(struct builder *b)
{
    const struct node *nodes = b->bvh->nodes;

    for (uint32_t i = b->bvh->node_count; i-- > 0;)
        b->tri_counts[i] =
            nodes[i].count != 0
                ? nodes[i].count
                : b->tri_counts[i + 1] + b->tri_counts[nodes[i].next];
}

static bool is_leaf(const struct builder *b, uint32_t node)
{
    return b->bvh->nodes[node].count != 0 || b->tri_counts[node] <= BLOCK_TRIS;
}

/* Of the children that can be opened, the one with the largest area; count if
 * there is none. */
static uint32_t largest_of(const struct builder *b, const uint32_t *children,
                           uint32_t count)
{
    uint32_t best = count;
    float best_area = -1.0f;

    for (uint32_t i = 0; i < count; i++) {
        float area = area_of(&b->bvh->nodes[children[i]]);

        if (!is_leaf(b, children[i]) && area > best_area) {
            best = i;
            best_area = area;
        }
    }
    return best;
}

/* Up to eight nodes of the binary tree in place of the one that children[0] is;
 * their number. */
static uint32_t open_children(const struct builder *b,
                              uint32_t children[WIDE_CHILDREN])
{
    uint32_t count = 1;

    while (count < WIDE_CHILDREN) {
        uint32_t i = largest_of(b, children, count);
        uint32_t opened;

        if (i == count)
            break;
        opened = children[i];
        children[i] = opened + 1;
        children[count++] = b->bvh->nodes[opened].next;
    }
    return count;
}

static void fill_tri(struct tri_block *block, uint32_t at,
                     const struct leaf_tri *t)
{
    const struct vec3 corners[3] = {t->p0, t->p1, t->p2};

    for (int k = 0; k < 3; k++) {
        block->corners[k][0][at] = corners[k].x;
        block->corners[k][1][at] = corners[k].y;
        block->corners[k][2][at] = corners[k].z;
    }
    block->tri[at] = t->tri;
}

/* The triangles below a node lie side by side: they were written in this
 * order. */
static uint32_t add_leaf(struct builder *b, uint32_t node)
{
    struct wide *wide = b->wide;
    uint32_t count = b->tri_counts[node];
    uint32_t first_block = wide->block_count;
    uint32_t block_count = (count + BLOCK_TRIS - 1) / BLOCK_TRIS;
    uint32_t leaf = node;

    assert(count <= LEAF_TRIS_MAX);
    while (b->bvh->nodes[leaf].count == 0)
        leaf++;
    for (uint32_t i = 0; i < block_count * BLOCK_TRIS; i++) {
        struct tri_block *block = &wide->blocks[first_block + i / BLOCK_TRIS];
        const struct leaf_tri none = {{NAN, NAN, NAN},
                                      {NAN, NAN, NAN},
                                      {NAN, NAN, NAN},
                                      NO_INDEX};

        fill_tri(block, i % BLOCK_TRIS,
                 i < count ? &b->bvh->leaf_tris[b->bvh->nodes[leaf].next + i]
                           : &none);
    }
    wide->block_count += block_count;
    return child_at(wide, &wide->blocks[first_block]) | WIDE_LEAF |
           (block_count - 1);
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

/* Recursion is as deep as the tree, at most. */
static uint32_t build(struct builder *b, uint32_t node)
{
    uint32_t children[WIDE_CHILDREN] = {node};
    uint32_t count = open_children(b, children);
    struct wide_node *n = &b->wide->nodes[b->wide->node_count++];

    for (uint32_t i = 0; i < WIDE_CHILDREN; i++) {
        const struct vec3 nowhere = {INFINITY, INFINITY, INFINITY};
        const struct node *from =
            i < count ? &b->bvh->nodes[children[i]] : NULL;

        fill_box(n, i, from ? from->lo : nowhere, from ? from->hi : nowhere);
        n->child[i] = from == NULL              ? 0
                      : is_leaf(b, children[i]) ? add_leaf(b, children[i])
                                                : build(b, children[i]);
    }
    return child_at(b->wide, n);
}

/* NULL if there is none, or if children could not name all of it. */
static void *alloc_tree(size_t node_capacity, size_t block_capacity)
{
    size_t size = node_capacity * sizeof(struct wide_node) +
                  block_capacity * sizeof(struct tri_block);
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

bool wide_build(struct wide *wide, const struct bvh *bvh, struct error *err)
{
    struct builder b = {bvh, wide, NULL};

    wide_free(wide);
    if (bvh->node_count == 0)
        return true;
    /* a node has at least two children, but for a root that is a leaf; the
     * blocks of a leaf are at most as many as its triangles */
    b.tri_counts = alloc_array(bvh->node_count, sizeof *b.tri_counts);
    wide->nodes = alloc_tree(bvh->node_count / 2 + 1, bvh->leaf_tri_count);
    if (b.tri_counts == NULL || wide->nodes == NULL) {
        free(b.tri_counts);
        wide_free(wide);
        return fail(err, "out of memory for the tree of %u triangles",
                    bvh->leaf_tri_count);
    }
    wide->blocks = (void *)(wide->nodes + bvh->node_count / 2 + 1);
    count_tris(&b);
    build(&b, 0);
    free(b.tri_counts);
    return true;
}

void wide_free(struct wide *wide)
{
    free(wide->nodes);
    *wide = (struct wide){NULL, 0, NULL, 0};
}
