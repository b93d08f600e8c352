// SPDX-License-Identifier: MIT
/*
 * axis.h - a logarithmic axis of a diagram
 *
 * Units:     dots of the diagram; those of the labels outside
 * Threads:   any
 */
#ifndef GLIM_AXIS_H
#define GLIM_AXIS_H

#include <stdbool.h>

#include "measure/series.h"

/* Range in decimal logarithms, and the dots of its ends. */
struct axis {
    double low, high;
    int from, to;
};

#define AXIS_LABEL_BYTES 32

struct axis_tick {
    double value;
    bool is_power; /* of ten */
    char label[AXIS_LABEL_BYTES];
};

/* Sets the ranges of both axes to those of all points that are drawn. Returns
 * false if there is no point. */
bool axes_fit(struct axis *x, struct axis *y, const struct series *series,
              int series_count);

/* Returns the place of a value, which must be above 0. */
double axis_place(const struct axis *axis, double value);

/* Returns tick `number`, from 0: 1, 2 and 5 times each power of ten on the
 * axis. Returns false after the last. */
bool axis_tick(const struct axis *axis, int number, struct axis_tick *tick);

/* True if the point has two numbers above 0. Others are not drawn. */
bool axis_shows(const struct series *s, int point);

#endif
