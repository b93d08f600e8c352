// SPDX-License-Identifier: MIT
#include "series.h"

#include <math.h>

double series_slope(const struct series *s)
{
    double x = 0, y = 0, xx = 0, xy = 0;

    for (int i = 0; i < s->count; i++) {
        double a = log(s->x[i]), b = log(s->y[i]) / 2;

        x += a;
        y += b;
        xx += a * a;
        xy += a * b;
    }
    return (s->count * xy - x * y) / (s->count * xx - x * x);
}

/* Interpolates the error after this time. */
static double error_after(const struct series *s, double seconds)
{
    int i = 1;
    double t;

    while (i < s->count - 1 && s->x[i] < seconds)
        i++;
    t = log(seconds / s->x[i - 1]) / log(s->x[i] / s->x[i - 1]);
    return s->y[i - 1] * pow(s->y[i] / s->y[i - 1], t);
}

double series_times(const struct series *a, const struct series *b)
{
    double seconds = fmin(a->x[a->count - 1], b->x[b->count - 1]);

    return error_after(b, seconds) / error_after(a, seconds);
}
