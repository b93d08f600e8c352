// SPDX-License-Identifier: MIT
/*
 * lamp.h - an emitting rectangle above a floor, with its closed form
 *
 * Units:     file units, radiance
 * Threads:   one
 */
#ifndef TESTS_LAMP_H
#define TESTS_LAMP_H

#include "stress_scene.h"
#include "tests/unit/lambert.h"

/* Corners of the lamp in the plane y = 0.7, in put_quad()'s order: z, x. */
static const double lamp_lo[2] = {-0.3, -0.4}, lamp_hi[2] = {0.3, 0.4};

static inline void put_floor(struct stress_scene *s)
{
    put_material(s, "floor", "Kd .6 .6 .6");
    put_quad(s, 1, 0, (double[]){-2, -2}, (double[]){2, 2});
}

static inline void put_shining(struct stress_scene *s, const char *name,
                               double radiance)
{
    char lines[64];

    snprintf(lines, sizeof lines, "Kd 0 0 0\nKe %g %g %g", radiance, radiance,
             radiance);
    put_material(s, name, lines);
}

/* Radiance of the floor at (0.5, 0, 0.2) for a lamp of radiance 1. */
static inline double lit_floor(void)
{
    const struct receiver r = {.p = {0.5f, 0, 0.2f}, .n = {0, 1, 0}};
    const float x0 = (float)lamp_lo[1], x1 = (float)lamp_hi[1];
    const float z0 = (float)lamp_lo[0], z1 = (float)lamp_hi[0];
    const struct vec3 lamp[4] = {{x0, 0.7f, z0},
                                 {x1, 0.7f, z0},
                                 {x1, 0.7f, z1},
                                 {x0, 0.7f, z1}};

    return 0.6 / M_PI * lambert(lamp, 4, &r);
}

static const struct shot at_floor = {.eye = {0.5, 0.4, 1.2},
                                     .at = {0.5, 0, 0.2},
                                     .fovy_deg = 0.01};

#endif
