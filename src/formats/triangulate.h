// SPDX-License-Identifier: MIT
/*
 * triangulate.h - cuts polygons of any size into triangles
 *
 * A small polygon becomes a fan if it is strictly convex, or else loses one ear
 * after the other (Meisters 1975), where only reflex corners can be in the way
 * of an ear. Large polygons, and small ones that defeat ears, are swept over
 * (monotone.h). What crosses itself loses ears as long as its size explains,
 * and then is cut blindly.
 *
 * Units:     any
 * Ownership: polygon_free() frees; a zeroed struct is ready for use
 * Threads:   one thread at a time
 * Errors:    memory
 */
#ifndef GLIM_TRIANGULATE_H
#define GLIM_TRIANGULATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "formats/monotone.h"

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
 * keep the polygon's winding. Of thousands of corners that cross themselves
 * some have no triangle. False when memory is out. */
bool polygon_triangulate(struct polygon *polygon, const double *corners,
                         uint32_t corner_count);

void polygon_free(struct polygon *polygon);

#endif
