// SPDX-License-Identifier: MIT
/*
 * features.h - what a scene may need, for leaving out what it does not
 *
 * world_lend() says which features a scene has. A build is for all of them,
 * unless FEATURES names those it is for; both give the same bits.
 */
#ifndef KERNELS_FEATURES_H
#define KERNELS_FEATURES_H

enum feature {
    FEATURE_COVERAGE = 1, /* a material or texture lets rays pass */
    FEATURE_TEXTURES = 2, /* colours or radiances from images */
    FEATURE_METAL = 4,    /* any metal */
    FEATURE_GLASS = 8,    /* any glass, thin or solid */
    FEATURE_PLASTIC = 16, /* a coat over diffuse */
    FEATURE_ROUGH = 32,   /* metal, glass or coat that is not smooth */
    FEATURE_ROUGH_DIFFUSE = 64,
    FEATURE_SKY_IMAGE = 128, /* the sky is an image */
    FEATURE_EMITTERS = 256,  /* surfaces that shine */
    FEATURE_BUMPS = 512,     /* maps of heights or normals */
    FEATURE_AOV = 1024,      /* samples are no light: see aov.h */
    FEATURE_GUIDE = 2048     /* directions of hidden light: guide.h */
};

#define FEATURES_ALL 4095u

#ifndef FEATURES
#define FEATURES FEATURES_ALL
#endif

#define HAS(feature) ((FEATURES & (feature)) != 0)

#endif
