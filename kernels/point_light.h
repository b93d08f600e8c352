// SPDX-License-Identifier: MIT
/*
 * point_light.h - point and spot lights: how they look from a receiver, and
 * rays through those that are spheres
 *
 * Units:     normalised scene units, radiance, intensity (radiance times area)
 */
#ifndef KERNELS_POINT_LIGHT_H
#define KERNELS_POINT_LIGHT_H

#include "kernels/sample.h"

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
    bool is_near;         /* of a light of the tree; false: from infinity */
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

#endif
