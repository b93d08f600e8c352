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
 * Threads:   any
 * Errors:    none: impossible values are replaced, with a warning
 */
#ifndef GLIM_MATERIAL_H
#define GLIM_MATERIAL_H

#include <stdbool.h>
#include <stddef.h>

#include "base/warnings.h"
#include "kernels/types.h"

/* The reflectance of a coat whose Ks is 1. Exporters write Ks .5 for what is
 * ordinary, which gives the 4 % of glass and varnish. */
#define MATERIAL_COAT 0.08f

/* The colour of what has none. */
#define MATERIAL_GREY 0.8f

/* line 0: the file does not say, and the numbers are 0. */
struct mtl_number {
    double value;
    uint64_t line;
};

struct mtl_color {
    double rgb[3];
    uint64_t line;
};

enum mtl_map {
    MTL_MAP_KD,
    MTL_MAP_KS,
    MTL_MAP_KE,
    MTL_MAP_PR,
    MTL_MAP_PM,
    MTL_MAP_D,
    MTL_MAP_NORM,
    MTL_MAP_BUMP,
    MTL_MAPS
};

/* As a statement of the file; heights have three names, this is one. */
extern const char *const mtl_map_keys[MTL_MAPS];

struct mtl_source {
    struct mtl_color kd, ks, ke, tf;
    /* of Ke_blackbody; if kelvin is there it stands for ke */
    struct mtl_number kelvin, luminance;
    struct mtl_number illum, ns, ni, d, tr, pr, pm, kd_roughness;
    uint32_t maps[MTL_MAPS]; /* numbers of textures, or NO_INDEX */
    uint32_t maps_off;       /* 1 << enum mtl_map: as if it were not there */
    double bump_scale;       /* of MTL_MAP_BUMP */
};

/* A statement of one colour or one number. The file is read, compared and saved
 * by this table; Ke, Ke_blackbody and the maps stand beside it. */
struct mtl_property {
    const char *key;
    size_t member; /* offset in mtl_source of an mtl_color or mtl_number */
    bool is_color;
};

#define MTL_PROPERTIES 11

/* Colours come first. */
extern const struct mtl_property mtl_properties[MTL_PROPERTIES];

/* A material of which the file says nothing. */
struct mtl_source mtl_source_empty(void);

/* True if both say the same, wherever they say it. */
bool mtl_number_equal(const struct mtl_number *a, const struct mtl_number *b);
bool mtl_color_equal(const struct mtl_color *a, const struct mtl_color *b);
bool mtl_source_equal(const struct mtl_source *a, const struct mtl_source *b);

/* The texture of a map that is there and not off, or NO_INDEX. */
uint32_t mtl_source_map(const struct mtl_source *source, enum mtl_map map);

/* The radiance that ke or kelvin and luminance say; line 0: neither. */
struct mtl_color mtl_source_light(const struct mtl_source *source);

struct material material_default(void);

/* A black colour beside a map stays black here: textures_load() decides. */
struct material material_from_source(const struct mtl_source *source,
                                     const char *path, struct warnings *report);

/* Enum feature, or-ed: what samples of the material need. */
uint32_t material_features(const struct material *material,
                           const struct texture *textures);

/* The statements that a file must have to give the wanted material: where those
 * that it has already give the same, they stay. */
struct mtl_source mtl_source_needed(const struct mtl_source *file,
                                    const struct mtl_source *wanted);

#endif
