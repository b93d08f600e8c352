// SPDX-License-Identifier: MIT
/*
 * filter.h - the denoising filter of a picture: kernels/filter.h over all
 * pixels
 *
 * The picture is given as two halves with independent samples and one or two
 * components of light, with features of the surfaces that are seen. The result
 * has the same bits for any number of threads and any instruction set. If the
 * halves are equal it is the picture, up to rounding. Each pixel needs a
 * sample. A half without samples is taken from the four pixels beside it, so
 * that pictures of one sample can be filtered if the samples of neighbours
 * belong to different halves.
 *
 * Units:     radiance, 0 to 2^62; depths in any unit
 * Ownership: filter_free() frees; a zeroed struct is empty. The filter may be
 *            used for any number of pictures of its size
 * Threads:   one at a time; workers of the pool call the source's functions for
 *            different rows
 * Errors:    out of memory
 */
#ifndef GLIM_FILTER_H
#define GLIM_FILTER_H

#include <stdbool.h>

#include "base/error.h"
#include "base/thread_pool.h"
#include "film/filter/filter_loops.h"

/* ---- builds of the loops ---- */

/* Returns the loops for the i-th instruction set that this processor has,
 * fastest first, or NULL after the last. */
const struct filter_loops *filter_loops_at(int i);

/* ---- the filter ---- */

/* A row of the features of pixels, which the source fills. */
struct filter_row {
    float *albedo[3];
    float *normal[3];
    float *depth;
    /* variances of the means above, summed over components */
    float *albedo_noise, *normal_noise, *depth_noise;
    float *count[2]; /* samples of each half */
};

/* Functions that fill row y of the picture. After the features of a row, the
 * same worker asks for the light of its component 0. */
struct filter_source {
    void *context;
    int component_count;
    void (*features)(void *context, int y, const struct filter_row *to);
    /* means of red, green and blue of a component of each half */
    void (*light)(void *context, int component, int y, float *to[2][3]);
    const struct cancel *cancel; /* NULL: none. After a cancel, the result is
                                    any picture. */
};

struct filter {
    struct filter_planes planes;
    float *count[2]; /* planes too */
    float *memory;
    float *row_max; /* greatest light of each row */
    const struct filter_loops *loops;
};

enum filter_form {
    FILTER_FULL,
    FILTER_FAST, /* four levels without weights of opposite pixels, for a
                    picture that moves */
};

bool filter_init(struct filter *f, int width, int height, struct error *err);
void filter_free(struct filter *f);

/* Three numbers for each pixel, of the sum of the components. */
struct filter_result {
    float *rgb;
    float *variance;   /* that noise leaves in it, estimated; NULL: not asked */
    float *difference; /* half of that of the filtered halves, which has this
                          variance in the mean; NULL: not asked */
};

/* Filters a picture. The pool may be NULL. Blocks. */
void filter_run(struct filter *f, const struct filter_source *source,
                enum filter_form form, struct pool *pool,
                const struct filter_result *result);

#endif
