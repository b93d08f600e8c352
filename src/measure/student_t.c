// SPDX-License-Identifier: MIT
#include "measure/student_t.h"

#include <math.h>

/* The continued fraction of the incomplete beta function converges in about
 * the root of its greater parameter. */
#define TERMS_MAX 10000

/* Keeps the divisors of Lentz's method away from 0. */
static double nonzero(double x)
{
    return fabs(x) < 1e-300 ? 1e-300 : x;
}

/* Returns the continued fraction of the incomplete beta function (DLMF 8.17.22)
 * by the method of Lentz. It converges fast for x < (a + 1) / (a + b + 2). */
static double beta_fraction(double a, double b, double x)
{
    double c = 1, d = 1 / nonzero(1 - (a + b) * x / (a + 1)), f = d;

    for (int m = 1; m < TERMS_MAX; m++) {
        double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        double odd =
            -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        double step;

        d = 1 / nonzero(1 + even * d);
        c = nonzero(1 + even / c);
        f *= d * c;
        d = 1 / nonzero(1 + odd * d);
        c = nonzero(1 + odd / c);
        step = d * c;
        f *= step;
        if (fabs(step - 1) < 1e-14)
            break;
    }
    return f;
}

/* Returns the regularised incomplete beta function I_x(a, b). */
static double beta_part(double a, double b, double x)
{
    double front =
        exp(lgamma(a + b) - lgamma(a) - lgamma(b) + a * log(x) + b * log1p(-x));

    if (x < (a + 1) / (a + b + 2))
        return front * beta_fraction(a, b, x) / a;
    return 1 - front * beta_fraction(b, a, 1 - x) / b;
}

/* Returns the probability that |t| exceeds `bound`. */
static double tail(double bound, double degrees)
{
    double x = degrees / (degrees + bound * bound);

    return x >= 1 ? 1 : x <= 0 ? 0 : beta_part(degrees / 2, 0.5, x);
}

double student_t_bound(double probability, double degrees)
{
    double low = 0, high = 1;

    while (tail(high, degrees) > probability && high < 1e150)
        high *= 2;
    for (int i = 0; i < 200 && high - low > 1e-13 * high; i++) {
        double middle = (low + high) / 2;

        if (tail(middle, degrees) > probability)
            low = middle;
        else
            high = middle;
    }
    return (low + high) / 2;
}
