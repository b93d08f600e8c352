// SPDX-License-Identifier: MIT
/*
 * first_surface.h - the first surface of a path that is not a mirror or clear
 * glass, with the light that it sends by itself
 *
 * The denoising filter tells surfaces apart by these features, and filters
 * direct light apart from indirect light.
 *
 * Units:     normalised scene units, radiance
 */
#ifndef KERNELS_FIRST_SURFACE_H
#define KERNELS_FIRST_SURFACE_H

#include "kernels/bsdf.h"
#include "kernels/medium.h"

enum surface_state {
    SURFACE_AHEAD, /* delta lobes only so far */
    SURFACE_MET,   /* it has been met, and direct light goes on */
    SURFACE_BEHIND /* direct light is complete */
};

/* A path without such a surface has no features, and all its light is
 * direct. */
struct first_surface {
    /* light of the path up to the surface, of its emission, and of lights that
     * it reflects */
    struct vec3 direct;
    /* part of it: the sky and emission that a pinhole sees with nothing
     * between, not even partial coverage, without noise but for edges; 0 with a
     * lens */
    struct vec3 seen;
    struct vec3 albedo;
    struct vec3 normal; /* shading normal on the eye's side */
    float depth;        /* length of the path to the surface */
    uint32_t state;     /* enum surface_state */
};

/* True if the world's samples have first surfaces. */
static inline bool has_first_surface(const struct world *w)
{
    return HAS(FEATURE_FILTER) && (w->settings.features & FEATURE_FILTER) != 0;
}

static inline void first_surface_begin(struct first_surface *s)
{
    if (!HAS(FEATURE_FILTER))
        return;
    s->seen = v3(0.0f, 0.0f, 0.0f);
    s->depth = 0.0f;
    s->state = SURFACE_AHEAD;
}

static inline bool first_surface_is_ahead(const struct first_surface *s)
{
    return HAS(FEATURE_FILTER) && s->state == SURFACE_AHEAD;
}

/* Takes a distance to where the path goes on as it came. */
static inline void first_surface_pass(struct first_surface *s, float distance)
{
    if (first_surface_is_ahead(s))
        s->depth += distance;
}

/* Takes the medium in which the path is scattered. It is like a surface across
 * the ray, whose normal is n. */
static inline void first_surface_scatter(struct first_surface *s,
                                         const struct medium *m, struct vec3 n,
                                         float distance)
{
    if (!first_surface_is_ahead(s))
        return;
    s->depth += distance;
    s->albedo = scattering_albedo(m);
    s->normal = n;
    s->state = SURFACE_MET;
}

/* Takes the part of the surface that is seen through a medium, by channel. The
 * rest is that of the medium, whose normal is n. */
static inline void first_surface_fade(struct first_surface *s,
                                      const struct medium *m, struct vec3 seen,
                                      struct vec3 n)
{
    struct vec3 base = scattering_albedo(m);

    s->albedo = v3_add(base, v3_mul(seen, v3_sub(s->albedo, base)));
    s->normal = v3_lerp(n, s->normal, (seen.x + seen.y + seen.z) / 3.0f);
}

/* Takes the BSDF of the path's next vertex, with its normal and its distance
 * from the last one. */
static inline void first_surface_meet(struct first_surface *s,
                                      const struct bsdf *b, struct vec3 n,
                                      float distance)
{
    if (!HAS(FEATURE_FILTER) || s->state != SURFACE_AHEAD)
        return;
    s->depth += distance;
    if (bsdf_is_delta(b))
        return;
    s->albedo = base_albedo(b);
    s->normal = n;
    s->state = SURFACE_MET;
}

/* Takes the path's radiance after the emission of a vertex was added. That of
 * the first vertex is seen; that of the vertex behind the surface is the last
 * direct light. */
static inline void first_surface_light(struct first_surface *s, uint32_t vertex,
                                       struct vec3 radiance)
{
    if (!HAS(FEATURE_FILTER))
        return;
    if (vertex == 1)
        s->seen = radiance;
    if (s->state != SURFACE_MET)
        return;
    s->direct = radiance;
    s->state = SURFACE_BEHIND;
}

/* Completes the surface with the whole radiance of the path, which has this
 * number of vertices. Light of a path that ends at a surface is reflected
 * there, not seen. */
static inline void first_surface_end(const struct world *w,
                                     struct first_surface *s, uint32_t vertices,
                                     struct vec3 radiance)
{
    if (!HAS(FEATURE_FILTER))
        return;
    if (vertices == 1 && s->state == SURFACE_AHEAD)
        s->seen = radiance;
    if (w->settings.camera.lens_radius > 0.0f)
        s->seen = v3(0.0f, 0.0f, 0.0f);
    if (s->state != SURFACE_BEHIND)
        s->direct = radiance;
}

#endif
