// SPDX-License-Identifier: MIT
/*
 * render_left.h - the limit that a render reaches first, and the time until
 * then
 *
 * Units:     nanoseconds of rendering
 * Threads:   any
 */
#ifndef GLIM_RENDER_LEFT_H
#define GLIM_RENDER_LEFT_H

#include <stdbool.h>

#include "render/render_loop.h"

struct render_left {
    /* the limit that is reached, or the nearest one; none without limits, or
     * while the time to none of them is known */
    enum render_limit limit;
    double ns;
    double part; /* part of the way to that limit, 0 to 1 */
};

struct render_left render_left(const struct render_progress *p);

/* Finds the time until the upper end of the error is at the target. Returns
 * false while the error is unknown or unresolved. */
bool render_left_to_error(const struct render_progress *p, double target,
                          double *ns);

#endif
