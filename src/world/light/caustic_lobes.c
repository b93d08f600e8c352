// SPDX-License-Identifier: MIT
#include "world/light/caustic_lobes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "world/light/guide_grid.h"
#include "world/light/photons.h"
#include "kernels/caustic_lobes.h"
#include "kernels/vec.h"

/* Most photons of a fit. */
#define CAUSTIC_FIT_MAX 48u

/* Most lobes of one place. */
#define CAUSTIC_LOBES_MAX 32u

/* A photon near a place. */
struct near_photon {
    const struct landing *landing;
    float square; /* of the distance */
};

/* A lobe, whose sum is not set, and its photons. */
struct caustic_part {
    struct caustic_lobe lobe;
    double flux;        /* sum */
    double radiance;    /* mean, by flux */
    double solid_angle; /* that of the lobe, seen from where they landed */
};

struct caustic_parts {
    struct caustic_part list[CAUSTIC_LOBES_MAX];
    uint32_t count;
};

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
#define SHARE_MAX 0.5

/* Light of other kinds, as a part of the mean irradiance by all lamps on the
 * box around the scene. */
#define REST 0.5

/* Least variance by a caustic without lobes for which a leaf gets some, as a
 * part of the square of the other light. */
#define VARIANCE_MIN 0.1

/* Least side of a node's box. */
#define SIDE_MIN 1e-5f

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

/* ---- fitting lobes ---- */

/* Least number of photons of which two lobes are made in place of one. */
#define PART_MIN 6u

/* Logarithm of the likelihood that two lobes have to gain: for each photon, and
 * for the numbers that they are more. */
#define GAIN_EACH 0.3
#define GAIN      2.0

/* Photons that a lobe needs to move with the place, and the numbers that are
 * fitted to them. */
#define MOVING_MIN 5u
#define MOVING     3.0

/* Damping of these numbers, relative to the squared extent of the landings. */
#define DAMPING 1e-3

/* Residuals that are assumed beside the photons' own: their number, and their
 * size relative to the extent of the landings. On a glass ball under the sun
 * twice the size leaves 10 % more error, half of it as much. */
#define PRIOR_COUNT 2.0
#define PRIOR_SIZE  0.05

/* Least size of residuals relative to the distance, so that floats suffice. */
#define SIZE_MIN 1e-5

/* Factor from the residuals' covariance to the lobe. A disc of light is sampled
 * best with 2.3. */
#define WIDENING 2.0

/* Least height of the caster over a photon's landing, and cosine of its way, in
 * the direction of the lobe and relative to the lobe's height. */
#define SLANT_MIN 0.05f

/* A fit of one lobe. Coordinates on its plane are those along x and y. */
struct fit {
    struct vec3 p, q; /* means of landings and of where they came from */
    struct vec3 axis, x, y;
    double distance;                     /* from p to q */
    struct vec2 places[CAUSTIC_FIT_MAX]; /* where photons meet the plane */
    double weights[CAUSTIC_FIT_MAX];     /* have a sum of 1 */
    double middle[2];                    /* mean place */
    struct vec3 dx, dy;                  /* change of the places with p */
    double extent;                       /* mean squared distance from p */
    double xx, xy, yy;                   /* covariance of the residuals */
};

/* Sets the plane and the photons' places on it. Returns false if they come from
 * too many directions for one plane. */
static bool fit_plane(const struct near_photon *near, uint32_t n, struct fit *f)
{
    double sum = 0;

    memset(f, 0, sizeof *f);
    for (uint32_t i = 0; i < n; i++)
        sum += (double)near[i].landing->flux;
    for (uint32_t i = 0; i < n; i++) {
        const struct landing *l = near[i].landing;

        f->weights[i] = (double)l->flux / sum;
        f->p = v3_add(f->p, v3_scale(l->p, (float)f->weights[i]));
        f->q = v3_add(f->q, v3_scale(l->from, (float)f->weights[i]));
    }
    f->axis = v3_sub(f->q, f->p);
    f->distance = (double)v3_length(f->axis);
    if (!(f->distance > 1e-6))
        return false;
    f->axis = v3_unit(f->axis);
    frame_around(f->axis, &f->x, &f->y);
    for (uint32_t i = 0; i < n; i++) {
        const struct landing *l = near[i].landing;
        struct vec3 to = v3_sub(f->q, l->p), at;
        float height = v3_dot(to, f->axis), cosine = v3_dot(l->wi, f->axis);

        if (!(height > SLANT_MIN * (float)f->distance && cosine > SLANT_MIN))
            return false;
        at = v3_sub(v3_scale(l->wi, height / cosine), to);
        f->places[i] = v2(v3_dot(at, f->x), v3_dot(at, f->y));
        f->middle[0] += f->weights[i] * (double)f->places[i].x;
        f->middle[1] += f->weights[i] * (double)f->places[i].y;
    }
    return true;
}

/* Solves the symmetric equations m x = y for x. m is positive definite. */
static struct vec3 solve(double m[3][3], const double y[3])
{
    double a[3][4], x[3];

    for (int i = 0; i < 3; i++) {
        memcpy(a[i], m[i], sizeof m[i]);
        a[i][3] = y[i];
    }
    for (int i = 0; i < 3; i++)
        for (int j = i + 1; j < 3; j++)
            for (int k = 3; k >= i; k--)
                a[j][k] -= a[i][k] * a[j][i] / a[i][i];
    for (int i = 2; i >= 0; i--) {
        x[i] = a[i][3];
        for (int k = i + 1; k < 3; k++)
            x[i] -= a[i][k] * x[k];
        x[i] /= a[i][i];
    }
    return v3((float)x[0], (float)x[1], (float)x[2]);
}

/* Sets the change of places with the landings, by least squares. */
static void fit_moves(const struct near_photon *near, uint32_t n, struct fit *f)
{
    double m[3][3] = {{0}}, y[2][3] = {{0}};

    for (uint32_t i = 0; i < n; i++) {
        struct vec3 way = v3_sub(near[i].landing->p, f->p);
        double w = f->weights[i];
        double of[3] = {(double)way.x, (double)way.y, (double)way.z};

        for (int j = 0; j < 3; j++) {
            for (int k = 0; k < 3; k++)
                m[j][k] += w * of[j] * of[k];
            y[0][j] += w * of[j] * ((double)f->places[i].x - f->middle[0]);
            y[1][j] += w * of[j] * ((double)f->places[i].y - f->middle[1]);
        }
    }
    f->extent = m[0][0] + m[1][1] + m[2][2];
    if (n < MOVING_MIN || !(f->extent > 0))
        return;
    for (int j = 0; j < 3; j++)
        m[j][j] += DAMPING * f->extent;
    f->dx = solve(m, y[0]);
    f->dy = solve(m, y[1]);
}

/* Difference of a photon's place from the fitted one. */
static struct vec2 residual(const struct fit *f, const struct near_photon *near,
                            uint32_t i)
{
    struct vec3 way = v3_sub(near[i].landing->p, f->p);

    return v2(f->places[i].x - (float)f->middle[0] - v3_dot(f->dx, way),
              f->places[i].y - (float)f->middle[1] - v3_dot(f->dy, way));
}

/* Sets the covariance of the residuals. */
static void fit_widths(const struct near_photon *near, uint32_t n,
                       struct fit *f)
{
    double free = n - (n < MOVING_MIN ? 1 : MOVING);
    double own = n / (free + PRIOR_COUNT);
    double least = SIZE_MIN * SIZE_MIN * f->distance * f->distance;
    double prior = PRIOR_SIZE * PRIOR_SIZE * f->extent + least;

    for (uint32_t i = 0; i < n; i++) {
        struct vec2 r = residual(f, near, i);
        double w = own * f->weights[i];

        f->xx += w * (double)(r.x * r.x);
        f->xy += w * (double)(r.x * r.y);
        f->yy += w * (double)(r.y * r.y);
    }
    f->xx += prior * PRIOR_COUNT / (free + PRIOR_COUNT);
    f->yy += prior * PRIOR_COUNT / (free + PRIOR_COUNT);
}

static bool fit_one(const struct near_photon *near, uint32_t n, struct fit *f)
{
    if (!fit_plane(near, n, f))
        return false;
    fit_moves(near, n, f);
    fit_widths(near, n, f);
    return true;
}

/* Area of a lobe on its plane, without constant factors. */
static double fit_area(const struct fit *f)
{
    return sqrt(fmax(f->xx * f->yy - f->xy * f->xy, 1e-12 * f->xx * f->yy));
}

static struct vec3 combine(double a, struct vec3 x, double b, struct vec3 y)
{
    return v3_add(v3_scale(x, (float)a), v3_scale(y, (float)b));
}

static double dot(struct vec3 a, struct vec3 b)
{
    return (double)a.x * (double)b.x + (double)a.y * (double)b.y +
           (double)a.z * (double)b.z;
}

/* The coordinates along x and y are divided by the Cholesky factor of the
 * covariance. */
static struct caustic_lobe lobe_of(const struct fit *f)
{
    double xx = sqrt(WIDENING * f->xx);
    double yx = WIDENING * f->xy / xx;
    double yy = WIDENING * fit_area(f) / xx;
    double a = 1 / xx, b = -yx / (xx * yy), c = 1 / yy;
    struct vec3 move_x = v3_sub(f->x, f->dx), move_y = v3_sub(f->y, f->dy);
    double x0 = dot(f->dx, f->p) - dot(f->x, f->q) - f->middle[0];
    double y0 = dot(f->dy, f->p) - dot(f->y, f->q) - f->middle[1];

    return (struct caustic_lobe){
        .axis = f->axis,
        .height = (float)dot(f->axis, f->q),
        .u = v3_scale(f->x, (float)a),
        .v = combine(b, f->x, c, f->y),
        .du = v3_scale(move_x, (float)a),
        .dv = combine(b, move_x, c, move_y),
        .u0 = (float)(a * x0),
        .v0 = (float)(b * x0 + c * y0),
        .scale = (float)(a * c / M_PI),
    };
}

static void add_part(const struct near_photon *near, uint32_t n,
                     const struct fit *f, struct caustic_parts *parts)
{
    struct caustic_part *part = &parts->list[parts->count];

    if (parts->count == CAUSTIC_LOBES_MAX)
        return;
    *part = (struct caustic_part){
        .lobe = lobe_of(f),
        .solid_angle =
            M_PI * WIDENING * fit_area(f) / (f->distance * f->distance),
    };
    for (uint32_t i = 0; i < n; i++) {
        part->flux += (double)near[i].landing->flux;
        part->radiance += f->weights[i] * (double)near[i].landing->radiance;
    }
    parts->count++;
}

/* Divides the photons at the middle of the residuals' longest axis. Returns the
 * number of those before it. */
static uint32_t divide(struct near_photon *near, uint32_t n,
                       const struct fit *f)
{
    double angle = .5 * atan2(2 * f->xy, f->xx - f->yy);
    struct vec2 axis = v2((float)cos(angle), (float)sin(angle));
    struct near_photon behind[CAUSTIC_FIT_MAX];
    uint32_t before_count = 0, behind_count = 0;

    for (uint32_t i = 0; i < n; i++) {
        struct vec2 r = residual(f, near, i);

        if (r.x * axis.x + r.y * axis.y < 0.0f)
            near[before_count++] = near[i];
        else
            behind[behind_count++] = near[i];
    }
    memcpy(near + before_count, behind, behind_count * sizeof *behind);
    return before_count;
}

/* Likelihood of a part of a mixture at its photons, as a logarithm. */
static double likelihood(const struct fit *f, uint32_t n, uint32_t all)
{
    return n * (log((double)n / all) - log(fit_area(f)));
}

/* Divides the photons into `*first` and the rest. Returns false if one lobe
 * suits them as well. */
static bool is_divided(struct near_photon *near, uint32_t n,
                       const struct fit *whole, uint32_t *first)
{
    struct fit a, b;
    uint32_t rest;

    if (n < 2 * PART_MIN)
        return false;
    *first = divide(near, n, whole);
    rest = n - *first;
    return *first >= PART_MIN && rest >= PART_MIN &&
           fit_one(near, *first, &a) && fit_one(near + *first, rest, &b) &&
           likelihood(&a, *first, n) + likelihood(&b, rest, n) >
               likelihood(whole, n, n) + GAIN_EACH * n + GAIN;
}

/* Adds lobes for photons that have met the same kinds of surfaces: one, or
 * several if that suits them better. Changes the order of the photons. Lobes
 * beyond the most are left out. */
static void caustic_fit(struct near_photon *near, uint32_t count,
                        struct caustic_parts *parts)
{
    struct fit whole;
    bool ok = fit_one(near, count, &whole);
    uint32_t first = count / 2;

    if (ok && !is_divided(near, count, &whole, &first)) {
        add_part(near, count, &whole, parts);
    } else if (count > 1) {
        caustic_fit(near, first, parts);
        caustic_fit(near + first, count - first, parts);
    }
}

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
        if (n >= CAUSTIC_FIT_MAX) {
            n = CAUSTIC_FIT_MAX;
            square = f_max(b->near[i + n - 1].square, leaf_square);
        }
        add_chain(b, &b->near[i], n, (double)f_max(square, SIDE_MIN * SIDE_MIN),
                  to);
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
    if (!(variance > VARIANCE_MIN * b->rest * b->rest))
        return true;
    if (!grow_array((void **)&to->lobes, &b->lobe_capacity,
                    to->lobe_count + count, sizeof *to->lobes))
        return false;
    node->split = (float)fmin(total / (total + b->rest), SHARE_MAX);
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
 * margin. */
struct cut {
    float gap, margin;
    uint32_t nodes[6], count; /* what is cut off */
};

/* Returns the node that is left. */
static uint32_t cut_sides(struct build *b, uint32_t node, struct box space,
                          struct box photons, struct cut *c)
{
    for (uint32_t axis = 0; axis < 3; axis++) {
        float lo = v3_axis(photons.lo, axis), hi = v3_axis(photons.hi, axis);

        if (lo - v3_axis(space.lo, axis) > c->gap) {
            uint32_t child = split_node(b, node, axis, lo - c->margin);

            c->nodes[c->count++] = child;
            node = child + 1;
        }
        if (v3_axis(space.hi, axis) - hi > c->gap) {
            uint32_t child = split_node(b, node, axis, hi + c->margin);

            c->nodes[c->count++] = child + 1;
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
    struct cut cut = {.gap = GAP * side, .margin = MARGIN * side};
    uint32_t count = find_near(b, r, around);

    find_candidates(b, count, 0.25f * v3_dot(size, size), &found);
    node = cut_sides(b, node, space, photons, &cut);
    if (!add_lobes(b, &found, &b->to->nodes[node]))
        return false;
    for (uint32_t i = 0; i < cut.count; i++) {
        b->to->nodes[cut.nodes[i]] = b->to->nodes[node];
        b->to->nodes[cut.nodes[i]].split *= FAR_SHARE;
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
    if (r.count <= LEAF || !(v3_max_component(size) > SIDE_MIN))
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
    struct cut cut = {.margin =
                          OUTER_MARGIN *
                          v3_max_component(v3_sub(photons.hi, photons.lo))};
    uint32_t node =
        cut_sides(b, facing, (struct box){v3_neg(all), all}, photons, &cut);

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
    const struct photon_plan plan = {PHOTONS_OF_LAMPS, count, 1, box};
    bool ok = photons_trace(w, lights, &plan, pool, p);

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
