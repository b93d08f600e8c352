// SPDX-License-Identifier: MIT
/*
 * features.h - features of a scene that a build of the kernels may leave out
 *
 * world_lend() finds which features a scene needs. A build has all of them,
 * unless FEATURES lists fewer. Every build that has the features of a scene
 * renders it with the same bits.
 */
#ifndef KERNELS_FEATURES_H
#define KERNELS_FEATURES_H

#include "kernels/dialect.h"

#define FEATURE_BIT(n) ((uint64_t)1 << (n))

/* Materials */
#define FEATURE_TEXTURES      FEATURE_BIT(1) /* images of materials */
#define FEATURE_METAL         FEATURE_BIT(2)
#define FEATURE_GLASS         FEATURE_BIT(3) /* and thin glass */
#define FEATURE_PLASTIC       FEATURE_BIT(4)
#define FEATURE_ROUGH         FEATURE_BIT(5) /* rough metal, glass or coats */
#define FEATURE_ROUGH_DIFFUSE FEATURE_BIT(6)
#define FEATURE_BUMPS         FEATURE_BIT(9) /* bump and normal maps */
#define FEATURE_PRINCIPLED    FEATURE_BIT(13)
#define FEATURE_ANISOTROPY    FEATURE_BIT(14) /* surfaces with a grain */
#define FEATURE_SHEEN         FEATURE_BIT(15)
#define FEATURE_ATTENUATION   FEATURE_BIT(18) /* media: medium.h */
#define FEATURE_ROUGH_SHEETS  FEATURE_BIT(20) /* rough thin glass */
#define FEATURE_THIN_FILM     FEATURE_BIT(22) /* iridescence: thin_film.h */
#define FEATURE_COAT_NORMALS  FEATURE_BIT(27) /* coats over bumps, or a map */
#define FEATURE_DISPERSION    FEATURE_BIT(31) /* dispersion.h */
#define FEATURE_TRANSLUCENT   FEATURE_BIT(30) /* diffuse transmission */
/* texture_flag beyond TEXTURE_CLAMP, channels, maps of rare parameters */
#define FEATURE_TEXTURE_OPTIONS FEATURE_BIT(24)

/* Geometry */
#define FEATURE_COVERAGE      FEATURE_BIT(0) /* opacity or alpha below 1 */
#define FEATURE_VERTEX_COLORS FEATURE_BIT(19)
#define FEATURE_VERTEX_ALPHAS FEATURE_BIT(25)
#define FEATURE_TANGENTS      FEATURE_BIT(26) /* of vertices */
#define FEATURE_SUBSURFACE    FEATURE_BIT(32) /* subsurface.h */
#define FEATURE_INSTANCES     FEATURE_BIT(23) /* instance.h */
/* Media that scatter, or boundaries of media; with FEATURE_ATTENUATION */
#define FEATURE_MEDIA FEATURE_BIT(29)
#define FEATURE_GRIDS FEATURE_BIT(33) /* smoke.h; with FEATURE_MEDIA */

/* Light */
#define FEATURE_SKY_IMAGE          FEATURE_BIT(7)  /* the sky is an image */
#define FEATURE_EMITTERS           FEATURE_BIT(8)  /* emissive surfaces */
#define FEATURE_POINT_LIGHTS       FEATURE_BIT(16) /* and spot lights */
#define FEATURE_DIRECTIONAL_LIGHTS FEATURE_BIT(17) /* the sun is one */

/* Samples */
#define FEATURE_AOV            FEATURE_BIT(10) /* AOVs, not radiance: aov.h */
#define FEATURE_GUIDE          FEATURE_BIT(11) /* path guide: guide.h */
#define FEATURE_FILTER         FEATURE_BIT(12) /* first_surface.h */
#define FEATURE_LIGHT_PATHS    FEATURE_BIT(21) /* settings.has_light_paths */
#define FEATURE_RADIANCE_CELLS FEATURE_BIT(28) /* radiance_cells.h */

#define FEATURES_ALL (FEATURE_BIT(34) - 1u)

#ifndef FEATURES
#define FEATURES FEATURES_ALL
#endif

#define HAS(feature) ((FEATURES & (feature)) != 0)

#endif
