// SPDX-License-Identifier: MIT
/*
 * path.h - one sample of a pixel: a path from the eye
 *
 * The estimator of Kajiya 1986, "The rendering equation", with Russian roulette
 * by throughput. path_extend() is the body of its loop: emission, light sample,
 * scattering, roulette. The shadow ray and the next ray follow: of one path in
 * path_step(), of a stream of paths in src/render/path_stream.h. Direct light
 * is that of path_lights.h.
 *
 * The ray queries are supplied by a file that is included first, traverse.h or
 * a faster one that finds the same hits:
 *     bool hit_closest(const struct world *, struct ray, struct hit *);
 *     bool hit_any(const struct world *, struct ray, uint32_t tri);
 *
 * Units:   normalised scene units, radiance
 * Threads: any; the world is read only
 * Errors:  a surface that cannot be computed is black
 */
#ifndef KERNELS_PATH_H
#define KERNELS_PATH_H

#include "kernels/aov.h"
#include "kernels/camera.h"
#include "kernels/dispersion.h"
#include "kernels/light_cells.h"
#include "kernels/path_lights.h"
#include "kernels/radiance_cells.h"
#include "kernels/subsurface.h"

/* Samples the next ray from the BSDF, or from the path guide if it has a table
 * here. Returns false if the path is absorbed. */
APART static bool path_scatter(const struct world *w, struct path *p,
                               uint32_t material, const struct bsdf *b,
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
    if (HAS(FEATURE_MEDIA))
        p->segment.is_there = false;
    surface_spawn_ray(v, wi, s.wi.z, &p->ray);
    p->beta = v3_mul(p->beta, s.weight);
    p->scale = f_finite(p->scale * s.eta_scale);
    p->pdf = s.is_delta ? 0.0f : s.pdf;
    if (HAS(FEATURE_ATTENUATION))
        media_follow(&p->media, material, b, v, s.wi.z);
    return true;
}

/* Russian roulette. Returns false if the path is terminated. */
static inline bool path_survives(struct path *p, float u)
{
    float q = roulette_survival(p->beta, p->vertex);

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

/* Begins a path. Its estimates, if they are not NULL, become those of its
 * vertices. */
static inline void path_open(const struct world *w, struct path *p,
                             struct camera_sample start,
                             struct cell_estimates *estimates)
{
    p->ray = start.ray;
    p->vertex = 1;
    p->sampler = start.sampler;
    p->half_number = start.half_number;
    p->beta = v3(1.0f, 1.0f, 1.0f);
    p->scale = 1.0f;
    p->pdf = 0.0f;
    p->from.p = start.ray.o;
    p->from.n = start.ray.d;
    p->from.transmits = true;
    if (HAS(FEATURE_ATTENUATION))
        p->media = w->settings.camera_media;
    if (HAS(FEATURE_MEDIA)) {
        p->from.is_free = false;
        p->segment.is_there = false;
        p->along = v3(0.0f, 0.0f, 0.0f);
        p->crossings = 0;
    }
    if (HAS(FEATURE_GRIDS))
        p->smoke_steps = 0;
    if (HAS(FEATURE_SUBSURFACE))
        p->below.steps = 0;
    if (HAS(FEATURE_DISPERSION))
        p->wavelength = 0.0f;
    p->drops = false;
    p->is_chain = true;
    p->casts = false;
    p->estimates = estimates;
    if (HAS(FEATURE_RADIANCE_CELLS) && estimates != NULL)
        estimates->count = 0;
    p->out.radiance = v3(0.0f, 0.0f, 0.0f);
    p->out.rays = 1; /* the camera ray */
    p->out.cut = 0;
    first_surface_begin(&p->surface);
}

/* Notes the role of a vertex. Returns true if it is a matte one from which on
 * the path leaves out the light that light cells have there. */
static inline bool path_meet_role(const struct world *w, struct path *p,
                                  GLOBAL const struct material *m)
{
    bool has_cells = false;

    if (p->is_chain && m->role == ROLE_MATTE &&
        w->settings.has_light_paths != 0) {
        has_cells = p->vertex > 1 && w->settings.has_light_cells != 0;
        p->drops = p->vertex == 1 || has_cells;
    }
    p->casts = m->role == ROLE_CASTS;
    p->is_chain = p->is_chain && p->casts;
    return has_cells;
}

/* True if the path ends here by the limit of bounces. */
static inline bool path_is_full(const struct world *w, struct path *p)
{
    if (p->vertex < w->settings.max_vertices)
        return false;
    p->out.cut = p->vertex >= PATH_HARD_STOP ? 1u : 0u;
    return true;
}

/* Completes a vertex whose next direction is known. Returns false if roulette
 * ends the path. */
static inline bool path_advance(const struct world *w, struct path *p, float u)
{
    if (!path_survives(p, u))
        return false;
    p->vertex++;
    if (HAS(FEATURE_MEDIA))
        p->crossings = 0;
    p->out.rays++;
    p->ray.t_max = FLOAT_MAX;
    path_set_key(w, p->sampler, p->vertex, &p->ray);
    return true;
}

/* ---- media ---- */

/* Returns random numbers for a collision. After a boundary they are others. */
static inline struct vec2 path_medium_2d(const struct path *p, uint32_t kind)
{
    struct sampler s = p->sampler;

    if (p->crossings > 0)
        s.key = hash_u32(s.key + p->crossings);
    return vertex_2d(s, p->vertex, kind);
}

/* Takes the path along a distance t of its ray, whose end it sees: its
 * throughput becomes that of light which is emitted there. *beta becomes that
 * with which it goes on, from the collision or from the end. */
static inline struct collision
path_travel(struct path *p, const struct medium *m, float t, struct vec3 *beta)
{
    struct collision c = {t, v3(1.0f, 1.0f, 1.0f), false, false};
    bool scatters = medium_scatters(m);

    if (scatters) {
        c = medium_collide(m, p->beta, p->ray, t,
                           path_medium_2d(p, DIMENSION_MEDIUM));
        *beta = v3_mul(p->beta, c.weight);
    }
    p->beta = attenuated(p->beta, m, p->ray, t);
    if (!scatters)
        *beta = p->beta;
    return c;
}

/* True if light is sampled along the path's ray in this medium. */
static inline bool path_samples_along(const struct world *w,
                                      const struct path *p,
                                      const struct medium *m)
{
    return medium_scatters(m) && w->settings.light_share > 0.0f &&
           has_light_samples(w) && p->vertex < w->settings.max_vertices;
}

/* Takes the path along a distance t of its ray as path_travel() does, through a
 * medium without smokes. *s becomes its segment. */
static inline struct collision
path_travel_lit(const struct world *w, struct path *p, const struct medium *m,
                float t, struct vec3 *beta, struct segment *s)
{
    struct vec3 before = p->beta;
    struct collision c;

    if (HAS(FEATURE_MEDIA) && path_samples_along(w, p, m))
        *s = path_add_along(w, p, m, t);
    c = path_travel(p, m, t, beta);
    if (HAS(FEATURE_MEDIA) && s->is_there && c.is_there) {
        s->t = c.t;
        s->density =
            collision_density(m, collision_shares(m, before), p->ray, c.t);
        s->is_there = s->density > 0.0f;
    }
    return c;
}

/* Returns the medium that fog and smokes of density 1 are together. */
static inline struct medium smoke_sum(const struct world *w, struct medium fog)
{
    for (uint32_t i = 0; i < w->settings.smoke_count; i++) {
        fog.extinction = v3_add(fog.extinction, w->smokes[i].extinction);
        fog.scattering = v3_add(fog.scattering, w->smokes[i].scattering);
    }
    return fog;
}

/* Returns the probabilities with which the channels decide where smokes stop a
 * path: half by what they would scatter, as in fog, and half by what passes, or
 * light in a channel that is not scattered would come from rare paths. */
static inline struct vec3
smoke_shares(const struct world *w, const struct medium *fog, struct vec3 beta)
{
    const struct medium none = {.falloff = 0.0f};
    struct medium sum = smoke_sum(w, *fog);

    return v3_scale(v3_add(collision_shares(&sum, beta),
                           collision_shares(&none, beta)),
                    0.5f);
}

/* Takes the path along a distance t of its ray as path_travel() does, through
 * smokes and the fog *m, which becomes the medium in which the path is
 * scattered. Light at the end is seen if no smoke stops the path. */
APART static struct collision path_travel_smoke(const struct world *w,
                                                struct path *p,
                                                struct medium *m, float t,
                                                struct vec3 *beta)
{
    const struct vec3 one = v3(1.0f, 1.0f, 1.0f);
    const struct vec3 none = v3(0.0f, 0.0f, 0.0f);
    struct collision c = {t, one, false, false};
    struct vec3 q = smoke_shares(w, m, p->beta);
    struct vec2 u = path_medium_2d(p, DIMENSION_MEDIUM);
    struct smoke_ray ray = {.r = p->ray,
                            .fog = *m,
                            .shares = q,
                            .channel = channel_chosen(q, u.y),
                            .key = smoke_key(p),
                            .first = path_medium_2d(p, DIMENSION_SMOKE),
                            .steps = &p->smoke_steps};
    struct smoke_flight f = smoke_fly(w, &ray, t);
    struct vec3 left = f.left, factor = one, densities = one;
    bool scatters = medium_scatters(m);

    path_add(p, f.glow, 1.0f);
    if (f.is_cut) {
        p->beta = *beta = none;
        c.is_there = true;
        return c;
    }
    *beta = p->beta;
    p->beta = f.smoke == NO_INDEX
                  ? attenuated(v3_mul(p->beta, balanced(one, one, left, q)), m,
                               p->ray, t)
                  : none;
    if (scatters) {
        float depth =
            collision_depth(channel_of(m->extinction, ray.channel), u.x);

        c.is_there = depth < medium_depth(m, p->ray, f.t);
        if (c.is_there) {
            c.t = f_min(medium_distance(m, p->ray, depth), f.t);
            f = smoke_fly(w, &ray, c.t);
            left = f.is_cut ? none : f.left;
            factor = m->scattering;
            densities = m->extinction;
        }
    }
    if (!c.is_there && f.smoke != NO_INDEX) {
        GLOBAL const struct smoke_medium *s = &w->smokes[f.smoke];

        c.is_there = c.is_in_smoke = true;
        c.t = f.t;
        factor = s->scattering;
        densities = s->extinction;
    }
    if (scatters)
        left =
            v3_mul(left, relative_transmittance(m->extinction,
                                                medium_depth(m, p->ray, c.t)));
    else
        *beta = attenuated(*beta, m, p->ray, c.t);
    *beta = v3_mul(*beta, balanced(factor, densities, left, q));
    if (c.is_in_smoke) {
        m->extinction = densities;
        m->scattering = factor;
        m->anisotropy = w->smokes[f.smoke].anisotropy;
    }
    return c;
}

/* Extends the path by a vertex in a medium, at a distance t of its ray, on this
 * segment. Returns as path_extend(). */
static inline bool path_collide(const struct world *w, struct path *p,
                                const struct medium *m, float t,
                                struct vec3 beta, const struct segment *s)
{
    struct vec3 d = p->ray.d;

    p->beta = beta;
    if (v3_is_zero(beta) || path_is_full(w, p))
        return false;
    path_prepare_2d(p);
    first_surface_scatter(&p->surface, m, v3_neg(d), t);
    p->ray.o = v3_add(p->ray.o, v3_scale(d, t));
    p->ray.from = 0;
    p->from.p = p->ray.o;
    p->from.n = d;
    p->from.transmits = true;
    p->from.is_free = true;
    p->cell = guide_cell_none();
    p->casts = p->is_chain = false;
    p->segment = *s;
    p->light.is_lit = path_choose_medium_light(w, p, m, d);
    p->ray.d = phase_sample(m, d, path_2d(p, DIMENSION_BSDF_DIRECTION));
    p->pdf = phase_density(m, d, p->ray.d);
    return path_advance(w, p, path_2d(p, DIMENSION_BSDF_LOBE).y);
}

/* Takes the path's ray through a boundary, at a distance t. Returns false after
 * too many of them. */
static inline bool path_cross(struct path *p, uint32_t material,
                              const struct surface_point *v, float t)
{
    if (p->crossings == CROSSINGS_MAX) {
        p->out.cut = 1;
        return false;
    }
    p->crossings++;
    p->out.rays++;
    first_surface_pass(&p->surface, t);
    boundary_cross(&p->media, material, v, &p->ray);
    p->ray.t_max = FLOAT_MAX;
    return true;
}

/* Gives the BSDF of a dispersive material the index at the path's wavelength,
 * which is drawn at the first one. */
static inline void path_disperse(struct path *p,
                                 GLOBAL const struct material *m,
                                 const struct surface_point *v, struct bsdf *b)
{
    if (p->wavelength == 0.0f)
        p->wavelength =
            wavelength_draw(&p->beta,
                            random_2d(p->sampler, DIMENSION_WAVELENGTH).x);
    bsdf_disperse(m, v, p->wavelength, b);
}

/* ---- below surfaces ---- */

/* Returns random numbers of a step of the path's walk; `which` is 0 or 1. Step
 * 0 decides whether there is a walk. */
static inline struct vec2 path_below_2d(const struct path *p, uint32_t which)
{
    struct sampler s = p->sampler;

    s.key = hash_u32(s.key + 2u * p->below.steps + which);
    return vertex_2d(s, p->vertex, DIMENSION_WALK);
}

/* Chooses where the next step of the walk collides. Its ray ends there, which
 * takes less time than to the next surface. Rays of steps whose number is a
 * power of two do not end, so that walks out of an open mesh are noticed. */
static inline void path_aim_below(struct path *p)
{
    uint32_t steps = ++p->below.steps;
    float depth =
        collision_sample(&p->below.medium, p->beta, path_below_2d(p, 0));

    p->below.reach = f_min(depth, FLOAT_MAX);
    p->ray.t_max = (steps & (steps - 1u)) == 0 ? FLOAT_MAX : p->below.reach;
    p->out.rays++;
}

/* Begins a walk below the surface, or leaves the BSDF what does not enter.
 * Returns false if the path does not enter. */
APART static bool path_enters(const struct world *w, struct path *p,
                              GLOBAL const struct material *m,
                              uint32_t material, const struct surface_point *v,
                              struct bsdf *b)
{
    struct vec3 entry =
        subsurface_entry(b, surface_to_local(v, v3_neg(p->ray.d)));
    float share = subsurface_share(w, m, v, b);
    float q = share * subsurface_chance(b, entry);
    struct surface_point below;
    struct vec3 d;

    if (!(path_below_2d(p, 0).x < q)) {
        p->beta = v3_scale(p->beta, 1.0f / (1.0f - q));
        subsurface_leave(b, share);
        return false;
    }
    below = surface_turned(surface_of_face(*v));
    d = cosine_around(below.ng,
                      vertex_2d(p->sampler, p->vertex, DIMENSION_ENTRY));
    p->beta = v3_mul(p->beta, v3_scale(entry, share / q));
    p->below.medium = subsurface_medium(m, b->color);
    p->below.material = material;
    surface_spawn_ray(&below, d, 1.0f, &p->ray);
    path_aim_below(p);
    return true;
}

/* Ends a walk at the hit of its ray, where the path leaves. Returns as
 * path_extend(). */
static inline bool path_leave(const struct world *w, struct path *p,
                              const struct hit *h)
{
    const struct bsdf white = {.color = {1.0f, 1.0f, 1.0f},
                               .kind = MATERIAL_DIFFUSE};
    const struct vec3 wo = v3(0.0f, 0.0f, 1.0f); /* Lambert's needs none */
    uint32_t material = p->below.material;
    GLOBAL const struct material *m = &w->materials[material];
    struct surface_point v;
    struct vec2 lobe = path_2d(p, DIMENSION_BSDF_LOBE);

    if (!surface_at(w, m, p->ray, *h, &v))
        return false;
    v = surface_turned(v);
    p->below.steps = 0;
    p->from.p = v.p;
    p->from.n = v.n;
    p->from.transmits = false;
    p->from.is_free = false;
    p->cell = guide_cell_none();
    p->light.is_lit = path_choose_light(w, p, material, m, &white, &v, wo);
    return path_scatter(w, p, material, &white, &v, wo,
                        path_2d(p, DIMENSION_BSDF_DIRECTION), lobe.x) &&
           path_advance(w, p, lobe.y);
}

/* True if the walk collides before the hit of its ray. A ray that does not end
 * and meets nothing has left the body. */
static inline bool path_collides_below(const struct path *p,
                                       const struct hit *h)
{
    return h->tri == NO_INDEX ? p->ray.t_max < FLOAT_MAX
                              : p->below.reach < h->t;
}

/* Takes a step of a walk, whose ray has this hit. Walks that come to another
 * material or out of an open mesh end. Returns as path_extend(). */
APART static bool path_go_below(const struct world *w, struct path *p,
                                const struct hit *h)
{
    bool collides = path_collides_below(p, h);
    float t = collides ? p->below.reach : h->t, q;
    struct vec2 u;

    if (!collides && h->tri == NO_INDEX)
        return false;
    p->beta = v3_mul(p->beta,
                     collision_weight(&p->below.medium, p->beta, t, collides));
    if (!collides)
        return tri_material(w, h->tri, instance_of(w, h->tri)) ==
                   p->below.material &&
               path_leave(w, p, h);
    if (p->below.steps == SUBSURFACE_STEPS_MAX) {
        p->out.cut = 1;
        return false;
    }
    q = f_min(sqrtf(v3_max_component(p->beta)), 1.0f);
    u = path_below_2d(p, 1);
    if (!(unit_float(
              hash_u32(p->sampler.key ^ float_bits(u.x) ^ p->below.steps)) < q))
        return false;
    p->beta = v3_scale(p->beta, 1.0f / q);
    p->ray.o = v3_add(p->ray.o, v3_scale(p->ray.d, t));
    p->ray.d = phase_sample(&p->below.medium, p->ray.d, u);
    p->ray.from = 0;
    path_aim_below(p);
    return true;
}

/* Takes the surface that the path's ray meets at a distance t, with its BSDF
 * and normal, as the first one, behind the medium of the ray. */
static inline void path_meet_first(struct path *p, const struct medium *m,
                                   const struct bsdf *b, struct vec3 n, float t)
{
    bool is_ahead = first_surface_is_ahead(&p->surface);

    first_surface_meet(&p->surface, b, n, t);
    if (HAS(FEATURE_MEDIA) && is_ahead && p->surface.state == SURFACE_MET &&
        p->media.count == 0 && medium_scatters(m))
        first_surface_fade(&p->surface, m,
                           transmittance(m->extinction,
                                         medium_depth(m, p->ray, t)),
                           v3_neg(p->ray.d));
}

/* Extends the path by one vertex, the hit *h of the path's ray. The shadow ray
 * of p->light is to be traced next, if there is one, then the path's ray.
 * Returns false if the path ends. */
static inline bool path_extend(const struct world *w, struct path *p,
                               const struct hit *h)
{
    GLOBAL const struct material *m;
    struct surface_point v;
    struct bsdf b;
    struct vec3 wo, beta;
    struct vec2 lobe;
    struct medium medium;
    struct collision c = {0.0f, v3(1.0f, 1.0f, 1.0f), false, false};
    struct segment segment;
    uint32_t material;
    bool has_cells = false;

    p->light.is_lit = false;
    if (HAS(FEATURE_SUBSURFACE) && p->below.steps > 0)
        return path_go_below(w, p, h);
    /* Add lights before the hit, and the sky and suns of a ray that leaves */
    if (HAS(FEATURE_POINT_LIGHTS))
        path_add_spheres(w, p, h->tri == NO_INDEX ? FLOAT_MAX : h->t);
    if (HAS(FEATURE_ATTENUATION)) {
        float t = h->tri == NO_INDEX ? FLOAT_MAX : h->t;

        medium = medium_of(w, &p->media);
        segment.is_there = false;
        c = is_in_smokes(w, &p->media)
                ? path_travel_smoke(w, p, &medium, t, &beta)
                : path_travel_lit(w, p, &medium, t, &beta, &segment);
    }
    if (h->tri == NO_INDEX) {
        path_add_sky(w, p);
        if (HAS(FEATURE_DIRECTIONAL_LIGHTS))
            path_add_discs(w, p);
        if (!HAS(FEATURE_MEDIA) || !c.is_there)
            return false;
        first_surface_light(&p->surface, p->vertex, p->out.radiance);
        return path_collide(w, p, &medium, c.t, beta, &segment);
    }
    /* Find the surface. The sample points are computed early: they take long,
     * and nothing before depends on them. */
    path_prepare_2d(p);
    material = tri_material(w, h->tri, instance_of(w, h->tri));
    m = &w->materials[material];
    if (!surface_at(w, m, p->ray, *h, &v))
        return false;
    /* Add emission of the surface */
    path_add_emission(w, p, m, h->tri, &v);
    first_surface_light(&p->surface, p->vertex, p->out.radiance);
    /* Scatter in the medium on the way, or enter another one */
    if (HAS(FEATURE_MEDIA) && c.is_there) {
        if (p->media.count == 0 && !c.is_in_smoke &&
            first_surface_is_ahead(&p->surface)) {
            b = bsdf_at(w, m, &v);
            path_meet_first(p, &medium, &b, v.n, h->t);
        }
        return path_collide(w, p, &medium, c.t, beta, &segment);
    }
    if (HAS(FEATURE_MEDIA))
        p->beta = beta;
    if (HAS(FEATURE_MEDIA) && m->is_boundary != 0)
        return path_cross(p, material, &v, h->t);
    if (HAS(FEATURE_LIGHT_PATHS))
        has_cells = path_meet_role(w, p, m);
    /* End at the limit of bounces */
    if (path_is_full(w, p))
        return false;
    /* Evaluate the BSDF's parameters and the path guide's cell */
    b = bsdf_at(w, m, &v);
    path_meet_first(p, &medium, &b, v.n, h->t);
    if (bsdf_is_black(&b))
        return false;
    /* behind the first surface, whose features have no wavelength */
    if (HAS(FEATURE_DISPERSION) && m->dispersion > 0.0f)
        path_disperse(p, m, &v, &b);
    if (has_cells)
        path_add(p,
                 light_cells_radiance(w, p->half_number, &v, &b,
                                      surface_to_local(&v, v3_neg(p->ray.d)),
                                      random_2d(p->sampler, DIMENSION_CELL)),
                 1.0f);
    if (HAS(FEATURE_SUBSURFACE) && b.subsurface > 0.0f) {
        if (path_enters(w, p, m, material, &v, &b))
            return true;
    } else if (HAS(FEATURE_RADIANCE_CELLS) &&
               w->settings.has_radiance_cells != 0 &&
               radiance_meet(w, p, &v, &b, h->tri, h->t))
        return false;
    if (!bsdf_is_glass(&b) && !is_translucent(&b))
        surface_lift(w, h->tri, *h, &v);
    wo = surface_to_local(&v, v3_neg(p->ray.d));
    p->from.p = v.p;
    p->from.n = v.n;
    p->from.transmits = bsdf_transmits(&b);
    if (HAS(FEATURE_MEDIA))
        p->from.is_free = false;
    p->cell = guide_cell_none();
    if (HAS(FEATURE_GUIDE) && guide_helps(&b))
        p->cell = guide_at(w, v.p, v.ng);
    /* Sample a light */
    p->light.is_lit = path_choose_light(w, p, material, m, &b, &v, wo);
    /* Sample the BSDF for the next direction; Russian roulette */
    lobe = path_2d(p, DIMENSION_BSDF_LOBE);
    return path_scatter(w, p, material, &b, &v, wo,
                        path_2d(p, DIMENSION_BSDF_DIRECTION), lobe.x) &&
           path_advance(w, p, lobe.y);
}

/* Extends the path by one vertex and traces its rays. *h becomes the next hit.
 * Returns false if the path ends. */
static inline bool path_step(const struct world *w, struct path *p,
                             struct hit *h)
{
    bool goes_on = path_extend(w, p, h);

    if (p->light.is_lit)
        path_add_light(w, p);
    if (goes_on)
        hit_closest(w, p->ray, h);
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

/* Returns the light that the path has found, at most the largest float. */
static inline struct vec3 path_light(const struct path *p)
{
    struct vec3 sum = p->out.radiance;

    if (HAS(FEATURE_MEDIA))
        sum = v3_add(sum, p->along);
    return v3_min(v3(FLOAT_MAX, FLOAT_MAX, FLOAT_MAX), sum);
}

/* Returns the sample of a path that has ended. Radiance is capped at the
 * largest float, and the film counts it as saturated. *surface is set if the
 * world's samples have first surfaces. */
static inline struct path_sample path_close(const struct world *w,
                                            struct path *p, struct ray camera,
                                            struct first_surface *surface)
{
    if (HAS(FEATURE_RADIANCE_CELLS) && p->estimates != NULL)
        radiance_estimate(p);
    p->out.radiance =
        v3_min(v3(FLOAT_MAX, FLOAT_MAX, FLOAT_MAX), p->out.radiance);
    if (has_first_surface(w)) {
        first_surface_end(w, &p->surface, p->vertex, p->out.radiance);
        if (HAS(FEATURE_MEDIA))
            p->surface.direct = v3_add(p->surface.direct, p->along);
        if (has_coverage(w) && !v3_is_zero(p->surface.seen)) {
            p->out.rays++;
            if (ray_is_divided(w, camera))
                p->surface.seen = v3(0.0f, 0.0f, 0.0f);
        }
        *surface = p->surface;
    }
    if (HAS(FEATURE_GRIDS) && p->smoke_steps > w->settings.smoke_steps_max)
        p->out.cut = 1;
    p->out.radiance = path_light(p);
    return p->out;
}

static inline bool samples_are_aovs(const struct world *w)
{
    return HAS(FEATURE_AOV) && w->settings.sample != SAMPLE_LIGHT;
}

/* Traces a camera ray and returns the radiance along it, or the AOV of its hit.
 */
static inline struct path_sample path_trace(const struct world *w,
                                            struct camera_sample start,
                                            struct first_surface *surface)
{
    struct path p;
    struct hit h;

    path_set_key(w, start.sampler, 1, &start.ray);
    hit_closest(w, start.ray, &h);
    if (samples_are_aovs(w))
        return aov_sample(w, start.ray, h);
    path_open(w, &p, start, NULL);
    while (path_step(w, &p, &h))
        ;
    return path_close(w, &p, start.ray, surface);
}

#endif
