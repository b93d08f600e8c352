// SPDX-License-Identifier: MIT
/*
 * paths.h - the CPU's samples, compiled once for each set of instructions
 *
 * src/paths.c is built several times; all give the same bits. isa.h chooses.
 *
 * Units:     as kernels/path.h
 * Ownership: static
 * Threads:   any, on one world
 * Errors:    none
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

extern const struct paths paths_plain; /* what every processor can run */
extern const struct paths paths_avx2;  /* x86-64 only */
extern const struct paths paths_avx512;

#endif
