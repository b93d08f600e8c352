// SPDX-License-Identifier: MIT
/*
 * guide_lookup.h - the tables of the path guide that apply at a point
 *
 * Threads:   any
 */
#ifndef TESTS_GUIDE_LOOKUP_H
#define TESTS_GUIDE_LOOKUP_H

#include "world/light/path_guide.h"

#include "kernels/guide.h"

/* First sum of the table for scattering at p, or NO_INDEX. */
static inline uint32_t scatter_table_at(const struct world *w, struct vec3 p,
                                        struct vec3 n)
{
    return guide_at(w, p, n).scatter;
}

/* First sum of the table for light samples of the sky at p, or NO_INDEX. */
static inline uint32_t sky_at(const struct world *w, struct vec3 p,
                              struct vec3 n)
{
    return guide_at(w, p, n).sky;
}

#endif
