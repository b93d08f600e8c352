// SPDX-License-Identifier: MIT
/*
 * pass_plan.h - the plan of passes and the limits that end a render
 *
 * Units:     samples per pixel (spp), of adaptive renders in the mean;
 *            nanoseconds of tracing
 * Threads:   one at a time
 */
#ifndef GLIM_PASS_PLAN_H
#define GLIM_PASS_PLAN_H

#include <stdint.h>

#include "film/adaptive.h"
#include "film/film_error.h"
#include "render/backend.h"

/* ---- limits and the course of the error ---- */

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

/* ---- passes ---- */

/*
 * Passes double, from one sample per pixel to SAMPLE_BLOCK: short passes give
 * early pictures. Then, without a limit of the error, they grow with the
 * samples before them. At the end of a pass threads wait, a device's film is
 * read back and the error is estimated, which is a small share of long passes.
 * The plan depends on sample counts, never on the clock.
 */

/* Returns whether the passes after `done` samples have the shares of adaptive
 * sampling, in a render that is adaptive or not. */
bool pass_plan_has_shares(uint64_t done, bool is_adaptive);

/* Returns the number of samples at the end of the pass after `done` samples. */
uint64_t pass_plan_next(uint64_t done, const struct render_limits *limits,
                        bool is_adaptive);

/* Returns the number of samples at the end of the pass in which a render with
 * `done` samples and a limit of the error gets `spp` samples. */
uint64_t pass_plan_end(uint64_t done, uint64_t spp, bool is_adaptive);

/* Returns the pass from `done` to `target` samples over a grid. `adaptive` has
 * decided the shares if pass_plan_has_shares(); they are lent to the pass. */
struct pass pass_plan_pass(uint64_t done, uint64_t target, int stride,
                           const struct adaptive *adaptive);

#endif
