// SPDX-License-Identifier: MIT
/*
 * error_history.h - the errors of a render over its time, for a plot with
 * logarithmic axes
 *
 * Units:     seconds of rendering; relative errors, 0.01 is 1 %
 * Ownership: a zeroed struct is empty
 * Threads:   one at a time
 */
#ifndef GLIM_ERROR_HISTORY_H
#define GLIM_ERROR_HISTORY_H

#include "render/render_loop.h"

/* Times grow by a tenth at least, so that this is enough for a year. */
#define ERROR_HISTORY_MAX 256

struct error_history {
    struct error_then {
        double time_s, error;
    } points[ERROR_HISTORY_MAX];
    int count;
};

/* Adds the present error, if it is known and the time has grown enough. Begins
 * anew if the time is less than before. */
void error_history_update(struct error_history *history,
                          const struct render_progress *progress);

#endif
