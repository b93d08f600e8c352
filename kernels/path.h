// SPDX-License-Identifier: MIT
/*
 * path.h - one sample of a pixel: a path from the eye
 *
 * The estimator of Kajiya 1986, "The rendering equation", with Russian roulette
 * by throughput. path_extend() is the body of its loop: emission, light
 * sample, scattering, roulette, next hit. Direct light is that of
 * path_lights.h.
 *
 * The ray queries are supplied by a file that is included first, traverse.h or
 * a faster one that finds the same hits:
 *     bool hit_closest(const struct world *, struct ray, struct hit *);
 *     void hits_closest(const struct world *, const struct ray *,
 *                       uint32_t count, struct hit *);
 *     bool hit_any(const struct world *, struct ray, uint32_t tri);
 *
 * Units:   normalised scene units, radiance
 * Threads: path_samples() from any thread; the world is read only
 * Errors:  a surface that cannot be computed is black
 */
#ifndef KERNELS_PATH_H
#define KERNELS_PATH_H

#include "kernels/aov.h"
#include "kernels/camera.h"
#include "kernels/light_cells.h"
#include "kernels/path_lights.h"
#include "kernels/radiance_cells.h"

/* Samples the next ray from the BSDF, or from the path guide if it has a table
 * here. Returns false if the path is absorbed. */
static inline bool path_scatter(const struct world *w, struct path *p,
                                const struct material *m, const struct bsdf *b,
                                const struct surface_point *v, struct vec3 wo,
                                struct vec2 direction, float choice)
{
    struct bsdf_sample s;
    struct vec3 wi;

    if (HAS(FEATURE_GUIDE) && p->cell.scatter != NO_INDEX) {
        if (!guide_scatter(w, p->cell.scatter, v, b, wo, direction, choice, &s,
                           &wi, &p->scale))
            return false;
    } else if (!surface_scatter(v, b, wo, direction, choice, &s, &wi)) {
        /* A shading normal may send light that clear glass transmits to the
         * wrong side of the face. It is then refracted at the geometric normal,
         * so that glass loses no light. */
        struct surface_point face = surface_of_face(*v);

        if (!bsdf_is_delta(b) ||
            !surface_scatter(&face, b,
                             surface_to_local(&face, v3_neg(p->ray.d)),
                             direction, choice, &s, &wi))
            return false;
    }
    surface_spawn_ray(v, wi, s.wi.z, &p->ray);
    p->beta = v3_mul(p->beta, s.weight);
    p->scale = f_finite(p->scale * s.eta_scale);
    p->pdf = s.is_delta ? 0.0f : s.pdf;
    if (HAS(FEATURE_ATTENUATION))
        p->medium = medium_beyond(m, b, v, s.wi.z, p->medium);
    return true;
}

/* Russian roulette. Returns false if the path is terminated. */
static inline bool path_survives(struct path *p, uint32_t vertex, float u)
{
    float q = roulette_survival(p->beta, vertex);

    p->beta = v3_scale(p->beta, 1.0f / q);
    return u < q;
}

/* Sets the key of the random numbers by which coverage lets the ray pass on its
 * way to `vertex`. */
static inline void path_set_key(const struct world *w, struct sampler s,
                                uint32_t vertex, struct ray *r)
{
    if (has_coverage(w))
        r->key = ray_key(s, vertex);
}

/* Finds the hit of the path's ray on the way to `vertex`. */
static inline void path_intersect(const struct world *w, struct path *p,
                                  uint32_t vertex, struct hit *h)
{
    path_set_key(w, p->sampler, vertex, &p->ray);
    p->ray.t_max = FLOAT_MAX;
    p->out.rays++;
    hit_closest(w, p->ray, h);
}

static inline void path_open(struct path *p, struct camera_sample start)
{
    p->ray = start.ray;
    p->sampler = start.sampler;
    p->half_number = start.half_number;
    p->beta = v3(1.0f, 1.0f, 1.0f);
    p->scale = 1.0f;
    p->pdf = 0.0f;
    p->from.p = start.ray.o;
    p->from.n = start.ray.d;
    p->from.transmits = true;
    p->medium = v3(0.0f, 0.0f, 0.0f);
    p->drops = false;
    p->is_chain = true;
    p->casts = false;
    p->estimates = NULL;
    p->out.radiance = v3(0.0f, 0.0f, 0.0f);
    p->out.rays = 1; /* the camera ray */
    p->out.cut = 0;
    first_surface_begin(&p->surface);
}

/* Notes the role of a vertex. Returns true if it is a matte one from which on
 * the path leaves out the light that light cells have there. */
static inline bool path_meet_role(const struct world *w, struct path *p,
                                  const struct material *m, uint32_t vertex)
{
    bool has_cells = false;

    if (p->is_chain && m->role == ROLE_MATTE &&
        w->settings.has_light_paths != 0) {
        has_cells = vertex > 1 && w->settings.has_light_cells != 0;
        p->drops = vertex == 1 || has_cells;
    }
    p->casts = m->role == ROLE_CASTS;
    p->is_chain = p->is_chain && p->casts;
    return has_cells;
}

/* Extends the path by one vertex, the hit *h of the path's ray. *h becomes the
 * hit of the next ray. Returns false if the path ends. */
static inline bool path_extend(const struct world *w, struct path *p,
                               uint32_t vertex, struct hit *h)
{
    struct material m;
    struct surface_point v;
    struct bsdf b;
    struct path_light light;
    struct vec3 wo;
    struct vec2 lobe;
    bool is_lit, goes_on, has_cells = false;

    /* Add lights before the hit, and the sky and suns of a ray that leaves */
    if (HAS(FEATURE_POINT_LIGHTS))
        path_add_spheres(w, p, h->tri == NO_INDEX ? FLOAT_MAX : h->t);
    if (h->tri == NO_INDEX) {
        if (HAS(FEATURE_ATTENUATION))
            p->beta = attenuated(p->beta, p->medium, FLOAT_MAX);
        path_add_sky(w, p);
        if (HAS(FEATURE_DIRECTIONAL_LIGHTS))
            path_add_discs(w, p);
        return false;
    }
    /* Find the surface. The sample points are computed early: they take long,
     * and nothing before depends on them. */
    path_prepare_2d(p, vertex);
    m = w->materials[tri_material(w, h->tri, instance_of(w, h->tri))];
    if (!surface_at(w, &m, p->ray, *h, &v))
        return false;
    /* Attenuate by the medium on the way. The camera is in a solid if it sees
     * one of its faces from inside. */
    if (HAS(FEATURE_ATTENUATION)) {
        if (vertex == 1 && !v.is_outside)
            p->medium = m.attenuation;
        p->beta = attenuated(p->beta, p->medium, h->t);
    }
    /* Add emission of the surface */
    path_add_emission(w, p, &m, h->tri, &v);
    first_surface_light(&p->surface, vertex, p->out.radiance);
    if (HAS(FEATURE_LIGHT_PATHS))
        has_cells = path_meet_role(w, p, &m, vertex);
    /* End at the limit of bounces */
    if (vertex >= w->settings.max_vertices) {
        p->out.cut = vertex >= PATH_HARD_STOP ? 1u : 0u;
        return false;
    }
    /* Evaluate the BSDF's parameters and the path guide's cell */
    b = bsdf_at(w, &m, &v);
    first_surface_meet(&p->surface, &b, v.n, h->t);
    if (bsdf_is_black(&b))
        return false;
    if (has_cells)
        path_add(p,
                 light_cells_radiance(w, p->half_number, &v, &b,
                                      surface_to_local(&v, v3_neg(p->ray.d)),
                                      random_2d(p->sampler, DIMENSION_CELL)),
                 1.0f);
    if (HAS(FEATURE_RADIANCE_CELLS) && w->settings.has_radiance_cells != 0 &&
        radiance_meet(w, p, &v, &b, h->tri, h->t))
        return false;
    if (!bsdf_is_glass(&b))
        surface_lift(w, h->tri, *h, &v);
    wo = surface_to_local(&v, v3_neg(p->ray.d));
    p->from.p = v.p;
    p->from.n = v.n;
    p->from.transmits = bsdf_transmits(&b);
    p->cell = guide_cell_none();
    if (HAS(FEATURE_GUIDE) && guide_helps(&b))
        p->cell = guide_at(w, v.p, v.ng);
    /* Sample a light. Its shadow ray is traced after the next direction was
     * sampled, on which it does not depend: 3 to 6 % less time. */
    is_lit = path_choose_light(w, p, &m, &b, &v, wo, vertex, &light);
    /* Sample the BSDF for the next direction; Russian roulette */
    lobe = path_2d(p, vertex, DIMENSION_BSDF_LOBE);
    goes_on =
        path_scatter(w, p, &m, &b, &v, wo,
                     path_2d(p, vertex, DIMENSION_BSDF_DIRECTION), lobe.x) &&
        path_survives(p, vertex, lobe.y);
    /* Trace the shadow ray, then the next ray */
    if (is_lit)
        path_add_light(w, p, &v, &light, vertex);
    if (goes_on)
        path_intersect(w, p, vertex + 1, h);
    return goes_on;
}

/* Returns true if the ray meets partial coverage first, where its further way
 * is chance. */
static inline bool ray_is_divided(const struct world *w, struct ray r)
{
    struct hit h;

    r.from = RAY_STOPS_EARLY;
    hit_closest(w, r, &h);
    return h.tri != NO_INDEX && coverage_at(w, h) < 1.0f;
}

/* Returns the radiance along a camera ray, whose hit is h, or the AOV of the
 * hit. Radiance is capped at the largest float, and the film counts it as
 * saturated. *surface is set if the world's samples have first surfaces, and
 * *estimates unless it is NULL. */
static inline struct path_sample
path_follow(const struct world *w, struct camera_sample start, struct hit h,
            struct first_surface *surface, struct cell_estimates *estimates)
{
    struct path p;
    uint32_t vertex = 1;

    if (HAS(FEATURE_AOV) && w->settings.sample != SAMPLE_LIGHT)
        return aov_sample(w, start.ray, h);
    path_open(&p, start);
    if (HAS(FEATURE_RADIANCE_CELLS) && estimates != NULL) {
        p.estimates = estimates;
        estimates->count = 0;
    }
    while (path_extend(w, &p, vertex, &h))
        vertex++;
    if (HAS(FEATURE_RADIANCE_CELLS) && estimates != NULL)
        radiance_estimate(&p);
    p.out.radiance =
        v3_min(v3(FLOAT_MAX, FLOAT_MAX, FLOAT_MAX), p.out.radiance);
    if (has_first_surface(w)) {
        first_surface_end(w, &p.surface, vertex, p.out.radiance);
        if (has_coverage(w) && !v3_is_zero(p.surface.seen)) {
            p.out.rays++;
            if (ray_is_divided(w, start.ray))
                p.surface.seen = v3(0.0f, 0.0f, 0.0f);
        }
        *surface = p.surface;
    }
    return p.out;
}

/* Traces a camera ray and returns path_follow() of its hit. */
static inline struct path_sample path_trace(const struct world *w,
                                            struct camera_sample start,
                                            struct first_surface *surface)
{
    struct hit h;

    path_set_key(w, start.sampler, 1, &start.ray);
    hit_closest(w, start.ray, &h);
    return path_follow(w, start, h, surface, NULL);
}

/* Makes the samplers of some samples, and their points within the pixel. */
VECTORISED static void path_points(const struct settings *s,
                                   const struct sample_id *places,
                                   uint32_t count, struct sampler *samplers,
                                   struct vec2 *points)
{
    for (uint32_t i = 0; i < count; i++)
        samplers[i] =
            camera_sampler(s, places[i].x, places[i].y, places[i].index);
    for (uint32_t i = 0; i < count; i++)
        points[i] = random_2d(samplers[i], DIMENSION_PIXEL);
}

/* Computes at most SAMPLE_BLOCK samples, their first surfaces if the world's
 * samples have some, and estimates for radiance cells unless that is NULL.
 * Samples of one pixel, or of neighbours, take less
 * time together. */
static inline void path_samples(const struct world *w,
                                const struct sample_id *places, uint32_t count,
                                struct path_sample *out,
                                struct first_surface *surfaces,
                                struct cell_estimates *estimates)
{
    struct sample_id all[SAMPLE_BLOCK];
    struct sampler samplers[SAMPLE_BLOCK];
    struct vec2 points[SAMPLE_BLOCK];
    struct ray rays[SAMPLE_BLOCK];
    struct hit hits[SAMPLE_BLOCK];

    if (count == 0)
        return;
    for (uint32_t i = 0; i < SAMPLE_BLOCK; i++)
        all[i] = places[i < count ? i : 0];
    path_points(&w->settings, all, HAS_WIDE_VECTORS ? SAMPLE_BLOCK : count,
                samplers, points);
    for (uint32_t i = 0; i < count; i++) {
        rays[i] = camera_sample_ray(&w->settings, all[i].x, all[i].y, points[i],
                                    samplers[i]);
        path_set_key(w, samplers[i], 1, &rays[i]);
    }
    hits_closest(w, rays, count, hits);
    for (uint32_t i = 0; i < count; i++) {
        struct camera_sample start;

        start.ray = rays[i];
        start.sampler = samplers[i];
        start.half_number = (uint32_t)all[i].index & 1u;
        out[i] = path_follow(w, start, hits[i], surfaces + i,
                             estimates != NULL ? estimates + i : NULL);
    }
}

#endif
