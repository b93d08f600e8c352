// SPDX-License-Identifier: MIT
/*
 * filter_loops.h - the loops of the denoising filter over the pixels of a tile,
 * compiled for several instruction sets
 *
 * kernels.mk compiles src/film/filter/filter_loops.c for each (FILTERS). All
 * builds give the same bits. filter_dispatch.h chooses one.
 *
 * Units:     as kernels/filter.h
 * Threads:   any, on tiles that differ
 */
#ifndef GLIM_FILTER_LOOPS_H
#define GLIM_FILTER_LOOPS_H

#include <stdbool.h>

#include "film/filter/filter_planes.h"
#include "kernels/sum.h"

/* A level of the filter. */
struct filter_level {
    int from; /* index of the halves that it reads; it writes the others */
    int step;
    bool has_opposite; /* opposite pixels have weights of their own */
    bool is_last;      /* no later level reads the result, and its variance is
                          of no use */
};

struct filter_loops {
    /* Computes the variances of halves[0] from its light. */
    void (*variance)(const struct filter_planes *p, struct filter_tile t);

    /* Computes the weights of the pixels of a tile. */
    void (*weigh)(const struct filter_planes *p, struct filter_tile t,
                  const struct filter_level *level);

    /* Filters a tile with the weights of all tiles. */
    void (*average)(const struct filter_planes *p, struct filter_tile t,
                    const struct filter_level *level);

    /* Computes the weights in planes.weights[0] with which features of a tile
     * are averaged. */
    void (*weigh_features)(const struct filter_planes *p, struct filter_tile t,
                           int step);

    /* Averages features of a tile with the weights of all tiles. */
    void (*average_features)(const struct filter_planes *p,
                             struct filter_tile t, int step,
                             const struct filter_features *to);

    /* Converts sums to floats. */
    void (*convert)(const struct sum *sums, int count, float *to);
};

#endif
