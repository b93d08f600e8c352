// SPDX-License-Identifier: MIT
/*
 * adaptive.h - adaptive sampling: more samples for pixels with more error
 *
 * The mean square error falls most if the samples of pixels are in proportion
 * to the standard deviation of one, relative as in film_error.h. Rounds begin
 * after 16, 32, 64, ... samples per pixel. Each chooses quotas for its passes,
 * so that the totals are as near to that proportion as the samples so far
 * allow.
 *
 * A mean is biased if the number of samples depends on their own values: pixels
 * in which bright light was found get more samples, those in which it was not
 * stay too dark (Kirk and Arvo 1991, "Unbiased sampling techniques for image
 * synthesis"). So no pixel's number depends on its own samples. Each cell of 2
 * x 2 pixels has a pilot, its upper left one. The quotas of the other pixels
 * come from the deviations of the 5 x 5 pilots around. The share of a pilot
 * comes from the other 24, and only from their first 16 samples, whose number
 * is fixed; so no later number reaches back to it. All pixels share one factor
 * that makes the total right.
 *
 * Units:     samples
 * Ownership: adaptive_free() frees; a zeroed struct is empty
 * Threads:   between passes
 * Errors:    out of memory
 */
#ifndef GLIM_ADAPTIVE_H
#define GLIM_ADAPTIVE_H

#include "picture/film.h"

/* Samples of each pixel before the first round. */
#define ADAPTIVE_FIRST 16u

/* Samples per pixel of a pass in the mean, and at most. */
#define ADAPTIVE_PASS 8u
#define ADAPTIVE_MOST 32u

struct adaptive {
    int width, height; /* of the film */
    size_t cells;      /* number of cells of 2 x 2 pixels */
    /* two numbers for each cell, of its pilot and of its other pixels: see
     * kernels/targets.h */
    uint32_t *targets; /* samples after the pass */
    uint8_t *quotas;   /* samples in a pass of ADAPTIVE_PASS */
    float *deviations; /* of a sample; those of pilots are kept */
    uint64_t planned;  /* samples per pixel, in the mean, of the targets */
    uint32_t version;  /* of the targets; never the same again */
};

bool adaptive_init(struct adaptive *a, int width, int height,
                   struct error *err);
void adaptive_free(struct adaptive *a);

/* Returns to the state before the first round. */
void adaptive_reset(struct adaptive *a);

/* Returns the samples per pixel at the end of the round after `done`. */
uint64_t adaptive_round_end(uint64_t done);

/* Sets the targets of the next pass, from `done` to *target samples per pixel
 * in the mean: at most ADAPTIVE_PASS, and within a round. A pass that was
 * interrupted keeps its targets, and *target becomes theirs. */
bool adaptive_next_pass(struct adaptive *a, struct film *film, float exposure,
                        uint64_t done, uint64_t *target, struct error *err);

#endif
