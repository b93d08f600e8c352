// SPDX-License-Identifier: MIT
#include "measure/axis.h"

#include <math.h>
#include <stdio.h>

/* Added at both ends of a logarithmic axis. */
#define BORDER 0.05

/* Added to the largest value of a linear axis, and its most ticks. */
#define LINEAR_BORDER 1.05
#define LINEAR_TICKS  8

bool axis_shows(const struct series *s, int point)
{
    return s->x[point] > 0 && s->y[point] > 0 && isfinite(s->x[point]) &&
           isfinite(s->y[point]);
}

static void include(struct axis *a, double value)
{
    if (a->is_linear) {
        a->low = 0;
        a->high = fmax(a->high, LINEAR_BORDER * value);
        return;
    }
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
    double at = a->is_linear ? value : log10(value);

    return a->from + (a->to - a->from) * (at - a->low) / (a->high - a->low);
}

static void set_label(struct axis_tick *tick, int factor, int power)
{
    if (power < -2 || power > 5)
        snprintf(tick->label, sizeof tick->label, "%de%d", factor, power);
    else
        snprintf(tick->label, sizeof tick->label, "%.6g", tick->value);
}

/* Returns the least of 1, 2 and 5 times a power of ten that gives few enough
 * ticks. */
static double linear_step(const struct axis *a)
{
    double least = a->high / LINEAR_TICKS;
    double power = pow(10, floor(log10(least)));

    if (least <= power)
        return power;
    return least <= 2 * power   ? 2 * power
           : least <= 5 * power ? 5 * power
                                : 10 * power;
}

static bool linear_tick(const struct axis *a, int number,
                        struct axis_tick *tick)
{
    tick->value = number * linear_step(a);
    tick->is_power = true;
    snprintf(tick->label, sizeof tick->label, "%.6g", tick->value);
    return tick->value <= a->high;
}

bool axis_tick(const struct axis *a, int number, struct axis_tick *tick)
{
    static const int steps[] = {1, 2, 5};

    if (a->is_linear)
        return linear_tick(a, number, tick);
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
