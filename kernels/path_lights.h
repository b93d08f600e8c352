// SPDX-License-Identifier: MIT
/*
 * path_lights.h - direct light of a path: lights that its ray meets, and light
 * samples
 *
 * Both estimates are weighted by the power heuristic (Veach 1997, "Robust Monte
 * Carlo methods for light transport simulation", 9.2). The ray query hit_any()
 * is that of path.h.
 *
 * Units:   normalised scene units, radiance
 */
#ifndef KERNELS_PATH_LIGHTS_H
#define KERNELS_PATH_LIGHTS_H

#include "kernels/medium.h"
#include "kernels/path_state.h"
#include "kernels/roulette.h"
#include "kernels/smoke.h"
#include "kernels/sphere_walk.h"
#include "kernels/surface_point.h"
#include "kernels/vec.h"

/* Offset between the keys of a vertex's next ray and of its shadow ray. */
#define SHADOW_KEY 0x10000u

/* Likewise of its key in smokes. */
#define SMOKE_KEY 0x20000u

/* Likewise of its samples along segments. */
#define ALONG_KEY 0x51ed270bu

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

/* True if smokes are where the ray is. */
static inline bool is_in_smokes(const struct world *w, const struct media *s)
{
    return HAS(FEATURE_GRIDS) && w->settings.smoke_count > 0 && s->count == 0;
}

/* Returns the key of random numbers of the path's ray in smokes. */
static inline uint32_t smoke_key(const struct path *p)
{
    return hash_u32(ray_key(p->sampler, SMOKE_KEY + p->vertex) + p->crossings);
}

/* Estimates the share of light that comes through smokes along a distance t of
 * a ray. `light` is its value in the pixel. */
static inline struct vec3 path_smoke_share(const struct world *w,
                                           struct path *p, struct ray r,
                                           float t, struct vec3 light,
                                           uint32_t key)
{
    struct smoke_passage a = {
        .r = r, .t = t, .weights = light, .key = key, .steps = &p->smoke_steps};

    return smoke_transmittance(w, a);
}

/* True if light paths bring light of lamps that comes by way of surfaces that
 * cast, so that the path leaves it out. */
static inline bool path_begins_matte(const struct path *p)
{
    return HAS(FEATURE_LIGHT_PATHS) && p->drops;
}

/* True if light paths bring the light of a lamp that the ray meets. */
static inline bool path_drops(const struct path *p)
{
    return path_begins_matte(p) && p->casts;
}

static inline void path_add_sky(const struct world *w, struct path *p)
{
    float pdf = 0.0f;
    struct vec3 radiance =
        p->pdf > 0.0f
            ? sky_light_terms(w, &p->from, p->cell.sky, p->ray.d, &pdf)
            : sky_radiance(w, p->ray.d);

    if (HAS(FEATURE_SKY_IMAGE) && path_drops(p))
        radiance = sky_below(w->settings.sky_level, radiance);
    path_add(p, radiance, bsdf_mis_weight(w, p->pdf, pdf));
}

/* Adds the discs of directional lights to which the path's ray escapes. */
static inline void path_add_discs(const struct world *w, struct path *p)
{
    for (uint32_t i = 0; i < w->settings.directional_light_count; i++) {
        float pdf = 0.0f;

        if (path_drops(p) || !disc_meets(w, i, p->ray.d))
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
    if (HAS(FEATURE_ATTENUATION)) {
        struct medium medium = medium_of(w, &p->media);

        radiance = attenuated(radiance, &medium, r, t);
    }
    if (is_in_smokes(w, &p->media))
        radiance =
            radiance_share(radiance, path_smoke_share(w, p, r, t,
                                                      v3_mul(p->beta, radiance),
                                                      smoke_key(p) ^ ~i));
    if (p->pdf > 0.0f)
        pdf = sphere_pdf_at(w, &p->from, i);
    if (HAS(FEATURE_MEDIA) && p->pdf > 0.0f && p->segment.is_there)
        pdf =
            both_densities(pdf,
                           segment_light_pdf(w, &p->segment,
                                             w->settings.light_count + i,
                                             w->point_lights[i].p,
                                             point_light_pdf(w, i, p->from.p)));
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
    if (w->settings.sphere_count == 0 || path_drops(p))
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

/* Returns the density of samples along the path's last segment at point y of a
 * triangle, which the path has met after a collision there. */
static inline float path_segment_pdf(const struct world *w,
                                     const struct path *p, uint32_t tri,
                                     struct vec3 y)
{
    uint32_t light = light_of(w, tri);

    if (light == NO_INDEX)
        return 0.0f;
    return segment_light_pdf(w, &p->segment, light, y,
                             light_tri_pdf(w, light, tri,
                                           v3_sub(y, p->from.p)));
}

static inline void path_add_emission(const struct world *w, struct path *p,
                                     GLOBAL const struct material *m,
                                     uint32_t tri,
                                     const struct surface_point *v)
{
    float light_pdf = 0.0f;

    if (!HAS(FEATURE_EMITTERS) || v3_is_zero(m->emission) ||
        (path_drops(p) && light_of(w, tri) != NO_INDEX))
        return;
    if (p->pdf > 0.0f)
        light_pdf = light_pdf_at(w, &p->from, tri, v->p);
    if (HAS(FEATURE_MEDIA) && p->pdf > 0.0f && p->segment.is_there)
        light_pdf =
            both_densities(light_pdf, path_segment_pdf(w, p, tri, v->p));
    path_add(p, emission_at(w, m, v), bsdf_mis_weight(w, p->pdf, light_pdf));
}

static inline uint32_t shadow_key(const struct path *p)
{
    return ray_key(p->sampler, SHADOW_KEY + p->vertex);
}

/* Russian roulette on the shadow ray of a light sample. Returns false if the
 * shadow ray is not traced. */
static inline bool shadow_survives(const struct path *p, struct vec3 *light)
{
    float q = roulette_shadow_survival(*light, p->out.radiance);

    if (!(q < 1.0f))
        return true;
    /* the random number is above 0, so that q = 0 never survives */
    if (!(1.0f - unit_float(hash_u32(shadow_key(p))) < q))
        return false;
    *light = v3_scale(*light, 1.0f / q);
    return true;
}

/* Returns true if light_sample() may find a light, and is wanted. */
static inline bool has_light_samples(const struct world *w)
{
    bool has_lights = w->settings.sky_share > 0.0f;

    if (HAS(FEATURE_EMITTERS))
        has_lights = has_lights || w->settings.light_count > 0;
    if (HAS(FEATURE_POINT_LIGHTS))
        has_lights = has_lights || w->settings.point_light_count > 0;
    return has_lights && w->settings.direct != DIRECT_BSDF;
}

/* Returns true if light_sample() can contribute at a surface with this BSDF. */
static inline bool wants_light_sample(const struct world *w,
                                      const struct bsdf *b)
{
    return has_light_samples(w) && !bsdf_is_delta(b);
}

/* Attenuates radiance of a light sample that comes to p in these media. With
 * boundaries, and in smokes, path_add_light() does that. */
static inline struct vec3 path_light_attenuated(const struct world *w,
                                                struct path *p,
                                                const struct media *media,
                                                const struct light_sample *l,
                                                struct vec3 radiance)
{
    float distance =
        l->is_near ? v3_length(v3_sub(l->p, p->from.p)) : FLOAT_MAX;
    struct ray r = {p->from.p, l->wi, distance, 0, 0};
    struct medium medium;

    if (HAS(FEATURE_MEDIA))
        p->light_media = *media;
    if (HAS(FEATURE_MEDIA) && w->settings.has_boundaries != 0)
        return radiance;
    medium = medium_of(w, media);
    return attenuated(radiance, &medium, r, distance);
}

/* Aims the shadow ray at the light sample. The direction is computed again,
 * because the ray's origin is offset from the vertex; it need not be of unit
 * length. Returns false if the ray misses the light. */
static inline bool path_aim(const struct world *w, const struct path *p,
                            const struct surface_point *v,
                            const struct light_sample *l, float cosine,
                            struct ray *r)
{
    r->o = surface_ray_origin(v, cosine);
    r->d = l->wi;
    r->t_max = FLOAT_MAX;
    r->key = has_coverage(w) ? shadow_key(p) : 0;
    r->from = v->face;
    if (l->tri != NO_INDEX) {
        uint32_t instance = instance_of(w, l->tri);
        struct tri t = tri_at(w, l->tri, instance);

        r->d = v3_sub(l->p, r->o);
        r->t_max = aimed_distance(*r, position_at(w, t.v[0], instance),
                                  position_at(w, t.v[1], instance),
                                  position_at(w, t.v[2], instance));
        return r->t_max > 0.0f;
    }
    if (HAS(FEATURE_POINT_LIGHTS) && l->is_near) {
        r->d = v3_sub(l->p, r->o);
        r->t_max = POINT_WAY;
    }
    return true;
}

/* Draws the light sample of the path's vertex. Returns false if there is none,
 * or if roulette drops its shadow ray. */
FLATTENED static inline bool
path_choose_light(const struct world *w, struct path *p, uint32_t material,
                  GLOBAL const struct material *m, const struct bsdf *b,
                  const struct surface_point *v, struct vec3 wo)
{
    struct light_sample l;
    struct vec3 wi, radiance;
    float pdf;

    if (!wants_light_sample(w, b) ||
        !light_sample(w, &p->from, p->cell.sky,
                      path_2d(p, DIMENSION_LIGHT_POSITION),
                      path_2d(p, DIMENSION_LIGHT_CHOICE), &l))
        return false;
    if (path_begins_matte(p) && m->role == ROLE_CASTS) {
        if (!l.is_sky)
            return false;
        if (HAS(FEATURE_SKY_IMAGE))
            l.radiance = sky_below(w->settings.sky_level, l.radiance);
    }
    wi = surface_to_local(v, l.wi);
    if (!surface_sides_agree(v, l.wi, wi.z))
        return false;
    radiance = v3_mul(bsdf_terms(b, wo, wi, &pdf), l.radiance);
    if ((HAS(FEATURE_POINT_LIGHTS) || HAS(FEATURE_DIRECTIONAL_LIGHTS)) &&
        l.is_delta)
        pdf = 0.0f;
    if (v3_is_zero(radiance))
        return false;
    radiance = path_part(p, radiance,
                         bsdf_eta_scale(b, wi) *
                             light_mis_weight(w, l.pdf, pdf) / l.pdf);
    if (HAS(FEATURE_ATTENUATION)) {
        struct media media = p->media;

        media_follow(&media, material, b, v, wi.z);
        radiance = path_light_attenuated(w, p, &media, &l, radiance);
    }
    p->light.tri = l.tri;
    p->light.radiance = radiance;
    return shadow_survives(p, &p->light.radiance) &&
           path_aim(w, p, v, &l, wi.z, &p->light.shadow);
}

/* Aims the shadow ray from the path's vertex in a medium. radiance: that of the
 * sample at the pixel. Returns as path_choose_light(). */
static inline bool path_light_medium(const struct world *w, struct path *p,
                                     const struct light_sample *l,
                                     struct vec3 radiance)
{
    struct surface_point v;

    if (v3_is_zero(radiance))
        return false;
    v.above = p->from.p;
    v.face = 0;
    p->light.tri = l->tri;
    p->light.radiance = path_light_attenuated(w, p, &p->media, l, radiance);
    return shadow_survives(p, &p->light.radiance) &&
           path_aim(w, p, &v, l, 1.0f, &p->light.shadow);
}

/* Density with which a path that is scattered by the phase function, whose
 * density is `phase`, would have met the light sample. */
static inline float phase_light_pdf(const struct world *w,
                                    const struct light_sample *l, float phase)
{
    return l->is_delta || w->settings.direct == DIRECT_LIGHTS ? 0.0f : phase;
}

/* Draws the light sample of a vertex in a medium, to which the path has come in
 * direction d. Returns as path_choose_light(). */
static inline bool path_choose_medium_light(const struct world *w,
                                            struct path *p,
                                            const struct medium *m,
                                            struct vec3 d)
{
    struct light_sample l;
    float pdf, other;

    if (!has_light_samples(w) ||
        !light_sample(w, &p->from, NO_INDEX,
                      path_2d(p, DIMENSION_LIGHT_POSITION),
                      path_2d(p, DIMENSION_LIGHT_CHOICE), &l))
        return false;
    pdf = phase_density(m, d, l.wi);
    other = phase_light_pdf(w, &l, pdf);
    if (p->segment.is_there && l.is_near)
        other =
            both_densities(other,
                           segment_light_pdf(w, &p->segment, l.light,
                                             segment_target(w, l.light, l.p),
                                             l.pdf / l.probability));
    return path_light_medium(
        w, p, &l,
        path_part(p, l.radiance, pdf * power_weight(l.pdf, other) / l.pdf));
}

/* Boundaries of media that a ray crosses at most between two vertices. */
#define CROSSINGS_MAX 64u

/* Takes a ray to the other side of a boundary. */
static inline void boundary_cross(struct media *media, uint32_t material,
                                  const struct surface_point *v, struct ray *r)
{
    media_cross(media, material, v);
    surface_spawn_ray(v, r->d, -1.0f, r);
}

/* Returns the ray with a direction of length 1. */
static inline struct ray ray_of_unit(struct ray r)
{
    float length = v3_length(r.d);

    r.d = v3_scale(r.d, 1.0f / length);
    r.t_max = f_min(r.t_max * length, FLOAT_MAX);
    return r;
}

/* Returns the share of light that comes along the shadow ray, through media and
 * their boundaries. Boundaries are crossed in the order in which they lie, so
 * that the share does not depend on the tree. */
static inline struct vec3 shadow_transmittance(const struct world *w,
                                               struct path *p)
{
    struct ray r = ray_of_unit(p->light.shadow);
    struct media media = p->light_media;
    struct vec3 left = v3(1.0f, 1.0f, 1.0f);

    for (uint32_t i = 0; i <= CROSSINGS_MAX; i++) {
        struct medium medium = medium_of(w, &media);
        struct surface_point v;
        GLOBAL const struct material *m;
        uint32_t material;
        struct hit h;
        bool is_end;

        p->out.rays++;
        is_end = !hit_closest(w, r, &h) || h.tri == p->light.tri;
        left = attenuated(left, &medium, r, is_end ? r.t_max : h.t);
        if (is_in_smokes(w, &media))
            left =
                v3_mul(left, path_smoke_share(w, p, r, is_end ? r.t_max : h.t,
                                              v3_mul(left, p->light.radiance),
                                              hash_u32(shadow_key(p) + i)));
        if (is_end)
            return left;
        material = tri_material(w, h.tri, instance_of(w, h.tri));
        m = &w->materials[material];
        if (m->is_boundary == 0 || v3_is_zero(left))
            break;
        if (!surface_at(w, m, r, h, &v))
            break;
        boundary_cross(&media, material, &v, &r);
        if (r.t_max < FLOAT_MAX)
            r.t_max -= h.t;
    }
    return v3(0.0f, 0.0f, 0.0f);
}

/* Traces the shadow ray and adds the light sample if it is not occluded. */
static inline void path_add_light(const struct world *w, struct path *p)
{
    if (HAS(FEATURE_MEDIA) && w->settings.has_boundaries != 0) {
        p->out.radiance =
            v3_add(p->out.radiance, radiance_share(p->light.radiance,
                                                   shadow_transmittance(w, p)));
        return;
    }
    p->out.rays++;
    if (hit_any(w, p->light.shadow, p->light.tri))
        return;
    if (is_in_smokes(w, &p->light_media)) {
        struct ray r = ray_of_unit(p->light.shadow);

        p->light.radiance =
            radiance_share(p->light.radiance,
                           path_smoke_share(w, p, r, r.t_max, p->light.radiance,
                                            shadow_key(p)));
    }
    p->out.radiance = v3_add(p->out.radiance, p->light.radiance);
}

/* Draws a light sample along the segment, at a point that becomes p->from.
 * Returns as path_choose_light(). */
static inline bool path_choose_along(const struct world *w, struct path *p,
                                     const struct medium *m, struct segment *s)
{
    struct sampler sampler = p->sampler;
    struct receiver reference;
    struct light_sample l;
    struct vec3 shares = collision_shares(m, p->beta), target, scattered;
    struct vec2 position, u;
    float pmf, t, pdf, collision, phase, at_collision, by_phase;
    uint32_t light;

    sampler.key = hash_u32(sampler.key + ALONG_KEY + p->crossings);
    position = vertex_2d(sampler, p->vertex, DIMENSION_LIGHT_POSITION);
    u = vertex_2d(sampler, p->vertex, DIMENSION_MEDIUM);
    /* the light is chosen where collisions are */
    s->reference = u.y * f_min(s->end, 2.0f / v3_max_component(m->extinction));
    reference = segment_receiver(s, s->reference);
    pmf =
        w->settings.light_share *
        light_tree_sample(w, &reference,
                          vertex_2d(sampler, p->vertex, DIMENSION_LIGHT_CHOICE),
                          &light);
    if (!(pmf > 0.0f) ||
        !sample_chosen_light(w, light, &reference, position, 1.0f, &l))
        return false;
    target = segment_target(w, light, l.p);
    if (!segment_passes(s, target, 0.0f))
        return false;
    t = segment_sample(s, target, u.x);
    p->from = segment_receiver(s, t);
    if (!sample_chosen_light(w, light, &p->from, position, 1.0f, &l))
        return false;
    pdf = pmf * segment_density(s, target, t) * l.pdf;
    if (!(pdf > 0.0f && pdf <= FLOAT_MAX))
        return false;
    collision = collision_density(m, shares, p->ray, t);
    phase = phase_density(m, s->d, l.wi);
    at_collision = collision * w->settings.light_share *
                   light_tree_pmf(w, &p->from, light) * l.pdf;
    by_phase = collision * phase_light_pdf(w, &l, phase);
    scattered =
        v3_mul(v3_scale(m->scattering, density_along(m, p->ray, t)),
               transmittance(m->extinction, medium_depth(m, p->ray, t)));
    return path_light_medium(
        w, p, &l,
        path_part(p, v3_mul(l.radiance, scattered),
                  phase *
                      power_weight(pdf,
                                   both_densities(at_collision, by_phase)) /
                      pdf));
}

/* Adds a light sample along the path's ray, which ends at t, if it passes a
 * light in a medium that scatters. Light before the first vertex is kept apart
 * from what is seen there. */
APART static struct segment path_add_along(const struct world *w,
                                           struct path *p,
                                           const struct medium *m, float t)
{
    struct segment s = segment_of(w, m, p->ray, t);
    struct receiver from = p->from;
    struct vec3 sum = p->out.radiance;

    if (!s.is_there)
        return s;
    if (path_choose_along(w, p, m, &s)) {
        if (p->vertex == 1)
            p->out.radiance = p->along;
        path_add_light(w, p);
        if (p->vertex == 1) {
            p->along = p->out.radiance;
            p->out.radiance = sum;
        }
    }
    p->from = from;
    return s;
}

#endif
