// SPDX-License-Identifier: MIT
/*
 * polygon.h - cuts polygons of any size into triangles
 *
 * A strictly convex polygon becomes a fan; others lose one ear after the other
 * (Meisters 1975), where only reflex corners can be in the way of an ear, and
 * a grid finds those. Polygons with holes, joined to the outline by a bridge,
 * have coincident corners: these are in nobody's way.
 *
 * Units:     any
 * Ownership: polygon_free() frees; a zeroed struct is ready for use
 * Threads:   one thread at a time
 * Errors:    memory
 */
#ifndef GLIM_POLYGON_H
#define GLIM_POLYGON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "glim/monotone.h"

/* Storage that is used again for the next polygon. */
struct polygon {
    uint32_t (*triangles)[3]; /* corner numbers, from 0 */
    uint32_t triangle_count;
    bool crosses_itself; /* the triangles are a guess */

    size_t capacity; /* corners that the arrays below can hold */
    struct point2 *points;
    uint32_t *prev, *next;
    bool *is_reflex;
    uint32_t *reflex; /* corners that were reflex at first */
    uint32_t reflex_count;
    uint64_t work;
};

/* Fills triangles from the corners (3 doubles each, finite, at least 3). They
 * keep the polygon's winding. False when memory is out. */
bool polygon_cut(struct polygon *polygon, const double *corners,
                 uint32_t corner_count);

void polygon_free(struct polygon *polygon);

#endif
