// SPDX-License-Identifier: MIT
/*
 * aov.h - arbitrary output variables: samples that end at the camera ray's
 * first hit, for the preview and for false colours
 *
 * Values take the place of radiance, so none is negative. Where the ray meets
 * nothing the value is 0, but in the preview it is the sky.
 *
 * Units: normalised scene units, and those that enum sample_kind states
 */
#ifndef KERNELS_AOV_H
#define KERNELS_AOV_H

#include "kernels/light.h"
#include "kernels/path_types.h"
#include "kernels/surface_point.h"

/* Ambient part of the preview's light. The rest comes from the eye. */
#define PREVIEW_AMBIENT 0.25f

/* Emission, scaled down to 1 at most, so that lamps keep their hue. */
static inline struct vec3 preview_glow(struct vec3 emission)
{
    float top = f_max(emission.x, f_max(emission.y, emission.z));

    return v3_scale(emission, 1.0f / f_max(top, 1.0f));
}

/* Spheres and discs that the ray meets before its t_max. */
static inline struct vec3 preview_lamps(const struct world *w, struct ray r)
{
    struct vec3 sum = v3(0.0f, 0.0f, 0.0f);
    float t;

    for (uint32_t i = 0;
         HAS(FEATURE_POINT_LIGHTS) && i < w->settings.sphere_count; i++)
        if (sphere_meets(w, i, r, &t))
            sum = v3_add(sum,
                         preview_glow(v3_scale(w->point_lights[i].emission,
                                               point_light_part(w, i, r.d))));
    for (uint32_t i = 0; has_directional_lights(w) && r.t_max == FLOAT_MAX &&
                         i < w->settings.directional_light_count;
         i++)
        if (disc_meets(w, i, r.d))
            sum = v3_add(sum, preview_glow(w->directional_lights[i].emission));
    return sum;
}

/* The material's colour, brighter the more the surface faces the eye. */
static inline struct vec3 preview_color(const struct world *w,
                                        GLOBAL const struct material *m,
                                        const struct bsdf *b,
                                        const struct surface_point *v,
                                        struct vec3 wo)
{
    struct vec3 glow = preview_glow(emission_at(w, m, v));
    float shade = PREVIEW_AMBIENT + (1.0f - PREVIEW_AMBIENT) * v3_dot(v->n, wo);

    return v3_add(v3_scale(base_albedo(b), shade), glow);
}

/* Maps components from [-1, 1] to [0, 1]. */
static inline struct vec3 direction_numbers(struct vec3 d)
{
    return v3(0.5f + 0.5f * d.x, 0.5f + 0.5f * d.y, 0.5f + 0.5f * d.z);
}

/* Returns the quantity that settings.sample names, at a surface point. */
static inline struct vec3 aov_value(const struct world *w,
                                    GLOBAL const struct material *m,
                                    const struct surface_point *v, struct ray r,
                                    struct hit h)
{
    struct bsdf b;

    switch (w->settings.sample) {
    case SAMPLE_NORMAL: return direction_numbers(v->n);
    case SAMPLE_FACE:
        return direction_numbers(v->is_outside ? v->ng : v3_neg(v->ng));
    case SAMPLE_UV:
        return v3(v->uv.first.x - floorf(v->uv.first.x),
                  v->uv.first.y - floorf(v->uv.first.y),
                  v->has_uv ? 1.0f : 0.0f);
    case SAMPLE_DEPTH: return v3(h.t, 0.0f, 0.0f);
    case SAMPLE_MATERIAL:
        return v3((float)tri_material(w, h.tri, v->instance) + 1.0f, 0.0f,
                  0.0f);
    default:
        b = bsdf_at(w, m, v);
        return preview_color(w, m, &b, v, v3_neg(r.d));
    }
}

/* Returns the sample of a pixel whose camera ray r has hit h. */
static inline struct path_sample aov_sample(const struct world *w, struct ray r,
                                            struct hit h)
{
    struct path_sample out = {{0.0f, 0.0f, 0.0f}, 1, 0};
    GLOBAL const struct material *m;
    struct surface_point v;

    r.t_max = h.tri == NO_INDEX ? FLOAT_MAX : h.t;
    if (w->settings.sample == SAMPLE_PREVIEW)
        out.radiance = preview_lamps(w, r);
    if (h.tri == NO_INDEX) {
        if (w->settings.sample == SAMPLE_PREVIEW)
            out.radiance = v3_add(out.radiance, sky_radiance(w, r.d));
        return out;
    }
    m = &w->materials[tri_material(w, h.tri, instance_of(w, h.tri))];
    if (surface_at(w, m, r, h, &v))
        out.radiance = v3_add(out.radiance, aov_value(w, m, &v, r, h));
    return out;
}

#endif
