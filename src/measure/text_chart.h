// SPDX-License-Identifier: MIT
/*
 * text_chart.h - curves in a log-log diagram of characters
 *
 * Units:     characters
 * Threads:   any
 */
#ifndef GLIM_TEXT_CHART_H
#define GLIM_TEXT_CHART_H

#include <stdbool.h>
#include <stdio.h>

#include "measure/chart.h"

/* Least size of a diagram; a smaller one is enlarged. */
#define TEXT_CHART_COLS_MIN 24
#define TEXT_CHART_ROWS_MIN 8

/* Writes the diagram, at most `cols` wide and `rows` high, in braille or in
 * ASCII. Guides are dotted. Writes nothing if there is no point to draw. */
void text_chart_write(FILE *to, const struct chart *chart, int cols, int rows,
                      bool has_braille);

#endif
