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

/* The maps of kernels/material_maps.h. */
#define MTL_MAP_NAME(name, ...) MTL_MAP_##name,
enum mtl_map { MATERIAL_MAP_LIST(MTL_MAP_NAME, MTL_MAP_NAME) MTL_MAPS };
#undef MTL_MAP_NAME

#define MTL_MAP_KEYS 3

struct mtl_map_kind {
    bool is_data;
    size_t factor; /* offset in material_values of an mtl_number; 0: none */
    const char *keys[MTL_MAP_KEYS]; /* of its statements; NULL: no more */
    bool is_second_of_blender;      /* keys[1] is it in files of Blender only */
};

extern const struct mtl_map_kind mtl_maps[MTL_MAPS];

/* The program whose meaning the statements of a file have. */
enum mtl_dialect {
    MTL_CLASSIC,   /* the MTL specification and its PBR extension */
    MTL_BLENDER_3, /* Blender before 4.0, since its exporter of 3.1 */
    MTL_BLENDER_4  /* Blender 4.0 and later */
};

/*
 * Statements of one colour or one number: member of struct material_values,
 * key. Each row is read, compared and saved by the same code, colours first.
 * Ke, Ke_blackbody and the maps have code of their own.
 */
/* clang-format off */
#define MTL_PROPERTY_LIST(COLOR, NUMBER)                                       \
    COLOR(base_color, "Kd")                                                    \
    COLOR(specular_color, "Ks")                                                \
    COLOR(transmission, "Tf")                                                  \
    COLOR(ambient, "Ka") /* read in files of Blender only */                   \
    COLOR(attenuation, "Tf_attenuation")                                       \
    COLOR(medium_scatter, "Tf_scatter")                                        \
    COLOR(medium_absorb, "Tf_absorb")                                          \
    COLOR(medium_albedo, "Tf_albedo")                                          \
    COLOR(medium_color, "Tf_multiscatter")                                     \
    COLOR(subsurface_path, "Sr")                                               \
    COLOR(sheen_color, "Ps_color")                                             \
    COLOR(back_color, "Td")                                                    \
    NUMBER(illum, "illum")                                                     \
    NUMBER(shininess, "Ns")                                                    \
    NUMBER(ior, "Ni")                                                          \
    NUMBER(abbe, "Ni_abbe")                                                    \
    NUMBER(opacity, "d")                                                       \
    NUMBER(transparency, "Tr")                                                 \
    NUMBER(roughness, "Pr")                                                    \
    NUMBER(metalness, "Pm")                                                    \
    NUMBER(coat, "Pc")                                                         \
    NUMBER(coat_roughness, "Pcr")                                              \
    NUMBER(diffuse_roughness, "Kd_roughness")                                  \
    NUMBER(sheen, "Ps")                                                        \
    NUMBER(anisotropy, "aniso")                                                \
    NUMBER(anisotropy_rotation, "anisor")                                      \
    NUMBER(attenuation_distance, "Tf_distance")                                \
    NUMBER(thinness, "Tf_thin")                                                \
    NUMBER(medium_anisotropy, "Tf_anisotropy")                                 \
    NUMBER(subsurface, "Sf")                                                   \
    NUMBER(subsurface_anisotropy, "Sg")                                        \
    NUMBER(sheen_roughness, "Ps_roughness")                                    \
    NUMBER(film, "Pf")                                                         \
    NUMBER(film_ior, "Pf_ior")                                                 \
    NUMBER(film_thickness, "Pf_thickness")                                     \
    NUMBER(film_thinnest, "Pf_thinnest")                                       \
    NUMBER(cutoff, "d_cutoff")                                                 \
    NUMBER(specular_scale, "Ks_full")                                          \
    NUMBER(translucency, "Td_weight")
/* clang-format on */

struct material_values {
    uint32_t dialect; /* enum mtl_dialect, that of the whole file */
#define MTL_COLOR(member, key)  struct mtl_color member;
#define MTL_NUMBER(member, key) struct mtl_number member;
    MTL_PROPERTY_LIST(MTL_COLOR, MTL_NUMBER)
#undef MTL_COLOR
#undef MTL_NUMBER
    struct mtl_color emission;
    /* the two numbers of Ke_blackbody, which replaces Ke */
    struct mtl_number kelvin, luminance;
    uint32_t maps[MTL_MAPS]; /* numbers of textures, or NO_INDEX */
    uint32_t maps_off; /* bit set of 1 << enum mtl_map: maps to be ignored */
    /* factors for the heights of MTL_MAP_BUMP, and for x and y of maps of
     * normals; 1 for all others */
    double map_scales[MTL_MAPS];
};

struct mtl_property {
    const char *key;
    size_t member; /* offset in material_values of an mtl_color or mtl_number */
    bool is_color;
};

#define MTL_ONE(...) +1
enum { MTL_PROPERTIES = MTL_PROPERTY_LIST(MTL_ONE, MTL_ONE) };
#undef MTL_ONE

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
 * write black beside maps. Beside Td an absent Td_weight is 1. Everything that
 * renders or shows a material reads these statements. */
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

/* Returns radiances or coefficients. Channels that are negative or no floats
 * become 0, with a warning. */
struct vec3 statement_amounts(const struct mtl_color *color, const char *key,
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
