// SPDX-License-Identifier: MIT
#include "world/light/sky_portals.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "image/color.h"
#include "world/bvh/ray_queries.h"
#include "world/light/triangle_cdf.h"
#include "kernels/guide.h"
#include "kernels/light.h"
#include "kernels/rng.h"
#include "kernels/sample.h"
#include "kernels/texture.h"

/* Probes, on either side of surfaces by area, and rays of a probe. */
#define PROBES     4096u
#define PROBE_RAYS 16u

/* Instances that a ray may have to look at with all probes, which take half a
 * second of processor time there; 20,000 in one place took 40 s. The shipped
 * forest has 4. */
#define OVERLAP_MAX 256.0

/* A probe is enclosed if no more of its rays see the sky. With 4 an arcade has
 * 5 % less error, and objects under the sky 8 % more. */
#define OPEN_RAYS 2u

/* One probe ray in so many is continued from the surface that it hits. */
#define BOUNCE_EVERY 4u

/* Portal rays of each enclosed probe. In a room four times as many probes and
 * portal rays leave 4 % less error. */
#define PORTAL_RAYS 32u

/* Panes of glass that rays pass, without refraction, and the result where the
 * sky is not seen. */
#define PANES  4
#define HIDDEN (-1)

/* Limit on the light of all bounces as a multiple of the first, in a white room
 * without portals. */
#define BOUNCES_MAX 1000.0

/* Weight, in rays, of the mean over all cells in a cell's estimate. */
#define MEAN_BOUNCES 16.0

/* Dimensions and key of the search, so that its random numbers are not shared
 * with pixel samples. */
#define PORTALS_KEY       0x3c6ef372u
#define PORTALS_DIMENSION 0x20000u

enum decision {
    DECISION_TRI,
    DECISION_POINT,
    DECISION_SIDE,
    DECISION_DIRECTION,
    DECISION_BOUNCE,
    DECISION_PORTAL
};

/* The position of a probe, on one side of a surface. */
struct probe_point {
    struct hit at;
    struct ray ray; /* with its origin there */
    struct vec3 n;
    uint32_t cell;
};

/* The point where a probe ray leaves the box around the scene, and the axis of
 * that side. */
struct portal_point {
    struct vec3 at;
    uint32_t axis;
};

/* A probe and the results of its rays. */
struct visibility_probe {
    struct probe_point point;
    uint32_t seen;                          /* rays that see the sky */
    struct portal_point portals[OPEN_RAYS]; /* of the first of them */
    uint32_t bounces, lit; /* rays continued; those of them that then see it */
};

/* Sky radiance found along one ray from a probe to a portal, and the bin of its
 * direction. */
struct portal_ray {
    uint32_t bin;
    float flux;
    bool is_glazed; /* it passes panes of glass */
};

struct search {
    const struct world *w;
    uint32_t probe_count;
    const struct guide_grid *grid;
    struct sky_portals *found;
    struct triangle_cdf surfaces;
    struct visibility_probe *probes; /* all */
    struct probe_point *points;      /* of enclosed probes */
    uint32_t point_count;
    struct portal_point *portals;
    uint32_t portal_count;
    struct portal_ray *portal_rays; /* PORTAL_RAYS of each point */
    /* of each cell: probes, enclosed probes, their rays that were continued,
     * and those of them that see the sky */
    float *probe_counts, *enclosed, *bounces, *lit;
};

static struct vec2 probe_2d(uint32_t i, enum decision decision)
{
    struct sampler s = {PORTALS_KEY, reverse_bits(i)};

    return random_2d(s, PORTALS_DIMENSION + (uint32_t)decision);
}

/* Sets the origin of the ray at the hit, on the side of its face that `side`
 * points to. Returns the face's normal on that side. */
static struct vec3 leave_surface(const struct world *w, struct hit h,
                                 struct vec3 side, struct ray *r)
{
    struct placed_tri t = tri_placed(w, h.tri);
    struct vec3 n = t.t.ng, at, error;

    if (v3_dot(n, side) < 0.0f)
        n = v3_neg(n);
    at = hit_point_inset(h, t.p[0], t.p[1], t.p[2], &error);
    r->o = offset_ray_origin(at, error, n);
    r->from = h.tri + 1;
    return n;
}

static bool is_glass(const struct material *m)
{
    return m->kind == MATERIAL_GLASS || m->kind == MATERIAL_THIN_GLASS;
}

/* Returns the number of panes between the ray and the sky, or HIDDEN. *h is the
 * hit that hides it; h->tri is NO_INDEX where there are too many panes. */
static int panes_to_sky(const struct world *w, struct ray r, struct hit *h)
{
    r.t_max = FLOAT_MAX;
    for (int i = 0; i <= PANES; i++) {
        if (!hit_closest(w, r, h))
            return i;
        if (!is_glass(&w->materials[tri_placed(w, h->tri).t.material]))
            return HIDDEN;
        leave_surface(w, *h, r.d, &r);
    }
    h->tri = NO_INDEX;
    return HIDDEN;
}

/* Returns true if the surface that a probe ray has hit sees the sky in a random
 * direction. */
static bool is_lit(const struct world *w, struct ray probe_ray, struct hit h,
                   uint32_t i)
{
    struct ray r = probe_ray;

    if (h.tri == NO_INDEX)
        return false;
    r.d = cosine_around(leave_surface(w, h, v3_neg(probe_ray.d), &r),
                        probe_2d(i, DECISION_BOUNCE));
    return panes_to_sky(w, r, &h) != HIDDEN;
}

static struct portal_point exit_box(const struct guide_grid *g, struct ray r)
{
    const float o[3] = {r.o.x - g->lo.x, r.o.y - g->lo.y, r.o.z - g->lo.z};
    const float d[3] = {r.d.x, r.d.y, r.d.z};
    const uint32_t cells[3] = {g->width, g->height, g->depth};
    struct portal_point m = {r.o, 0};
    float least = FLOAT_MAX;

    for (uint32_t k = 0; k < 3; k++) {
        float end = d[k] > 0.0f ? (float)cells[k] / g->cells_per_unit : 0.0f;
        float t = d[k] == 0.0f ? FLOAT_MAX : (end - o[k]) / d[k];

        if (t < least) {
            least = t;
            m.axis = k;
        }
    }
    m.at = v3_add(r.o, v3_scale(r.d, f_max(least, 0.0f)));
    return m;
}

static void trace_probe_ray(const struct search *s, struct visibility_probe *l,
                            uint32_t k)
{
    const struct world *w = s->w;
    struct ray *r = &l->point.ray;
    struct hit met;
    bool is_blocked;

    r->d = cosine_around(l->point.n, probe_2d(k, DECISION_DIRECTION));
    is_blocked = panes_to_sky(w, *r, &met) == HIDDEN;
    if (!is_blocked && l->seen++ < OPEN_RAYS)
        l->portals[l->seen - 1] = exit_box(s->grid, *r);
    if (k % BOUNCE_EVERY == 0) {
        l->bounces++;
        l->lit += is_blocked && is_lit(w, *r, met, k) ? 1 : 0;
    }
}

static void trace_probe(void *context, uint32_t i, int worker)
{
    const struct search *s = context;
    struct vec2 side = probe_2d(i, DECISION_SIDE);
    struct visibility_probe *l = &s->probes[i];
    struct probe_point *p = &l->point;

    (void)worker;
    p->at = triangle_point(probe_2d(i, DECISION_POINT));
    p->at.tri = triangle_cdf_choose(&s->surfaces, probe_2d(i, DECISION_TRI).x);
    p->ray.key = hash_u32(i);
    p->n = leave_surface(s->w, p->at,
                         guide_direction(side.x * (float)GUIDE_SIDE,
                                         side.y * (float)GUIDE_SIDE),
                         &p->ray);
    p->cell = guide_cell_index(s->grid, p->ray.o, p->n);
    for (uint32_t k = i * PROBE_RAYS; k < (i + 1) * PROBE_RAYS; k++)
        trace_probe_ray(s, l, k);
}

/* Adds a probe to the sums of its cell and, if it is enclosed, to the points of
 * the search. */
static void keep_probe(struct search *s, const struct visibility_probe *l)
{
    uint32_t cell = l->point.cell;

    s->probe_counts[cell]++;
    if (l->seen > OPEN_RAYS)
        return;
    s->enclosed[cell]++;
    s->bounces[cell] += (float)l->bounces;
    s->lit[cell] += (float)l->lit;
    s->points[s->point_count++] = l->point;
    for (uint32_t i = 0; i < l->seen; i++)
        s->portals[s->portal_count++] = l->portals[i];
}

/* Traces a ray to a portal point. Its flux stands for the part of the portal
 * around the point. */
static struct portal_ray trace_portal_ray(const struct search *s,
                                          const struct probe_point *p,
                                          const struct portal_point *m)
{
    float cell = 1.0f / s->grid->cells_per_unit;
    struct vec3 d = v3_sub(m->at, p->ray.o);
    float distance2 = v3_dot(d, d), cosine;
    struct ray r = p->ray;
    struct portal_ray b = {0, 0.0f, false};
    struct hit met;
    int panes;

    if (!(distance2 > 0.0f))
        return b;
    r.d = v3_unit(d);
    cosine = v3_dot(r.d, p->n);
    if (!(cosine > 0.0f))
        return b;
    panes = panes_to_sky(s->w, r, &met);
    if (panes != HIDDEN) {
        b.is_glazed = panes > 0;
        b.bin = guide_bin(r.d);
        b.flux =
            cosine * fabsf(v3_axis(r.d, m->axis)) / (distance2 + cell * cell);
    }
    return b;
}

static void trace_portal_rays(void *context, uint32_t i, int worker)
{
    const struct search *s = context;

    (void)worker;
    for (uint32_t k = i * PORTAL_RAYS; k < (i + 1) * PORTAL_RAYS; k++) {
        float u = probe_2d(k, DECISION_PORTAL).x;

        s->portal_rays[k] = trace_portal_ray(
            s, &s->points[i],
            &s->portals[(uint32_t)(u * (float)s->portal_count)]);
    }
}

static void add_portal_rays(struct search *s)
{
    for (uint32_t k = 0; k < s->point_count * PORTAL_RAYS; k++) {
        const struct portal_ray *b = &s->portal_rays[k];
        struct guide_flux *part =
            b->is_glazed ? &s->found->glazed : &s->found->open;
        size_t cell = s->points[k / PORTAL_RAYS].cell;

        part->flux[cell * GUIDE_BINS + b->bin] += b->flux;
    }
}

static double sum_of(const float *numbers, size_t count)
{
    double sum = 0;

    for (size_t i = 0; i < count; i++)
        sum += (double)numbers[i];
    return sum;
}

/* Turns a cell's sums into means over its enclosed probes; the flux is scaled
 * by `scale`. Light of other kinds is what bounces, and all light at probes of
 * the cell that are in the open, which are not to be guided. */
static void finish_cell(struct search *s, uint32_t cell, double scale)
{
    struct sky_portals *o = s->found;
    struct guide_flux *parts[2] = {&o->open, &o->glazed};
    double all = (double)s->probe_counts[cell] / (double)s->enclosed[cell];
    double totals[2] = {0, 0};

    for (int i = 0; i < 2 && parts[i]->flux != NULL; i++) {
        float *flux = parts[i]->flux + (size_t)cell * GUIDE_BINS;

        for (uint32_t k = 0; k < GUIDE_BINS; k++)
            flux[k] *= (float)(scale / (double)s->enclosed[cell]);
        totals[i] = guide_flux_total(parts[i], cell);
    }
    for (int i = 0; i < 2 && parts[i]->flux != NULL; i++)
        parts[i]->rest[cell] =
            (float)(all * (totals[0] + totals[1]) - totals[i]);
    o->bounced[cell] =
        (float)(all * ((double)s->lit[cell] + MEAN_BOUNCES * o->escape) /
                ((double)s->bounces[cell] + MEAN_BOUNCES));
}

/* Scales the flux so that all portal rays together see as much of the sky as
 * all probe rays. */
static void finish(struct search *s)
{
    struct sky_portals *o = s->found;
    uint32_t count = guide_cell_count(s->grid);
    double found = (double)s->portal_count / PROBE_RAYS;
    double arrived = sum_of(o->open.flux, (size_t)count * GUIDE_BINS);

    if (o->glazed.flux != NULL)
        arrived += sum_of(o->glazed.flux, (size_t)count * GUIDE_BINS);
    if (!(arrived > 0))
        return;
    o->escape = sum_of(s->lit, count) / sum_of(s->bounces, count);
    for (uint32_t i = 0; i < count; i++)
        if (s->enclosed[i] > 0.0f)
            finish_cell(s, i, found / arrived);
    for (uint32_t i = 0; i < s->point_count; i++)
        o->walls[o->wall_count++] = s->points[i].at;
}

static bool has_glass(const struct world *w)
{
    bool has = false;

    for (uint32_t i = 0; i < w->settings.material_count && !has; i++)
        has = is_glass(&w->materials[i]);
    return has;
}

static bool portals_init(struct sky_portals *o, const struct world *w,
                         const struct guide_grid *grid)
{
    o->bounced = alloc_array(guide_cell_count(grid), sizeof *o->bounced);
    o->walls = alloc_array(PROBES, sizeof *o->walls);
    return o->bounced != NULL && o->walls != NULL &&
           guide_flux_init(&o->open, grid) &&
           (!has_glass(w) || guide_flux_init(&o->glazed, grid));
}

static bool search_init(struct search *s, struct pool *pool)
{
    const struct world *w = s->w;
    uint32_t count = guide_cell_count(s->grid);

    s->probes = alloc_array(PROBES, sizeof *s->probes);
    s->points = alloc_array(PROBES, sizeof *s->points);
    s->portals = alloc_array((size_t)PROBES * OPEN_RAYS, sizeof *s->portals);
    s->portal_rays =
        alloc_array((size_t)PROBES * PORTAL_RAYS, sizeof *s->portal_rays);
    s->probe_counts = alloc_array(count, sizeof *s->probe_counts);
    s->enclosed = alloc_array(count, sizeof *s->enclosed);
    s->bounces = alloc_array(count, sizeof *s->bounces);
    s->lit = alloc_array(count, sizeof *s->lit);
    return s->probes != NULL && s->points != NULL && s->portals != NULL &&
           s->portal_rays != NULL && s->probe_counts != NULL &&
           s->enclosed != NULL && s->bounces != NULL && s->lit != NULL &&
           triangle_cdf_of_areas(&s->surfaces, w, pool);
}

/* Traces in parallel, and adds the results in the order of probes. */
static void find(struct search *s, struct pool *pool)
{
    pool_each(pool, s->probe_count, trace_probe, s);
    for (uint32_t i = 0; i < s->probe_count; i++)
        keep_probe(s, &s->probes[i]);
    if (s->portal_count == 0)
        return;
    pool_each(pool, s->point_count, trace_portal_rays, s);
    add_portal_rays(s);
    finish(s);
}

bool sky_portals_find(const struct world *w, const struct guide_grid *grid,
                      double overlap, struct pool *pool,
                      struct sky_portals *portals)
{
    struct search s = {.w = w,
                       .probe_count =
                           (uint32_t)(PROBES / fmax(overlap / OVERLAP_MAX, 1)),
                       .grid = grid,
                       .found = portals};
    bool ok = portals_init(portals, w, grid) && search_init(&s, pool);

    if (ok)
        find(&s, pool);
    triangle_cdf_free(&s.surfaces);
    free(s.probes);
    free(s.points);
    free(s.portals);
    free(s.portal_rays);
    free(s.probe_counts);
    free(s.enclosed);
    free(s.bounces);
    free(s.lit);
    return ok;
}

static double color_at(const struct world *w, struct hit h)
{
    struct tri t = tri_at(w, h.tri, instance_of(w, h.tri));
    const struct material *m = &w->materials[t.material];
    struct vec3 c = m->color;

    if (m->color_texture != NO_INDEX && t.vt[0] != NO_INDEX)
        c = v3_mul(c, texture_at(w, m->color_texture,
                                 texture_uv_at(w, m->color_texture, t, h))
                          .color);
    return color_mean(c);
}

/* The series of bounces between walls that all see each other alike: a part of
 * the light escapes, and the walls reflect their albedo of the rest. */
double sky_portals_bounces(const struct sky_portals *o, const struct world *w)
{
    double color = 0;

    for (uint32_t i = 0; i < o->wall_count; i++)
        color += color_at(w, o->walls[i]) / o->wall_count;
    return color / fmax(1 - color * (1 - o->escape), 1 / BOUNCES_MAX);
}

void sky_portals_free(struct sky_portals *o)
{
    guide_flux_free(&o->open);
    guide_flux_free(&o->glazed);
    free(o->bounced);
    free(o->walls);
    *o = (struct sky_portals){.bounced = NULL};
}
