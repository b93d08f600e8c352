// SPDX-License-Identifier: MIT
/*
 * render_limits.h - the limits of a render: samples, error, time
 *
 * Units:     samples per pixel (spp), nanoseconds
 */
#ifndef GLIM_RENDER_LIMITS_H
#define GLIM_RENDER_LIMITS_H

#include <stdint.h>

#include "picture/film_error.h"

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

#endif
