// SPDX-License-Identifier: MIT
/*
 * light.h - light samples of all lights and of the sky, and their densities
 *
 * light_sample() samples a direction from a receiver to a light, for next-event
 * estimation. light_pdf_at() and sky_light_terms() have its density at a point
 * that a BSDF sample has hit, for MIS weights (Veach 1997, 9.2). Densities of a
 * light sample and of the same point hit by a ray are the same bits.
 *
 * Units:     normalised scene units, radiance, densities per solid angle
 */
#ifndef KERNELS_LIGHT_H
#define KERNELS_LIGHT_H

#include "kernels/guide.h"
#include "kernels/hit.h"
#include "kernels/lamps.h"
#include "kernels/light_tree.h"
#include "kernels/sample.h"
#include "kernels/sky.h"
#include "kernels/surface_point.h"

/* True if a material emits light and is not invisible. */
static inline bool material_shines(GLOBAL const struct material *m)
{
    return (m->emission.x > 0.0f || m->emission.y > 0.0f ||
            m->emission.z > 0.0f) &&
           m->opacity > 0.0f;
}

/* Emitted radiance of a material at a surface point, the same to both sides. */
static inline struct vec3 emission_at(const struct world *w,
                                      GLOBAL const struct material *m,
                                      const struct surface_point *v)
{
    if (!HAS(FEATURE_TEXTURES) || m->emission_texture == NO_INDEX || !v->has_uv)
        return m->emission;
    return v3_mul(m->emission, surface_texel(w, v, m->emission_texture).color);
}

/* Density per solid angle at the receiver of a point of a light: density by
 * area times distance^2 / cosine. to_point leads to it from the receiver;
 * `part` is its triangle in the light. 0 where the density is not finite; such
 * points are not sampled. */
static inline float light_point_pdf(const struct world *w, uint32_t light,
                                    uint32_t part, struct vec3 to_point)
{
    float square = v3_dot(to_point, to_point);
    float pdf = 2.0f * square * sqrtf(square) /
                fabsf(v3_dot(to_point, w->lights[light].scaled_normals[part]));

    return pdf <= FLOAT_MAX ? pdf : 0.0f;
}

/* Maps the square to uniform barycentrics and keeps stratification (Heitz 2019,
 * "A low-distortion map between triangle and square"). */
static inline struct hit triangle_point(struct vec2 u)
{
    struct hit h = {0.0f, 0.0f, 0.0f, 0.0f, NO_INDEX};
    float less = 0.5f * f_min(u.x, u.y);

    h.b0 = u.x - less;
    h.b1 = u.y - less;
    h.b2 = f_max(1.0f - h.b0 - h.b1, 0.0f);
    return h;
}

/* The same for two triangles that share a side, the halves of a parallelogram:
 * u.x and u.y are the barycentrics of corners 1 and 2 in the first half, and 1
 * minus these in the second. */
static inline struct hit pair_point(struct vec2 u, uint32_t *part)
{
    struct hit h = {0.0f, 0.0f, 0.0f, 0.0f, NO_INDEX};
    float turn;

    /* without a branch, as half of the predictions would be wrong */
    *part = (uint32_t)(u.x + u.y > 1.0f);
    turn = (float)*part;
    h.b1 = fabsf(turn - u.x);
    h.b2 = fabsf(turn - u.y);
    h.b0 = f_max(1.0f - h.b1 - h.b2, 0.0f);
    return h;
}

/* The hit with the mesh's order of corners. */
static inline struct hit hit_rotated(struct hit h, uint32_t turn)
{
    const float b[5] = {h.b0, h.b1, h.b2, h.b0, h.b1};

    h.b0 = b[turn];
    h.b1 = b[turn + 1];
    h.b2 = b[turn + 2];
    return h;
}

/* Emitted radiance of a light at a hit on it. */
static inline struct vec3 light_radiance(const struct world *w, uint32_t light,
                                         struct hit h)
{
    struct vec3 radiance = w->lights[light].emission;
    uint32_t texture = w->lights[light].texture;

    if (HAS(FEATURE_TEXTURES) && texture != NO_INDEX)
        radiance =
            v3_mul(radiance,
                   texture_at(w, texture,
                              texture_uv_at(
                                  w, texture,
                                  tri_at(w, h.tri, instance_of(w, h.tri)), h))
                       .color);
    if (has_coverage(w))
        radiance = v3_scale(radiance, coverage_at(w, h));
    return radiance;
}

/* Samples point light i, which was chosen with this probability. */
static inline bool sample_point_light(const struct world *w, uint32_t i,
                                      const struct receiver *r, struct vec2 u,
                                      float probability, struct light_sample *s)
{
    if (!point_light_sample(w, i, r->p, u, s))
        return false;
    s->pdf *= probability;
    s->tri = NO_INDEX;
    s->is_delta = i >= w->settings.sphere_count;
    return s->pdf > 0.0f;
}

/* Samples a light of the tree, which was chosen with this probability. */
static inline bool sample_chosen_light(const struct world *w, uint32_t light,
                                       const struct receiver *r,
                                       struct vec2 point, float probability,
                                       struct light_sample *s)
{
    uint32_t part = 0;
    struct vec3 p_error, to_point;
    struct hit h;

    s->light = light;
    s->probability = probability;
    s->is_near = true;
    s->is_sky = false;
    s->is_delta = false;
    if (!(probability > 0.0f))
        return false;
    if (HAS(FEATURE_POINT_LIGHTS) && light >= w->settings.light_count)
        return sample_point_light(w, light - w->settings.light_count, r, point,
                                  probability, s);
    h = w->lights[light].tris[1] == NO_INDEX ? triangle_point(point)
                                             : pair_point(point, &part);
    s->tri = h.tri = w->lights[light].tris[part];
    s->p = hit_point(h, w->lights[light].corners[2 * part],
                     w->lights[light].corners[1 + 2 * part],
                     w->lights[light].corners[3 - 2 * part], &p_error);
    to_point = v3_sub(s->p, r->p);
    s->pdf = probability * light_point_pdf(w, light, part, to_point);
    if (!(s->pdf > 0.0f))
        return false;
    s->wi = v3_unit(to_point);
    s->radiance =
        light_radiance(w, light,
                       hit_rotated(h, w->lights[light].rotation[part]));
    return true;
}

/* Samples a light of the tree. */
static inline bool sample_near_light(const struct world *w,
                                     const struct receiver *r,
                                     struct vec2 point, struct vec2 choice,
                                     struct light_sample *s)
{
    uint32_t light;
    float probability =
        w->settings.light_share * light_tree_sample(w, r, choice, &light);

    return sample_chosen_light(w, light, r, point, probability, s);
}

/* The light of a triangle of an instance, or NO_INDEX. Lights are in the order
 * of their triangles. */
static inline uint32_t instance_light(const struct world *w, uint32_t tri)
{
    uint32_t low = 0, high = w->settings.light_count;

    while (high - low > 1u) {
        uint32_t middle = low + (high - low) / 2u;

        if (tri < w->lights[middle].tris[0])
            high = middle;
        else
            low = middle;
    }
    return w->lights[low].tris[0] == tri || w->lights[low].tris[1] == tri
               ? low
               : NO_INDEX;
}

/* The light that a triangle belongs to, or NO_INDEX. */
static inline uint32_t light_of(const struct world *w, uint32_t tri)
{
    if (w->settings.light_count == 0)
        return NO_INDEX;
    if (has_instances(w) && tri >= plain_tri_count(w))
        return instance_light(w, tri);
    return w->tri_lights[tri];
}

/* Density of a sample of a light that was chosen, at the point of its triangle
 * that is to_point from the receiver. */
static inline float light_tri_pdf(const struct world *w, uint32_t light,
                                  uint32_t tri, struct vec3 to_point)
{
    uint32_t part = w->lights[light].tris[1] == tri ? 1u : 0u;

    return light_point_pdf(w, light, part, to_point);
}

/* Density of light_sample() at point p of a triangle, which a ray from the
 * receiver has hit. */
static inline float light_pdf_at(const struct world *w,
                                 const struct receiver *r, uint32_t tri,
                                 struct vec3 p)
{
    uint32_t light = light_of(w, tri);

    if (light == NO_INDEX)
        return 0.0f;
    return w->settings.light_share * light_tree_pmf(w, r, light) *
           light_tri_pdf(w, light, tri, v3_sub(p, r->p));
}

/* Density of light_sample() at sphere i, which a ray from the receiver has
 * met. */
static inline float sphere_pdf_at(const struct world *w,
                                  const struct receiver *r, uint32_t i)
{
    return w->settings.light_share *
           light_tree_pmf(w, r, w->settings.light_count + i) *
           point_light_pdf(w, i, r->p);
}

/* Density of a direction to the sky by the cosine at the receiver; even in a
 * medium. */
static inline float sky_cosine_pdf(const struct receiver *r, struct vec3 wi)
{
    if (receiver_is_free(r))
        return cone_pdf(2.0f);
    return f_max(v3_dot(wi, r->n), 0.0f) * (1.0f / PI);
}

/* Radiance of the sky in direction wi, a unit vector, and the density of
 * light_sample() there. Without a table the sky is sampled by the cosine at the
 * receiver. `first` is the receiver's table in the guide, with which it is
 * mixed, or NO_INDEX. */
static inline struct vec3 sky_light_terms(const struct world *w,
                                          const struct receiver *r,
                                          uint32_t first, struct vec3 wi,
                                          float *pdf)
{
    struct vec3 radiance;

    if (sky_has_table(w)) {
        radiance = sky_terms(w, wi, pdf);
    } else {
        radiance = sky_radiance(w, wi);
        *pdf = sky_cosine_pdf(r, wi);
    }
    if (HAS(FEATURE_GUIDE) && first != NO_INDEX)
        *pdf = guide_mixed_pdf(w, first, wi, *pdf);
    *pdf *= sky_pmf(w, r);
    return radiance;
}

/* Samples a direction to the sky. */
static inline struct vec3 sky_direction(const struct world *w,
                                        const struct receiver *r,
                                        uint32_t first, struct vec2 u)
{
    if (HAS(FEATURE_GUIDE) && first != NO_INDEX) {
        float share = guide_share(w, first);

        if (u.x < share)
            return guide_sample(w, first, u);
        u = guide_remap(u, share);
    }
    if (sky_has_table(w))
        return sky_sample(w, u);
    return receiver_is_free(r) ? cone_around(v3(0.0f, 1.0f, 0.0f), 2.0f, u)
                               : cosine_around(r->n, u);
}

/* Samples a directional light. */
static inline bool sample_directional(const struct world *w, uint32_t i,
                                      const struct receiver *r, struct vec2 u,
                                      struct light_sample *s)
{
    float size = w->directional_lights[i].size;

    s->wi = w->directional_lights[i].d;
    s->radiance = w->directional_lights[i].emission;
    s->pdf = directional_pmf(w, i, r);
    s->is_delta = !(size > 0.0f);
    if (size > 0.0f) {
        s->wi = cone_around(s->wi, size, u);
        s->pdf *= cone_pdf(size);
    }
    return s->pdf > 0.0f;
}

/* Samples the sky or a directional light; u, in [0, 1), chooses. */
static inline bool sample_infinite_light(const struct world *w,
                                         const struct receiver *r,
                                         uint32_t first, struct vec2 point,
                                         float u, struct light_sample *s)
{
    s->tri = NO_INDEX;
    s->p = r->p;
    s->is_near = false;
    s->is_sky = false;
    s->is_delta = false;
    if (has_directional_lights(w)) {
        uint32_t i = infinite_choose(w, r, u);

        if (i != NO_INDEX)
            return sample_directional(w, i, r, point, s);
        if (!(w->settings.sky_power > 0.0f))
            return false;
    }
    s->is_sky = true;
    s->wi = sky_direction(w, r, first, point);
    s->radiance = sky_light_terms(w, r, first, s->wi, &s->pdf);
    return s->pdf > 0.0f;
}

/* Samples a light and a point on it, or a direction to the sky. Returns false
 * if choice.x chooses no light sample, or if there is no light. `first` is the
 * receiver's table in the guide, or NO_INDEX. The caller tests the side of the
 * surface and the occlusion. */
static inline bool light_sample(const struct world *w, const struct receiver *r,
                                uint32_t first, struct vec2 point,
                                struct vec2 choice, struct light_sample *s)
{
    if (choice.x < w->settings.sky_share)
        return sample_infinite_light(w, r, first, point,
                                     choice.x / w->settings.sky_share, s);
    /* most scenes do without this division */
    if (w->settings.light_share != 1.0f)
        choice.x = (choice.x - w->settings.sky_share) / w->settings.light_share;
    if (!(choice.x < 1.0f))
        return false;
    return sample_near_light(w, r, point, choice, s);
}

#endif
