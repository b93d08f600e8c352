// SPDX-License-Identifier: MIT
/*
 * adaptive.h - adaptive sampling: more samples for pixels with more error
 *
 * After the first samples, of which each pixel has the same number, each pixel
 * gets its share of all later ones, which never changes. It grows with the
 * standard deviation of the pixel, relative as in film_error.h.
 *
 * A mean is biased if the number of samples depends on their own values: pixels
 * in which bright light was found get more samples, those in which it was not
 * stay too dark (Kirk and Arvo 1991, "Unbiased sampling techniques for image
 * synthesis"). So the pixels are coloured as a chess board. The shares of white
 * pixels come from the light of black ones around, and those of black pixels
 * from white ones. The two colours get equally many samples.
 *
 * Deviations of a few samples are noisy, so each share is computed from many
 * pixels. No share is below an eighth: light that the first samples do not find
 * is found later. None is far above the mean, so that chance costs little.
 *
 * The rays of a pixel, its cost, do not count: they change the error at equal
 * time by less than 1 %.
 *
 * Ownership: adaptive_free() frees; a zeroed struct is empty
 * Threads:   between passes; the pool may be NULL
 * Errors:    out of memory
 */
#ifndef GLIM_ADAPTIVE_H
#define GLIM_ADAPTIVE_H

#include "base/thread_pool.h"
#include "picture/film.h"

struct adaptive {
    int width, height; /* of the film */
    uint16_t *shares;  /* of each pixel: kernels/sample_share.h */
    bool is_decided;   /* false: the shares are not computed yet */
};

bool adaptive_init(struct adaptive *a, int width, int height,
                   struct error *err);
void adaptive_free(struct adaptive *a);

/* Forgets the shares. */
void adaptive_reset(struct adaptive *a);

/* Computes the shares, unless they are. The film has ADAPTIVE_FIRST samples in
 * each pixel. After a cancel, which may be NULL, they are not decided. */
bool adaptive_decide(struct adaptive *a, struct film *film, float exposure,
                     struct pool *pool, const struct cancel *cancel,
                     struct error *err);

#endif
