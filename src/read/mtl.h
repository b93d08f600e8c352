// SPDX-License-Identifier: MIT
/*
 * mtl.h - reads Wavefront MTL text and maps it to glim's materials
 *
 * Blender names itself and its version in the first line. Where that line was
 * lost, the order of its statements and their six decimals show it. Versions
 * 2.8 to 3.0 name no version but wrote the same; before 2.8 statements were
 * classic. The comment "# Wavefront MTL File" makes a file classic whatever it
 * looks like.
 *
 * Units:     MATERIALS in the man page has the unit of each statement
 * Ownership: adds materials, names and textures to the scene
 * Threads:   one thread
 * Errors:    malformed number, memory; a missing file is the caller's warning;
 *            options of maps without their values keep the defaults
 */
#ifndef GLIM_MTL_H
#define GLIM_MTL_H

#include "base/lexer.h"
#include "scene/material_values.h"
#include "scene/scene.h"
#include "kernels/types.h"

/* ---- dialects ---- */

struct mtl_dialect_found {
    enum mtl_dialect dialect;
    /* Blender's version as its line has it; "" if the order of the statements
     * showed the dialect */
    char version[16];
};

struct mtl_dialect_found mtl_dialect_find(const char *text, size_t size_bytes);

/* Returns the comment that gives a file this dialect, without line end. */
const char *mtl_dialect_line(enum mtl_dialect dialect);

/* ---- maps ---- */

struct mtl_map_options {
    struct texture texture; /* from all but -bm */
    double rotation_deg;    /* from -rotate */
    double bump_scale;      /* from -bm */
    int unknown_count;      /* options that glim does not use */
};

/* Reads to the end of the line and returns the file name for free(), "" if it
 * is missing. Options may stand before and after the name. NULL when memory is
 * out. */
char *mtl_map_read(struct lexer *lex, struct mtl_map_options *options);

/* ---- statements ---- */

/* Adds the materials of the text. A text of the scene's own MTL file may define
 * those of an earlier one anew. */
bool mtl_parse(struct scene *scene, const char *text, size_t size_bytes,
               const char *path, struct warnings *report, struct error *err);

/* Adds material 0 if the scene has no material. Returns false when memory is
 * out. */
bool mtl_add_default(struct scene *scene, struct error *err);

/* Returns the number of the texture of an image without options, as a map; adds
 * it if it is new. NO_INDEX when memory is out. */
uint32_t mtl_add_map(struct scene *scene, enum mtl_map map, const char *path);

/* Returns the index of the material of this name, or NO_INDEX. */
uint32_t mtl_find(const struct scene *scene, const char *name);

#endif
