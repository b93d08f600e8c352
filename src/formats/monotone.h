// SPDX-License-Identifier: MIT
/*
 * monotone.h - triangulates a polygon of any size with a sweep line
 *
 * The sweep parts the inside into monotone pieces (Garey, Johnson, Preparata
 * and Tarjan 1978) and cuts triangles off each piece as it grows. Edges that
 * cross are found on the way (Shamos and Hoey 1976). The time is n log n,
 * whatever the outline. Bridges to holes, edges that coincide and corners that
 * touch an edge are no crossings.
 *
 * Units:     those of the points
 * Ownership: all memory that is taken is freed before the return
 * Threads:   any
 * Errors:    memory
 */
#ifndef GLIM_MONOTONE_H
#define GLIM_MONOTONE_H

#include <stdint.h>

struct point2 {
    double x, y;
};

enum monotone_result {
    MONOTONE_DONE,
    MONOTONE_CROSSING, /* the outline crosses itself, or is all noise */
    MONOTONE_NO_MEMORY
};

/* Fills at most count - 2 triangles of corner numbers, counter-clockwise as the
 * outline is. Of corners at one place the first stands for all. Distances
 * within `noise` along either axis are the input's rounding, and count as 0. */
enum monotone_result monotone_cut(const struct point2 *points, uint32_t count,
                                  struct point2 noise, uint32_t (*triangles)[3],
                                  uint32_t *triangle_count);

#endif
