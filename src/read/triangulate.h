// SPDX-License-Identifier: MIT
/*
 * triangulate.h - cuts polygons of any size into triangles
 *
 * Small polygons become a fan if they are strictly convex; otherwise their
 * ears are clipped (Meisters 1975), where only reflex corners have to be
 * tested. Large polygons, and small ones where ear clipping fails, go to the
 * sweep of monotone.h. Polygons that cross themselves lose ears until the work
 * limit and are then cut without a test.
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

#include "read/monotone.h"

/* Result and storage, which is reused for the next polygon. */
struct polygon {
    uint32_t (*triangles)[3]; /* corner numbers, from 0 */
    uint32_t triangle_count;
    bool crosses_itself; /* the triangles are an approximation */

    size_t capacity; /* corners that the arrays below can hold */
    struct point2 *points;
    uint32_t *prev, *next;
    bool *is_reflex;
    uint32_t *reflex; /* corners that were reflex at the start */
    uint32_t reflex_count;
    uint64_t work;
};

/* Triangulates the polygon of the corners (3 doubles each, finite, at least 3).
 * The triangles keep its winding. Polygons of more than 1000 corners that cross
 * themselves lose some corners. Returns false when memory is out. */
bool polygon_triangulate(struct polygon *polygon, const double *corners,
                         uint32_t corner_count);

void polygon_free(struct polygon *polygon);

#endif
