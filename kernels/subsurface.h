// SPDX-License-Identifier: MIT
/*
 * subsurface.h - light that enters a diffuse surface, is scattered below it,
 * and leaves elsewhere
 *
 * The path enters by a cosine lobe, walks through a medium of the material's
 * mean free path, and leaves by a cosine lobe where it meets a surface of the
 * same material. The albedo of the medium is such that a thick even body has
 * the color of the surface (medium.h). A walk is part of the vertex where it
 * begins: light samples and the next ray are those of its end.
 *
 * Units:     normalised scene units
 */
#ifndef KERNELS_SUBSURFACE_H
#define KERNELS_SUBSURFACE_H

#include "kernels/medium.h"

/* Collisions after which a walk is cut. */
#define SUBSURFACE_STEPS_MAX 65536u

/* Largest color of a channel: a white body would keep paths for ever. */
#define SUBSURFACE_COLOR_MAX 0.999f

static inline float subsurface_albedo(float color, float g)
{
    return medium_albedo_of(f_min(color, SUBSURFACE_COLOR_MAX), g);
}

/* Returns the medium below a surface of this color. */
static inline struct medium subsurface_medium(GLOBAL const struct material *m,
                                              struct vec3 color)
{
    struct medium medium = m->medium;
    float g = medium.anisotropy;

    medium.scattering =
        v3_mul(medium.extinction,
               v3(subsurface_albedo(color.x, g), subsurface_albedo(color.y, g),
                  subsurface_albedo(color.z, g)));
    return medium;
}

/* Returns the share of the diffuse base that is a walk. Light that has come
 * through glass does not enter the base from behind. */
static inline float subsurface_share(const struct world *w,
                                     GLOBAL const struct material *m,
                                     const struct surface_point *v,
                                     const struct bsdf *b)
{
    if (bsdf_is_glass(b) && !v->is_outside)
        return 0.0f;
    return HAS(FEATURE_TEXTURE_OPTIONS)
               ? b->subsurface * map_number_at(w, v, m->subsurface_texture)
               : b->subsurface;
}

/* Returns the share of light that comes below a face of plastic. facets:
 * bsdf_albedo(). */
static inline struct vec3 subsurface_below(const struct bsdf *b, struct vec3 wo,
                                           struct ggx_albedo facets)
{
    return v3_sub(v3(1.0f, 1.0f, 1.0f), specular_albedo(b, wo, facets));
}

/* Returns the share of light that comes below the layers of a mixture, and
 * beside its metal and its glass. */
RARE static struct vec3 subsurface_entry_mixed(const struct bsdf *b,
                                               struct vec3 wo)
{
    struct bsdf plastic = has_film(b) ? film_plastic(b, wo) : *b;
    struct lobes l = principled_lobes(&plastic, wo);

    return v3_scale(subsurface_below(&plastic, wo, l.facets),
                    f_max(l.weight[LOBE_PLASTIC], 0.0f));
}

/* Returns the share of light that comes to the diffuse base. */
static inline struct vec3 subsurface_entry(const struct bsdf *b, struct vec3 wo)
{
    if (bsdf_is_principled(b))
        return subsurface_entry_mixed(b, wo);
    if (HAS(FEATURE_PLASTIC) && b->kind == MATERIAL_PLASTIC)
        return subsurface_below(b, wo, bsdf_albedo(b, wo));
    return v3(1.0f, 1.0f, 1.0f);
}

/* Returns the probability with which a path enters where the whole base is a
 * walk: by the light of both ways. entry: subsurface_entry(). */
static inline float subsurface_chance(const struct bsdf *b, struct vec3 entry)
{
    float base = v3_max_component(v3_mul(b->color, entry));
    float rest = 1.0f - f_min(entry.x, f_min(entry.y, entry.z));

    return base > 0.0f ? base / (base + rest) : 0.0f;
}

/* Scales the base by what a walk leaves of it. Mixtures, whose metal and glass
 * have the color too, and EON, which is not linear in it, scale themselves. */
static inline void subsurface_leave(struct bsdf *b, float share)
{
    bool is_eon =
        HAS(FEATURE_ROUGH_DIFFUSE) && b->kind == MATERIAL_ROUGH_DIFFUSE;

    b->subsurface = -share;
    if (!bsdf_is_principled(b) && !is_eon)
        b->color = v3_scale(b->color, 1.0f - share);
    b->back_color = v3_scale(b->back_color, 1.0f - share);
}

/* Returns the surface from the other side. */
static inline struct surface_point surface_turned(struct surface_point v)
{
    v.ng = v3_neg(v.ng);
    v.n = v3_neg(v.n);
    v.is_outside = !v.is_outside;
    v.above = offset_ray_origin(v.p, v.p_error, v.ng);
    frame_around(v.n, &v.t, &v.b);
    return v;
}

#endif
