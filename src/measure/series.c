// SPDX-License-Identifier: MIT
#include "measure/series.h"

#include <math.h>

#include "measure/student_t.h"

/* Sums of least squares over the points. */
struct sums {
    double x, xx, y, xy, yy;
};

static struct sums sums_of(const struct series *s)
{
    struct sums sum = {0};

    for (int i = 0; i < s->count; i++) {
        double x = log(s->x[i]), y = log(s->y[i]) / 2;

        sum.x += x;
        sum.xx += x * x;
        sum.y += y;
        sum.xy += x * y;
        sum.yy += y * y;
    }
    return sum;
}

struct series_fit series_fit(const struct series *s)
{
    struct series_fit fit = {NAN, NAN, NAN};
    struct sums m = sums_of(s);
    double n = s->count, determinant = n * m.xx - m.x * m.x;
    double offset, rest, margin;

    if (s->count < 2)
        return fit;
    fit.slope = (n * m.xy - m.x * m.y) / determinant;
    if (s->count < 3)
        return fit;
    offset = (m.xx * m.y - m.x * m.xy) / determinant;
    rest = fmax(m.yy - offset * m.y - fit.slope * m.xy, 0);
    margin =
        student_t_bound(0.05, n - 2) * sqrt(rest / (n - 2) * n / determinant);
    fit.low = fit.slope - margin;
    fit.high = fit.slope + margin;
    return fit;
}

struct series series_half_slope(const struct series *s)
{
    struct series guide = {.name = "slope -0.5", .is_guide = true, .count = 2};
    double x = 0, y = 0;

    for (int i = 0; i < s->count; i++) {
        x += log(s->x[i]) / s->count;
        y += log(s->y[i]) / s->count;
    }
    for (int i = 0; i < 2; i++) {
        guide.x[i] = s->x[i == 0 ? 0 : s->count - 1];
        /* the error is a square, whose slope is twice that of its root */
        guide.y[i] = exp(y - (log(guide.x[i]) - x));
    }
    return guide;
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
