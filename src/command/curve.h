// SPDX-License-Identifier: MIT
/*
 * curve.h - the error of one render at doubling numbers of samples, and curves
 * of error over seconds
 *
 * Units:     seconds, mean squares, samples per pixel; errors as struct
 *            picture_error
 * Ownership: curve_csv() returns memory for free()
 * Threads:   any
 * Errors:    numbers that are not above 0 give NaN
 */
#ifndef GLIM_CURVE_H
#define GLIM_CURVE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "command/difference.h"
#include "command/reference_info.h"
#include "film/film_error.h"

/* ---- series ---- */

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

/* ---- curves ---- */

/* A render in progress. */
struct curve_render {
    uint64_t spp;
    double seconds;
    double cpu_seconds; /* processor time of all threads; other programs hardly
                           disturb it */
    double exposure;    /* of the view */
    struct film_error stated;
};

/* Errors without the reference's own. */
struct curve_point {
    struct curve_render render;
    double error; /* the true one of what the render states */
    double mse, relmse;
    double bias, percentile;
    struct group_errors groups;
    bool is_drowned; /* the reference's own error is more than half of it */
};

struct curve {
    struct curve_point points[SERIES_POINTS];
    int count;
};

/* Adds a measurement, unless the curve is full. */
void curve_add(struct curve *curve, const struct curve_render *render,
               const struct picture_pair *pair,
               const struct reference_info *own);

/* Returns 1 / (relMSE x seconds). */
double curve_efficiency(const struct curve_point *point);

/* Measures of error and time of a curve. */
struct curve_axes {
    bool is_relative; /* relMSE, else MSE */
    bool is_cpu;      /* processor time */
};

/* Returns the points that are not drowned. */
struct series curve_series(const struct curve *curve, struct curve_axes axes);

/* Write the head of the table, and the row of a point. */
void curve_write_head(FILE *to);
void curve_write_row(FILE *to, const struct curve_point *point);

/* Fits the slope. Its interval is the larger of two: from the points' distances
 * from the line, which have the noise of the times, and from leaving out groups
 * of pixels in turn (jackknife), which has the noise of the errors. Errors
 * share half of their samples with the point before, so the distances alone do
 * not show it. */
struct series_fit curve_fit(const struct curve *curve, struct curve_axes axes);

/* Write the slopes with their intervals. */
void curve_write_slopes(FILE *to, const struct curve *curve);

/* Returns the table as comma-separated values, NULL if memory is out. */
char *curve_csv(const struct curve *curve);

#endif
