// SPDX-License-Identifier: MIT
/*
 * surfaces.h - functions of u and v for the grids of glb.h
 *
 * Units:     metres; y is up
 * Threads:   any
 */
#ifndef SCENES_SURFACES_H
#define SCENES_SURFACES_H

#include "glb.h"

#define PI 3.14159265358979323846

/* Profile of (radius, height) pairs that is turned about the y axis, from the
 * bottom outwards and up. The surface is a cubic B-spline of them, which is
 * rounder than the profile. */
struct profile {
    const double (*points)[2];
    int count;
    double star; /* depth of the points of a star, of which there are 9 */
};

struct plane {
    struct point corner, u, v;
};

glb_function surface_lathe; /* struct profile */
glb_function surface_plane; /* struct plane */
glb_function surface_ball;  /* of radius 1 about 0; no context */

/* Returns a colour of JSON text as a material of an emissive panel. */
uint32_t surface_lamp(struct glb *g, const char *color, double strength);

/* Adds a rectangular lamp about `center` that faces `at`. */
void surface_softbox(struct glb *g, struct point center, struct point at,
                     double width, double height, uint32_t lamp);

#endif
