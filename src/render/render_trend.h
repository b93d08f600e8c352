// SPDX-License-Identifier: MIT
/*
 * render_trend.h - the course of a render's error over its time, and the time
 * at which the error is at a target
 *
 * The upper end h of the error's interval is taken as
 *
 *     h^2 = C / t^p * exp(a / t)
 *
 * after a time t. Without the exponential, p is 1 for independent samples, and
 * a little more where the sequences stratify well. The exponential is for light
 * that few pixels have found so far: it widens the interval, and its share
 * falls as 1 / t^2 until such pixels are found again. The time counts instead
 * of samples, because adaptive samples are fewer and slower for the same error.
 *
 * Units:     nanoseconds of tracing; samples per pixel
 * Threads:   one at a time
 */
#ifndef GLIM_RENDER_TREND_H
#define GLIM_RENDER_TREND_H

#include <stdint.h>

#include "picture/film_error.h"

struct render_trend {
    struct trend_point {
        double ns, spp;
        double log_high; /* of the square of the interval's upper end */
        double width;    /* log_high above the logarithm of the estimate */
    } points[2], last;   /* the second has at least twice the time */
    int count;           /* of points */
};

/* Adds a known error. */
void render_trend_add(struct render_trend *t, double ns, double spp,
                      const struct film_error *error);

/* Returns the time of a sample per pixel, over at least the latter half of the
 * time; 0 if that is unknown. */
double render_trend_sample_ns(const struct render_trend *t);

/* Returns the time at which the upper end of the error is at the target: that
 * of the last error or later. HUGE_VAL is never. */
double render_trend_target_ns(const struct render_trend *t, double target);

#endif
