// SPDX-License-Identifier: MIT
/*
 * chart.h - curves in a diagram, log-log or with a linear y, as a PNG file
 *
 * Units:     pixels inside; those of the axes' labels outside
 * Threads:   one
 * Errors:    no points, memory, unwritable file
 */
#ifndef GLIM_CHART_H
#define GLIM_CHART_H

#include <stdbool.h>

#include "base/error.h"
#include "measure/series.h"

/* Points that are not above 0 are left out. Characters of the texts that
 * lettering.h does not have are blank. */
struct chart {
    const char *title, *x_label, *y_label;
    const struct series *series;
    int series_count;
    bool is_linear; /* y is linear, from 0 on */
};

bool chart_write(const struct chart *chart, const char *path,
                 struct error *err);

#endif
