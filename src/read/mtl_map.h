// SPDX-License-Identifier: MIT
/*
 * mtl_map.h - reads the options and the file name of an MTL map statement
 *
 * Units:     texture coordinates
 * Threads:   any
 * Errors:    memory; options without their values keep the defaults
 */
#ifndef GLIM_MTL_MAP_H
#define GLIM_MTL_MAP_H

#include "base/lexer.h"
#include "kernels/types.h"

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

#endif
