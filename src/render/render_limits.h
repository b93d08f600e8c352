// SPDX-License-Identifier: MIT
/*
 * render_limits.h - the limits of a render: samples, error, time; and the
 * course of its error, which tells when it is at a target
 *
 * Units:     nanoseconds of tracing; samples per pixel (spp)
 * Threads:   one at a time
 */
#ifndef GLIM_RENDER_LIMITS_H
#define GLIM_RENDER_LIMITS_H

#include <stdint.h>

#include "film/film_error.h"

/* ---- limits ---- */

/* Samples of each pixel before the error can end a render: in fewer, rare light
 * is often neither in the picture nor in its error. */
#define RENDER_ERROR_SPP_MIN 16

/* 0 is none. The first that holds ends the render. */
struct render_limits {
    uint64_t spp;
    /* upper end of the film's error at the end of a pass; 0.01 is 1 % */
    double error;
    uint64_t time_ns; /* time of rendering, without halts */
};

enum render_limit {
    RENDER_LIMIT_NONE,
    RENDER_LIMIT_SPP,
    RENDER_LIMIT_ERROR,
    RENDER_LIMIT_TIME
};

/* Returns the limit that holds at the end of a pass, which depends on samples
 * only. The error counts more than the samples, since it tells more. */
enum render_limit render_limits_at(const struct render_limits *limits,
                                   uint64_t spp_done,
                                   const struct film_error *error);

/* ---- course of the error ---- */

/*
 * The upper end h of the error's interval is taken as
 *
 *     h^2 = C / t^p * exp(a / t)
 *
 * after a time t. Without the exponential, p is 1 for independent samples, and
 * a little more where the sequences stratify well. The exponential is for light
 * that few pixels have found so far: it widens the interval, and its share
 * falls as 1 / t^2 until such pixels are found again. The time counts instead
 * of samples, because adaptive samples are fewer and slower for the same error.
 */

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
