// SPDX-License-Identifier: MIT
/*
 * path.h - one sample of a pixel: a path from the eye
 *
 * The estimator of Kajiya 1986, "The rendering equation", with Russian roulette
 * by throughput. path_extend() is the body of its loop: emission, light
 * sample, scattering, roulette, next hit. Direct light is estimated by
 * next-event estimation and by paths that hit a light, and both estimates are
 * weighted by the power heuristic (Veach 1997, "Robust Monte Carlo methods for
 * light transport simulation", 9.2).
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
#include "kernels/attenuation.h"
#include "kernels/first_surface.h"
#include "kernels/guide.h"
#include "kernels/light.h"
#include "kernels/path_types.h"
#include "kernels/roulette.h"
#include "kernels/sphere_walk.h"
#include "kernels/camera_sample.h"
#include "kernels/surface_point.h"

/* Set to 1, random numbers of several vertices are computed together, in loops
 * that compilers vectorise; set to 0, each is computed when it is used. */
#ifndef HAS_WIDE_VECTORS
#define HAS_WIDE_VECTORS 0
#endif

/* Number of vertices whose random numbers are computed together. */
#define VERTICES_AHEAD 2u

/* Offset between the keys of a vertex's next ray and of its shadow ray. */
#define SHADOW_KEY 0x10000u

/* State of a path between two vertices. */
struct path {
    struct ray ray;
    struct sampler sampler;
    struct vec2 numbers[VERTICES_AHEAD * DIMENSION_KINDS];
    struct vec3 beta; /* throughput for Russian roulette */
    float scale;      /* factor of the throughput that roulette ignores */
    float pdf;        /* density of the ray's direction; 0 for the camera and
                         delta lobes, with which light samples do not compete */
    struct receiver from;   /* vertex that the ray left, if pdf is above 0 */
    struct guide_cell cell; /* tables of the path guide at that vertex */
    struct vec3 medium;     /* absorption along the ray; FEATURE_ATTENUATION */
    struct path_sample out;
    struct first_surface surface;
};

/* Caps a factor at the largest float, because an infinite factor times a black
 * channel is NaN. NaN stays NaN, and the film counts it. */
static inline float f_finite(float x)
{
    return f_min(FLOAT_MAX, x);
}

/* Weights incoming radiance by the path throughput. */
static inline struct vec3 path_part(const struct path *p, struct vec3 radiance,
                                    float weight)
{
    return v3_mul(v3_scale(p->beta, f_finite(p->scale * weight)), radiance);
}

/* Returns two random numbers of a vertex. Vertices are counted from 1. `kind`
 * is a dimension counted from DIMENSION_BOUNCE in enum dimension. */
static inline struct vec2 vertex_2d(struct sampler s, uint32_t vertex,
                                    uint32_t kind)
{
    return random_2d(s, vertex * DIMENSION_STRIDE + kind);
}

/* Computes all random numbers of VERTICES_AHEAD vertices. */
VECTORISED static void vertices_2d(struct sampler s, uint32_t vertex,
                                   struct vec2 *numbers)
{
    for (uint32_t i = 0; i < VERTICES_AHEAD * DIMENSION_KINDS; i++)
        numbers[i] =
            vertex_2d(s, vertex + i / DIMENSION_KINDS, i % DIMENSION_KINDS);
}

/* Computes random numbers ahead. Call it before the first path_2d() of a
 * vertex. */
static inline void path_prepare_2d(struct path *p, uint32_t vertex)
{
    if (HAS_WIDE_VECTORS && (vertex - 1) % VERTICES_AHEAD == 0)
        vertices_2d(p->sampler, vertex, p->numbers);
}

static inline struct vec2 path_2d(const struct path *p, uint32_t vertex,
                                  uint32_t kind)
{
    if (!HAS_WIDE_VECTORS)
        return vertex_2d(p->sampler, vertex, kind);
    return p->numbers[(vertex - 1) % VERTICES_AHEAD * DIMENSION_KINDS + kind];
}

static inline void path_add(struct path *p, struct vec3 radiance, float weight)
{
    p->out.radiance = v3_add(p->out.radiance, path_part(p, radiance, weight));
}

/* Returns the MIS weight by the power heuristic of a sample with density `pdf`
 * that the other technique would have drawn with density `other`. Measured
 * against the balance heuristic: the error of the Cornell boxes is 5 to 9 %
 * smaller, of many lights 7 % smaller, of materials 4 % larger, elsewhere the
 * same. */
static inline float power_weight(float pdf, float other)
{
    float ratio = other / pdf;

    return 1.0f / (1.0f + ratio * ratio);
}

/* Returns the MIS weight of emission that the path has hit. light_pdf is the
 * density with which light_sample() would have drawn the same point. */
static inline float bsdf_mis_weight(const struct world *w, float pdf,
                                    float light_pdf)
{
    if (pdf == 0.0f || w->settings.direct == DIRECT_BSDF)
        return 1.0f;
    if (w->settings.direct == DIRECT_LIGHTS)
        return light_pdf > 0.0f ? 0.0f : 1.0f;
    return power_weight(pdf, light_pdf);
}

/* Returns the MIS weight of a light sample. pdf is the density with which the
 * BSDF would have drawn the same direction. */
static inline float light_mis_weight(const struct world *w, float light_pdf,
                                     float pdf)
{
    return w->settings.direct == DIRECT_LIGHTS ? 1.0f
                                               : power_weight(light_pdf, pdf);
}

static inline void path_add_sky(const struct world *w, struct path *p)
{
    float pdf = 0.0f;
    struct vec3 radiance =
        p->pdf > 0.0f
            ? sky_light_terms(w, &p->from, p->cell.sky, p->ray.d, &pdf)
            : sky_radiance(w, p->ray.d);

    path_add(p, radiance, bsdf_mis_weight(w, p->pdf, pdf));
}

/* Adds the discs of directional lights to which the path's ray escapes. */
static inline void path_add_discs(const struct world *w, struct path *p)
{
    for (uint32_t i = 0; i < w->settings.directional_light_count; i++) {
        float pdf = 0.0f;

        if (!disc_meets(w, i, p->ray.d))
            continue;
        if (p->pdf > 0.0f)
            pdf = directional_pdf(w, i, &p->from);
        path_add(p, w->directional_lights[i].emission,
                 bsdf_mis_weight(w, p->pdf, pdf));
    }
}

/* Adds sphere i if the ray, which is the path's, meets it. */
static inline void path_add_sphere(const struct world *w, struct path *p,
                                   uint32_t i, struct ray r)
{
    struct vec3 radiance;
    float t, pdf = 0.0f;

    if (!sphere_meets(w, i, r, &t))
        return;
    radiance =
        v3_scale(w->point_lights[i].emission, point_light_part(w, i, r.d));
    if (HAS(FEATURE_ATTENUATION))
        radiance = attenuated(radiance, p->medium, t);
    if (p->pdf > 0.0f)
        pdf = sphere_pdf_at(w, &p->from, i);
    path_add(p, radiance, bsdf_mis_weight(w, p->pdf, pdf));
}

/* Adds the spheres that the path's ray meets on its way. They hide nothing. */
static inline void path_add_spheres(const struct world *w, struct path *p,
                                    float t_max)
{
    struct ray r = p->ray;
    struct sphere_walk walk;
    uint32_t light;

    r.t_max = t_max;
    if (w->settings.sphere_count == 0)
        return;
    if (light_tree_count(w) == 1) {
        path_add_sphere(w, p, 0, r);
        return;
    }
    sphere_walk_begin(&walk, w, r);
    while ((light = sphere_walk_next(&walk, w, r)) != NO_INDEX) {
        uint32_t i = light - w->settings.light_count;

        if (light >= w->settings.light_count && i < w->settings.sphere_count)
            path_add_sphere(w, p, i, r);
    }
}

static inline void path_add_emission(const struct world *w, struct path *p,
                                     const struct material *m, uint32_t tri,
                                     const struct surface_point *v)
{
    float light_pdf = 0.0f;

    if (!HAS(FEATURE_EMITTERS) || v3_is_zero(m->emission))
        return;
    if (p->pdf > 0.0f)
        light_pdf = light_pdf_at(w, &p->from, tri, v->p);
    path_add(p, emission_at(w, m, v->uv, v->has_uv),
             bsdf_mis_weight(w, p->pdf, light_pdf));
}

static inline uint32_t shadow_key(const struct path *p, uint32_t vertex)
{
    return ray_key(p->sampler, SHADOW_KEY + vertex);
}

/* Russian roulette on the shadow ray of a light sample. Returns false if the
 * shadow ray is not traced. */
static inline bool shadow_survives(const struct path *p, uint32_t vertex,
                                   struct vec3 *light)
{
    float q = roulette_shadow_survival(*light, p->out.radiance);

    if (!(q < 1.0f))
        return true;
    /* the random number is above 0, so that q = 0 never survives */
    if (!(1.0f - unit_float(hash_u32(shadow_key(p, vertex))) < q))
        return false;
    *light = v3_scale(*light, 1.0f / q);
    return true;
}

/* Returns true if light_sample() can contribute at a surface with this BSDF. */
static inline bool wants_light_sample(const struct world *w,
                                      const struct bsdf *b)
{
    bool has_lights = w->settings.sky_share > 0.0f;

    if (HAS(FEATURE_EMITTERS))
        has_lights = has_lights || w->settings.light_count > 0;
    if (HAS(FEATURE_POINT_LIGHTS))
        has_lights = has_lights || w->settings.point_light_count > 0;
    return has_lights && w->settings.direct != DIRECT_BSDF && !bsdf_is_delta(b);
}

/* Light sample with its contribution to the pixel if it is not occluded. */
struct path_light {
    struct light_sample at;
    float cosine; /* between the sample's direction and the shading normal */
    struct vec3 radiance;
};

/* Attenuates light that comes to the surface from a light sample. */
static inline struct vec3 path_light_attenuated(const struct path *p,
                                                const struct material *m,
                                                const struct bsdf *b,
                                                const struct surface_point *v,
                                                const struct path_light *l)
{
    float distance =
        l->at.is_near ? v3_length(v3_sub(l->at.p, v->p)) : FLOAT_MAX;

    return attenuated(l->radiance, medium_beyond(m, b, v, l->cosine, p->medium),
                      distance);
}

/* Draws a light sample. Returns false if there is none, or if roulette drops
 * its shadow ray. */
FLATTENED static inline bool
path_choose_light(const struct world *w, const struct path *p,
                  const struct material *m, const struct bsdf *b,
                  const struct surface_point *v, struct vec3 wo,
                  uint32_t vertex, struct path_light *l)
{
    struct vec3 wi;
    float pdf;

    l->radiance = v3(0.0f, 0.0f, 0.0f);
    if (!wants_light_sample(w, b) ||
        !light_sample(w, &p->from, p->cell.sky,
                      path_2d(p, vertex, DIMENSION_LIGHT_POSITION),
                      path_2d(p, vertex, DIMENSION_LIGHT_CHOICE), &l->at))
        return false;
    wi = surface_to_local(v, l->at.wi);
    l->cosine = wi.z;
    if (!surface_sides_agree(v, l->at.wi, wi.z))
        return false;
    l->radiance = v3_mul(bsdf_terms(b, wo, wi, &pdf), l->at.radiance);
    if ((HAS(FEATURE_POINT_LIGHTS) || HAS(FEATURE_DIRECTIONAL_LIGHTS)) &&
        l->at.is_delta)
        pdf = 0.0f;
    if (v3_is_zero(l->radiance))
        return false;
    l->radiance =
        path_part(p, l->radiance,
                  bsdf_eta_scale(b, wi) * light_mis_weight(w, l->at.pdf, pdf) /
                      l->at.pdf);
    if (HAS(FEATURE_ATTENUATION))
        l->radiance = path_light_attenuated(p, m, b, v, l);
    return shadow_survives(p, vertex, &l->radiance);
}

/* Traces the shadow ray and adds the light sample if it is not occluded. The
 * direction is computed again, because the ray's origin is offset from the
 * vertex; it need not be of unit length. Flattened into one function with the
 * traversal: 2 to 13 % less time in scenes of more than walls and lamps. */
FLATTENED static inline void path_add_light(const struct world *w,
                                            struct path *p,
                                            const struct surface_point *v,
                                            const struct path_light *l,
                                            uint32_t vertex)
{
    struct ray r = {surface_ray_origin(v, l->cosine), l->at.wi, FLOAT_MAX, 0,
                    v->face};

    if (has_coverage(w))
        r.key = shadow_key(p, vertex);
    if (l->at.tri != NO_INDEX) {
        struct tri t = w->tris[l->at.tri];

        r.d = v3_sub(l->at.p, r.o);
        r.t_max = aimed_distance(r, w->positions[t.v[0]], w->positions[t.v[1]],
                                 w->positions[t.v[2]]);
        if (!(r.t_max > 0.0f))
            return;
    } else if (HAS(FEATURE_POINT_LIGHTS) && l->at.is_near) {
        r.d = v3_sub(l->at.p, r.o);
        r.t_max = POINT_WAY;
    }
    p->out.rays++;
    if (!hit_any(w, r, l->at.tri))
        p->out.radiance = v3_add(p->out.radiance, l->radiance);
}

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

/* Begins a path with the camera ray r. */
static inline void path_open(struct path *p, struct ray r,
                             struct sampler sampler)
{
    p->ray = r;
    p->sampler = sampler;
    p->beta = v3(1.0f, 1.0f, 1.0f);
    p->scale = 1.0f;
    p->pdf = 0.0f;
    p->from.p = r.o;
    p->from.n = r.d;
    p->from.transmits = true;
    p->medium = v3(0.0f, 0.0f, 0.0f);
    p->out.radiance = v3(0.0f, 0.0f, 0.0f);
    p->out.rays = 1; /* the camera ray */
    p->out.cut = 0;
    first_surface_begin(&p->surface);
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
    bool is_lit, goes_on;

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
    /* call this early: it takes long, and nothing before depends on it */
    path_prepare_2d(p, vertex);
    m = w->materials[w->tris[h->tri].material];
    if (!surface_at(w, &m, p->ray, *h, &v))
        return false;
    if (HAS(FEATURE_ATTENUATION)) {
        /* the camera is in a solid if it sees one of its faces from inside */
        if (vertex == 1 && !v.is_outside)
            p->medium = m.attenuation;
        p->beta = attenuated(p->beta, p->medium, h->t);
    }
    path_add_emission(w, p, &m, h->tri, &v);
    first_surface_light(&p->surface, vertex, p->out.radiance);
    if (vertex >= w->settings.max_vertices) {
        p->out.cut = vertex >= PATH_HARD_STOP ? 1u : 0u;
        return false;
    }
    b = bsdf_at(w, &m, &v);
    first_surface_meet(&p->surface, &b, v.n, h->t);
    if (bsdf_is_black(&b))
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
    /* The next direction is sampled before the shadow ray is traced: 3 to 6 %
     * less time. The two do not depend on each other. */
    is_lit = path_choose_light(w, p, &m, &b, &v, wo, vertex, &light);
    lobe = path_2d(p, vertex, DIMENSION_BSDF_LOBE);
    goes_on =
        path_scatter(w, p, &m, &b, &v, wo,
                     path_2d(p, vertex, DIMENSION_BSDF_DIRECTION), lobe.x) &&
        path_survives(p, vertex, lobe.y);
    if (is_lit)
        path_add_light(w, p, &v, &light, vertex);
    if (goes_on)
        path_intersect(w, p, vertex + 1, h);
    return goes_on;
}

/* Returns the radiance along the camera ray r, whose hit is h, or the AOV of
 * the hit. Radiance is capped at the largest float, and the film counts it as
 * saturated. *surface is set if the world's samples have first surfaces. */
static inline struct path_sample
path_follow(const struct world *w, struct ray r, struct sampler sampler,
            struct hit h, struct first_surface *surface)
{
    struct path p;
    uint32_t vertex = 1;

    if (HAS(FEATURE_AOV) && w->settings.sample != SAMPLE_LIGHT)
        return aov_sample(w, r, h);
    path_open(&p, r, sampler);
    while (path_extend(w, &p, vertex, &h))
        vertex++;
    p.out.radiance =
        v3_min(v3(FLOAT_MAX, FLOAT_MAX, FLOAT_MAX), p.out.radiance);
    if (has_first_surface(w)) {
        first_surface_end(w, &p.surface, vertex, p.out.radiance);
        *surface = p.surface;
    }
    return p.out;
}

/* Traces the camera ray r and returns path_follow() of its hit. */
static inline struct path_sample path_trace(const struct world *w, struct ray r,
                                            struct sampler sampler,
                                            struct first_surface *surface)
{
    struct hit h;

    path_set_key(w, sampler, 1, &r);
    hit_closest(w, r, &h);
    return path_follow(w, r, sampler, h, surface);
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

/* Computes at most SAMPLE_BLOCK samples, and their first surfaces if the
 * world's samples have some. Samples of one pixel, or of neighbours, take less
 * time together. */
static inline void path_samples(const struct world *w,
                                const struct sample_id *places, uint32_t count,
                                struct path_sample *out,
                                struct first_surface *surfaces)
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
    for (uint32_t i = 0; i < count; i++)
        out[i] = path_follow(w, rays[i], samplers[i], hits[i], surfaces + i);
}

#endif
