// SPDX-License-Identifier: MIT
/*
 * mtl_map.h - the rest of an MTL map statement: options and the name of a file
 *
 * Units:     texture coordinates
 * Ownership: the name is the caller's
 * Threads:   any
 * Errors:    memory; options without their values keep the defaults
 */
#ifndef GLIM_MTL_MAP_H
#define GLIM_MTL_MAP_H

#include "base/lexer.h"
#include "kernels/types.h"

struct mtl_map_options {
    struct texture texture; /* how it is looked up: -s, -o, -clamp */
    double bump_scale;      /* -bm */
    int unknown_count;      /* options that glim does not know */
};

/* Reads to the end of the line; options may stand on both sides of the name,
 * which is "" if it is missing. NULL when memory is out. */
char *mtl_map_read(struct lexer *lex, struct mtl_map_options *options);

#endif
