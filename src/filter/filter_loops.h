// SPDX-License-Identifier: MIT
/*
 * filter_loops.h - the loops of the denoising filter over the pixels of a tile,
 * compiled for several instruction sets
 *
 * The Makefile compiles src/filter/filter_loops.c for each (FILTERS). All
 * builds give the same bits. filter_dispatch.h chooses one.
 *
 * Units:     as kernels/filter.h
 * Threads:   any, on tiles that differ
 */
#ifndef GLIM_FILTER_LOOPS_H
#define GLIM_FILTER_LOOPS_H

#include "filter/filter_planes.h"
#include "kernels/sum.h"

struct filter_loops {
    /* Computes the variances of halves[0] from its light. */
    void (*variance)(const struct filter_planes *p, struct filter_tile t);

    /* Computes the weights of the pixels of halves[from] with those at a
     * distance of `step`. */
    void (*weigh)(const struct filter_planes *p, struct filter_tile t, int from,
                  int step);

    /* Filters halves[from] into halves[1 - from] with the weights of all
     * tiles. The last level needs no variance. */
    void (*average)(const struct filter_planes *p, struct filter_tile t,
                    int from, int step, bool is_last);

    /* Converts sums to floats. */
    void (*convert)(const struct sum *sums, int count, float *to);
};

#endif
