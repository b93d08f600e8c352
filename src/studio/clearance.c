// SPDX-License-Identifier: MIT
#include "studio/clearance.h"

#include <math.h>

#include "base/geometry.h"

#define RAYS 64

/* Rank of the ray whose length is `near`: the seventh shortest of 64, a tenth.
 * Fewer rays hit leaves and wires. Above a floor at height h it is 1.28 h
 * long. */
#define NEAR_RAY 6

/* Turns between successive directions: 1 / golden ratio. */
#define TURN 0.61803398874989485

/* Computes direction i of a spiral from pole to pole with equal areas (Swinbank
 * and Purser 2006, "Fibonacci grids"). */
static void set_direction(int i, double d[3])
{
    double y = 1 - (2 * i + 1) / (double)RAYS;
    double angle = 2 * M_PI * TURN * i;
    double r = sqrt(1 - y * y);

    d[0] = r * cos(angle);
    d[1] = y;
    d[2] = r * sin(angle);
}

/* Inserts x into the sorted numbers and drops the greatest. */
static void insert(double *sorted, int count, double x)
{
    for (int i = 0; i < count; i++) {
        if (x < sorted[i]) {
            double other = sorted[i];

            sorted[i] = x;
            x = other;
        }
    }
}

static double distance_to_box(const struct scene *s, const double point[3])
{
    double off[3];

    for (int k = 0; k < 3; k++)
        off[k] = fmax(0, fmax(s->bounds_lo[k] - point[k],
                              point[k] - s->bounds_hi[k]));
    return vec3d_length(off);
}

struct clearance clearance_of(const struct surfaces *s, const double point[3])
{
    double nearest[NEAR_RAY + 1];
    int hits = 0;

    for (int i = 0; i <= NEAR_RAY; i++)
        nearest[i] = INFINITY;
    for (int i = 0; i < RAYS; i++) {
        struct surface_hit hit;
        double d[3];

        set_direction(i, d);
        if (!surfaces_hit(s, point, d, INFINITY, SURFACE_GLASS_STOPS, &hit))
            continue;
        hits++;
        insert(nearest, NEAR_RAY + 1, hit.distance);
    }
    return (struct clearance){
        .nearest = nearest[0],
        .near = nearest[NEAR_RAY],
        .box_distance = distance_to_box(s->scene, point),
        .hit_share = (double)hits / RAYS,
    };
}
