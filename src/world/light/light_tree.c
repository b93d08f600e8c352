// SPDX-License-Identifier: MIT
#include "world/light/light_tree.h"

#include <assert.h>
#include <float.h>
#include <math.h>

#include "base/memory.h"

#include "base/min_max.h"
#include "kernels/hit.h"

#define BIN_COUNT 12

/* Depth from which nodes are split by count: 11 levels of halves hold 2^33
 * lights. */
#define LIGHT_SAH_DEPTH (LIGHT_LEVELS - 11)

/* Least radius of a node. A quarter of its square, squared, is a normal float;
 * it is below any distance of points that float coordinates near 1 can
 * represent. */
#define RADIUS_MIN 1e-9f

struct builder {
    struct emitter *emitters;
    struct lights *lights;
    size_t node_capacity;
};

/* Bounds of a set of emitters. */
struct cluster {
    double power;
    struct vec3 lo, hi;
    struct vec3 axis; /* sum of the normals, turned to one side */
    uint32_t count;
};

struct split {
    double cost;
    uint32_t axis; /* NO_INDEX: none found */
    int bin;       /* the first bin of the right side */
    float lo, scale;
};

/* Range of emitters, first .. first + count - 1. */
struct emitter_range {
    uint32_t first, count;
    double cost;
};

static struct cluster cluster_empty(void)
{
    struct cluster c = {.lo = {FLT_MAX, FLT_MAX, FLT_MAX},
                        .hi = {-FLT_MAX, -FLT_MAX, -FLT_MAX}};

    return c;
}

static void cluster_add(struct cluster *a, const struct cluster *b)
{
    a->lo = v3_min(a->lo, b->lo);
    a->hi = v3_max(a->hi, b->hi);
    a->axis = v3_add(a->axis, b->axis);
    a->power += b->power;
    a->count += b->count;
}

/* The cluster of one emitter, with its normal on the side of `front`. */
static struct cluster cluster_of(const struct emitter *e, struct vec3 front)
{
    struct cluster c = {e->power, e->lo, e->hi, e->normal, 1};

    if (v3_dot(e->normal, front) < 0.0f)
        c.axis = v3_neg(e->normal);
    return c;
}

static struct cluster cluster_all(const struct emitter *e, uint32_t count)
{
    struct cluster all = cluster_empty();

    for (uint32_t i = 0; i < count; i++) {
        struct cluster one = cluster_of(&e[i], e[0].normal);

        cluster_add(&all, &one);
    }
    return all;
}

/* Cost of a cluster: its power times the square of its size, which blurs its
 * distance, times the solid angle M into which its normals may emit. For
 * normals spread evenly over a cap the mean normal has length 1 - l, where 2 l
 * = 1 - cos(theta_o). M is pi for one direction and 2 pi + pi^2 / 2 for all; a
 * straight line between these in l is within a fifth. */
static double cluster_cost(const struct cluster *c)
{
    struct vec3 d = v3_sub(c->hi, c->lo);
    double lost = 1 - (double)v3_length(c->axis) / c->count;

    return c->power * (double)v3_dot(d, d) * (1 + (2 + M_PI) * fmax(lost, 0));
}

/* Twice the centre of an emitter on an axis. */
static float center_of(const struct emitter *e, uint32_t axis)
{
    return v3_axis(e->lo, axis) + v3_axis(e->hi, axis);
}

static int bin_of(const struct split *s, const struct emitter *e)
{
    int bin = (int)((center_of(e, s->axis) - s->lo) * s->scale);

    return index_clamp(bin, BIN_COUNT);
}

/* Finds the cheapest of BIN_COUNT - 1 planes on one axis, and sets *best if it
 * is cheaper. */
static void split_axis(const struct emitter *e, uint32_t count, uint32_t axis,
                       struct split *best)
{
    struct cluster bins[BIN_COUNT], right[BIN_COUNT];
    struct cluster left = cluster_empty();
    float lo = FLT_MAX, hi = -FLT_MAX;
    struct split s;

    for (uint32_t i = 0; i < count; i++) {
        lo = f_min(center_of(&e[i], axis), lo);
        hi = f_max(center_of(&e[i], axis), hi);
    }
    s = (struct split){0, axis, 0, lo, BIN_COUNT / (hi - lo)};
    if (!(hi > lo) || !(s.scale <= FLT_MAX))
        return;
    for (int i = 0; i < BIN_COUNT; i++)
        bins[i] = cluster_empty();
    for (uint32_t i = 0; i < count; i++) {
        int bin = bin_of(&s, &e[i]);
        struct cluster one = cluster_of(&e[i], e[0].normal);

        cluster_add(&bins[bin], &one);
    }
    right[BIN_COUNT - 1] = bins[BIN_COUNT - 1];
    for (int i = BIN_COUNT - 2; i > 0; i--) {
        right[i] = bins[i];
        cluster_add(&right[i], &right[i + 1]);
    }
    for (int i = 1; i < BIN_COUNT; i++) {
        cluster_add(&left, &bins[i - 1]);
        if (left.count == 0 || left.count == count)
            continue;
        s.cost = cluster_cost(&left) + cluster_cost(&right[i]);
        s.bin = i;
        if (best->axis == NO_INDEX || s.cost < best->cost)
            *best = s;
    }
}

/* Moves the emitters of the left side to the front. Returns their count. */
static uint32_t partition(struct emitter *e, uint32_t count,
                          const struct split *s)
{
    uint32_t left = 0;

    for (uint32_t i = 0; i < count; i++) {
        if (bin_of(s, &e[i]) < s->bin) {
            struct emitter swap = e[left];

            e[left] = e[i];
            e[i] = swap;
            left++;
        }
    }
    return left;
}

/* Splits two or more emitters. Returns the count of the left side. */
static uint32_t split(struct emitter *e, uint32_t count, uint32_t depth)
{
    struct split best = {.axis = NO_INDEX};

    if (depth < LIGHT_SAH_DEPTH)
        for (uint32_t axis = 0; axis < 3; axis++)
            split_axis(e, count, axis, &best);
    return best.axis == NO_INDEX ? count / 2 : partition(e, count, &best);
}

static struct emitter_range emitter_range_of(const struct builder *b,
                                             uint32_t first, uint32_t count)
{
    struct cluster c = cluster_all(b->emitters + first, count);
    struct emitter_range p = {first, count, cluster_cost(&c)};

    return p;
}

/* Returns true if `a` is to be split before `b`. */
static bool is_worse(const struct emitter_range *a,
                     const struct emitter_range *b, uint32_t depth)
{
    if (depth >= LIGHT_SAH_DEPTH || a->cost == b->cost)
        return a->count > b->count;
    return a->cost > b->cost;
}

/* Splits the most expensive range until there are LIGHT_WIDTH. Returns the
 * number of ranges. */
static uint32_t divide(const struct builder *b, uint32_t first, uint32_t count,
                       uint32_t depth, struct emitter_range ranges[LIGHT_WIDTH])
{
    uint32_t n = 1;

    ranges[0] = emitter_range_of(b, first, count);
    while (n < LIGHT_WIDTH) {
        struct emitter_range *worst = NULL;
        uint32_t left;

        for (uint32_t i = 0; i < n; i++)
            if (ranges[i].count > 1 &&
                (worst == NULL || is_worse(&ranges[i], worst, depth)))
                worst = &ranges[i];
        if (worst == NULL)
            break;
        left = split(b->emitters + worst->first, worst->count, depth);
        ranges[n++] =
            emitter_range_of(b, worst->first + left, worst->count - left);
        *worst = emitter_range_of(b, worst->first, left);
    }
    return n;
}

/* Sets child i of the node to the bounds of the emitters. */
static void fill_child(struct light_node *node, uint32_t i,
                       const struct emitter *e, uint32_t count)
{
    struct cluster c = cluster_all(e, count);
    float length = v3_length(c.axis);
    struct vec3 axis =
        length > 0.0f ? v3_scale(c.axis, 1.0f / length) : e[0].normal;
    float spread = 0.0f;

    for (uint32_t k = 0; k < count; k++) {
        float cosine = fabsf(v3_dot(axis, e[k].normal));

        spread = f_max(spread, sqrtf(f_max(1.0f - cosine * cosine, 0.0f)) +
                                   e[k].spread);
    }
    node->x[i] = 0.5f * (c.lo.x + c.hi.x);
    node->y[i] = 0.5f * (c.lo.y + c.hi.y);
    node->z[i] = 0.5f * (c.lo.z + c.hi.z);
    node->radius[i] = f_max(0.5f * v3_length(v3_sub(c.hi, c.lo)), RADIUS_MIN);
    node->axis_x[i] = axis.x;
    node->axis_y[i] = axis.y;
    node->axis_z[i] = axis.z;
    node->spread[i] = f_min(spread, 1.0f);
    node->power[i] = (float)c.power;
}

static bool add_node(struct builder *b, uint32_t *index, struct error *err)
{
    struct lights *l = b->lights;
    void *nodes = l->nodes;

    if (!grow_array(&nodes, &b->node_capacity, (size_t)l->node_count + 1,
                    sizeof *l->nodes))
        return fail(err, "out of memory for the tree of %u lights",
                    l->light_count + l->point_light_count);
    l->nodes = nodes;
    l->nodes[l->node_count] = (struct light_node){.power = {0}};
    for (uint32_t i = 0; i < LIGHT_WIDTH; i++)
        l->nodes[l->node_count].radius[i] = RADIUS_MIN;
    *index = l->node_count++;
    return true;
}

/* Sets the index of the child at one depth in the path of a light. */
static void set_path(struct lights *l, uint32_t light, uint32_t depth,
                     uint32_t child)
{
    uint32_t *path = light < l->light_count
                         ? l->lights[light].path
                         : l->point_lights[light - l->light_count].path;

    path[depth / (LIGHT_LEVELS / 2)] |= child
                                        << 3 * (depth % (LIGHT_LEVELS / 2));
}

/* Builds the node of a range. Recursion is at most LIGHT_LEVELS deep. */
static bool build(struct builder *b, uint32_t first, uint32_t count,
                  uint32_t depth, uint32_t *index, struct error *err)
{
    struct emitter_range ranges[LIGHT_WIDTH];
    uint32_t range_count;

    assert(depth < LIGHT_LEVELS);
    if (!add_node(b, index, err))
        return false;
    range_count = divide(b, first, count, depth, ranges);
    for (uint32_t i = 0; i < range_count; i++) {
        struct emitter_range p = ranges[i];
        uint32_t child;

        fill_child(&b->lights->nodes[*index], i, b->emitters + p.first,
                   p.count);
        for (uint32_t k = p.first; k < p.first + p.count; k++)
            set_path(b->lights, b->emitters[k].light, depth, i);
        if (p.count == 1)
            child = b->emitters[p.first].light | LIGHT_LEAF;
        else if (!build(b, p.first, p.count, depth + 1, &child, err))
            return false;
        b->lights->nodes[*index].child[i] = child;
    }
    return true;
}

bool light_tree_build(struct lights *lights, struct emitter *emitters,
                      struct error *err)
{
    struct builder b = {emitters, lights, 0};
    uint32_t count = lights->light_count + lights->point_light_count;
    uint32_t root;

    return count < 2 || build(&b, 0, count, 0, &root, err);
}
