// SPDX-License-Identifier: MIT
/*
 * chart.h - curves in a log-log diagram, which gnuplot draws
 *
 * Units:     those of the axes' labels
 * Threads:   one
 * Errors:    memory, unwritable file
 */
#ifndef GLIM_CHART_H
#define GLIM_CHART_H

#include "base/error.h"
#include "measure/series.h"

/* Points that are not above 0 are left out. */
struct chart {
    const char *title, *x_label, *y_label;
    const struct series *series;
    int series_count;
};

/* Writes a script with the points. Of NAME.gp, gnuplot draws NAME.png. */
bool chart_write(const struct chart *chart, const char *path,
                 struct error *err);

#endif
