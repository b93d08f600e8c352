// SPDX-License-Identifier: MIT
/*
 * gauge.h - gauges and sliders as cells
 *
 * A gauge is filled from the left in steps of an eighth of a cell. A slider
 * shows the colour that each of its places stands for, and a handle at the
 * present one.
 *
 * Units:     terminal cells; fractions are clamped to 0..1
 * Threads:   any
 */
#ifndef GLIM_GAUGE_H
#define GLIM_GAUGE_H

#include <stdbool.h>

#include "terminal/theme.h"

/* Fills a gauge of `cols` cells. Without Unicode its characters are = and . */
void gauge_cells(struct cell *cells, int cols, double fraction,
                 struct text_style style, bool has_unicode);

/* Puts the handle on a slider whose cells are blanks of cells_of_color(). */
void gauge_handle(struct cell *cells, int cols, double fraction,
                  enum palette palette, bool has_unicode);

/* Returns the fraction that the middle of a cell stands for. */
double gauge_fraction(int col, int cols);

#endif
