// SPDX-License-Identifier: MIT
/*
 * material.h - the statements of an MTL file about one material, and the
 * material that the kernels render, made from them
 *
 * The kind of a material is the first of these that applies:
 *   glass        illum 6 or 7; colour Tf times map_Kd
 *   thin glass   illum 4 or 9; colour Tf times map_Kd
 *   principled   Pm between 0 and 1, map_Pm, Pc above 0, or Tf that is not
 *                black beside Pr: a mixture of metal of colour Kd (weight Pm
 *                times map_Pm), glass (mean of Tf) and plastic, under a coat
 *                (weight Pc, roughness Pcr)
 *   metal        Pm 1; colour Kd
 *   metal        illum 3 or 5 with map_Ks or with Ks that is not black;
 *                colour Ks
 *   plastic      map_Ks, or Ks that is not black: diffuse of colour Kd under a
 *                clear surface of reflectance MATERIAL_SPECULAR times Ks
 *   diffuse      all others; colour Kd, roughness Kd_roughness (default 0)
 * A map multiplies its colour. Roughness alpha is Pr squared; without Pr it is
 * sqrt(2 / (Ns + 2)), or 0 if Ns is absent, 0, or at least 1000. Pr defaults
 * to 1 if there is map_Pr, and Pm to 1 if there is map_Pm.
 *
 * Threads:   any
 * Errors:    impossible values are replaced, with a warning
 */
#ifndef GLIM_MATERIAL_H
#define GLIM_MATERIAL_H

#include <stdbool.h>
#include <stddef.h>

#include "base/warnings.h"
#include "kernels/types.h"

/* Reflectance of plastic whose Ks is 1. Exporters write Ks 0.5 for ordinary
 * surfaces, which then reflect 4 %, like glass and varnish. */
#define MATERIAL_SPECULAR 0.08f

/* Colour of a material whose file gives none. */
#define MATERIAL_GREY 0.8f

/* One number of a statement. Line 0 means that the file does not have the
 * statement; the number is 0 then. Likewise for mtl_color. */
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

/* Keys of the map statements. Height maps have three keys, of which this is
 * one. */
extern const char *const mtl_map_keys[MTL_MAPS];

struct mtl_source {
    struct mtl_color kd, ks, ke, tf;
    /* the two numbers of Ke_blackbody, which replaces Ke */
    struct mtl_number kelvin, luminance;
    struct mtl_number illum, ns, ni, d, tr, pr, pm, pc, pcr, kd_roughness;
    uint32_t maps[MTL_MAPS]; /* numbers of textures, or NO_INDEX */
    uint32_t maps_off; /* bit set of 1 << enum mtl_map: maps to be ignored */
    double bump_scale; /* factor for the heights of MTL_MAP_BUMP */
};

/* A statement of one colour or one number. Statements of this table are read,
 * compared and saved by the same code. Ke, Ke_blackbody and the maps have code
 * of their own. */
struct mtl_property {
    const char *key;
    size_t member; /* offset in mtl_source of an mtl_color or mtl_number */
    bool is_color;
};

#define MTL_PROPERTIES 13

/* All statements of one colour or number, colours first. */
extern const struct mtl_property mtl_properties[MTL_PROPERTIES];

/* Returns the source of a material without statements. */
struct mtl_source mtl_source_empty(void);

/* Compare values; line numbers do not matter. NaN equals NaN. */
bool mtl_number_equal(const struct mtl_number *a, const struct mtl_number *b);
bool mtl_color_equal(const struct mtl_color *a, const struct mtl_color *b);
bool mtl_source_equal(const struct mtl_source *a, const struct mtl_source *b);

/* Returns the texture of a map, or NO_INDEX if it is absent or switched off. */
uint32_t mtl_source_map(const struct mtl_source *source, enum mtl_map map);

/* True if the statements ask for a mirror whose colour is Ks. */
bool mtl_source_is_mirror(const struct mtl_source *source);

/* Returns the emitted radiance given by Ke_blackbody, else by Ke; its line is 0
 * if there is neither. */
struct mtl_color mtl_source_light(const struct mtl_source *source);

struct material material_default(void);

/* Makes the material that the statements describe. `path` is the MTL file, for
 * warnings. A black colour that has a map stays black; textures_load() replaces
 * it if the image can be read. */
struct material material_from_source(const struct mtl_source *source,
                                     const char *path, struct warnings *report);

/* Returns the kernel features that the material needs, a set of enum
 * feature. */
uint32_t material_features(const struct material *material,
                           const struct texture *textures);

/* Returns `wanted` with as many statements as possible replaced by those of
 * `file`, such that the material stays the same. Used to save only changes. */
struct mtl_source mtl_source_needed(const struct mtl_source *file,
                                    const struct mtl_source *wanted);

#endif
