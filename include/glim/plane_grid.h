// SPDX-License-Identifier: MIT
/*
 * plane_grid.h - square cells over points in a plane, and which a triangle
 * meets
 *
 * Cells are numbered row by row. A triangle meets a few neighbours of each row
 * between its lowest and its highest corner: a long and thin one far fewer than
 * the box around it does.
 *
 * Units:     any
 * Ownership: none
 * Threads:   any
 * Errors:    none
 */
#ifndef GLIM_PLANE_GRID_H
#define GLIM_PLANE_GRID_H

#include <stdint.h>

struct point2 {
    double x, y;
};

struct plane_grid {
    struct point2 origin, scale; /* cells per unit */
    uint32_t side;               /* cells along either side */
};

/* An edge of a triangle, in cells. */
struct plane_edge {
    struct point2 low, high;
    double slope; /* of x along y; not used where y is the same */
};

struct plane_triangle {
    struct plane_edge edges[3];
    uint32_t first_row, last_row;
};

/* About as many cells over the points as there are points. */
struct plane_grid plane_grid_over(const struct point2 *points, uint32_t count);

uint32_t plane_grid_cell(const struct plane_grid *grid, struct point2 p);

struct plane_triangle plane_grid_triangle(const struct plane_grid *grid,
                                          struct point2 a, struct point2 b,
                                          struct point2 c);

/* The first and the last cell that the triangle meets in one of its rows. What
 * rounding may bring there counts. */
void plane_grid_row(const struct plane_grid *grid,
                    const struct plane_triangle *triangle, uint32_t row,
                    uint32_t *first, uint32_t *last);

#endif
