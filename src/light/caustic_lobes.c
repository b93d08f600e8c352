// SPDX-License-Identifier: MIT
#include "light/caustic_lobes.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "light/caustic_fit.h"
#include "light/guide_grid.h"
#include "kernels/caustic_lobes.h"

/* Number of photons, half of which arrive. On a glass ball under the sun half
 * as many leave 15 % more error, and twice as many no less. */
#define PHOTONS 131072u

/* The same for points and single directions, whose caustics are those of rough
 * surfaces. Eight times as many leave the same error on a gold ball, and take
 * six times as long. */
#define PHOTONS_ROUGH 16384u

/* Most photons of a leaf. On that ball a third as many leave 40 % more error,
 * since some of its rays then come from no lobe. */
#define LEAF 24u

/* Least number of photons around a leaf among which those nearest to it are
 * found, also of rare kinds. */
#define AROUND 128u

/* Lobes of a leaf. 12 leave the same error, and take more time. */
#define LOBES 4u

/* Gap between the photons of a leaf and its side, and the margin that stays of
 * it, as parts of the longest side of the photons' box. Beyond it the leaf's
 * share is smaller. */
#define GAP       0.25f
#define MARGIN    0.1f
#define FAR_SHARE 0.1f

/* Margin around all photons, as a part of the longest side of their box. */
#define OUTER_MARGIN 1e-3f

/* Most of a leaf's share. More than a half leaves less error where nothing but
 * the caustic is seen, and more in a pool. */
#define SHARE_MOST 0.5

/* Light of other kinds, as a part of the mean irradiance by all lamps on the
 * box around the scene. */
#define REST 0.5

/* Least variance by a caustic without lobes for which a leaf gets some, as a
 * part of the square of the other light. */
#define VARIANCE_LEAST 0.1

/* Least side of a node's box. */
#define SIDE_LEAST 1e-5f

/* Room for nodes: so many for each photon, and more. A leaf has twelve photons
 * or more, and up to twelve nodes that cut it off; a root has as many. */
#define NODES_EACH 2u
#define NODES_MORE 128u

struct range {
    uint32_t first, count;
};

struct box {
    struct vec3 lo, hi;
};

/* A lobe of the leaf that is being made. */
struct candidate {
    struct caustic_lobe lobe;
    double weight;
    double variance; /* by its light without lobes */
};

struct candidates {
    struct candidate list[AROUND];
    uint32_t count;
};

struct build {
    struct caustic_lobes *to;
    struct landing *landings; /* ordered by their place in the tree */
    struct near_photon near[2 * AROUND];
    size_t lobe_capacity;
    double unit; /* irradiance by a flux of 1 on an area of 1 */
    double rest; /* irradiance by other light */
};

/* ---- leaves ---- */

static int compare_near(const void *a, const void *b)
{
    const struct near_photon *x = a, *y = b;

    if (x->landing->chain != y->landing->chain)
        return x->landing->chain < y->landing->chain ? -1 : 1;
    if (x->square != y->square)
        return x->square < y->square ? -1 : 1;
    return (x->landing > y->landing) - (x->landing < y->landing);
}

static int compare_candidates(const void *a, const void *b)
{
    const struct candidate *x = a, *y = b;

    return (x->weight < y->weight) - (x->weight > y->weight);
}

/* Lists the photons around a leaf by their chains and distances from its
 * middle. Returns their number. */
static uint32_t find_near(struct build *b, struct range leaf,
                          struct range around)
{
    uint32_t count = around.count < 2 * AROUND ? around.count : 2 * AROUND;
    struct vec3 middle = v3(0.0f, 0.0f, 0.0f);

    for (uint32_t i = 0; i < leaf.count; i++)
        middle = v3_add(middle, v3_scale(b->landings[leaf.first + i].p,
                                         1.0f / (float)leaf.count));
    for (uint32_t i = 0; i < count; i++) {
        const struct landing *l = &b->landings[around.first + i];
        struct vec3 way = v3_sub(l->p, middle);

        b->near[i] = (struct near_photon){l, v3_dot(way, way)};
    }
    qsort(b->near, count, sizeof *b->near, compare_near);
    return count;
}

/* Adds the lobes of photons of one chain. A lobe as wide as the image of the
 * light has the variance of the square of its irradiance; a wider one has as
 * many times more. Lobes have least variance together if their weights are the
 * roots. Without lobes the variance is that of the light's radiance. */
static void add_chain(const struct build *b, struct near_photon *near,
                      uint32_t count, double square, struct candidates *to)
{
    struct caustic_parts fit = {.count = 0};

    caustic_fit(near, count, &fit);
    for (uint32_t i = 0; i < fit.count && to->count < AROUND; i++) {
        const struct caustic_part *p = &fit.list[i];
        double e = p->flux * b->unit / (M_PI * square);
        double whole = fmax(e, p->radiance * p->solid_angle);

        to->list[to->count++] = (struct candidate){
            .lobe = p->lobe,
            .weight = sqrt(e * whole),
            .variance = e * fmax(p->radiance, e / p->solid_angle),
        };
    }
}

/* Finds lobes for the photons that are listed, of each chain for the nearest
 * ones. Their density is that of a disc as wide as the leaf or their distance.
 */
static void find_candidates(struct build *b, uint32_t count, float leaf_square,
                            struct candidates *to)
{
    float farthest = leaf_square;
    uint32_t end;

    for (uint32_t i = 0; i < count; i++)
        farthest = f_max(farthest, b->near[i].square);
    for (uint32_t i = 0; i < count; i = end) {
        uint32_t chain = b->near[i].landing->chain, n;
        float square = farthest;

        end = i;
        while (end < count && b->near[end].landing->chain == chain)
            end++;
        n = end - i;
        if (n >= CAUSTIC_FIT_MOST) {
            n = CAUSTIC_FIT_MOST;
            square = f_max(b->near[i + n - 1].square, leaf_square);
        }
        add_chain(b, &b->near[i], n,
                  (double)f_max(square, SIDE_LEAST * SIDE_LEAST), to);
    }
    qsort(to->list, to->count, sizeof *to->list, compare_candidates);
}

/* Adds the first lobes to the arrays, and makes the node their leaf. */
static bool add_lobes(struct build *b, const struct candidates *from,
                      struct caustic_node *node)
{
    uint32_t count = from->count < LOBES ? from->count : LOBES;
    struct caustic_lobes *to = b->to;
    double total = 0, variance = 0, sum = 0;

    for (uint32_t i = 0; i < count; i++) {
        total += from->list[i].weight;
        variance += from->list[i].variance;
    }
    if (!(variance > VARIANCE_LEAST * b->rest * b->rest))
        return true;
    if (!grow_array((void **)&to->lobes, &b->lobe_capacity,
                    to->lobe_count + count, sizeof *to->lobes))
        return false;
    node->split = (float)fmin(total / (total + b->rest), SHARE_MOST);
    node->next = to->lobe_count << 2 | 3u;
    for (uint32_t i = 0; i < count; i++) {
        struct caustic_lobe *lobe = &to->lobes[to->lobe_count++];

        sum += from->list[i].weight / total;
        *lobe = from->list[i].lobe;
        lobe->sum = i + 1 < count ? (float)sum : 1.0f;
    }
    return true;
}

/* ---- the tree ---- */

static struct box box_of(const struct build *b, struct range r)
{
    struct box box = {b->landings[r.first].p, b->landings[r.first].p};

    for (uint32_t i = 1; i < r.count; i++) {
        box.lo = v3_min(box.lo, b->landings[r.first + i].p);
        box.hi = v3_max(box.hi, b->landings[r.first + i].p);
    }
    return box;
}

static void set_axis(struct vec3 *v, uint32_t axis, float x)
{
    *(axis == 0 ? &v->x : axis == 1 ? &v->y : &v->z) = x;
}

/* Splits a node. Returns its lower child; both are leaves without lobes. */
static uint32_t split_node(struct build *b, uint32_t node, uint32_t axis,
                           float at)
{
    uint32_t child = b->to->node_count;

    b->to->node_count += 2;
    b->to->nodes[node] = (struct caustic_node){at, child << 2 | axis};
    b->to->nodes[child].next = b->to->nodes[child + 1].next = NO_INDEX;
    return child;
}

/* Cuts off what is more than `gap` outside of the box of the photons, up to a
 * margin. Returns the node that is left, and the others in cut[]. */
static uint32_t cut_sides(struct build *b, uint32_t node, struct box space,
                          struct box photons, float gap, float margin,
                          uint32_t cut[6], uint32_t *cut_count)
{
    *cut_count = 0;
    for (uint32_t axis = 0; axis < 3; axis++) {
        float lo = v3_axis(photons.lo, axis), hi = v3_axis(photons.hi, axis);

        if (lo - v3_axis(space.lo, axis) > gap) {
            uint32_t child = split_node(b, node, axis, lo - margin);

            cut[(*cut_count)++] = child;
            node = child + 1;
        }
        if (v3_axis(space.hi, axis) - hi > gap) {
            uint32_t child = split_node(b, node, axis, hi + margin);

            cut[(*cut_count)++] = child + 1;
            node = child;
        }
    }
    return node;
}

/* Makes a leaf of the photons of a node. */
static bool make_leaf(struct build *b, uint32_t node, struct range r,
                      struct range around, struct box space)
{
    struct box photons = box_of(b, r);
    struct vec3 size = v3_sub(photons.hi, photons.lo);
    float side = v3_max_component(size);
    struct candidates found = {.count = 0};
    uint32_t cut[6], cut_count, count = find_near(b, r, around);

    find_candidates(b, count, 0.25f * v3_dot(size, size), &found);
    node = cut_sides(b, node, space, photons, GAP * side, MARGIN * side, cut,
                     &cut_count);
    if (!add_lobes(b, &found, &b->to->nodes[node]))
        return false;
    for (uint32_t i = 0; i < cut_count; i++) {
        b->to->nodes[cut[i]] = b->to->nodes[node];
        b->to->nodes[cut[i]].split *= FAR_SHARE;
    }
    return true;
}

static void swap_landings(struct landing *a, struct landing *b)
{
    struct landing swap = *a;

    *a = *b;
    *b = swap;
}

/* Orders landings so that none before number k is above it along the axis, and
 * none behind it is below (Hoare 1961, "Algorithm 65: find"). */
static void select_landing(struct landing *a, uint32_t count, uint32_t k,
                           uint32_t axis)
{
    int64_t lo = 0, hi = (int64_t)count - 1;

    while (lo < hi) {
        float pivot = v3_axis(a[k].p, axis);
        int64_t i = lo, j = hi;

        while (i <= j) {
            while (v3_axis(a[i].p, axis) < pivot)
                i++;
            while (v3_axis(a[j].p, axis) > pivot)
                j--;
            if (i <= j)
                swap_landings(&a[i++], &a[j--]);
        }
        if (j < (int64_t)k)
            lo = i;
        if ((int64_t)k < i)
            hi = j;
    }
}

/* Makes the tree of the photons in the space of a node. `around` is the
 * smallest range with them that has enough photons. */
static bool make_node(struct build *b, uint32_t node, struct range r,
                      struct range around, struct box space)
{
    struct box photons = box_of(b, r), lower = space, upper = space;
    struct vec3 size = v3_sub(photons.hi, photons.lo);
    uint32_t axis = 0, half = r.count / 2, child;
    float at;

    if (r.count >= AROUND)
        around = r;
    if (r.count <= LEAF || !(v3_max_component(size) > SIDE_LEAST))
        return make_leaf(b, node, r, around, space);
    for (uint32_t i = 1; i < 3; i++)
        if (v3_axis(size, i) > v3_axis(size, axis))
            axis = i;
    select_landing(b->landings + r.first, r.count, half, axis);
    at = v3_axis(b->landings[r.first + half].p, axis);
    child = split_node(b, node, axis, at);
    set_axis(&lower.hi, axis, at);
    set_axis(&upper.lo, axis, at);
    return make_node(b, child, (struct range){r.first, half}, around, lower) &&
           make_node(b, child + 1,
                     (struct range){r.first + half, r.count - half}, around,
                     upper);
}

/* Makes the tree of the landings in a range, on surfaces of one class. */
static bool make_root(struct build *b, uint32_t facing, struct range r)
{
    const struct vec3 all = v3(FLOAT_MAX, FLOAT_MAX, FLOAT_MAX);
    struct box photons = box_of(b, r);
    float margin =
        OUTER_MARGIN * v3_max_component(v3_sub(photons.hi, photons.lo));
    uint32_t cut[6], cut_count;
    uint32_t node = cut_sides(b, facing, (struct box){v3_neg(all), all},
                              photons, 0.0f, margin, cut, &cut_count);

    return make_node(b, node, r, r, photons);
}

/* Copies the landings in the order of their classes of normals. Returns the
 * number of a class. */
static uint32_t copy_landings(const struct photons *p, uint32_t facing,
                              struct landing *to)
{
    uint32_t count = 0;

    for (uint32_t i = 0; i < p->landing_count; i++)
        if (p->landings[i].flux > 0.0f &&
            guide_facing(p->landings[i].n) == facing)
            to[count++] = p->landings[i];
    return count;
}

static bool make_trees(struct build *b, const struct photons *p)
{
    struct range r = {0, 0};

    b->landings = alloc_array(p->landing_count, sizeof *b->landings);
    b->to->nodes =
        alloc_array((size_t)p->landing_count * NODES_EACH + NODES_MORE,
                    sizeof *b->to->nodes);
    if (b->landings == NULL || b->to->nodes == NULL)
        return false;
    b->to->node_count = GUIDE_FACINGS;
    for (uint32_t i = 0; i < GUIDE_FACINGS; i++) {
        b->to->nodes[i].next = NO_INDEX;
        r.count = copy_landings(p, i, &b->landings[r.first]);
        if (r.count > 0 && !make_root(b, i, r))
            return false;
        r.first += r.count;
    }
    return true;
}

static bool build(struct caustic_lobes *to, const struct bvh8_world *w,
                  const struct lights *lights, struct pool *pool,
                  struct photons *p)
{
    struct guide_grid grid;
    double box = guide_grid_init(&grid, &w->world, NULL);
    uint32_t count = photons_need_rough(&w->world, PHOTONS_OF_LAMPS)
                         ? PHOTONS_ROUGH
                         : PHOTONS;
    struct build b = {.to = to};
    bool ok =
        photons_trace(w, lights, PHOTONS_OF_LAMPS, count, 1, box, pool, p);

    b.unit = p->power * p->caster_area / count;
    b.rest = REST * 2 * M_PI * p->power / box;
    ok = ok && make_trees(&b, p);
    free(b.landings);
    return ok;
}

bool caustic_lobes_build(struct caustic_lobes *lobes,
                         const struct bvh8_world *w,
                         const struct lights *lights, struct pool *pool)
{
    struct caustic_lobes made = {.nodes = NULL};
    struct photons photons = {.landings = NULL};
    bool ok = build(&made, w, lights, pool, &photons);

    photons_free(&photons);
    if (!ok || made.lobe_count == 0)
        caustic_lobes_free(&made);
    if (!ok)
        return false;
    caustic_lobes_free(lobes);
    *lobes = made;
    return true;
}

void caustic_lobes_lend(const struct caustic_lobes *l, struct world *world)
{
    world->settings.caustic_node_count = l->node_count;
    world->settings.caustic_lobe_count = l->lobe_count;
    world->caustic_nodes = l->nodes;
    world->caustic_lobes = l->lobes;
}

void caustic_lobes_free(struct caustic_lobes *l)
{
    free(l->nodes);
    free(l->lobes);
    *l = (struct caustic_lobes){.nodes = NULL};
}
