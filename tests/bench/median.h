// SPDX-License-Identifier: MIT
/*
 * median.h - the median of measurements
 *
 * Units:     those of the values
 * Threads:   any
 */
#ifndef BENCH_MEDIAN_H
#define BENCH_MEDIAN_H

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Maximum number of values for median(). */
#define MEDIAN_MAX 32

static inline int median_order(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static inline double median(const double *values, int count)
{
    double sorted[MEDIAN_MAX];

    assert(count > 0 && count <= MEDIAN_MAX);
    memcpy(sorted, values, (size_t)count * sizeof *sorted);
    qsort(sorted, (size_t)count, sizeof *sorted, median_order);
    return (sorted[(count - 1) / 2] + sorted[count / 2]) / 2;
}

#endif
