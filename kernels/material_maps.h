// SPDX-License-Identifier: MIT
/*
 * material_maps.h - the maps of a material, one row for each
 *
 * A row makes the enum of maps, the member of struct material, its default, its
 * statements in MTL files and its line in the panel. Reading and saving, the
 * check for unused maps and the features of a world go through all rows. What
 * is left for a new one is the line of a kernel that looks it up, that of
 * scene/material.c which tells the kinds that use it, and a test.
 *
 *     MAP(NAME, member, is_data, factor, keys)
 *
 * NAME     MTL_MAP_NAME
 * member   texture in struct material, NO_INDEX: none. INSTEAD has none: it
 *          stands in place of the map above it.
 * is_data  numbers, which are not decoded from sRGB
 * factor   FACTOR(number of struct material_values), which is 1 beside its map
 *          if the file does not give it; or 0
 * keys     KEYS(statements that mean it), the first one is written; or
 *          KEY_OR_BLENDER(statement, another one in files of Blender)
 */
#ifndef KERNELS_MATERIAL_MAPS_H
#define KERNELS_MATERIAL_MAPS_H

/* clang-format off */
#define MATERIAL_MAP_LIST(MAP, INSTEAD)                                        \
    /* multiplies color */                                                     \
    MAP(COLOR, color_texture, false, 0, KEYS("map_Kd"))                        \
    /* multiplies specular */                                                  \
    MAP(SPECULAR, specular_texture, false, 0, KEYS("map_Ks"))                  \
    /* multiplies emission */                                                  \
    MAP(EMISSION, emission_texture, false, 0, KEYS("map_Ke"))                  \
    /* its square multiplies alpha */                                          \
    MAP(ROUGHNESS, alpha_texture, true, FACTOR(roughness),                     \
        KEY_OR_BLENDER("map_Pr", "map_Ns"))                                    \
    /* multiplies metalness */                                                 \
    MAP(METALNESS, metal_texture, true, FACTOR(metalness),                     \
        KEY_OR_BLENDER("map_Pm", "map_refl"))                                  \
    /* its alpha multiplies opacity */                                         \
    MAP(OPACITY, opacity_texture, true, 0, KEYS("map_d"))                      \
    /* multiplies transmission */                                              \
    MAP(TRANSMISSION, transmission_texture, true, 0, KEYS("map_Tf"))           \
    /* multiplies coat */                                                      \
    MAP(COAT, coat_texture, true, FACTOR(coat), KEYS("map_Pc"))                \
    /* its square multiplies coat_alpha */                                     \
    MAP(COAT_ROUGHNESS, coat_alpha_texture, true, FACTOR(coat_roughness),      \
        KEYS("map_Pcr"))                                                       \
    /* multiplies sheen */                                                     \
    MAP(SHEEN, sheen_texture, true, FACTOR(sheen), KEYS("map_Ps"))             \
    INSTEAD(SHEEN_COLOR, false, FACTOR(sheen), KEYS("map_Ps_color"))           \
    /* its square multiplies sheen_alpha */                                    \
    MAP(SHEEN_ROUGHNESS, sheen_alpha_texture, true, FACTOR(sheen_roughness),   \
        KEYS("map_Ps_roughness"))                                              \
    /* multiplies specular */                                                  \
    MAP(SPECULAR_WEIGHT, specular_weight_texture, true, 0,                     \
        KEYS("map_Ks_weight"))                                                 \
    /* multiplies film */                                                      \
    MAP(FILM, film_texture, true, FACTOR(film), KEYS("map_Pf"))                \
    /* 0: film_thinnest; 1: film_thickness */                                  \
    MAP(FILM_THICKNESS, film_thickness_texture, true, 0,                       \
        KEYS("map_Pf_thickness"))                                              \
    /* multiplies back_color */                                                \
    MAP(BACK_COLOR, back_texture, false, 0, KEYS("map_Td"))                    \
    /* multiplies translucency */                                              \
    MAP(TRANSLUCENCY, translucency_texture, true, FACTOR(translucency),        \
        KEYS("map_Td_weight"))                                                 \
    /* multiplies subsurface */                                                \
    MAP(SUBSURFACE, subsurface_texture, true, FACTOR(subsurface),              \
        KEYS("map_Sf"))                                                        \
    /* red and green turn the grain from where it is at 1, 1/2; blue is a      \
     * factor of its strength */                                               \
    MAP(GRAIN, grain_texture, true, 0, KEYS("map_grain"))                      \
    /* FEATURE_COAT_NORMALS: of the coat alone */                              \
    MAP(COAT_NORMAL, coat_normal_texture, true, 0, KEYS("map_Pc_norm"))        \
    /* shading normals in tangent space */                                     \
    MAP(NORMAL, normal_texture, true, 0, KEYS("norm", "map_Kn"))               \
    /* heights in alpha */                                                     \
    MAP(BUMP, bump_texture, true, 0, KEYS("map_Bump", "map_bump", "bump"))
/* clang-format on */

#endif
