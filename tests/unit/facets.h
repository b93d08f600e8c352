// SPDX-License-Identifier: MIT
/*
 * facets.h - truth about surfaces, from textbook formulas in double
 *
 * Units:     cosines to the normal; alpha of GGX
 * Threads:   one
 */
#ifndef TESTS_FACETS_H
#define TESTS_FACETS_H

#include <math.h>

/* Unpolarised Fresnel from the law of refraction in angles (Hecht, Optics,
 * 4.6: sines and tangents). */
static inline double fresnel_by_angles(double cosine, double eta)
{
    double ti = acos(cosine);
    double st = sin(ti) / eta;
    double tt, s, p;

    if (st >= 1)
        return 1;
    if (ti < 1e-6)
        return pow((eta - 1) / (eta + 1), 2);
    tt = asin(st);
    s = sin(ti - tt) / sin(ti + tt);
    p = tan(ti - tt) / tan(ti + tt);
    return (s * s + p * p) / 2;
}

static inline double smith_lambda(double alpha, double cosine)
{
    double tan2 = (1 - cosine * cosine) / (cosine * cosine);

    return (sqrt(1 + alpha * alpha * tan2) - 1) / 2;
}

/* Reflectance of the facets of a surface. */
enum facets {
    FACETS_WHITE,   /* all */
    FACETS_SCHLICK, /* (1 - cosine)^5 */
    FACETS_GLASS    /* Fresnel; the rest is transmitted */
};

/* Directional albedo by quadrature over all microfacet normals drawn with
 * density D cos (Walter et al. 2007, eq. 35): E = mean of
 * G2 (wo.h) / (cos_o cos_h). */
static inline double albedo_by_quadrature(enum facets facets, double alpha,
                                          double mu, double eta)
{
    const int side = facets == FACETS_GLASS ? 500 : 1000; /* it takes long */
    double sine = sqrt(1 - mu * mu);
    double lo = smith_lambda(alpha, mu);
    double sum = 0;

    for (int i = 0; i < side; i++) {
        /* A square samples more of the tail, where normals are far from
         * upright. */
        double s = (i + 0.5) / side;
        double tan2 = alpha * alpha * (1 / ((1 - s) * (1 - s)) - 1);
        double hz = 1 / sqrt(1 + tan2);
        double hr = sqrt(tan2) * hz;

        for (int j = 0; j < side; j++) {
            double oh = sine * hr * cos(M_PI * (j + 0.5) / side) + mu * hz;
            double iz = 2 * oh * hz - mu;
            double f = 1;
            double part = 0;

            if (oh <= 0)
                continue;
            if (facets == FACETS_SCHLICK)
                f = pow(1 - fmin(oh, 1), 5);
            if (facets == FACETS_GLASS)
                f = fresnel_by_angles(fmin(oh, 1), eta);
            if (iz > 0)
                part = f / (1 + lo + smith_lambda(alpha, iz));
            if (facets == FACETS_GLASS && f < 1) {
                double ct = sqrt(1 - (1 - oh * oh) / (eta * eta));

                iz = -((oh / eta - ct) * hz - mu / eta);
                if (iz > 0)
                    part += (1 - f) / (1 + lo + smith_lambda(alpha, iz));
            }
            sum += 2 * (1 - s) * part * oh / (mu * hz);
        }
    }
    return sum / side / side;
}

/* The same over facets of the widths ax and ay, from an azimuth phi; without
 * glass. Normals have slopes stretched by the widths. */
static inline double stretched_by_quadrature(enum facets facets, double ax,
                                             double ay, double mu, double phi)
{
    const int side = 700;
    double sine = sqrt(1 - mu * mu);
    double x = sine * cos(phi), y = sine * sin(phi);
    double width =
        sine > 0 ? sqrt(ax * ax * x * x + ay * ay * y * y) / sine : 0;
    double lo = smith_lambda(width, mu);
    double sum = 0;

    for (int i = 0; i < side; i++) {
        double s = (i + 0.5) / side;
        double slope = sqrt(1 / ((1 - s) * (1 - s)) - 1);

        for (int j = 0; j < side; j++) {
            double turn = 2 * M_PI * (j + 0.5) / side;
            double hx = ax * slope * cos(turn), hy = ay * slope * sin(turn);
            double hz = 1 / sqrt(1 + hx * hx + hy * hy);
            double oh = (x * hx + y * hy + mu) * hz;
            double ix = 2 * oh * hx * hz - x, iy = 2 * oh * hy * hz - y;
            double iz = 2 * oh * hz - mu, li;

            if (oh <= 0 || iz <= 0)
                continue;
            width = sqrt((ax * ax * ix * ix + ay * ay * iy * iy) /
                         (ix * ix + iy * iy));
            li = smith_lambda(width, fmin(iz, 1));
            sum += 2 * (1 - s) * oh / (mu * hz) / (1 + lo + li) *
                   (facets == FACETS_SCHLICK ? pow(1 - fmin(oh, 1), 5) : 1);
        }
    }
    return sum / side / side;
}

#endif
