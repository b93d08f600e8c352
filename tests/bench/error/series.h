// SPDX-License-Identifier: MIT
/*
 * series.h - points of a curve: error against seconds
 *
 * Units:     seconds, mean squares
 * Errors:    numbers that are not above 0 give NaN
 */
#ifndef ERROR_SERIES_H
#define ERROR_SERIES_H

#define SERIES_POINTS 16

struct series {
    const char *name;
    int count; /* 2 at least */
    double x[SERIES_POINTS], y[SERIES_POINTS];
};

/* Of the logarithm of the error's root against that of seconds, by least
 * squares; -0.5: independent samples. */
double series_slope(const struct series *s);

/* How many times the error of b is that of a at equal time: the longest that
 * both were measured for. */
double series_times(const struct series *a, const struct series *b);

#endif
