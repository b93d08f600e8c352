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

enum feature {
    FEATURE_COVERAGE = 1, /* opacity or alpha of textures below 1 */
    FEATURE_TEXTURES = 2, /* images that materials refer to */
    FEATURE_METAL = 4,    /* MATERIAL_METAL */
    FEATURE_GLASS = 8,    /* MATERIAL_GLASS and MATERIAL_THIN_GLASS */
    FEATURE_PLASTIC = 16, /* MATERIAL_PLASTIC */
    FEATURE_ROUGH = 32,   /* rough metal, glass or coats */
    FEATURE_ROUGH_DIFFUSE = 64,
    FEATURE_SKY_IMAGE = 128,    /* the sky is an image */
    FEATURE_EMITTERS = 256,     /* emissive surfaces */
    FEATURE_BUMPS = 512,        /* bump and normal maps */
    FEATURE_AOV = 1024,         /* AOVs in place of radiance: aov.h */
    FEATURE_GUIDE = 2048,       /* path guide: guide.h */
    FEATURE_FILTER = 4096,      /* features for the filter: first_surface.h */
    FEATURE_PRINCIPLED = 8192,  /* MATERIAL_PRINCIPLED */
    FEATURE_ANISOTROPY = 16384, /* surfaces with a grain */
    FEATURE_SHEEN = 32768,
    FEATURE_POINT_LIGHTS = 65536,        /* point and spot lights */
    FEATURE_DIRECTIONAL_LIGHTS = 131072, /* the sun is one */
    FEATURE_ATTENUATION = 262144, /* solids that absorb light: attenuation.h */
    FEATURE_VERTEX_COLORS = 524288,
    FEATURE_ROUGH_SHEETS = 1048576, /* rough thin glass */
    FEATURE_THIN_FILM = 4194304,    /* iridescence: thin_film.h */
    FEATURE_INSTANCES = 8388608,    /* instance.h */
    /* texture_flag beyond TEXTURE_CLAMP, channels, maps of rare parameters */
    FEATURE_TEXTURE_OPTIONS = 16777216,
    FEATURE_VERTEX_ALPHAS = 33554432,
    FEATURE_TANGENTS = 67108864,       /* tangents of vertices */
    FEATURE_COAT_NORMALS = 134217728,  /* coats over bumps, or with a map */
    FEATURE_LIGHT_PATHS = 2097152,     /* settings.has_light_paths */
    FEATURE_RADIANCE_CELLS = 268435456 /* radiance_cells.h */
};

#define FEATURES_ALL 536870911u

#ifndef FEATURES
#define FEATURES FEATURES_ALL
#endif

#define HAS(feature) ((FEATURES & (feature)) != 0)

#endif
