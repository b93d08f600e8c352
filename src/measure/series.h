// SPDX-License-Identifier: MIT
/*
 * series.h - curves of error over seconds
 *
 * Units:     seconds, mean squares
 * Threads:   any
 * Errors:    numbers that are not above 0 give NaN
 */
#ifndef GLIM_SERIES_H
#define GLIM_SERIES_H

#include <stdbool.h>

/* Doublings of samples up to the most that an option takes. */
#define SERIES_POINTS 48

struct series {
    const char *name;
    bool is_guide; /* a line for the eye: thin, without points */
    int count;
    double x[SERIES_POINTS], y[SERIES_POINTS];
};

/* Slope with its 95 % interval; NaN where there are too few points. */
struct series_fit {
    double slope, low, high;
};

/* Fits the logarithm of the root of the error over that of seconds by least
 * squares; -0.5 for independent samples. The interval follows from the points'
 * distances from the line, as if they were independent. */
struct series_fit series_fit(const struct series *s);

/* Returns a guide of slope -0.5 through the points' centre of gravity. The
 * points must be above 0. */
struct series series_half_slope(const struct series *s);

/* Returns the ratio of b's error to a's at the longest time for which both were
 * measured. */
double series_times(const struct series *a, const struct series *b);

#endif
