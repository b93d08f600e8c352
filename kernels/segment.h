// SPDX-License-Identifier: MIT
/*
 * segment.h - light samples along a ray in a medium that scatters
 *
 * A collision comes near a lamp by chance, and is bright if it does. Where the
 * ray passes a light, a second technique draws the light first and then a point
 * of the ray, uniformly by the angle under which the light's point sees the ray
 * (Kulla and Fajardo 2012, "Importance sampling techniques for path tracing in
 * participating media"). Light samples at collisions, these samples, and lights
 * that are met after a collision have one integral, of points of the ray and
 * directions; all three are weighted by the power heuristic. Densities are
 * divided by that of the collision, so that they are per solid angle.
 *
 * Units:   normalised scene units, densities per length, solid angle or both
 */
#ifndef KERNELS_SEGMENT_H
#define KERNELS_SEGMENT_H

#include "kernels/light.h"
#include "kernels/medium.h"

/* A ray passes a light within this part of a mean free path, and of the
 * distance of the light from its origin. In a foggy room 0.02, 0.05,
 * 0.1 and 0.25 mean free paths take 1.20, 1.37, 1.41 and 1.34 times less time
 * to the same error than no such samples; all rays take 1.07 times more. In
 * thin fog a mean free path is longer than the way to the light, and only the
 * angle keeps the time. */
#define SEGMENT_NEAR  0.1f
#define SEGMENT_ANGLE 0.05f

/* Longest segment, and least distance of its line from a light. */
#define SEGMENT_END_MAX  1e6f
#define SEGMENT_LINE_MIN 1e-4f

/* The way of a ray through a medium, if it passes a light. */
struct segment {
    struct vec3 o, d;
    float end;
    float near;      /* greatest distance within which it passes a light */
    float reference; /* where the light is chosen */
    float t;         /* of the collision, if there is one */
    float density;   /* per length, of a collision at t */
    bool is_there;
};

/* True if the segment passes a point that is at most `radius` from y. */
static inline bool segment_passes(const struct segment *s, struct vec3 y,
                                  float radius)
{
    struct vec3 to = v3_sub(y, s->o);
    float foot = f_min(f_max(v3_dot(to, s->d), 0.0f), s->end);
    struct vec3 aside = v3_sub(to, v3_scale(s->d, foot));
    float near = f_min(s->near, SEGMENT_ANGLE * (v3_length(to) + radius));

    return v3_dot(aside, aside) < (near + radius) * (near + radius);
}

/* True if the segment passes light 0. Corners 1 and 3 of a triangle or a
 * parallelogram are ends of a diagonal. */
static inline bool segment_passes_first(const struct world *w,
                                        const struct segment *s)
{
    struct vec3 middle, side, rest;

    if (HAS(FEATURE_POINT_LIGHTS) && w->settings.light_count == 0)
        return segment_passes(s, w->point_lights[0].p, 0.0f);
    middle = v3_lerp(w->lights[0].corners[1], w->lights[0].corners[3], 0.5f);
    side = v3_sub(w->lights[0].corners[1], middle);
    rest = v3_sub(w->lights[0].corners[0], middle);
    return segment_passes(s, middle,
                          sqrtf(f_max(v3_dot(side, side), v3_dot(rest, rest))));
}

/* True if the segment passes a light, or a child of the light tree's root. */
static inline bool segment_passes_lights(const struct world *w,
                                         const struct segment *s)
{
    uint32_t count = 0; /* all of them, so that compilers make vectors */

    if (light_tree_count(w) < 2)
        return light_tree_count(w) == 1 && segment_passes_first(w, s);
    for (uint32_t i = 0; i < LIGHT_WIDTH; i++) {
        struct vec3 middle = v3(w->light_nodes[0].x[i], w->light_nodes[0].y[i],
                                w->light_nodes[0].z[i]);
        float radius = w->light_nodes[0].radius[i];

        if (w->light_nodes[0].power[i] > 0.0f &&
            segment_passes(s, middle, radius))
            count++;
    }
    return count > 0;
}

/* Returns the segment of a ray up to t, where it ends. */
static inline struct segment
segment_of(const struct world *w, const struct medium *m, struct ray r, float t)
{
    struct segment s = {.o = r.o, .d = r.d, .end = f_min(t, SEGMENT_END_MAX)};

    s.near = SEGMENT_NEAR / v3_max_component(m->extinction);
    s.is_there = segment_passes_lights(w, &s);
    return s;
}

/* Returns the angle under which y sees the segment, without a difference of
 * angles. *line and *foot: distance of y from its line, and where. */
static inline float segment_angle(const struct segment *s, struct vec3 y,
                                  float *line, float *foot)
{
    struct vec3 to = v3_sub(y, s->o);
    float h, b = v3_dot(to, s->d);

    h = f_max(v3_length(v3_sub(to, v3_scale(s->d, b))), SEGMENT_LINE_MIN);
    *line = h;
    *foot = b;
    return atan2_rad(h * s->end, h * h - b * (s->end - b));
}

/* Returns the density with which segment_sample() draws t for y. */
static inline float segment_density(const struct segment *s, struct vec3 y,
                                    float t)
{
    float h, b, angle = segment_angle(s, y, &h, &b);

    return angle > 0.0f && t <= s->end
               ? h / (angle * (h * h + (t - b) * (t - b)))
               : 0.0f;
}

/* Samples a distance along the segment for the point y of a light, by the law
 * of sines. */
static inline float segment_sample(const struct segment *s, struct vec3 y,
                                   float u)
{
    float h, b, t, angle = segment_angle(s, y, &h, &b);
    struct vec2 turn = cos_sin_turns(f_max(angle, 0.0f) * u * (0.5f / PI));

    t = (h * h + b * b) * turn.y / (b * turn.y + h * turn.x);
    return t >= 0.0f ? f_min(t, s->end) : 0.0f;
}

/* Returns the point of the segment at t, as a vertex in a medium. */
static inline struct receiver segment_receiver(const struct segment *s, float t)
{
    struct receiver r = {v3_add(s->o, v3_scale(s->d, t)), s->d, true, true};

    return r;
}

/* Returns the density of a collision at t. shares: of the channels, by
 * collision_shares(). */
static inline float collision_density(const struct medium *m,
                                      struct vec3 shares, struct ray r, float t)
{
    struct vec3 left = transmittance(m->extinction, medium_depth(m, r, t));

    return density_along(m, r, t) * v3_dot(shares, v3_mul(m->extinction, left));
}

/* Returns the point around which a light is sampled along segments: the middle
 * of a point light or sphere, or the point p of an area light. */
static inline struct vec3 segment_target(const struct world *w, uint32_t light,
                                         struct vec3 p)
{
    return HAS(FEATURE_POINT_LIGHTS) && light >= w->settings.light_count
               ? w->point_lights[light - w->settings.light_count].p
               : p;
}

/* Returns the density of samples along the segment at its collision, to a point
 * of a light that is chosen there with the density point_pdf. target: of
 * segment_target(). */
static inline float segment_light_pdf(const struct world *w,
                                      const struct segment *s, uint32_t light,
                                      struct vec3 target, float point_pdf)
{
    struct receiver r;

    if (!s->is_there || !segment_passes(s, target, 0.0f))
        return 0.0f;
    r = segment_receiver(s, s->reference);
    return w->settings.light_share * light_tree_pmf(w, &r, light) * point_pdf *
           (segment_density(s, target, s->t) / s->density);
}

/* Returns the density that counts in power_weight() as two do together. */
static inline float both_densities(float a, float b)
{
    float most = f_max(a, b), ratio = f_min(a, b) / most;

    return most > 0.0f ? most * sqrtf(1.0f + ratio * ratio) : 0.0f;
}

#endif
