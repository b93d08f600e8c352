// SPDX-License-Identifier: MIT
/*
 * chart.h - curves in a log-log diagram, of characters or for gnuplot
 *
 * Units:     those of the axes' labels; sizes are characters
 * Threads:   one
 * Errors:    memory, unwritable file
 */
#ifndef GLIM_CHART_H
#define GLIM_CHART_H

#include <stdbool.h>
#include <stdio.h>

#include "base/error.h"
#include "command/curve.h"

/* Points that are not above 0 are left out. */
struct chart {
    const char *title, *x_label, *y_label;
    const struct series *series;
    int series_count;
};

/* Writes a script with the points. Of NAME.gp, gnuplot draws NAME.png. */
bool chart_write(const struct chart *chart, const char *path,
                 struct error *err);

/* Least size of a diagram; a smaller one is enlarged. */
#define CHART_COLS_MIN 24
#define CHART_ROWS_MIN 8

/* Writes the diagram, at most `cols` wide and `rows` high, in braille or in
 * ASCII. Guides are dotted. Writes nothing if there is no point to draw. */
void chart_write_text(FILE *to, const struct chart *chart, int cols, int rows,
                      bool has_braille);

#endif
