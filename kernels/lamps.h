// SPDX-License-Identifier: MIT
/*
 * lamps.h - lights without triangles: how point and spot lights look from a
 * receiver, rays through those that are spheres, directional lights, and the
 * choice between them and the sky
 *
 * Units:     normalised scene units, radiance, intensity (radiance times area),
 *            irradiance, densities per solid angle
 */
#ifndef KERNELS_LAMPS_H
#define KERNELS_LAMPS_H

#include "kernels/light_tree.h"
#include "kernels/sample.h"

/* ---- point and spot lights ---- */

/* Squared distance below which a point without a radius lights surfaces as from
 * there. Its light would otherwise have no bound, and a path that comes so near
 * by chance would be a speck in the picture. */
#define POINT_NEAR2 1e-8f

/* Part of a way from which on nothing occludes a point light: a light on a
 * surface shines to both of its sides. */
#define POINT_WAY 0.9999f

/* The profile's factor for emission in direction d. Bilinear; columns wrap. */
static inline float profile_at(const struct world *w, uint32_t i, struct vec3 d)
{
    struct vec3 axis = w->point_lights[i].axis;
    struct vec3 side = w->point_lights[i].side;
    uint32_t columns = w->point_lights[i].profile_columns;
    uint32_t first = w->point_lights[i].profile - 1u;
    float x = v3_dot(side, d), y = v3_dot(v3_cross(side, axis), d);
    float row = atan2_rad(sqrtf(x * x + y * y), v3_dot(axis, d)) *
                ((float)(PROFILE_ROWS - 1) / PI);
    float column = (atan2_rad(y, x) * (0.5f / PI) + 1.0f) * (float)columns;
    uint32_t r = (uint32_t)f_min(row, (float)(PROFILE_ROWS - 2));
    uint32_t c = (uint32_t)column;
    float right = column - (float)c;
    uint32_t c0 = c % columns, c1 = (c + 1u) % columns;
    float low = f_min(row - (float)r, 1.0f);

    first += r * columns;
    return (1.0f - low) * ((1.0f - right) * w->profiles[first + c0] +
                           right * w->profiles[first + c1]) +
           low * ((1.0f - right) * w->profiles[first + columns + c0] +
                  right * w->profiles[first + columns + c1]);
}

/* Part of the emission towards a receiver that sees the light in direction
 * wi. */
static inline float point_light_part(const struct world *w, uint32_t i,
                                     struct vec3 wi)
{
    float part =
        w->point_lights[i].cone_offset -
        w->point_lights[i].cone_scale * v3_dot(w->point_lights[i].axis, wi);

    part = f_min(f_max(part, 0.0f), 1.0f);
    part *= part;
    if (w->point_lights[i].profile != 0u && part > 0.0f)
        part *= profile_at(w, i, v3_neg(wi));
    return part;
}

/* Size of the cone in which a sphere is seen, for cone_around(): its middle is
 * at `to` from the receiver. From inside it is seen in all directions. */
static inline float sphere_size(struct vec3 to, float radius)
{
    float ratio = radius * radius / v3_dot(to, to);

    return ratio < 1.0f ? ratio / (1.0f + sqrtf(1.0f - ratio)) : 2.0f;
}

/* Distance along d, a unit vector, at which a ray meets a sphere whose middle
 * is at `to` from its origin: the near side, or from inside the far one. Rays
 * that pass it get the distance of the middle; *passes is then true. */
static inline float sphere_distance(struct vec3 to, struct vec3 d, float radius,
                                    bool *passes)
{
    float middle = v3_dot(to, d);
    struct vec3 aside = v3_sub(to, v3_scale(d, middle));
    float square = radius * radius - v3_dot(aside, aside);
    float chord = sqrtf(f_max(square, 0.0f));

    *passes = !(square >= 0.0f);
    return v3_dot(to, to) < radius * radius ? middle + chord : middle - chord;
}

struct light_sample {
    struct vec3 wi;       /* unit, from the receiver */
    struct vec3 radiance; /* along wi, if nothing occludes it */
    float pdf;            /* of wi per solid angle; above 0 and finite */
    uint32_t tri;         /* NO_INDEX: not an area light */
    struct vec3 p;        /* the point on the area light or point light */
    uint32_t light;       /* of the tree, if it is near */
    float probability;    /* of that light */
    bool is_near;         /* of a light of the tree; false: from infinity */
    bool is_sky;
    bool is_delta; /* BSDF samples cannot find the light: radiance and pdf
                      are an irradiance and a probability */
};

/* Sets wi, radiance, p and pdf, which for a point is 1, of a sample of point
 * light i. Returns false if the receiver is on the point. */
static inline bool point_light_sample(const struct world *w, uint32_t i,
                                      struct vec3 from, struct vec2 u,
                                      struct light_sample *s)
{
    struct vec3 to = v3_sub(w->point_lights[i].p, from);
    float radius = w->point_lights[i].radius;
    float square = v3_dot(to, to);
    float scale = 1.0f;
    bool passes;

    if (!(square > 0x1p-100f && square <= FLOAT_MAX))
        return false;
    s->p = w->point_lights[i].p;
    s->wi = v3_unit(to);
    s->pdf = 1.0f;
    if (radius > 0.0f) {
        float size = sphere_size(to, radius);

        s->wi = cone_around(s->wi, size, u);
        s->p = v3_add(from, v3_scale(s->wi, sphere_distance(to, s->wi, radius,
                                                            &passes)));
        s->pdf = cone_pdf(size);
    } else {
        scale = 1.0f / f_max(square, POINT_NEAR2);
    }
    s->radiance = v3_scale(w->point_lights[i].emission,
                           scale * point_light_part(w, i, s->wi));
    return true;
}

/* Density of point_light_sample() for a sphere that a ray from `from` has
 * met. */
static inline float point_light_pdf(const struct world *w, uint32_t i,
                                    struct vec3 from)
{
    return cone_pdf(sphere_size(v3_sub(w->point_lights[i].p, from),
                                w->point_lights[i].radius));
}

/* Returns true if the ray meets sphere i before its t_max, at *t. */
static inline bool sphere_meets(const struct world *w, uint32_t i, struct ray r,
                                float *t)
{
    bool passes;

    *t = sphere_distance(v3_sub(w->point_lights[i].p, r.o), r.d,
                         w->point_lights[i].radius, &passes);
    return !passes && *t > 0.0f && *t < r.t_max;
}

/* ---- directional lights ---- */

/*
 * All light from infinity shares its light samples by the irradiance that the
 * receiver would have without occlusion, so that no sample is spent on a sun
 * behind the surface. Discs are sampled uniformly.
 */

static inline bool has_directional_lights(const struct world *w)
{
    return HAS(FEATURE_DIRECTIONAL_LIGHTS) &&
           w->settings.directional_light_count > 0;
}

/* Importance of a directional light for a receiver. It is above 0 where any
 * part of its disc is above the horizon. */
static inline float directional_importance(const struct world *w, uint32_t i,
                                           const struct receiver *r)
{
    float cosine = v3_dot(w->directional_lights[i].d, r->n);

    if (r->transmits)
        cosine = fabsf(cosine);
    if (receiver_is_free(r))
        cosine = 1.0f;
    return w->directional_lights[i].power *
           f_max(cosine + w->directional_lights[i].sine, 0.0f);
}

/* Importance of all light from infinity: of the sky and of directional
 * lights. */
static inline float infinite_importance(const struct world *w,
                                        const struct receiver *r)
{
    float sum = w->settings.sky_power;

    for (uint32_t i = 0; i < w->settings.directional_light_count; i++)
        sum += directional_importance(w, i, r);
    return sum;
}

/* Probability that a light sample is of the part of light from infinity that
 * has this importance. */
static inline float infinite_pmf(const struct world *w,
                                 const struct receiver *r, float importance)
{
    return importance > 0.0f ? w->settings.sky_share *
                                   (importance / infinite_importance(w, r))
                             : 0.0f;
}

/* Probability that a light sample is of the sky. */
static inline float sky_pmf(const struct world *w, const struct receiver *r)
{
    return has_directional_lights(w) ? infinite_pmf(w, r, w->settings.sky_power)
                                     : w->settings.sky_share;
}

/* Probability that a light sample is of directional light i. */
static inline float directional_pmf(const struct world *w, uint32_t i,
                                    const struct receiver *r)
{
    return infinite_pmf(w, r, directional_importance(w, i, r));
}

/* Chooses between the sky and directional lights by a number in [0, 1). Returns
 * a light, or NO_INDEX for the sky. */
static inline uint32_t infinite_choose(const struct world *w,
                                       const struct receiver *r, float u)
{
    float rest = u * infinite_importance(w, r) - w->settings.sky_power;
    uint32_t chosen = NO_INDEX;

    for (uint32_t i = 0;
         i < w->settings.directional_light_count && rest >= 0.0f; i++) {
        float importance = directional_importance(w, i, r);

        rest -= importance;
        if (importance > 0.0f)
            chosen = i;
    }
    return chosen;
}

/* Density of directions to the disc of a light. */
static inline float directional_pdf(const struct world *w, uint32_t i,
                                    const struct receiver *r)
{
    return directional_pmf(w, i, r) * cone_pdf(w->directional_lights[i].size);
}

/* True if the unit vector d leads to the disc of light i. The length of a chord
 * keeps the digits that the cosine of a small angle has lost. */
static inline bool disc_meets(const struct world *w, uint32_t i, struct vec3 d)
{
    struct vec3 chord = v3_sub(d, w->directional_lights[i].d);

    return v3_dot(chord, chord) <= 2.0f * w->directional_lights[i].size;
}

#endif
