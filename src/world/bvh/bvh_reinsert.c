// SPDX-License-Identifier: MIT
#include "world/bvh/bvh_reinsert.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "world/bvh/sah_bins.h"
#include "kernels/traverse_leaf.h"

/* Least areas of nodes that are moved, relative to the root's, for three
 * rounds. Measured: smaller nodes make trees cheaper by less than 1 %, and take
 * longer than all of these. */
static const float parts[] = {1e-2f, 2e-3f, 4e-4f};

/* Limit on the visits of all searches per node of the tree. Measured: real
 * meshes need up to 20. Without a limit, triangles that all overlap would take
 * very long. */
#define VISITS_EACH 32

/* A node, or a small node with its whole subtree. Children are neighbours, the
 * first at an even index: searches mostly look at siblings. */
struct branch {
    struct box bounds;
    float area;
    uint32_t parent, children; /* first child; 0 if closed */
    uint32_t first, count;     /* its range of nodes in the tree that is read */
    uint32_t height;           /* levels below, or more */
};

struct tree {
    struct branch *nodes; /* nodes[0] is the root, nodes[1] is unused */
    uint32_t count;
    int64_t visits_left;
};

/* A node whose children are to be looked at, and the area saved above it. */
struct visit {
    uint32_t at;
    float saved;
};

/* A search for the best place beside any node visited so far. */
struct search {
    struct tree *tree;
    const struct branch *node; /* the node to be moved */
    uint32_t at;
    float gain;
};

static bool is_closed(const struct branch *n)
{
    return n->children == 0;
}

static void refit(struct tree *t, struct branch *n)
{
    const struct branch *a = &t->nodes[n->children], *b = a + 1;

    n->bounds = a->bounds;
    box_join(&n->bounds, &b->bounds);
    n->area = box_area(&n->bounds);
    n->height = 1 + (a->height > b->height ? a->height : b->height);
}

/* ---- from and to nodes ---- */

struct reader {
    const struct bvh *from;
    struct tree *tree;
    float least_area; /* least area of nodes that are not closed */
};

static struct box box_of(const struct node *n)
{
    return box_of_corners(n->lo, n->hi);
}

/* Reads the subtree of `count` nodes at `first`. Recursion is as deep as the
 * tree, below TRAVERSE_STACK. */
static void read_node(const struct reader *r, struct branch *n, uint32_t first,
                      uint32_t count, uint32_t depth)
{
    const struct node *from = &r->from->nodes[first];
    struct branch *children;
    uint32_t left_count;

    n->first = first;
    n->count = count;
    n->bounds = box_of(from);
    n->area = box_area(&n->bounds);
    n->children = 0;
    n->height = count == 1 ? 0 : r->from->depth - depth;
    if (count == 1 || n->area < r->least_area)
        return;
    n->children = r->tree->count;
    r->tree->count += 2;
    left_count = from->next - first - 1;
    children = &r->tree->nodes[n->children];
    children[0].parent = children[1].parent = (uint32_t)(n - r->tree->nodes);
    read_node(r, &children[0], first + 1, left_count, depth + 1);
    read_node(r, &children[1], from->next, count - 1 - left_count, depth + 1);
    refit(r->tree, n);
}

struct writer {
    const struct tree *tree;
    const struct bvh *from;
    struct bvh *to; /* filled so far */
};

static const struct node *first_leaf(const struct node *n)
{
    while (n->count == 0)
        n++;
    return n;
}

/* Copies the nodes of a closed subtree, with their indices adjusted. */
static void copy_nodes(const struct writer *w, const struct branch *n)
{
    const struct node *from = &w->from->nodes[n->first];
    uint32_t first_tri = first_leaf(from)->next;
    uint32_t tris_on = w->to->tri_count - first_tri;
    uint32_t nodes_on = w->to->node_count - n->first;
    uint32_t tri_count = 0;

    for (uint32_t i = 0; i < n->count; i++) {
        struct node *to = &w->to->nodes[w->to->node_count++];

        *to = from[i];
        to->next += to->count != 0 ? tris_on : nodes_on;
        tri_count += to->count;
    }
    memcpy(w->to->tris + w->to->tri_count, w->from->tris + first_tri,
           tri_count * sizeof *w->to->tris);
    w->to->tri_count += tri_count;
}

/* Writes a subtree. Recursion is as deep as the tree, below TRAVERSE_STACK. */
static void write_node(const struct writer *w, const struct branch *from)
{
    const struct branch *children = &w->tree->nodes[from->children];
    const float *p = from->bounds.planes;
    struct node *n = &w->to->nodes[w->to->node_count];

    if (is_closed(from)) {
        copy_nodes(w, from);
        return;
    }
    w->to->node_count++;
    n->lo = v3(p[0], p[1], p[2]);
    n->hi = v3(-p[4], -p[5], -p[6]);
    n->count = 0;
    write_node(w, &children[0]);
    n->next = w->to->node_count;
    write_node(w, &children[1]);
}

/* ---- places ---- */

/* Visits the place beside a node, where *saved is the area saved above it.
 * Returns true if a place below may be better, with *saved for its children:
 * the node grows to hold ours, and the new node is no smaller than ours. */
static inline bool look_at(struct search *s, uint32_t at, float *saved)
{
    const struct branch *b = &s->tree->nodes[at];
    float joined = box_joined_area(&b->bounds, &s->node->bounds);

    s->tree->visits_left--;
    if (*saved - joined > s->gain) {
        s->gain = *saved - joined;
        s->at = at;
    }
    *saved -= joined - b->area;
    return !is_closed(b) && *saved - s->node->area > s->gain;
}

/* Visits the places below a node. The child that grows less comes first. */
static void look_below(struct search *s, struct visit v)
{
    struct visit stack[TRAVERSE_STACK + 1];
    uint32_t depth = 0;

    stack[depth++] = v;
    while (depth > 0 && s->tree->visits_left > 0) {
        v = stack[--depth];
        if (v.saved - s->node->area <= s->gain)
            continue;

        uint32_t left = s->tree->nodes[v.at].children;
        struct visit a = {left, v.saved}, b = {left + 1, v.saved};
        bool below_a = look_at(s, a.at, &a.saved);
        bool below_b = look_at(s, b.at, &b.saved);

        stack[depth] = a.saved < b.saved ? a : b;
        depth += a.saved < b.saved ? below_a : below_b;
        stack[depth] = a.saved < b.saved ? b : a;
        depth += a.saved < b.saved ? below_b : below_a;
    }
}

static inline void look_from(struct search *s, uint32_t at, float saved)
{
    if (look_at(s, at, &saved))
        look_below(s, (struct visit){at, saved});
}

/* Returns the best place for a node, or the node itself if none is better. When
 * it is removed its parent goes as well, and the nodes above shrink to the
 * siblings on the way up. */
static uint32_t find_place(struct tree *t, uint32_t node)
{
    const struct branch *n = &t->nodes[node];
    struct search s = {t, n, node, 0.0f};
    struct box rest = t->nodes[node ^ 1].bounds;
    float saved = t->nodes[n->parent].area;

    look_from(&s, node ^ 1, saved);
    for (uint32_t at = n->parent; at != 0; at = t->nodes[at].parent) {
        look_from(&s, at ^ 1, saved);
        box_join(&rest, &t->nodes[at ^ 1].bounds);
        saved += t->nodes[t->nodes[at].parent].area - box_area(&rest);
    }
    return s.at;
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

/* Moves a node with its subtree to another index. */
static void put(struct tree *t, uint32_t place, uint32_t node)
{
    uint32_t parent = t->nodes[place].parent;
    struct branch *n = &t->nodes[place];

    *n = t->nodes[node];
    n->parent = parent;
    if (!is_closed(n))
        t->nodes[n->children].parent = t->nodes[n->children + 1].parent = place;
}

/* Moves a node beside the one at `at`. The sibling takes the parent's index,
 * and its own goes to the node that was at `at`. */
static void move(struct tree *t, uint32_t node, uint32_t at)
{
    uint32_t parent = t->nodes[node].parent, sibling = node ^ 1;

    put(t, parent, sibling);
    refit_above(t, parent);
    put(t, sibling, at);
    t->nodes[at].children = node & ~1u;
    t->nodes[node].parent = t->nodes[sibling].parent = at;
    refit_above(t, node);
}

/* Moves all nodes of at least this area. The children of the root have no other
 * place. */
static void move_all(struct tree *t, float least_area)
{
    for (uint32_t i = 2; i < t->count && t->visits_left > 0; i++) {
        uint32_t place;

        if (t->nodes[i].area < least_area || t->nodes[i].parent == 0)
            continue;
        place = find_place(t, i);
        if (place != i && !is_too_deep(t, i, place))
            move(t, i, place);
    }
}

/* ---- the whole ---- */

bool bvh_reinsert(struct bvh *bvh)
{
    size_t rounds = sizeof parts / sizeof *parts;
    struct tree t = {.count = 2,
                     .visits_left = VISITS_EACH * (int64_t)bvh->node_count};
    struct bvh to = {.nodes = NULL};
    struct reader r = {bvh, &t, 0.0f};
    struct writer w = {&t, bvh, &to};
    struct box root;

    if (bvh->node_count == 0)
        return true;
    t.nodes = alloc_aligned((size_t)bvh->node_count + 1, sizeof *t.nodes);
    to.nodes = alloc_aligned(bvh->node_count, sizeof *to.nodes);
    to.tris = alloc_aligned(bvh->tri_count, sizeof *to.tris);
    if (t.nodes == NULL || to.nodes == NULL || to.tris == NULL) {
        free(t.nodes);
        bvh_free(&to);
        return false;
    }
    root = box_of(&bvh->nodes[0]);
    r.least_area = parts[rounds - 1] * box_area(&root);
    read_node(&r, &t.nodes[0], 0, bvh->node_count, 0);
    for (size_t i = 0; i < rounds; i++)
        move_all(&t, parts[i] * t.nodes[0].area);
    write_node(&w, &t.nodes[0]);
    to.depth = t.nodes[0].height;
    free(t.nodes);
    bvh_free(bvh);
    *bvh = to;
    return true;
}
