// SPDX-License-Identifier: MIT
/*
 * light.h - what shines: emissive surfaces and the sky
 *
 * Direct sampling of lights belongs here too, beside what it must agree with.
 *
 * Units:     radiance
 * Ownership: none
 * Threads:   none
 * Errors:    none
 */
#ifndef KERNELS_LIGHT_H
#define KERNELS_LIGHT_H

#include "kernels/texture.h"

/* Emitted radiance of a material at uv, the same to both sides. */
static inline struct vec3 emission_at(const struct world *w,
                                      const struct material *m, struct vec2 uv,
                                      bool has_uv)
{
    if (!HAS(FEATURE_TEXTURES) || m->emission_texture == NO_INDEX || !has_uv)
        return m->emission;
    return v3_mul(m->emission, texture_at(w, m->emission_texture, uv).color);
}

#endif
