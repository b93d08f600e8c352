// SPDX-License-Identifier: MIT
/*
 * lambert.h - what a polygon that shines does to a surface, in closed form
 *
 * Units:     irradiance for a radiance of 1
 * Ownership: none
 * Threads:   any
 * Errors:    none
 */
#ifndef TESTS_LAMBERT_H
#define TESTS_LAMBERT_H

#include <math.h>

/* Lambert's formula: E = |L/2 sum_i angle_i (edge normal_i . n)|. The corners
 * are seen from the receiver, all above its plane. */
static inline double lambert_irradiance(const double p[4][3], const double n[3])
{
    double sum = 0;

    for (int i = 0; i < 4; i++) {
        const double *a = p[i], *b = p[(i + 1) % 4];
        double la = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
        double lb = sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
        double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                       a[0] * b[1] - a[1] * b[0]};
        double lc = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
        double dot = (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / (la * lb);

        sum += acos(dot) * (c[0] * n[0] + c[1] * n[1] + c[2] * n[2]) / lc;
    }
    return fabs(sum) / 2;
}

#endif
