// SPDX-License-Identifier: MIT
/*
 * material.h - what an MTL file says about a material, and what glim makes of
 * it
 *
 * illum 6, 7: glass; 4, 9: thin glass; tinted by Tf times map_Kd. Else Pm of
 * one half and more: metal of colour Kd. Else illum 3, 5 with Ks that is not
 * black, or with map_Ks: metal of colour Ks. Else diffuse, colour Kd, under a
 * clear coat that reflects MATERIAL_COAT Ks if Ks is not black or there is
 * map_Ks. A map multiplies its colour. Roughness alpha is Pr squared, or
 * sqrt(2 / (Ns + 2)), or 0 where Ns is absent, 0 or 1000 and more; the
 * roughness of diffuse without a coat is Kd_roughness, 0 if absent. With
 * map_Pr, Pr is 1 if absent; with map_Pm, Pm too, and the map chooses between
 * metal of colour Kd and the rest.
 *
 * Units:     none
 * Ownership: none
 * Threads:   any
 * Errors:    none: impossible values are replaced, with a warning
 */
#ifndef GLIM_MATERIAL_H
#define GLIM_MATERIAL_H

#include "glim/report.h"
#include "kernels/types.h"

/* The reflectance of a coat whose Ks is 1. Exporters write Ks .5 for what is
 * ordinary, which gives the 4 % of glass and varnish. */
#define MATERIAL_COAT 0.08f

/* The colour of what has none. */
#define MATERIAL_GREY 0.8f

/* line 0: the file does not say. */
struct mtl_number {
    double value;
    uint64_t line;
};

struct mtl_color {
    double rgb[3];
    uint64_t line;
};

struct mtl_source {
    struct mtl_color kd, ks, ke, tf;
    struct mtl_number illum, ns, ni, d, tr, pr, pm, kd_roughness;
    /* numbers of textures, or NO_INDEX */
    uint32_t map_kd, map_ks, map_ke, map_pr, map_pm, map_d, map_bump, norm;
    double bump_scale; /* of map_bump */
};

struct material material_default(void);

/* A black colour beside a map stays black here: textures_load() decides. */
struct material material_from_source(const struct mtl_source *source,
                                     const char *path, struct report *report);

#endif
