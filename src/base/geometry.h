// SPDX-License-Identifier: MIT
/*
 * geometry.h - angles, vectors of three doubles, affine maps
 *
 * Cameras and files are computed in double; kernels/vec.h has the floats of
 * samples.
 *
 * Threads:   any
 */
#ifndef GLIM_GEOMETRY_H
#define GLIM_GEOMETRY_H

#include <math.h>
#include <stdbool.h>

static inline double angle_rad(double degrees)
{
    return degrees * M_PI / 180;
}

static inline double angle_deg(double radians)
{
    return radians * 180 / M_PI;
}

static inline double vec3d_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void vec3d_cross(const double a[3], const double b[3],
                               double to[3])
{
    to[0] = a[1] * b[2] - a[2] * b[1];
    to[1] = a[2] * b[0] - a[0] * b[2];
    to[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void vec3d_sub(const double a[3], const double b[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = a[i] - b[i];
}

/* Returns the length; it overflows only if the result is out of range. */
static inline double vec3d_length(const double v[3])
{
    return hypot(hypot(v[0], v[1]), v[2]);
}

/* Scales v to length 1. Returns false, with v unchanged, if it is zero or not
 * finite. */
static inline bool vec3d_normalize(double v[3])
{
    double most = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    double x = v[0] / most, y = v[1] / most, z = v[2] / most;
    double length = sqrt(x * x + y * y + z * z);

    if (!(most > 0 && length < INFINITY))
        return false;
    v[0] = x / length;
    v[1] = y / length;
    v[2] = z / length;
    return true;
}

/* An affine map. m has rows, whose last column is the translation. */
struct affine {
    double m[3][4];
};

static inline void affine_point(const struct affine *a, const double p[3],
                                double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = vec3d_dot(a->m[i], p) + a->m[i][3];
}

/* Returns the map that applies b, then a. */
static inline struct affine affine_join(const struct affine *a,
                                        const struct affine *b)
{
    struct affine c;

    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 4; k++)
            c.m[i][k] = a->m[i][0] * b->m[0][k] + a->m[i][1] * b->m[1][k] +
                        a->m[i][2] * b->m[2][k] + (k == 3 ? a->m[i][3] : 0);
    return c;
}

/* Fills the rows of the matrix that moves normals, up to a factor above 0.
 * Returns true if the map mirrors. */
static inline bool affine_normals(const struct affine *a, double rows[3][3])
{
    bool is_mirror;

    for (int i = 0; i < 3; i++)
        vec3d_cross(a->m[(i + 1) % 3], a->m[(i + 2) % 3], rows[i]);
    is_mirror = vec3d_dot(a->m[0], rows[0]) < 0;
    for (int i = 0; is_mirror && i < 9; i++)
        rows[i / 3][i % 3] = -rows[i / 3][i % 3];
    return is_mirror;
}

#endif
