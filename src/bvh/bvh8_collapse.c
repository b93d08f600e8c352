// SPDX-License-Identifier: MIT
#include "bvh/bvh8_collapse.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "bvh/sah_bins.h"

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

/* ---- costs ---- */

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

bool bvh8_collapse_init(struct bvh8_collapse *f, const struct bvh *bvh,
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

void bvh8_collapse_free(struct bvh8_collapse *f)
{
    free(f->costs);
    *f = (struct bvh8_collapse){.costs = NULL};
}

/* ---- choices ---- */

bool bvh8_collapse_leaf(const struct bvh8_collapse *f, uint32_t node)
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

/* Called for a leaf only if that is the root. */
uint32_t bvh8_collapse_children(const struct bvh8_collapse *f, uint32_t node,
                                uint32_t children[BVH8_CHILDREN])
{
    uint32_t count = 1;

    children[0] = node;
    if (!bvh8_collapse_leaf(f, node))
        count = open_node(f, node, BVH8_CHILDREN, children, 0);
    sort_children(f, children, count);
    return count;
}
