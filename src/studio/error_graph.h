// SPDX-License-Identifier: MIT
/*
 * error_graph.h - a graph of the error of the render over its time, with its
 * expected way to the next target
 *
 * Both axes are logarithmic, so that an error that falls as one over the root
 * of the time is a straight line. The graph is made of the dots of braille
 * characters, or of ASCII where the terminal has no Unicode.
 *
 * Units:     terminal cells, seconds
 * Threads:   any for the plot, main only for drawing
 */
#ifndef GLIM_ERROR_GRAPH_H
#define GLIM_ERROR_GRAPH_H

#include <stdbool.h>

#include "render/progress.h"
#include "session/live_render.h"
#include "terminal/screen.h"

#define ERROR_GRAPH_COLS 200
#define ERROR_GRAPH_ROWS 24

struct error_graph {
    int cols, rows; /* of the plot; up to the sizes above */
    bool has_unicode;
    double from_s, to_s; /* ends of the axes */
    double high, low;
    int known_cols; /* columns of errors so far; those after it are expected */
    char text[ERROR_GRAPH_ROWS][3 * ERROR_GRAPH_COLS + 1];
};

/* Plots the errors so far as an area, and their way to the target as dots. A
 * target whose time is 0 or far away is left out. Returns false while fewer
 * than two errors are known. */
bool error_graph_plot(struct error_graph *g, const struct error_history *errors,
                      double target, double target_s);

/* Draws a graph with a title and axes into `at` of the screen, above the last
 * row. It needs 4 rows and 24 columns. The errors are those without a filter.
 */
void error_graph_draw(const struct live_render *control, struct screen *screen,
                      const struct window_rect *at);

#endif
