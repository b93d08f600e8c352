// SPDX-License-Identifier: MIT
#include "glim/bvh.h"

#include <assert.h>
#include <stdlib.h>

#include "kernels/traverse.h"

#define BIN_COUNT 16

/* Where splits by cost end and halving by count begins: 32 more levels hold
 * any number of triangles, and all of them fit TRAVERSE_STACK. */
#define BVH_SAH_DEPTH 60

/* A leaf may hold this many; more are split whatever the cost says. */
#define LEAF_MAX 8

/* Cost of a triangle test in visits of a node. Measured: flat from 1 to 2. */
#define TRIANGLE_COST 1.5f

struct box {
    struct vec3 lo, hi;
};

struct primitive {
    struct box box;
    uint32_t tri;
};

struct builder {
    struct primitive *primitives;
    const struct world *world;
    struct bvh *bvh;
    size_t node_capacity;
};

struct split {
    float cost; /* times the area of the node */
    int axis;   /* -1: none found */
    int bin;    /* the first that goes right */
    float lo, scale;
};

static struct box box_empty(void)
{
    struct box b = {{FLOAT_MAX, FLOAT_MAX, FLOAT_MAX},
                    {-FLOAT_MAX, -FLOAT_MAX, -FLOAT_MAX}};

    return b;
}

static struct box box_join(struct box a, struct box b)
{
    a.lo =
        v3(f_min(a.lo.x, b.lo.x), f_min(a.lo.y, b.lo.y), f_min(a.lo.z, b.lo.z));
    a.hi =
        v3(f_max(a.hi.x, b.hi.x), f_max(a.hi.y, b.hi.y), f_max(a.hi.z, b.hi.z));
    return a;
}

static struct box box_add(struct box a, struct vec3 p)
{
    struct box b = {p, p};

    return box_join(a, b);
}

/* Half of the surface; 0 for an empty box. */
static float box_area(struct box b)
{
    struct vec3 d = v3_sub(b.hi, b.lo);

    if (!(d.x >= 0.0f))
        return 0.0f;
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

/* Twice the centre. */
static struct vec3 box_center(struct box b)
{
    return v3_add(b.lo, b.hi);
}

static int bin_of(const struct split *s, const struct primitive *p)
{
    float x = v3_axis(box_center(p->box), (uint32_t)s->axis);
    int bin = (int)((x - s->lo) * s->scale);

    return bin < 0 ? 0 : bin >= BIN_COUNT ? BIN_COUNT - 1 : bin;
}

/* The cheapest of BIN_COUNT - 1 planes on one axis, into *best if cheaper. */
static void split_axis(const struct primitive *p, uint32_t count,
                       struct box centers, int axis, struct split *best)
{
    struct box boxes[BIN_COUNT];
    struct box right[BIN_COUNT];
    uint32_t counts[BIN_COUNT] = {0};
    float lo = v3_axis(centers.lo, (uint32_t)axis);
    float hi = v3_axis(centers.hi, (uint32_t)axis);
    struct split s = {0.0f, axis, 0, lo, BIN_COUNT / (hi - lo)};
    struct box left = box_empty();
    uint32_t left_count = 0;

    if (!(hi > lo) || !(s.scale <= FLOAT_MAX))
        return;
    for (int i = 0; i < BIN_COUNT; i++)
        boxes[i] = box_empty();
    for (uint32_t i = 0; i < count; i++) {
        int bin = bin_of(&s, &p[i]);

        boxes[bin] = box_join(boxes[bin], p[i].box);
        counts[bin]++;
    }
    right[BIN_COUNT - 1] = boxes[BIN_COUNT - 1];
    for (int i = BIN_COUNT - 2; i > 0; i--)
        right[i] = box_join(boxes[i], right[i + 1]);
    for (int i = 1; i < BIN_COUNT; i++) {
        left = box_join(left, boxes[i - 1]);
        left_count += counts[i - 1];
        if (left_count == 0 || left_count == count)
            continue;
        s.cost =
            TRIANGLE_COST * (box_area(left) * (float)left_count +
                             box_area(right[i]) * (float)(count - left_count));
        s.bin = i;
        if (best->axis < 0 || s.cost < best->cost)
            *best = s;
    }
}

/* Puts those of the left side first; returns how many. */
static uint32_t partition(struct primitive *p, uint32_t count,
                          const struct split *s)
{
    uint32_t left = 0;

    for (uint32_t i = 0; i < count; i++) {
        if (bin_of(s, &p[i]) < s->bin) {
            struct primitive swap = p[left];

            p[left] = p[i];
            p[i] = swap;
            left++;
        }
    }
    return left;
}

static struct box bounds_of(const struct primitive *p, uint32_t count,
                            struct box *centers)
{
    struct box bounds = box_empty();

    *centers = box_empty();
    for (uint32_t i = 0; i < count; i++) {
        bounds = box_join(bounds, p[i].box);
        *centers = box_add(*centers, box_center(p[i].box));
    }
    return bounds;
}

/* How many primitives go left; 0 for a leaf. Reorders them. */
static uint32_t choose_split(struct primitive *p, uint32_t count,
                             struct box bounds, struct box centers,
                             uint32_t depth)
{
    struct split best = {0.0f, -1, 0, 0.0f, 0.0f};
    float area = box_area(bounds);

    if (count == 1)
        return 0;
    if (depth < BVH_SAH_DEPTH)
        for (int axis = 0; axis < 3; axis++)
            split_axis(p, count, centers, axis, &best);
    if (count <= LEAF_MAX &&
        (best.axis < 0 ||
         TRIANGLE_COST * (float)count * area <= area + best.cost))
        return 0;
    if (best.axis < 0)
        return count / 2;
    return partition(p, count, &best);
}

static bool add_node(struct builder *b, uint32_t *index, struct error *err)
{
    void *nodes = b->bvh->nodes;

    if (!grow_array(&nodes, &b->node_capacity, (size_t)b->bvh->node_count + 1,
                    sizeof(struct node)))
        return fail(err, "out of memory for the tree's %u. node",
                    b->bvh->node_count + 1);
    b->bvh->nodes = nodes;
    *index = b->bvh->node_count++;
    return true;
}

static void fill_leaf(struct builder *b, struct node *n, uint32_t first,
                      uint32_t count)
{
    const struct world *w = b->world;

    n->next = b->bvh->leaf_tri_count;
    n->count = count;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t tri = b->primitives[first + i].tri;
        struct leaf_tri *leaf = &b->bvh->leaf_tris[b->bvh->leaf_tri_count++];

        leaf->p0 = w->positions[w->tris[tri].v[0]];
        leaf->p1 = w->positions[w->tris[tri].v[1]];
        leaf->p2 = w->positions[w->tris[tri].v[2]];
        leaf->tri = tri;
    }
}

/* Recursion is as deep as the tree: below TRAVERSE_STACK. */
static bool build(struct builder *b, uint32_t first, uint32_t count,
                  uint32_t depth, struct error *err)
{
    struct box centers;
    struct box bounds = bounds_of(b->primitives + first, count, &centers);
    uint32_t index = 0;
    uint32_t left;
    struct node *n;

    if (!add_node(b, &index, err))
        return false;
    if (depth > b->bvh->depth)
        b->bvh->depth = depth;
    n = &b->bvh->nodes[index];
    n->lo = v3_sub(bounds.lo, v3(BOX_PAD, BOX_PAD, BOX_PAD));
    n->hi = v3_add(bounds.hi, v3(BOX_PAD, BOX_PAD, BOX_PAD));
    left = choose_split(b->primitives + first, count, bounds, centers, depth);
    if (left == 0) {
        fill_leaf(b, n, first, count);
        return true;
    }
    n->count = 0;
    if (!build(b, first, left, depth + 1, err))
        return false;
    b->bvh->nodes[index].next = b->bvh->node_count;
    return build(b, first + left, count - left, depth + 1, err);
}

bool bvh_build(struct bvh *bvh, const struct world *w, struct error *err)
{
    struct builder b = {NULL, w, bvh, 0};
    bool ok = false;

    bvh_free(bvh);
    if (w->settings.tri_count == 0)
        return true;
    b.primitives = alloc_array(w->settings.tri_count, sizeof *b.primitives);
    bvh->leaf_tris = alloc_array(w->settings.tri_count, sizeof *bvh->leaf_tris);
    if (b.primitives == NULL || bvh->leaf_tris == NULL) {
        fail(err, "out of memory for the tree of %u triangles",
             w->settings.tri_count);
        goto out;
    }
    for (uint32_t i = 0; i < w->settings.tri_count; i++) {
        struct box box = box_empty();

        for (int k = 0; k < 3; k++)
            box = box_add(box, w->positions[w->tris[i].v[k]]);
        b.primitives[i].box = box;
        b.primitives[i].tri = i;
    }
    ok = build(&b, 0, w->settings.tri_count, 0, err);
    assert(!ok || bvh->depth < TRAVERSE_STACK);
out:
    free(b.primitives);
    if (!ok)
        bvh_free(bvh);
    return ok;
}

void bvh_free(struct bvh *bvh)
{
    free(bvh->nodes);
    free(bvh->leaf_tris);
    *bvh = (struct bvh){NULL, 0, NULL, 0, 0};
}
