// SPDX-License-Identifier: MIT
#include "glim/reinsert.h"

#include <stdlib.h>

#include "glim/split.h"
#include "kernels/traverse.h"

/* Nodes of these parts of the root's area and above are moved, the larger ones
 * first: thrice. Measured: smaller ones make trees cheaper by less than 1 %. */
static const float parts[] = {1e-2f, 1e-3f, 1e-4f};

/* Nodes that searches look at, for each node of the tree. Measured: real meshes
 * need up to 20; among triangles that all overlap there would be no end. */
#define VISITS_EACH 32

struct branch {
    struct box bounds;
    float area;
    uint32_t parent, children[2];
    uint32_t first, count; /* triangles of a leaf; see struct node */
    uint32_t height;       /* levels below */
};

struct tree {
    struct branch *nodes; /* 0 is the root, and stays it */
    uint32_t count;
    uint64_t visits_left;
};

/* A node beside which another one may come. */
struct visit {
    uint32_t at;
    float saved;  /* by all that happens above it */
    float joined; /* area of both */
};

struct place {
    uint32_t at;
    float gain;
};

static bool is_leaf(const struct branch *n)
{
    return n->count != 0;
}

static void refit(struct tree *t, struct branch *n)
{
    const struct branch *a = &t->nodes[n->children[0]];
    const struct branch *b = &t->nodes[n->children[1]];

    n->bounds = a->bounds;
    box_join(&n->bounds, &b->bounds);
    n->area = box_area(&n->bounds);
    n->height = 1 + (a->height > b->height ? a->height : b->height);
}

static uint32_t sibling_of(const struct tree *t, uint32_t node)
{
    const struct branch *parent = &t->nodes[t->nodes[node].parent];

    return parent->children[parent->children[0] == node];
}

/* ---- from and to nodes ---- */

/* Children lie behind their parents. */
static void read_nodes(struct tree *t, const struct node *nodes)
{
    for (uint32_t i = t->count; i-- > 0;) {
        const struct node *from = &nodes[i];
        struct branch *n = &t->nodes[i];
        struct box high = box_of_point(from->hi);

        *n = (struct branch){.bounds = box_of_point(from->lo),
                             .first = from->next,
                             .count = from->count};
        box_join(&n->bounds, &high);
        n->area = box_area(&n->bounds);
        if (is_leaf(n))
            continue;
        n->children[0] = i + 1;
        n->children[1] = from->next;
        for (int k = 0; k < 2; k++)
            t->nodes[n->children[k]].parent = i;
        refit(t, n);
    }
}

struct writer {
    const struct tree *tree;
    struct bvh *to; /* filled so far */
    const uint32_t *tris;
};

/* Recursion is as deep as the tree: below TRAVERSE_STACK. */
static void write_nodes(struct writer *w, uint32_t index)
{
    const struct branch *from = &w->tree->nodes[index];
    const float *p = from->bounds.planes;
    struct node *n = &w->to->nodes[w->to->node_count++];

    *n = (struct node){.lo = v3(p[0], p[1], p[2]),
                       .next = w->to->leaf_tri_count,
                       .hi = v3(-p[4], -p[5], -p[6]),
                       .count = from->count};
    if (is_leaf(from)) {
        memcpy(w->to->tris + n->next, w->tris + from->first,
               from->count * sizeof *w->tris);
        w->to->leaf_tri_count += from->count;
        return;
    }
    write_nodes(w, from->children[0]);
    n->next = w->to->node_count;
    write_nodes(w, from->children[1]);
}

/* ---- places ---- */

static struct visit visit_of(const struct tree *t, const struct branch *n,
                             uint32_t at, float saved)
{
    struct box both = t->nodes[at].bounds;

    box_join(&both, &n->bounds);
    return (struct visit){at, saved, box_area(&both)};
}

/* Looks for a better place for n, at and below a node. What is above grows to
 * hold n, and the new node is no smaller than n. */
static void search_below(struct tree *t, const struct branch *n,
                         struct visit first, struct place *best)
{
    struct visit stack[TRAVERSE_STACK + 1];
    uint32_t depth = 0;

    stack[depth++] = first;
    while (depth > 0 && t->visits_left > 0) {
        struct visit v = stack[--depth];
        const struct branch *at = &t->nodes[v.at];
        float below = v.saved - (v.joined - at->area);

        t->visits_left--;
        if (v.saved - v.joined > best->gain)
            *best = (struct place){v.at, v.saved - v.joined};
        if (is_leaf(at) || below - n->area <= best->gain)
            continue;
        for (int k = 0; k < 2; k++)
            stack[depth + (uint32_t)k] = visit_of(t, n, at->children[k], below);
        /* the one that is to grow the least on top */
        if (stack[depth].joined - t->nodes[at->children[0]].area <
            stack[depth + 1].joined - t->nodes[at->children[1]].area) {
            v = stack[depth];
            stack[depth] = stack[depth + 1];
            stack[depth + 1] = v;
        }
        depth += 2;
    }
}

/* The best place for a node, by itself where there is none that is better.
 * Without the node its parent is gone, and the nodes above that shrink to what
 * hangs on the way up. */
static struct place find_place(struct tree *t, uint32_t node)
{
    const struct branch *n = &t->nodes[node];
    struct place best = {node, 0.0f};
    float saved = t->nodes[n->parent].area;
    struct box rest = box_empty();

    for (uint32_t at = node; at != 0; at = t->nodes[at].parent) {
        uint32_t other = sibling_of(t, at);

        if (at != node && at != n->parent)
            saved += t->nodes[at].area - box_area(&rest);
        search_below(t, n, visit_of(t, n, other, saved), &best);
        box_join(&rest, &t->nodes[other].bounds);
    }
    return best;
}

static bool is_too_deep(const struct tree *t, uint32_t node, uint32_t at)
{
    uint32_t a = t->nodes[node].height, b = t->nodes[at].height;
    uint32_t depth = 1 + (a > b ? a : b);

    for (; at != 0; at = t->nodes[at].parent)
        depth++;
    return depth >= TRAVERSE_STACK;
}

static void refit_above(struct tree *t, uint32_t node)
{
    while (node != 0) {
        node = t->nodes[node].parent;
        refit(t, &t->nodes[node]);
    }
}

/* `by` takes the place of a node. */
static void replace(struct tree *t, uint32_t node, uint32_t by)
{
    uint32_t parent = t->nodes[node].parent;

    t->nodes[parent].children[t->nodes[parent].children[1] == node] = by;
    t->nodes[by].parent = parent;
}

/* The node's parent comes with it, and holds both. */
static void move(struct tree *t, uint32_t node, uint32_t at)
{
    uint32_t parent = t->nodes[node].parent;
    uint32_t sibling = sibling_of(t, node);

    replace(t, parent, sibling);
    refit_above(t, sibling);
    replace(t, at, parent);
    t->nodes[parent].children[0] = node;
    t->nodes[parent].children[1] = at;
    t->nodes[at].parent = parent;
    refit_above(t, node);
}

/* The root's children have no other place. */
static void move_all(struct tree *t, float least_area)
{
    for (uint32_t i = 1; i < t->count && t->visits_left > 0; i++) {
        struct place best;

        if (t->nodes[i].area < least_area || t->nodes[i].parent == 0)
            continue;
        best = find_place(t, i);
        if (best.at != i && !is_too_deep(t, i, best.at))
            move(t, i, best.at);
    }
}

/* ---- the whole ---- */

bool bvh_reinsert(struct bvh *bvh)
{
    struct tree t = {.count = bvh->node_count,
                     .visits_left = VISITS_EACH * (uint64_t)bvh->node_count};
    struct bvh to = {.nodes = bvh->nodes};
    struct writer w = {&t, &to, bvh->tris};

    if (bvh->node_count == 0)
        return true;
    t.nodes = alloc_aligned(t.count, sizeof *t.nodes);
    to.tris = alloc_array(bvh->leaf_tri_count, sizeof *to.tris);
    if (t.nodes == NULL || to.tris == NULL) {
        free(t.nodes);
        free(to.tris);
        return false;
    }
    read_nodes(&t, bvh->nodes);
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        move_all(&t, parts[i] * t.nodes[0].area);
    write_nodes(&w, 0);
    to.depth = t.nodes[0].height;
    free(t.nodes);
    free(bvh->tris);
    *bvh = to;
    return true;
}
