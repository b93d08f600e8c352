// SPDX-License-Identifier: MIT
/*
 * series.h - curves of error over seconds
 *
 * Units:     seconds, mean squares
 * Errors:    numbers that are not above 0 give NaN
 */
#ifndef ERROR_SERIES_H
#define ERROR_SERIES_H

#define SERIES_POINTS 16

struct series {
    const char *name;
    int count; /* at least 2 */
    double x[SERIES_POINTS], y[SERIES_POINTS];
};

/* Returns the slope of the logarithm of the root of the error over that of
 * seconds, by least squares; -0.5 for independent samples. */
double series_slope(const struct series *s);

/* Returns the ratio of b's error to a's at the longest time for which both were
 * measured. */
double series_times(const struct series *a, const struct series *b);

#endif
