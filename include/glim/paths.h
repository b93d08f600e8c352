// SPDX-License-Identifier: MIT
/*
 * paths.h - the CPU's samples, compiled once for each set of instructions
 *
 * src/paths.c is built several times; all give the same bits. Which one runs is
 * chosen when the program starts.
 *
 * Units:     as kernels/path.h
 * Ownership: static
 * Threads:   any, on one world
 * Errors:    paths_named() says what it knows
 */
#ifndef GLIM_PATHS_H
#define GLIM_PATHS_H

#include "glim/wide.h"
#include "kernels/path_types.h"

struct paths {
    const char *name;

    /* path_samples() of kernels/path.h; w is within a struct wide_world. */
    void (*samples)(const struct world *w, uint32_t x, uint32_t y,
                    uint64_t first, uint32_t count, struct path_sample *out);
};

/* The fastest that this processor can run. */
const struct paths *paths_best(void);

/* The one of this name, if the processor can run it. */
const struct paths *paths_named(const char *name, struct error *err);

/* The i-th that the processor can run, the fastest first; NULL behind the last.
 */
const struct paths *paths_at(int i);

#endif
