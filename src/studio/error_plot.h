// SPDX-License-Identifier: MIT
/*
 * error_plot.h - the error over the time of a render as text, both logarithmic
 *
 * The course so far is a line, its expected continuation to the target is
 * dotted.
 *
 * Units:     terminal columns
 * Threads:   any
 */
#ifndef GLIM_ERROR_PLOT_H
#define GLIM_ERROR_PLOT_H

#include <stdbool.h>

#include "render/error_history.h"
#include "studio/progress_text.h"

#define ERROR_PLOT_ROWS 4

/* Formats the rows, of PROGRESS_TEXT_COLS columns each; blank ones while fewer
 * than two errors are known. `target` is the error that the render goes to, and
 * `target_s` the time when it is expected; 0: unknown. */
void error_plot_format(char rows[ERROR_PLOT_ROWS][PROGRESS_TEXT_BYTES],
                       const struct error_history *history, double target,
                       double target_s, bool has_unicode);

#endif
