// SPDX-License-Identifier: MIT
/*
 * angle.h - degrees for people, radians for sines
 *
 * Units:     as the names say
 * Threads:   any
 */
#ifndef GLIM_ANGLE_H
#define GLIM_ANGLE_H

#include <math.h>

static inline double angle_rad(double degrees)
{
    return degrees * M_PI / 180;
}

static inline double angle_deg(double radians)
{
    return radians * 180 / M_PI;
}

#endif
