// SPDX-License-Identifier: MIT
/*
 * aov.h - samples that end where the camera's ray does: the preview, and
 * numbers of the surface for pictures in false colours
 *
 * Numbers are stored where light would be, so none is negative, and the sky has
 * none but 0.
 *
 * Units:     normalised scene units; enum sample_kind says what else
 */
#ifndef KERNELS_AOV_H
#define KERNELS_AOV_H

#include "kernels/light.h"
#include "kernels/surface_point.h"

/* Of the preview's light the part that comes from everywhere; the rest comes
 * from the eye. */
#define PREVIEW_AMBIENT 0.25f

/* Colours as they are, brighter the more they face the eye. Lamps have their
 * hue as bright as a screen can show it. */
static inline struct vec3 preview_color(const struct world *w,
                                        const struct material *m,
                                        const struct bsdf *b,
                                        const struct vertex *v, struct vec3 wo)
{
    struct vec3 glow = emission_at(w, m, v->uv, v->has_uv);
    float top = f_max(glow.x, f_max(glow.y, glow.z));
    float shade = PREVIEW_AMBIENT + (1.0f - PREVIEW_AMBIENT) * v3_dot(v->n, wo);

    return v3_add(v3_scale(b->color, shade),
                  v3_scale(glow, 1.0f / f_max(top, 1.0f)));
}

/* Components in [-1, 1] as numbers in [0, 1]. */
static inline struct vec3 direction_numbers(struct vec3 d)
{
    return v3(0.5f + 0.5f * d.x, 0.5f + 0.5f * d.y, 0.5f + 0.5f * d.z);
}

/* What the settings ask for of the vertex v at a hit on material m. */
static inline struct vec3
first_hit(const struct world *w, const struct material *m, const struct bsdf *b,
          const struct vertex *v, struct ray r, struct hit h)
{
    switch (w->settings.sample) {
    case SAMPLE_NORMAL: return direction_numbers(v->n);
    case SAMPLE_FACE:
        return direction_numbers(v->is_outside ? v->ng : v3_neg(v->ng));
    case SAMPLE_UV:
        return v3(v->uv.x - floorf(v->uv.x), v->uv.y - floorf(v->uv.y),
                  v->has_uv ? 1.0f : 0.0f);
    case SAMPLE_DEPTH: return v3(h.t, 0.0f, 0.0f);
    case SAMPLE_MATERIAL:
        return v3((float)w->tris[h.tri].material + 1.0f, 0.0f, 0.0f);
    default: return preview_color(w, m, b, v, v3_neg(r.d));
    }
}

#endif
