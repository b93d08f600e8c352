// SPDX-License-Identifier: MIT
#include "measure/axis.h"

#include <math.h>
#include <stdio.h>

/* Added at both ends. */
#define BORDER 0.05

bool axis_shows(const struct series *s, int point)
{
    return s->x[point] > 0 && s->y[point] > 0 && isfinite(s->x[point]) &&
           isfinite(s->y[point]);
}

static void include(struct axis *a, double value)
{
    a->low = fmin(a->low, log10(value) - BORDER);
    a->high = fmax(a->high, log10(value) + BORDER);
}

bool axes_fit(struct axis *x, struct axis *y, const struct series *series,
              int series_count)
{
    x->low = y->low = INFINITY;
    x->high = y->high = -INFINITY;
    for (int i = 0; i < series_count; i++)
        for (int k = 0; k < series[i].count; k++)
            if (axis_shows(&series[i], k)) {
                include(x, series[i].x[k]);
                include(y, series[i].y[k]);
            }
    return x->low < x->high;
}

double axis_place(const struct axis *a, double value)
{
    return a->from +
           (a->to - a->from) * (log10(value) - a->low) / (a->high - a->low);
}

static void set_label(struct axis_tick *tick, int factor, int power)
{
    if (power < -2 || power > 5)
        snprintf(tick->label, sizeof tick->label, "%de%d", factor, power);
    else
        snprintf(tick->label, sizeof tick->label, "%.6g", tick->value);
}

bool axis_tick(const struct axis *a, int number, struct axis_tick *tick)
{
    static const int steps[] = {1, 2, 5};

    for (int power = (int)floor(a->low); power <= a->high; power++)
        for (int i = 0; i < 3; i++) {
            double value = steps[i] * pow(10, power);

            if (log10(value) < a->low || log10(value) > a->high || number-- > 0)
                continue;
            tick->value = value;
            tick->is_power = i == 0;
            set_label(tick, steps[i], power);
            return true;
        }
    return false;
}
