// SPDX-License-Identifier: MIT
/*
 * mtl_source.h - the statements of an MTL file about one material
 *
 * material.h says what they mean.
 *
 * Threads:   any
 */
#ifndef GLIM_MTL_SOURCE_H
#define GLIM_MTL_SOURCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

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
    MTL_MAP_KD,
    MTL_MAP_KS,
    MTL_MAP_KE,
    MTL_MAP_PR,
    MTL_MAP_PM,
    MTL_MAP_D,
    MTL_MAP_TF,
    MTL_MAP_PC,
    MTL_MAP_PCR,
    MTL_MAP_PS,
    MTL_MAP_PS_COLOR, /* in place of MTL_MAP_PS */
    MTL_MAP_PS_ROUGHNESS,
    MTL_MAP_KS_WEIGHT,
    MTL_MAP_PF,
    MTL_MAP_PF_THICKNESS,
    MTL_MAP_GRAIN,
    MTL_MAP_PC_NORM,
    MTL_MAP_NORM,
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

struct mtl_source {
    uint32_t dialect; /* enum mtl_dialect, that of the whole file */
    struct mtl_color kd, ks, ke, tf, tf_attenuation, ps_color;
    struct mtl_color ka; /* read in files of Blender only */
    /* the two numbers of Ke_blackbody, which replaces Ke */
    struct mtl_number kelvin, luminance;
    struct mtl_number illum, ns, ni, d, tr, pr, pm, pc, pcr, kd_roughness;
    struct mtl_number ps, ps_roughness, aniso, anisor, tf_distance, tf_thin;
    struct mtl_number pf, pf_ior, pf_thickness, pf_thinnest, d_cutoff;
    struct mtl_number ks_full;
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
    size_t member; /* offset in mtl_source of an mtl_color or mtl_number */
    bool is_color;
};

#define MTL_PROPERTIES 28

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

/* Returns the statements with the factors that maps multiply. Beside its map an
 * absent factor is 1, and so are Kd, Ks and emission that are black: exporters
 * write black beside maps. Everything that renders or shows a material reads
 * these statements. */
struct mtl_source mtl_source_with_factors(const struct mtl_source *source);

/* Returns true if no channel is above 0. */
bool mtl_color_is_black(const struct mtl_color *color);

/* Returns the factor of a map that -bm sets, or NULL for maps without one. */
double *mtl_source_map_scale(struct mtl_source *source, enum mtl_map map);

/* Returns the Pc of a coat of weight 1. Blender writes its clearcoat, of which
 * Cycles uses a quarter, and from 4.0 on four times the coat's weight. */
double mtl_source_full_coat(const struct mtl_source *source);

/* True if the statements ask for a mirror whose colour is Ks. */
bool mtl_source_is_mirror(const struct mtl_source *source);

/* Returns the emitted radiance given by Ke_blackbody, else by Ke; its line is 0
 * if there is neither. */
struct mtl_color mtl_source_light(const struct mtl_source *source);

#endif
