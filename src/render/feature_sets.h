// SPDX-License-Identifier: MIT
/*
 * feature_sets.h - features of the builds of the CPU kernel
 *
 * kernels.mk compiles the kernel with each of these sets (SETS), from the
 * fewest features to all; each set ending in _filter also has what the
 * denoising filter needs. cpu_dispatch.c uses the first build that covers the
 * scene.
 */
#ifndef GLIM_FEATURE_SETS_H
#define GLIM_FEATURE_SETS_H

/* Walls and lamps. */
#define FEATURES_lamps (FEATURE_EMITTERS | FEATURE_RADIANCE_CELLS)

/* With images on them. */
#define FEATURES_images \
    (FEATURES_lamps | FEATURE_TEXTURES | FEATURE_COVERAGE | FEATURE_GUIDE)

/* Most materials. */
#define FEATURES_shiny                                                       \
    (FEATURES_lamps | FEATURE_TEXTURES | FEATURE_SKY_IMAGE | FEATURE_METAL | \
     FEATURE_GLASS | FEATURE_PLASTIC | FEATURE_ROUGH |                       \
     FEATURE_DIRECTIONAL_LIGHTS | FEATURE_GUIDE | FEATURE_LIGHT_PATHS)

/* Materials and lights of typical glTF files. */
#define FEATURES_gltf                                                    \
    (FEATURES_images | FEATURE_TEXTURE_OPTIONS | FEATURE_SKY_IMAGE |     \
     FEATURE_DIRECTIONAL_LIGHTS | FEATURE_POINT_LIGHTS | FEATURE_METAL | \
     FEATURE_PLASTIC | FEATURE_ROUGH | FEATURE_ROUGH_DIFFUSE |           \
     FEATURE_PRINCIPLED | FEATURE_BUMPS | FEATURE_LIGHT_PATHS)

/* All of light, with simple geometry and textures, and neither media nor
 * sheets. */
#define FEATURES_light                                                   \
    (FEATURES_ALL &                                                      \
     ~(FEATURE_AOV | FEATURE_TEXTURE_OPTIONS | FEATURE_INSTANCES |       \
       FEATURE_VERTEX_ALPHAS | FEATURE_TANGENTS | FEATURE_COAT_NORMALS | \
       FEATURE_MEDIA | FEATURE_GRIDS | FEATURE_TRANSLUCENT))

#define FEATURES_lamps_filter  (FEATURES_lamps | FEATURE_FILTER)
#define FEATURES_images_filter (FEATURES_images | FEATURE_FILTER)
#define FEATURES_shiny_filter  (FEATURES_shiny | FEATURE_FILTER)
#define FEATURES_gltf_filter   (FEATURES_gltf | FEATURE_FILTER)

#endif
