// SPDX-License-Identifier: MIT
/*
 * path.h - one sample of a pixel: a path from the eye
 *
 * The estimator of Kajiya 1986 with throughput roulette. At each vertex light
 * is gathered in two ways: from a light that was chosen (next-event
 * estimation), and by chance, where the path meets one; the power heuristic
 * weighs both (Veach 1997, 9.2). Whoever includes this file supplies
 *     bool hit_closest(const struct world *, struct ray, struct hit *);
 *     bool hits_closest(const struct world *, const struct ray *,
 *                       uint32_t count, struct hit *);
 *     bool hit_any(const struct world *, struct ray, uint32_t tri);
 * first: traverse.h, or faster ones that find the same hits.
 *
 * Units:     normalised scene units, radiance
 * Threads:   path_samples() from any, on one world
 * Errors:    none: what cannot be computed is black
 */
#ifndef KERNELS_PATH_H
#define KERNELS_PATH_H

#include "kernels/aov.h"
#include "kernels/guide.h"
#include "kernels/light.h"
#include "kernels/path_types.h"
#include "kernels/roulette.h"
#include "kernels/camera_sample.h"
#include "kernels/surface_point.h"

/* 1: eight random numbers take the time of one, in loops that compilers turn
 * into vector code, and are computed together; 0: each when it is asked for. */
#ifndef HAS_WIDE_VECTORS
#define HAS_WIDE_VECTORS 0
#endif

/* Vertices whose numbers are computed together. */
#define VERTICES_AHEAD 2u

/* Between the keys of a vertex's next ray and of its shadow ray. */
#define SHADOW_KEY 0x10000u

/* A path on its way. */
struct path {
    struct ray ray;
    struct sampler sampler;
    struct vec2 numbers[VERTICES_AHEAD * DIMENSION_KINDS];
    struct vec3 beta; /* what radiance that comes along the ray counts, */
    float scale;      /* apart from this, which roulette does not see */
    float pdf;        /* of the ray's direction; 0: no light sample has it */
    struct receiver from;   /* where the ray began, if pdf is not 0 */
    struct guide_cell cell; /* there of the guide */
    struct path_sample out;
};

/* Factors and sums end at the largest float: an infinite one would make no
 * number of a black channel. What is no number stays so, to be counted. */
static inline float f_finite(float x)
{
    return f_min(FLOAT_MAX, x);
}

/* What radiance that comes along the path's ray is worth in the pixel. */
static inline struct vec3 path_part(const struct path *p, struct vec3 radiance,
                                    float weight)
{
    return v3_mul(v3_scale(p->beta, f_finite(p->scale * weight)), radiance);
}

/* Random numbers at a vertex, the first of which is 1; `kind` is one of enum
 * dimension's that are counted from DIMENSION_BOUNCE. */
static inline struct vec2 vertex_2d(struct sampler s, uint32_t vertex,
                                    uint32_t kind)
{
    return random_2d(s, vertex * DIMENSION_STRIDE + kind);
}

/* All numbers at VERTICES_AHEAD vertices. */
VECTORISED static void vertices_2d(struct sampler s, uint32_t vertex,
                                   struct vec2 *numbers)
{
    for (uint32_t i = 0; i < VERTICES_AHEAD * DIMENSION_KINDS; i++)
        numbers[i] =
            vertex_2d(s, vertex + i / DIMENSION_KINDS, i % DIMENSION_KINDS);
}

/* Before the first path_2d() at a vertex. */
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

/* Weight of a way to gather that had this density, where the other had
 * `other`. With squares the error of the Cornell boxes is 5 to 9 % less than
 * with the densities themselves, of many lights 7 % less; of materials it is
 * 4 % more, elsewhere the same. */
static inline float power_weight(float pdf, float other)
{
    float ratio = other / pdf;

    return 1.0f / (1.0f + ratio * ratio);
}

/* Weight of light that was met by chance, where light_pdf is the density with
 * which light_sample() would have found it. */
static inline float chance_weight(const struct world *w, float pdf,
                                  float light_pdf)
{
    if (pdf == 0.0f || w->settings.direct == DIRECT_CHANCE)
        return 1.0f;
    if (w->settings.direct == DIRECT_LIGHTS)
        return light_pdf > 0.0f ? 0.0f : 1.0f;
    return power_weight(pdf, light_pdf);
}

/* Weight of light that light_sample() has found. */
static inline float light_weight(const struct world *w, float light_pdf,
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

    path_add(p, radiance, chance_weight(w, p->pdf, pdf));
}

static inline void path_add_emission(const struct world *w, struct path *p,
                                     const struct material *m, uint32_t tri,
                                     const struct vertex *v)
{
    float light_pdf = 0.0f;

    if (!HAS(FEATURE_EMITTERS) || v3_is_zero(m->emission))
        return;
    if (p->pdf > 0.0f)
        light_pdf = light_pdf_at(w, &p->from, tri, v->p);
    path_add(p, emission_at(w, m, v->uv, v->has_uv),
             chance_weight(w, p->pdf, light_pdf));
}

static inline uint32_t shadow_key(const struct path *p, uint32_t vertex)
{
    return ray_key(p->sampler, SHADOW_KEY + vertex);
}

/* False if roulette saves the shadow ray for this light. */
static inline bool shadow_survives(const struct path *p, uint32_t vertex,
                                   struct vec3 *light)
{
    float q = shadow_survival(*light, p->out.radiance);

    if (!(q < 1.0f))
        return true;
    /* never 0: what is all but impossible must not be divided by */
    if (!(1.0f - unit_float(hash_u32(shadow_key(p, vertex))) < q))
        return false;
    *light = v3_scale(*light, 1.0f / q);
    return true;
}

/* Can light_sample() find anything for it? */
static inline bool wants_light_sample(const struct world *w,
                                      const struct bsdf *b)
{
    bool has_lights = w->settings.sky_share > 0.0f;

    if (HAS(FEATURE_EMITTERS))
        has_lights = has_lights || w->settings.light_count > 0;
    return has_lights && w->settings.direct != DIRECT_CHANCE &&
           !bsdf_is_delta(b);
}

/* What light that was chosen adds to a path if it is seen. */
struct path_light {
    struct light_sample at;
    float cosine; /* of its direction to the shading normal */
    struct vec3 radiance;
};

/* Chooses a light for the vertex. False if there is none, or its shadow ray is
 * not worth tracing. */
FLATTENED static inline bool
path_choose_light(const struct world *w, const struct path *p,
                  const struct bsdf *b, const struct vertex *v, struct vec3 wo,
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
    wi = vertex_to_local(v, l->at.wi);
    l->cosine = wi.z;
    if (!vertex_sides_agree(v, l->at.wi, wi.z))
        return false;
    l->radiance = v3_mul(bsdf_terms(b, wo, wi, &pdf), l->at.radiance);
    if (v3_is_zero(l->radiance))
        return false;
    l->radiance = path_part(p, l->radiance,
                            bsdf_eta_scale(b, wi) *
                                light_weight(w, l->at.pdf, pdf) / l->at.pdf);
    return shadow_survives(p, vertex, &l->radiance);
}

/* Adds the light unless something is in its way: would a ray from here find it
 * by chance? It is aimed anew, as a ray does not begin in the vertex itself; of
 * unit length it need not be. In one piece with the ray's walk: 2 to 13 % less
 * time where there is more than walls and lamps. */
FLATTENED static inline void
path_add_light(const struct world *w, struct path *p, const struct vertex *v,
               const struct path_light *l, uint32_t vertex)
{
    struct ray r = {vertex_leave(v, l->cosine), l->at.wi, FLOAT_MAX, 0,
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
    }
    p->out.rays++;
    if (!hit_any(w, r, l->at.tri))
        p->out.radiance = v3_add(p->out.radiance, l->radiance);
}

/* Draws a direction; false if there is none, or the face is in its way. */
static inline bool vertex_scatter(const struct vertex *v, const struct bsdf *b,
                                  struct vec3 wo, struct vec2 direction,
                                  float choice, struct bsdf_sample *s,
                                  struct vec3 *wi)
{
    if (!bsdf_sample(b, wo, direction, choice, s))
        return false;
    *wi = v3_unit_again(vertex_to_world(v, s->wi));
    return vertex_sides_agree(v, *wi, s->wi.z);
}

/* Draws where the path goes on. False if it ends here. */
static inline bool path_scatter(const struct world *w, struct path *p,
                                const struct bsdf *b, const struct vertex *v,
                                struct vec3 wo, struct vec2 direction,
                                float choice)
{
    struct bsdf_sample s;
    struct vec3 wi;

    if (HAS(FEATURE_GUIDE) && p->cell.ways != NO_INDEX) {
        if (!guide_scatter(w, p->cell.ways, v, b, wo, direction, choice, &s,
                           &wi, &p->scale))
            return false;
    } else if (!vertex_scatter(v, b, wo, direction, choice, &s, &wi)) {
        /* clear glass whose normal leans loses nothing: its face bends what
         * the normal would send to the wrong side */
        struct vertex face = vertex_of_face(*v);

        if (!bsdf_is_delta(b) ||
            !vertex_scatter(&face, b, vertex_to_local(&face, v3_neg(p->ray.d)),
                            direction, choice, &s, &wi))
            return false;
    }
    p->ray.o = vertex_leave(v, s.wi.z);
    p->ray.d = wi;
    p->ray.from = v->face;
    p->beta = v3_mul(p->beta, s.weight);
    p->scale = f_finite(p->scale * s.eta_scale);
    p->pdf = s.is_delta ? 0.0f : s.pdf;
    return true;
}

/* False if roulette ends the path. */
static inline bool path_survives(struct path *p, uint32_t vertex, float u)
{
    float q = survival(p->beta, vertex);

    p->beta = v3_scale(p->beta, 1.0f / q);
    return u < q;
}

/* Samples are paths: they go on from what they meet first. */
static inline bool are_paths(const struct world *w)
{
    return !HAS(FEATURE_FIRST_HIT) || w->settings.sample == SAMPLE_LIGHT;
}

/* What the path does at a vertex. False if it ends there. */
static inline bool path_step(const struct world *w, struct path *p,
                             struct hit h, uint32_t vertex)
{
    struct material m = w->materials[w->tris[h.tri].material];
    struct vertex v;
    struct bsdf b;
    struct path_light light;
    struct vec3 wo;
    struct vec2 lobe;
    bool is_lit, goes_on;

    /* first, as it takes long and waits for nothing */
    if (are_paths(w))
        path_prepare_2d(p, vertex);
    if (!vertex_at(w, &m, p->ray, h, &v))
        return false;
    b = bsdf_at(w, &m, &v);
    if (!are_paths(w)) {
        p->out.radiance = first_hit(w, &m, &b, &v, p->ray, h);
        return false;
    }
    path_add_emission(w, p, &m, h.tri, &v);
    if (vertex >= w->settings.max_vertices) {
        p->out.cut = vertex >= PATH_HARD_STOP ? 1u : 0u;
        return false;
    }
    if (bsdf_is_black(&b))
        return false;
    if (!bsdf_is_glass(&b))
        vertex_lift(w, h.tri, h, &v);
    wo = vertex_to_local(&v, v3_neg(p->ray.d));
    p->from.p = v.p;
    p->from.n = v.n;
    p->from.transmits = bsdf_transmits(&b);
    p->cell = guide_none();
    if (HAS(FEATURE_GUIDE) && guide_helps(&b))
        p->cell = guide_at(w, v.p, v.ng);
    /* The next ray waits for neither the light nor its shadow ray: drawn before
     * that one walks, it takes 3 to 6 % less time. */
    is_lit = path_choose_light(w, p, &b, &v, wo, vertex, &light);
    lobe = path_2d(p, vertex, DIMENSION_BSDF_LOBE);
    goes_on =
        path_scatter(w, p, &b, &v, wo,
                     path_2d(p, vertex, DIMENSION_BSDF_DIRECTION), lobe.x) &&
        path_survives(p, vertex, lobe.y);
    if (is_lit)
        path_add_light(w, p, &v, &light, vertex);
    return goes_on;
}

/* A path that begins with this ray. */
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
    p->out.radiance = v3(0.0f, 0.0f, 0.0f);
    p->out.rays = p->out.cut = 0;
}

/* Goes on to vertex `vertex`, counted from 1, and scatters there: *h is what it
 * meets, which may be known. False if the path has ended. */
static inline bool path_advance(const struct world *w, struct path *p,
                                uint32_t vertex, const struct hit *known,
                                struct hit *h)
{
    if (has_coverage(w))
        p->ray.key = ray_key(p->sampler, vertex);
    p->ray.t_max = FLOAT_MAX;
    p->out.rays++;
    if (known != NULL)
        *h = *known;
    else
        hit_closest(w, p->ray, h);
    if (h->tri == NO_INDEX) {
        if (w->settings.sample <= SAMPLE_PREVIEW)
            path_add_sky(w, p);
        return false;
    }
    return path_step(w, p, *h, vertex);
}

/* To its end; what it meets first may be known. Light that no float can hold
 * is more than a sum takes of it, which is counted there. */
static inline struct path_sample path_run(const struct world *w, struct path *p,
                                          const struct hit *first)
{
    uint32_t vertex = 1;
    struct hit h;

    while (path_advance(w, p, vertex, vertex == 1 ? first : NULL, &h))
        vertex++;
    p->out.radiance =
        v3_low(v3(FLOAT_MAX, FLOAT_MAX, FLOAT_MAX), p->out.radiance);
    return p->out;
}

static inline struct path_sample path_trace(const struct world *w, struct ray r,
                                            struct sampler sampler)
{
    struct path p;

    path_open(&p, r, sampler);
    return path_run(w, &p, NULL);
}

/* Where samples begin in their pixels, and their samplers. */
VECTORISED static void path_points(const struct settings *s,
                                   const struct sample_place *places,
                                   uint32_t count, struct sampler *samplers,
                                   struct vec2 *points)
{
    for (uint32_t i = 0; i < count; i++)
        samplers[i] =
            path_sampler(s, places[i].x, places[i].y, places[i].index);
    for (uint32_t i = 0; i < count; i++)
        points[i] = random_2d(samplers[i], DIMENSION_PIXEL);
}

/* At most SAMPLE_BLOCK samples; those of one pixel, or of neighbours, take less
 * time. */
static inline void path_samples(const struct world *w,
                                const struct sample_place *places,
                                uint32_t count, struct path_sample *out)
{
    struct sample_place all[SAMPLE_BLOCK];
    struct sampler samplers[SAMPLE_BLOCK];
    struct vec2 points[SAMPLE_BLOCK];
    struct ray rays[SAMPLE_BLOCK];
    struct hit hits[SAMPLE_BLOCK];
    struct path p;
    bool is_known;

    if (count == 0)
        return;
    for (uint32_t i = 0; i < SAMPLE_BLOCK; i++)
        all[i] = places[i < count ? i : 0];
    path_points(&w->settings, all, HAS_WIDE_VECTORS ? SAMPLE_BLOCK : count,
                samplers, points);
    for (uint32_t i = 0; i < count; i++) {
        rays[i] =
            path_ray(&w->settings, all[i].x, all[i].y, points[i], samplers[i]);
        if (has_coverage(w))
            rays[i].key = ray_key(samplers[i], 1);
    }
    is_known = hits_closest(w, rays, count, hits);
    for (uint32_t i = 0; i < count; i++) {
        path_open(&p, rays[i], samplers[i]);
        out[i] = path_run(w, &p, is_known ? &hits[i] : NULL);
    }
}

#endif
