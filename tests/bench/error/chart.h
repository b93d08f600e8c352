// SPDX-License-Identifier: MIT
/*
 * chart.h - curves in a log-log diagram, as a PNG file
 *
 * Units:     pixels inside; whatever the axes' labels say outside
 * Ownership: none
 * Threads:   one
 * Errors:    nothing to draw, memory, unwritable file
 */
#ifndef ERROR_CHART_H
#define ERROR_CHART_H

#include "glim/util.h"

#define CHART_POINTS 16

struct series {
    const char *name;
    int count;
    double x[CHART_POINTS], y[CHART_POINTS]; /* others than above 0: left out */
};

/* Text is of letters, shown as capitals, digits and - . , : + / _ ( ) */
struct chart {
    const char *title, *x_label, *y_label;
    const struct series *series;
    int series_count;
};

bool chart_write(const struct chart *chart, const char *path,
                 struct error *err);

#endif
