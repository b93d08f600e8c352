// SPDX-License-Identifier: MIT
/*
 * lambert.h - irradiance from an emitting polygon, in closed form
 *
 * Units:     irradiance for a radiance of 1
 * Threads:   one
 */
#ifndef TESTS_LAMBERT_H
#define TESTS_LAMBERT_H

#include <math.h>

#include "kernels/light_tree.h"
#include "kernels/vec.h"

/* Lambert's formula for a convex polygon, clipped to the upper side of the
 * receiver's plane: E = L/2 sum_i angle_i (edge normal_i . n). */
static inline double lambert(const struct vec3 *corners, int count,
                             const struct receiver *r)
{
    double p[16][3];
    double sum = 0;
    int kept = 0;

    for (int i = 0; i < count; i++) {
        struct vec3 a = v3_sub(corners[i], r->p);
        struct vec3 b = v3_sub(corners[(i + 1) % count], r->p);
        double ha = (double)v3_dot(a, r->n), hb = (double)v3_dot(b, r->n);

        if (ha >= 0) {
            p[kept][0] = (double)a.x;
            p[kept][1] = (double)a.y;
            p[kept++][2] = (double)a.z;
        }
        if ((ha < 0) != (hb < 0)) {
            double s = ha / (ha - hb);

            p[kept][0] = (double)a.x + s * (double)(b.x - a.x);
            p[kept][1] = (double)a.y + s * (double)(b.y - a.y);
            p[kept++][2] = (double)a.z + s * (double)(b.z - a.z);
        }
    }
    for (int i = 0; i < kept; i++) {
        const double *a = p[i], *b = p[(i + 1) % kept];
        double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                       a[0] * b[1] - a[1] * b[0]};
        double lc = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
        double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

        if (lc > 0)
            sum += atan2(lc, dot) *
                   (c[0] * (double)r->n.x + c[1] * (double)r->n.y +
                    c[2] * (double)r->n.z) /
                   lc;
    }
    return fabs(sum) / 2;
}

#endif
