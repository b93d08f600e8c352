// SPDX-License-Identifier: MIT
#include "glim/lights.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glim/footprint.h"
#include "kernels/texture.h"
#include "kernels/hit.h"

#define BIN_COUNT 12

/* Where splits by cost end: 11 levels of halves hold 2^33 lights. */
#define LIGHT_SAH_DEPTH (LIGHT_LEVELS - 11)

/* Of all lights together: no light is without any. */
#define POWER_LEAST 1e-30

/* Keeps 1 / distance^2 finite; below any distance between points that float
 * coordinates near 1 can tell apart. */
#define RADIUS_LEAST 1e-9f

/* Twice the area of the smallest triangle whose density is computed in float
 * without underflow. Smaller ones are left to rays that find them by chance. */
#define AREA_LEAST 1e-30

/* Lights that, found by chance, would have this part of the square of what a
 * constant sky sheds on a plane as variance are sampled each time; weaker ones
 * in proportion, but never less often than SHARE_LEAST. Measured: the lamps of
 * five scenes (6 times the square and more) leave 3 to 80 times the error
 * without sampling, a large paper lamp in a room with a window (.01) 1.2 times,
 * where its shadow rays double the time. */
#define GLARE_FULL  0.1
#define SHARE_LEAST 0.1

struct emitter {
    struct vec3 lo, hi;
    struct vec3 normal; /* unit; its sign means nothing */
    double power;
    uint32_t light;
};

struct builder {
    struct emitter *emitters;
    struct lights *lights;
    size_t node_capacity;
};

/* Some emitters taken together. */
struct cluster {
    double power;
    struct vec3 lo, hi;
    struct vec3 axis; /* sum of the normals, all turned to one side */
    uint32_t count;
};

struct split {
    double cost;
    uint32_t axis; /* NO_INDEX: none found */
    int bin;       /* the first that goes right */
    float lo, scale;
};

/* Emitters first .. first + count - 1. */
struct part {
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
    a->lo = v3(f_min(a->lo.x, b->lo.x), f_min(a->lo.y, b->lo.y),
               f_min(a->lo.z, b->lo.z));
    a->hi = v3(f_max(a->hi.x, b->hi.x), f_max(a->hi.y, b->hi.y),
               f_max(a->hi.z, b->hi.z));
    a->axis = v3_add(a->axis, b->axis);
    a->power += b->power;
    a->count += b->count;
}

/* An emitter's own cluster, its normal on the side of `front`. */
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

/* What the cluster costs: its power, times the square of the size that blurs
 * its distance, times the solid angle M that its normals may shine into. For
 * normals spread evenly over a cap the mean normal is as long as 1 - l, where
 * 2 l = 1 - cos(theta_o); M is pi for one direction, 2 pi + pi^2 / 2 for all,
 * and a straight line between the two in l is within a fifth. */
static double cluster_cost(const struct cluster *c)
{
    struct vec3 d = v3_sub(c->hi, c->lo);
    double lost = 1 - (double)v3_length(c->axis) / c->count;

    return c->power * (double)v3_dot(d, d) * (1 + (2 + M_PI) * fmax(lost, 0));
}

/* Twice the centre. */
static float center_of(const struct emitter *e, uint32_t axis)
{
    return v3_axis(e->lo, axis) + v3_axis(e->hi, axis);
}

static int bin_of(const struct split *s, const struct emitter *e)
{
    int bin = (int)((center_of(e, s->axis) - s->lo) * s->scale);

    return bin < 0 ? 0 : bin >= BIN_COUNT ? BIN_COUNT - 1 : bin;
}

/* The cheapest of BIN_COUNT - 1 planes on one axis, into *best if cheaper. */
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

/* Puts those of the left side first; returns how many. */
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

/* Two or more emitters in two; returns how many go left. */
static uint32_t split(struct emitter *e, uint32_t count, uint32_t depth)
{
    struct split best = {.axis = NO_INDEX};

    if (depth < LIGHT_SAH_DEPTH)
        for (uint32_t axis = 0; axis < 3; axis++)
            split_axis(e, count, axis, &best);
    return best.axis == NO_INDEX ? count / 2 : partition(e, count, &best);
}

static struct part part_of(const struct builder *b, uint32_t first,
                           uint32_t count)
{
    struct cluster c = cluster_all(b->emitters + first, count);
    struct part p = {first, count, cluster_cost(&c)};

    return p;
}

/* Whether `a` is to be split before `b`. */
static bool is_worse(const struct part *a, const struct part *b, uint32_t depth)
{
    if (depth >= LIGHT_SAH_DEPTH || a->cost == b->cost)
        return a->count > b->count;
    return a->cost > b->cost;
}

/* Splits the worst part until there are enough; returns how many there are. */
static uint32_t divide(const struct builder *b, uint32_t first, uint32_t count,
                       uint32_t depth, struct part parts[LIGHT_WIDTH])
{
    uint32_t n = 1;

    parts[0] = part_of(b, first, count);
    while (n < LIGHT_WIDTH) {
        struct part *worst = NULL;
        uint32_t left;

        for (uint32_t i = 0; i < n; i++)
            if (parts[i].count > 1 &&
                (worst == NULL || is_worse(&parts[i], worst, depth)))
                worst = &parts[i];
        if (worst == NULL)
            break;
        left = split(b->emitters + worst->first, worst->count, depth);
        parts[n++] = part_of(b, worst->first + left, worst->count - left);
        *worst = part_of(b, worst->first, left);
    }
    return n;
}

/* Bounds of the emitters, as child i of the node. */
static void fill_child(struct light_node *node, uint32_t i,
                       const struct emitter *e, uint32_t count)
{
    struct cluster c = cluster_all(e, count);
    float length = v3_length(c.axis);
    struct vec3 axis =
        length > 0.0f ? v3_scale(c.axis, 1.0f / length) : e[0].normal;
    float cosine = 1.0f;

    for (uint32_t k = 0; k < count; k++)
        cosine = f_min(cosine, fabsf(v3_dot(axis, e[k].normal)));
    node->x[i] = 0.5f * (c.lo.x + c.hi.x);
    node->y[i] = 0.5f * (c.lo.y + c.hi.y);
    node->z[i] = 0.5f * (c.lo.z + c.hi.z);
    node->radius[i] = f_max(0.5f * v3_length(v3_sub(c.hi, c.lo)), RADIUS_LEAST);
    node->axis_x[i] = axis.x;
    node->axis_y[i] = axis.y;
    node->axis_z[i] = axis.z;
    node->spread[i] = sqrtf(f_max(1.0f - cosine * cosine, 0.0f));
    node->power[i] = (float)c.power;
}

static bool add_node(struct builder *b, uint32_t *index, struct error *err)
{
    struct lights *l = b->lights;
    void *nodes = l->nodes;

    if (!grow_array(&nodes, &b->node_capacity, (size_t)l->node_count + 1,
                    sizeof *l->nodes))
        return fail(err, "out of memory for the tree of %u lights",
                    l->light_count);
    l->nodes = nodes;
    l->nodes[l->node_count] = (struct light_node){.power = {0}};
    for (uint32_t i = 0; i < LIGHT_WIDTH; i++)
        l->nodes[l->node_count].radius[i] = RADIUS_LEAST;
    *index = l->node_count++;
    return true;
}

/* Recursion is at most LIGHT_LEVELS deep. */
static bool build(struct builder *b, uint32_t first, uint32_t count,
                  uint32_t depth, uint32_t *index, struct error *err)
{
    struct part parts[LIGHT_WIDTH];
    uint32_t part_count;

    assert(depth < LIGHT_LEVELS);
    if (!add_node(b, index, err))
        return false;
    part_count = divide(b, first, count, depth, parts);
    for (uint32_t i = 0; i < part_count; i++) {
        struct part p = parts[i];
        uint32_t child;

        fill_child(&b->lights->nodes[*index], i, b->emitters + p.first,
                   p.count);
        for (uint32_t k = p.first; k < p.first + p.count; k++)
            b->lights->lights[b->emitters[k].light]
                .path[depth / (LIGHT_LEVELS / 2)] |=
                i << 3 * (depth % (LIGHT_LEVELS / 2));
        if (p.count == 1)
            child = b->emitters[p.first].light | LIGHT_LEAF;
        else if (!build(b, p.first, p.count, depth + 1, &child, err))
            return false;
        b->lights->nodes[*index].child[i] = child;
    }
    return true;
}

static bool shines(const struct material *m)
{
    return v3_max(m->emission) > 0.0f && m->opacity > 0.0f;
}

bool lights_differ(const struct material *a, const struct material *b)
{
    if (!shines(a) && !shines(b))
        return false;
    return memcmp(&a->emission, &b->emission, sizeof a->emission) != 0 ||
           a->emission_texture != b->emission_texture ||
           a->opacity != b->opacity;
}

/* The mean of the channels: errors of all three count alike. */
static double mean_radiance(const struct world *w, const struct tri *t,
                            const struct footprint_sums *footprints)
{
    const struct material *m = &w->materials[t->material];
    double mean = ((double)m->emission.x + (double)m->emission.y +
                   (double)m->emission.z) /
                  3;

    if (m->emission_texture != NO_INDEX && t->vt[0] != NO_INDEX) {
        const struct footprint_sums *f = &footprints[t->material];
        struct texture texture = w->textures[m->emission_texture];
        struct vec2 uv[3];

        for (int i = 0; i < 3; i++)
            uv[i] = texture_uv(texture, w->uvs[t->vt[i]]);
        /* outside a clamped image a triangle shows its border, who knows how
         * much of it */
        mean = texture.is_clamped != 0 ? footprint_whole(f)
                                       : footprint_mean(f, uv);
    }
    return mean * (double)m->opacity;
}

/* False if the triangle is not worth sampling. *glare grows by its own. */
static bool make_emitter(const struct world *w, uint32_t tri,
                         const struct footprint_sums *footprints,
                         struct emitter *e, double *glare)
{
    const struct tri *t = &w->tris[tri];
    struct vec3 p0 = w->positions[t->v[0]];
    struct vec3 p1 = w->positions[t->v[1]];
    struct vec3 p2 = w->positions[t->v[2]];
    double radiance;
    double twice_area =
        (double)v3_length(v3_cross(v3_sub(p1, p0), v3_sub(p2, p0)));

    if (!(twice_area > AREA_LEAST) || !triangle_normal(p0, p1, p2, &e->normal))
        return false;
    radiance = mean_radiance(w, t, footprints);
    e->power = twice_area * radiance;
    *glare += e->power / 2 * radiance;
    e->lo = v3(f_min(p0.x, f_min(p1.x, p2.x)), f_min(p0.y, f_min(p1.y, p2.y)),
               f_min(p0.z, f_min(p1.z, p2.z)));
    e->hi = v3(f_max(p0.x, f_max(p1.x, p2.x)), f_max(p0.y, f_max(p1.y, p2.y)),
               f_max(p0.z, f_max(p1.z, p2.z)));
    return e->power > 0;
}

/* Finds the emitters among `candidate_count` triangles of shining materials. */
static bool find_emitters(struct builder *b, const struct world *w,
                          uint32_t candidate_count,
                          const struct footprint_sums *footprints,
                          struct error *err)
{
    struct lights *l = b->lights;
    double total = 0;

    b->emitters = alloc_array(candidate_count, sizeof *b->emitters);
    l->lights = alloc_array(candidate_count, sizeof *l->lights);
    l->tri_lights = alloc_array(w->settings.tri_count, sizeof *l->tri_lights);
    if (b->emitters == NULL || l->lights == NULL || l->tri_lights == NULL)
        return fail(err, "out of memory for %u lights", candidate_count);
    for (uint32_t i = 0; i < w->settings.tri_count; i++) {
        struct emitter *e = &b->emitters[l->light_count];

        l->tri_lights[i] = NO_INDEX;
        if (!shines(&w->materials[w->tris[i].material]) ||
            !make_emitter(w, i, footprints, e, &l->glare))
            continue;
        total += e->power;
        l->tri_lights[i] = l->light_count;
        e->light = l->light_count;
        l->lights[l->light_count++].tri = i;
    }
    for (uint32_t i = 0; i < l->light_count; i++)
        b->emitters[i].power = fmax(b->emitters[i].power / total, POWER_LEAST);
    return true;
}

/* One for each material with an emission texture. */
static bool make_footprints(const struct world *w, const bool *is_used,
                            uint32_t material_count,
                            struct footprint_sums *footprints,
                            struct error *err)
{
    for (uint32_t i = 0; i < material_count; i++) {
        const struct material *m = &w->materials[i];

        if (is_used[i] && m->emission_texture != NO_INDEX &&
            !footprint_init(&footprints[i], w, m, err))
            return false;
    }
    return true;
}

static uint32_t count_materials(const struct world *w)
{
    uint32_t count = 0;

    for (uint32_t i = 0; i < w->settings.tri_count; i++)
        if (w->tris[i].material >= count)
            count = w->tris[i].material + 1;
    return count;
}

bool lights_build(struct lights *lights, const struct world *w,
                  struct error *err)
{
    struct builder b = {NULL, lights, 0};
    uint32_t material_count = count_materials(w);
    struct footprint_sums *footprints =
        alloc_array(material_count, sizeof *footprints);
    bool *is_used = alloc_array(material_count, sizeof *is_used);
    uint32_t candidate_count = 0;
    uint32_t root;
    bool ok = false;

    lights_free(lights);
    if (footprints == NULL || is_used == NULL) {
        fail(err, "out of memory for the lights of %u materials",
             material_count);
        goto out;
    }
    for (uint32_t i = 0; i < w->settings.tri_count; i++) {
        uint32_t material = w->tris[i].material;

        is_used[material] = shines(&w->materials[material]);
        candidate_count += is_used[material] ? 1 : 0;
    }
    ok = candidate_count == 0 ||
         (make_footprints(w, is_used, material_count, footprints, err) &&
          find_emitters(&b, w, candidate_count, footprints, err));
    if (ok && lights->light_count > 1)
        ok = build(&b, 0, lights->light_count, 0, &root, err);
out:
    for (uint32_t i = 0; footprints != NULL && i < material_count; i++)
        footprint_free(&footprints[i]);
    free(footprints);
    free(is_used);
    free(b.emitters);
    if (!ok)
        lights_free(lights);
    return ok;
}

/* Light found by chance that falls on a plane has a variance of about pi times
 * power times radiance at distance 1. */
static float light_share(const struct lights *lights, const struct sky *sky)
{
    double radiance =
        ((double)sky->color.x + (double)sky->color.y + (double)sky->color.z) /
        3;
    double ratio = lights->glare / (M_PI * radiance * radiance);

    if (lights->light_count == 0)
        return 0;
    if (sky->width != 0 || !(ratio < GLARE_FULL))
        return 1;
    return (float)fmax(ratio / GLARE_FULL, SHARE_LEAST);
}

void lights_lend(const struct lights *lights, struct world *world)
{
    world->lights = lights->lights;
    world->settings.light_count = lights->light_count;
    world->settings.light_share = light_share(lights, &world->settings.sky);
    world->tri_lights = lights->tri_lights;
    world->light_nodes = lights->nodes;
    world->settings.light_node_count = lights->node_count;
}

void lights_free(struct lights *lights)
{
    free(lights->lights);
    free(lights->tri_lights);
    free(lights->nodes);
    memset(lights, 0, sizeof *lights);
}
