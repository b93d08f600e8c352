// SPDX-License-Identifier: MIT
/*
 * oklab.h - perceived differences of colours by CIE XYZ, in double
 *
 * Units:     8-bit sRGB, light from 0 to 1, OKLab
 * Threads:   any
 */
#ifndef TESTS_OKLAB_H
#define TESTS_OKLAB_H

#include <math.h>

/* IEC 61966-2-1 */
static inline double light_of_srgb(double byte)
{
    double v = byte / 255;

    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static inline void matrix_times(const double m[3][3], const double in[3],
                                double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = m[i][0] * in[0] + m[i][1] * in[1] + m[i][2] * in[2];
}

/* Converts Rec.709 to XYZ, then by Ottosson's definition. */
static inline void oklab_of_light(const double light[3], double lab[3])
{
    static const double xyz_of_rgb[3][3] = {{0.4123908, 0.3575843, 0.1804808},
                                            {0.2126390, 0.7151687, 0.0721923},
                                            {0.0193308, 0.1191948, 0.9505322}};
    static const double m1[3][3] = {{0.8189330101, 0.3618667424, -0.1288597137},
                                    {0.0329845436, 0.9293118715, 0.0361456387},
                                    {0.0482003018, 0.2643662691, 0.6338517070}};
    static const double m2[3][3] = {{0.2104542553, 0.7936177850, -0.0040720468},
                                    {1.9779984951, -2.4285922050, 0.4505937099},
                                    {0.0259040371, 0.7827717662,
                                     -0.8086757660}};
    double xyz[3], lms[3];

    matrix_times(xyz_of_rgb, light, xyz);
    matrix_times(m1, xyz, lms);
    for (int i = 0; i < 3; i++)
        lms[i] = cbrt(lms[i]);
    matrix_times(m2, lms, lab);
}

/* Returns the distance of two colours given as light. */
static inline double oklab_distance(const double a[3], const double b[3])
{
    double p[3], q[3];

    oklab_of_light(a, p);
    oklab_of_light(b, q);
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                (p[2] - q[2]) * (p[2] - q[2]));
}

#endif
