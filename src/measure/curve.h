// SPDX-License-Identifier: MIT
/*
 * curve.h - the error of one render at doubling numbers of samples
 *
 * Units:     seconds, samples per pixel; errors as struct picture_error
 * Ownership: curve_csv() returns memory for free()
 * Threads:   any
 */
#ifndef GLIM_CURVE_H
#define GLIM_CURVE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "picture/film_error.h"
#include "measure/picture_error.h"
#include "measure/reference_info.h"
#include "measure/series.h"

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
