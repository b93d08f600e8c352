// SPDX-License-Identifier: MIT
/*
 * mtl_dialect.h - finds which program's meaning the statements of an MTL file
 * have
 *
 * Blender names itself and its version in the first line. Where that line was
 * lost, the order of its statements and their six decimals show it. Versions
 * 2.8 to 3.0 name no version but wrote the same; before 2.8 statements were
 * classic. The comment "# Wavefront MTL File" makes a file classic whatever it
 * looks like.
 *
 * Threads:   any
 */
#ifndef GLIM_MTL_DIALECT_H
#define GLIM_MTL_DIALECT_H

#include "scene/material_values.h"

struct mtl_dialect_found {
    enum mtl_dialect dialect;
    /* Blender's version as its line has it; "" if the order of the statements
     * showed the dialect */
    char version[16];
};

struct mtl_dialect_found mtl_dialect_find(const char *text, size_t size_bytes);

/* Returns the comment that gives a file this dialect, without line end. */
const char *mtl_dialect_line(enum mtl_dialect dialect);

#endif
