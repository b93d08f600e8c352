// SPDX-License-Identifier: MIT
/*
 * medium.h - what absorbs and scatters light between surfaces
 *
 * Over a distance t the radiance falls by exp(-extinction t), a coefficient for
 * each channel (Beer and Lambert). Of what is lost, scattering / extinction
 * goes on in other directions, by the phase function of Henyey and Greenstein
 * 1941.
 *
 * A body is filled with the medium of its material. Bodies may be nested: the
 * one entered last replaces the others. Outside of all bodies is the fog.
 *
 * The fog may thin out with height: above `base` its density is
 * exp(-(y - base) / falloff), below it is 1. A distance in it counts as its
 * depth, the integral of the density.
 *
 * Units:     lengths in normalised scene units, coefficients in their inverse,
 *            densities per solid angle
 */
#ifndef KERNELS_MEDIUM_H
#define KERNELS_MEDIUM_H

#include "kernels/power.h"
#include "kernels/sample.h"
#include "kernels/surface_point.h"

/* ---- which medium ---- */

static inline void media_enter(struct media *s, uint32_t material)
{
    if (s->count < MEDIA_MAX)
        s->at[s->count++] = material;
}

/* Removes the body that was entered last of those of the material, if there is
 * one: meshes may be open. */
static inline void media_leave(struct media *s, uint32_t material)
{
    uint32_t i = s->count;

    while (i > 0 && s->at[i - 1] != material)
        i--;
    if (i == 0)
        return;
    for (; i < s->count; i++)
        s->at[i - 1] = s->at[i];
    s->count--;
}

/* Crosses the face of a body from the side on which the eye is. */
static inline void media_cross(struct media *s, uint32_t material,
                               const struct surface_point *v)
{
    if (v->is_outside)
        media_enter(s, material);
    else
        media_leave(s, material);
}

/* Follows a ray that leaves a surface at the cosine z to its normal. */
static inline void media_follow(struct media *s, uint32_t material,
                                const struct bsdf *b,
                                const struct surface_point *v, float z)
{
    if (z < 0.0f && bsdf_is_solid(b))
        media_cross(s, material, v);
}

static inline struct medium medium_of(const struct world *w,
                                      const struct media *s)
{
    const struct medium none = {.base = 0.0f};

    if (s->count == 0)
        return w->settings.fog;
    if (HAS(FEATURE_SUBSURFACE) &&
        w->materials[s->at[s->count - 1]].subsurface > 0.0f)
        return none; /* the medium is that of walks */
    return w->materials[s->at[s->count - 1]].medium;
}

/* ---- along a ray ---- */

static inline bool fog_thins(const struct medium *m)
{
    return HAS(FEATURE_MEDIA) && m->falloff > 0.0f;
}

static inline float fog_density(const struct medium *m, float y)
{
    float above = (y - m->base) / m->falloff;

    return above > 0.0f ? f_exp(-above) : 1.0f;
}

/* Returns the integral of the fog's density from the base to the height y. */
static inline float fog_column(const struct medium *m, float y)
{
    float above = (y - m->base) / m->falloff;

    return above > 0.0f ? m->falloff * (1.0f - f_exp(-above)) : y - m->base;
}

/* True if the density hardly changes over a distance t along a ray. */
static inline bool fog_is_even(const struct medium *m, struct ray r, float t)
{
    return !(fabsf(r.d.y) * t > 1e-3f * m->falloff);
}

/* Returns the density halfway along a distance t. */
static inline float fog_middle(const struct medium *m, struct ray r, float t)
{
    return fog_density(m, r.o.y + 0.5f * r.d.y * t);
}

/* Returns the density at a distance t along a ray. */
static inline float density_along(const struct medium *m, struct ray r, float t)
{
    return fog_thins(m) ? fog_density(m, r.o.y + r.d.y * t) : 1.0f;
}

/* Returns the depth of a distance t along a ray whose direction is a unit
 * vector. */
static inline float medium_depth(const struct medium *m, struct ray r, float t)
{
    float end = r.o.y + r.d.y * t, column;

    if (!fog_thins(m))
        return t;
    if (fog_is_even(m, r, t))
        return t * fog_middle(m, r, t);
    if (r.o.y > m->base && end > m->base) /* keeps digits in thin fog */
        column = m->falloff * fog_density(m, r.o.y) *
                 (1.0f - f_exp((r.o.y - end) / m->falloff));
    else
        column = fog_column(m, end) - fog_column(m, r.o.y);
    return f_min(column / r.d.y, FLOAT_MAX);
}

/* Returns the distance of a depth, the inverse of medium_depth(); infinity if
 * the whole ray is not so deep. */
static inline float medium_distance(const struct medium *m, struct ray r,
                                    float depth)
{
    float even, column, start, left;

    if (!fog_thins(m))
        return depth;
    even = depth / fog_density(m, r.o.y);
    if (fog_is_even(m, r, even))
        return depth / fog_middle(m, r, even);
    column = fog_column(m, r.o.y) + r.d.y * depth;
    if (!(column > 0.0f))
        return (column + m->base - r.o.y) / r.d.y;
    /* the share that is left of the density above the start, or the base */
    start = f_max(r.o.y, m->base);
    left = r.o.y > m->base ? 1.0f - even * r.d.y / m->falloff
                           : 1.0f - column / m->falloff;
    if (!(left > 0.0f))
        return INFINITY;
    return (start - r.o.y - m->falloff * f_log2(left) / LOG2_E) / r.d.y;
}

/* Returns the share of the radiance that is left after a depth, which is
 * FLOAT_MAX for the sky. */
static inline struct vec3 transmittance(struct vec3 extinction, float depth)
{
    return v3(f_exp(-extinction.x * depth), f_exp(-extinction.y * depth),
              f_exp(-extinction.z * depth));
}

/* Returns a share of radiance. Radiance beyond floats is the greatest float, so
 * that nothing is left of it where the share is 0. */
static inline struct vec3 radiance_share(struct vec3 radiance,
                                         struct vec3 share)
{
    return v3_mul(v3_min(v3(FLOAT_MAX, FLOAT_MAX, FLOAT_MAX), radiance), share);
}

/* Returns radiance that has come a distance t along the ray, against it. */
static inline struct vec3
attenuated(struct vec3 radiance, const struct medium *m, struct ray r, float t)
{
    if (v3_is_zero(m->extinction))
        return radiance;
    return radiance_share(radiance,
                          transmittance(m->extinction, medium_depth(m, r, t)));
}

/* ---- scattering ---- */

/* Returns the albedo of single scattering, of mean cosine g, of a medium whose
 * half space has this color under a white sky (Kulla and Conty 2017,
 * "Revisiting physically based shading at Imageworks"). */
static inline float medium_albedo_of(float color, float g)
{
    float s = 4.09712f + 4.20863f * color -
              sqrtf(9.59217f + 41.6808f * color + 17.7126f * color * color);

    return f_max(f_min((1.0f - s * s) / (1.0f - g * s * s), 1.0f), 0.0f);
}

static inline bool medium_scatters(const struct medium *m)
{
    return HAS(FEATURE_MEDIA) && !v3_is_zero(m->scattering);
}

/* Returns the part of what a medium takes from a ray that it scatters. */
static inline struct vec3 scattering_albedo(const struct medium *m)
{
    struct vec3 s = m->scattering, e = m->extinction;

    return v3(e.x > 0.0f ? s.x / e.x : 0.0f, e.y > 0.0f ? s.y / e.y : 0.0f,
              e.z > 0.0f ? s.z / e.z : 0.0f);
}

/* Where a ray is scattered, if it is, and the factor of its throughput. */
struct collision {
    float t;
    struct vec3 weight;
    bool is_there;
    bool is_in_smoke; /* smoke.h */
};

/* Returns the probabilities with which the channels choose the distance: by
 * what they would scatter, so that the throughput has a bound. */
static inline struct vec3 collision_shares(const struct medium *m,
                                           struct vec3 beta)
{
    struct vec3 s = m->scattering, e = m->extinction;
    struct vec3 q = v3(e.x > 0.0f ? beta.x * s.x / e.x : 0.0f,
                       e.y > 0.0f ? beta.y * s.y / e.y : 0.0f,
                       e.z > 0.0f ? beta.z * s.z / e.z : 0.0f);
    float sum = q.x + q.y + q.z;

    if (!(sum > 0.0f)) {
        q = beta;
        sum = q.x + q.y + q.z;
    }
    return sum > 0.0f && sum <= FLOAT_MAX
               ? v3_scale(q, 1.0f / sum)
               : v3(1.0f / 3.0f, 1.0f / 3.0f, 1.0f / 3.0f);
}

static inline uint32_t channel_chosen(struct vec3 shares, float u)
{
    return u < shares.x ? 0u : u < shares.x + shares.y ? 1u : 2u;
}

static inline float channel_of(struct vec3 v, uint32_t channel)
{
    return channel == 0 ? v.x : channel == 1 ? v.y : v.z;
}

/* Samples how deep in a medium of a grey extinction the next collision is. */
static inline float collision_depth(float extinction, float u)
{
    return extinction > 0.0f ? -f_log2(1.0f - u) / (LOG2_E * extinction)
                             : FLOAT_MAX;
}

/* Returns transmittances divided by the largest, so that not all of them
 * underflow. */
static inline struct vec3 relative_transmittance(struct vec3 extinction,
                                                 float depth)
{
    float least = f_min(extinction.x, f_min(extinction.y, extinction.z));

    return transmittance(v3_sub(extinction, v3(least, least, least)), depth);
}

/* Returns the factor of a path by the balance heuristic. factor: what the path
 * does; densities: with which the channels do it; left: of both of them. */
static inline struct vec3 balanced(struct vec3 factor, struct vec3 densities,
                                   struct vec3 left, struct vec3 shares)
{
    float density = v3_dot(shares, v3_mul(densities, left));

    return density > 0.0f ? v3_scale(v3_mul(factor, left), 1.0f / density)
                          : v3(0.0f, 0.0f, 0.0f);
}

/*
 * Samples how deep the next collision of a path with throughput beta is. u:
 * random numbers for depth and channel. One channel is chosen and all of them
 * are weighted by the balance heuristic (Veach 1997, 9.2), as in Wilkie et al.
 * 2014, "Hero wavelength spectral sampling".
 */
static inline float collision_sample(const struct medium *m, struct vec3 beta,
                                     struct vec2 u)
{
    uint32_t channel = channel_chosen(collision_shares(m, beta), u.y);

    return collision_depth(channel_of(m->extinction, channel), u.x);
}

/* Returns the factor of a path with throughput beta that is scattered at a
 * depth, or passes it. */
static inline struct vec3 collision_weight(const struct medium *m,
                                           struct vec3 beta, float depth,
                                           bool is_there)
{
    const struct vec3 one = v3(1.0f, 1.0f, 1.0f);
    struct vec3 q = collision_shares(m, beta), e = m->extinction;
    struct vec3 left = relative_transmittance(e, depth);

    return is_there ? balanced(m->scattering, e, left, q)
                    : balanced(one, one, left, q);
}

/* Samples the next collision of a path with throughput beta on a ray that meets
 * the next surface at t_max. u: as collision_sample(). */
static inline struct collision medium_collide(const struct medium *m,
                                              struct vec3 beta, struct ray r,
                                              float t_max, struct vec2 u)
{
    float end = medium_depth(m, r, t_max), depth = collision_sample(m, beta, u);
    struct collision c = {.t = t_max, .is_there = depth < end};

    if (c.is_there)
        c.t = f_min(medium_distance(m, r, depth), t_max);
    c.weight = collision_weight(m, beta, c.is_there ? depth : end, c.is_there);
    return c;
}

/* Density of directions wi after the direction d, both unit vectors along the
 * way of the path. What the cosine to the peak lacks to 1 comes from the chord,
 * which keeps its digits. */
static inline float phase_density(const struct medium *m, struct vec3 d,
                                  struct vec3 wi)
{
    float g = fabsf(m->anisotropy);
    struct vec3 chord = m->anisotropy < 0.0f ? v3_add(wi, d) : v3_sub(wi, d);
    float rest = (1.0f - g) * (1.0f - g) + g * v3_dot(chord, chord);

    return (1.0f - g * g) * (0.25f / PI) / (rest * sqrtf(rest));
}

/* Samples phase_density(). The inverse of its distribution is written without a
 * division by g, and 1 - cosine and 1 + cosine without cancellation. */
static inline struct vec3 phase_sample(const struct medium *m, struct vec3 d,
                                       struct vec2 u)
{
    float g = fabsf(m->anisotropy);
    struct vec2 p = disk_from_square(u);
    float x = f_min(p.x * p.x + p.y * p.y, 1.0f), y = 1.0f - x;
    float root = 1.0f - g + 2.0f * g * x;
    float low = (1.0f - g) / root, high = (1.0f + g) / root;
    float less = 2.0f * y * (1.0f + g * x) * low * low;
    float more = 2.0f * (1.0f - g * y) * high * high; /* over x */
    float cosine = less < 1.0f ? 1.0f - less : x * more - 1.0f;
    float sine = sqrtf(less * more); /* over the root of x */
    struct vec3 t, b;

    if (m->anisotropy < 0.0f)
        cosine = -cosine;
    frame_around(d, &t, &b);
    return v3_unit(
        v3_add(v3_scale(d, cosine),
               v3_add(v3_scale(t, sine * p.x), v3_scale(b, sine * p.y))));
}

#endif
