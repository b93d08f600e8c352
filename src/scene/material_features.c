// SPDX-License-Identifier: MIT
#include "scene/material_features.h"

#include "scene/material.h"
#include "kernels/bump.h"
#include "kernels/light.h"

static bool has_texture(const struct material *m)
{
    uint32_t maps[MATERIAL_MAPS];

    material_maps(m, maps);
    for (int i = 0; i < MATERIAL_MAPS; i++)
        if (maps[i] != NO_INDEX)
            return true;
    return false;
}

/* Flags that no kernel reads, or every one. */
#define PLAIN_FLAGS (TEXTURE_CLAMP | TEXTURE_OPAQUE)

/* Returns true if a build without FEATURE_TEXTURE_OPTIONS would look the
 * texture up wrongly. */
static bool has_options(const struct texture *t)
{
    uint32_t clamp = t->flags & TEXTURE_CLAMP;

    return (t->flags & ~(uint32_t)PLAIN_FLAGS) != 0 ||
           (clamp != 0 && clamp != TEXTURE_CLAMP) ||
           (t->channel >= CHANNEL_RED && t->channel <= CHANNEL_BLUE);
}

static bool needs_options(const struct material *m,
                          const struct texture *textures)
{
    uint32_t maps[MATERIAL_MAPS];

    material_maps(m, maps);
    for (int i = 0; i < MATERIAL_MAPS; i++)
        if (maps[i] != NO_INDEX && has_options(&textures[maps[i]]))
            return true;
    return m->specular_weight_texture != NO_INDEX ||
           m->sheen_alpha_texture != NO_INDEX || m->film_texture != NO_INDEX ||
           m->film_thickness_texture != NO_INDEX ||
           m->grain_texture != NO_INDEX;
}

static bool is_translucent(const struct texture *textures, uint32_t texture)
{
    return texture != NO_INDEX && textures[texture].has_alpha != 0;
}

uint32_t material_features(const struct material *m,
                           const struct texture *textures)
{
    uint32_t features = 0;

    if (material_shines(m))
        features |= FEATURE_EMITTERS;
    if (has_texture(m))
        features |= FEATURE_TEXTURES;
    if (needs_options(m, textures))
        features |= FEATURE_TEXTURE_OPTIONS;
    if (m->bump_texture != NO_INDEX || m->normal_texture != NO_INDEX)
        features |= FEATURE_BUMPS;
    if (has_coat_bumps(m))
        features |= FEATURE_COAT_NORMALS;
    if (m->opacity < 1 ||
        (m->color_is_opaque == 0 &&
         is_translucent(textures, m->color_texture)) ||
        is_translucent(textures, m->opacity_texture))
        features |= FEATURE_COVERAGE;
    if (m->kind == MATERIAL_METAL)
        features |= FEATURE_METAL;
    if (m->kind == MATERIAL_PRINCIPLED)
        features |= FEATURE_PRINCIPLED;
    if (m->kind == MATERIAL_PRINCIPLED && m->anisotropy > 0)
        features |= FEATURE_ANISOTROPY;
    if (m->kind == MATERIAL_PRINCIPLED && !v3_is_zero(m->sheen))
        features |= FEATURE_SHEEN;
    if (m->kind == MATERIAL_PRINCIPLED && m->film > 0)
        features |= FEATURE_THIN_FILM;
    if (!v3_is_zero(m->attenuation))
        features |= FEATURE_ATTENUATION;
    if (m->kind == MATERIAL_GLASS || m->kind == MATERIAL_THIN_GLASS)
        features |= FEATURE_GLASS;
    if (m->is_thin != 0 ||
        (m->kind == MATERIAL_THIN_GLASS && m->alpha >= ALPHA_SMOOTH))
        features |= FEATURE_ROUGH_SHEETS;
    if (m->kind == MATERIAL_PLASTIC)
        features |= FEATURE_PLASTIC;
    if (m->kind == MATERIAL_ROUGH_DIFFUSE)
        features |= FEATURE_ROUGH_DIFFUSE;
    else if (m->kind != MATERIAL_DIFFUSE &&
             (m->alpha >= ALPHA_SMOOTH || m->coat_alpha >= ALPHA_SMOOTH))
        features |= FEATURE_ROUGH;
    return features;
}

bool features_use_tangents(uint32_t features)
{
    return (features &
            (FEATURE_BUMPS | FEATURE_ANISOTROPY | FEATURE_COAT_NORMALS)) != 0;
}
