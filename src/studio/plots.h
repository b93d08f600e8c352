// SPDX-License-Identifier: MIT
/*
 * plots.h - the speed and the error over the time of a render as text
 *
 * Plots are made of the dots of braille characters, or of ASCII where the
 * terminal has no Unicode.
 *
 * Units:     terminal columns
 * Threads:   any
 */
#ifndef GLIM_PLOTS_H
#define GLIM_PLOTS_H

#include <stdbool.h>

#include "render/progress.h"

#define PLOT_COLS       30
#define PLOT_BYTES      (3 * PLOT_COLS + 1)
#define PLOT_SPEED_ROWS 3
#define PLOT_ERROR_ROWS 4

/* Formats the speeds as bars from below, two in a column. The highest is `top`.
 */
void plot_speeds(char rows[PLOT_SPEED_ROWS][PLOT_BYTES],
                 const struct speeds *speeds, double top, bool has_unicode);

/* Formats the errors so far as a line, and their expected continuation to the
 * target as dots; both axes are logarithmic. The rows are blank while fewer
 * than two errors are known. `target` is the error that the render goes to, and
 * `target_s` the time when it is expected; 0: unknown. */
void plot_errors(char rows[PLOT_ERROR_ROWS][PLOT_BYTES],
                 const struct error_history *history, double target,
                 double target_s, bool has_unicode);

#endif
