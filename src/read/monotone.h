// SPDX-License-Identifier: MIT
/*
 * monotone.h - triangulates a polygon of any size with a sweep line
 *
 * The sweep divides the inside into monotone pieces (Garey, Johnson, Preparata
 * and Tarjan 1978) and cuts triangles off each piece as it grows. Edges that
 * cross are found during the sweep (Shamos and Hoey 1976). The time is
 * O(n log n) for every outline. Bridges to holes, coincident edges and corners
 * that touch an edge do not count as crossings.
 *
 * Units:     those of the points
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
    MONOTONE_CROSSING, /* the outline crosses itself, or all of it is within the
                          noise */
    MONOTONE_NO_MEMORY
};

/* Triangulates an outline. Fills at most count - 2 triangles of corner numbers,
 * counter-clockwise like the outline. The first of several corners at one point
 * stands for all. Distances up to `noise` along each axis are taken as rounding
 * of the input and count as 0. */
enum monotone_result monotone_cut(const struct point2 *points, uint32_t count,
                                  struct point2 noise, uint32_t (*triangles)[3],
                                  uint32_t *triangle_count);

#endif
