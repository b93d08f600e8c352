// SPDX-License-Identifier: MIT
/*
 * first_hit.h - samples that end where the camera's ray does: the preview, and
 * numbers of the surface for pictures in false colours
 *
 * Numbers are stored where light would be, so none is negative, and the sky has
 * none but 0. Whoever includes this file supplies hit_closest(), as for path.h.
 *
 * Units:     normalised scene units; enum sample_kind says what else
 * Ownership: none
 * Threads:   none
 * Errors:    a triangle without a normal is black
 */
#ifndef KERNELS_FIRST_HIT_H
#define KERNELS_FIRST_HIT_H

#include "kernels/light.h"
#include "kernels/path_types.h"
#include "kernels/start.h"
#include "kernels/vertex.h"

/* Of the preview's light the part that comes from everywhere; the rest comes
 * from the eye. */
#define PREVIEW_AMBIENT 0.25f

/* Colours as they are, brighter the more they face the eye. Lamps have their
 * hue as bright as a screen can show it. */
static inline struct vec3 preview_color(const struct world *w,
                                        const struct material *m,
                                        const struct vertex *v, struct vec3 wo)
{
    struct bsdf b = bsdf_at(w, m, v);
    struct vec3 glow = emission_at(w, m, v->uv, v->has_uv);
    float top = f_max(glow.x, f_max(glow.y, glow.z));
    float shade = PREVIEW_AMBIENT + (1.0f - PREVIEW_AMBIENT) * v3_dot(v->n, wo);

    return v3_add(v3_scale(b.color, shade),
                  v3_scale(glow, 1.0f / f_max(top, 1.0f)));
}

/* Components in [-1, 1] as numbers in [0, 1]. */
static inline struct vec3 direction_numbers(struct vec3 d)
{
    return v3(0.5f + 0.5f * d.x, 0.5f + 0.5f * d.y, 0.5f + 0.5f * d.z);
}

static inline struct vec3 hit_numbers(const struct world *w, struct ray r,
                                      struct hit h)
{
    uint32_t number = w->tris[h.tri].material;
    struct material m = w->materials[number];
    struct vec3 none = v3(0.0f, 0.0f, 0.0f);
    struct vertex v;

    if (!vertex_at(w, &m, r, h, &v))
        return none;
    switch (w->settings.sample) {
    case SAMPLE_NORMAL: return direction_numbers(v.n);
    case SAMPLE_FACE:
        return direction_numbers(v.is_outside ? v.ng : v3_neg(v.ng));
    case SAMPLE_UV:
        return v.has_uv
                   ? v3(v.uv.x - floorf(v.uv.x), v.uv.y - floorf(v.uv.y), 1.0f)
                   : none;
    case SAMPLE_DEPTH: return v3(h.t, 0.0f, 0.0f);
    case SAMPLE_MATERIAL: return v3((float)number + 1.0f, 0.0f, 0.0f);
    default: return preview_color(w, &m, &v, v3_neg(r.d));
    }
}

static inline struct path_sample first_hit(const struct world *w,
                                           struct path_start start)
{
    struct path_sample out;
    struct hit h;

    start.ray.key = ray_key(start.sampler, 1);
    out.radiance = v3(0.0f, 0.0f, 0.0f);
    out.rays = 1;
    out.cut = 0;
    if (hit_closest(w, start.ray, &h))
        out.radiance = hit_numbers(w, start.ray, h);
    else if (w->settings.sample == SAMPLE_PREVIEW)
        out.radiance = sky_radiance(w, start.ray.d);
    return out;
}

#endif
