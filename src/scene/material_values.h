// SPDX-License-Identifier: MIT
/*
 * material_values.h - the values of a material as a file states them: those of
 * MTL statements, which also stand for materials of other formats; checked for
 * their ranges
 *
 * material.h says what they mean.
 *
 * Threads:   any
 * Errors:    values out of range are replaced, with a warning
 */
#ifndef GLIM_MATERIAL_VALUES_H
#define GLIM_MATERIAL_VALUES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/warnings.h"
#include "kernels/types.h"

/* One number of a statement. Line 0 means that the file does not have the
 * statement; the number is 0 then. Likewise for mtl_color. MTL_IMPLIED is the
 * line of a factor that only its map implies. */
#define MTL_IMPLIED UINT64_MAX

struct mtl_number {
    double value;
    uint64_t line;
};

struct mtl_color {
    double rgb[3];
    uint64_t line;
};

enum mtl_map {
    MTL_MAP_COLOR,
    MTL_MAP_SPECULAR,
    MTL_MAP_EMISSION,
    MTL_MAP_ROUGHNESS,
    MTL_MAP_METALNESS,
    MTL_MAP_OPACITY,
    MTL_MAP_TRANSMISSION,
    MTL_MAP_COAT,
    MTL_MAP_COAT_ROUGHNESS,
    MTL_MAP_SHEEN,
    MTL_MAP_SHEEN_COLOR, /* in place of MTL_MAP_SHEEN */
    MTL_MAP_SHEEN_ROUGHNESS,
    MTL_MAP_SPECULAR_WEIGHT,
    MTL_MAP_FILM,
    MTL_MAP_FILM_THICKNESS,
    MTL_MAP_GRAIN,
    MTL_MAP_COAT_NORMAL,
    MTL_MAP_NORMAL,
    MTL_MAP_BUMP,
    MTL_MAPS
};

/* Keys of the map statements. Some have other keys as well. */
extern const char *const mtl_map_keys[MTL_MAPS];

/* The program whose meaning the statements of a file have. */
enum mtl_dialect {
    MTL_CLASSIC,   /* the MTL specification and its PBR extension */
    MTL_BLENDER_3, /* Blender before 4.0, since its exporter of 3.1 */
    MTL_BLENDER_4  /* Blender 4.0 and later */
};

struct material_values {
    uint32_t dialect; /* enum mtl_dialect, that of the whole file */
    struct mtl_color base_color, specular_color, emission, transmission,
        attenuation, sheen_color;
    struct mtl_color ambient; /* read in files of Blender only */
    /* the two numbers of Ke_blackbody, which replaces Ke */
    struct mtl_number kelvin, luminance;
    struct mtl_number illum, shininess, ior, opacity, transparency, roughness,
        metalness, coat, coat_roughness, diffuse_roughness;
    struct mtl_number sheen, sheen_roughness, anisotropy, anisotropy_rotation,
        attenuation_distance, thinness;
    struct mtl_number film, film_ior, film_thickness, film_thinnest, cutoff;
    struct mtl_number specular_scale;
    uint32_t maps[MTL_MAPS]; /* numbers of textures, or NO_INDEX */
    uint32_t maps_off; /* bit set of 1 << enum mtl_map: maps to be ignored */
    /* factors for the heights of MTL_MAP_BUMP, and for x and y of maps of
     * normals; 1 for all others */
    double map_scales[MTL_MAPS];
};

/* A statement of one colour or one number. Statements of this table are read,
 * compared and saved by the same code. Ke, Ke_blackbody and the maps have code
 * of their own. */
struct mtl_property {
    const char *key;
    size_t member; /* offset in material_values of an mtl_color or mtl_number */
    bool is_color;
};

#define MTL_PROPERTIES 28

/* All statements of one colour or number, colours first. */
extern const struct mtl_property mtl_properties[MTL_PROPERTIES];

/* Returns the source of a material without statements. */
struct material_values material_values_empty(void);

/* Compare values; line numbers do not matter. NaN equals NaN. */
bool mtl_number_equal(const struct mtl_number *a, const struct mtl_number *b);
bool mtl_color_equal(const struct mtl_color *a, const struct mtl_color *b);
bool material_values_equal(const struct material_values *a,
                           const struct material_values *b);

/* Returns the texture of a map, or NO_INDEX if it is absent or switched off. */
uint32_t material_values_map(const struct material_values *source,
                             enum mtl_map map);

/* Returns the statements with the factors that maps multiply. Beside its map an
 * absent factor is 1, and so are Kd, Ks and emission that are black: exporters
 * write black beside maps. Everything that renders or shows a material reads
 * these statements. */
struct material_values
material_values_with_factors(const struct material_values *source);

/* Returns true if no channel is above 0. */
bool mtl_color_is_black(const struct mtl_color *color);

/* Returns the factor of a map that -bm sets, or NULL for maps without one. */
double *material_values_map_scale(struct material_values *source,
                                  enum mtl_map map);

/* Returns the Pc of a coat of weight 1. Blender writes its clearcoat, of which
 * Cycles uses a quarter, and from 4.0 on four times the coat's weight. */
double material_values_full_coat(const struct material_values *source);

/* True if the statements ask for a mirror whose colour is Ks. */
bool material_values_is_mirror(const struct material_values *source);

/* Returns the emitted radiance given by Ke_blackbody, else by Ke; its line is 0
 * if there is neither. */
struct mtl_color material_values_light(const struct material_values *source);

/* ---- checks ---- */

/* Where warnings go. */
struct statement_place {
    const char *path;
    struct warnings *report;
};

/* Clamps a number to [0, 1]; NaN becomes 0. */
double statement_clamped(double x);

/* Returns a reflectance with each channel clamped to [0, 1], with a warning, or
 * `missing` in all channels if the file does not give it. */
struct vec3 statement_reflectance(const struct mtl_color *color,
                                  const char *key, float missing,
                                  const struct statement_place *at);

/* Returns a radiance. Channels that are negative or no floats become 0, with a
 * warning. */
struct vec3 statement_radiance(const struct mtl_color *color,
                               const struct statement_place *at);

/* Returns the number if it is in [lo, hi], else `missing`; a number out of
 * range is reported. */
double statement_within(const struct mtl_number *n, const char *key, double lo,
                        double hi, double missing,
                        const struct statement_place *at);

/* Returns a number from 0 to 1; others are clamped, with a warning. */
double statement_unit(const struct mtl_number *n, const char *key,
                      const struct statement_place *at);

#endif
