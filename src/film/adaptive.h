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
#include "film/film_error.h"

/* What the shares lower: the error of the film, or that of another picture of
 * it. */
struct adaptive_measure {
    /* Sets the squares as film_error_squares(). Fails only without memory. */
    bool (*squares)(struct film_squares *s, struct pool *pool,
                    const struct cancel *cancel, struct error *err);
    int reach;   /* pixels around a pixel, in each direction, whose deviations
                    it takes; ADAPTIVE_REACH_MAX at most */
    double most; /* greatest share over SHARE_ONE, up to SHARE_MAX */
};

#define ADAPTIVE_REACH_MAX 6

/* The error of the film. Fewer pixels around are too noisy for scenes with rare
 * bright light, more blur edges. */
extern const struct adaptive_measure adaptive_film;

struct adaptive {
    const struct adaptive_measure *measure; /* the user may set another one */
    int width, height;                      /* of the film */
    uint16_t *shares; /* of each pixel: kernels/sample_share.h */
    bool is_decided;  /* false: the shares are not computed yet */
};

/* Makes it empty, with adaptive_film as its measure. */

bool adaptive_init(struct adaptive *a, int width, int height,
                   struct error *err);
void adaptive_free(struct adaptive *a);

/* Forgets the shares. */
void adaptive_reset(struct adaptive *a);

/* Computes the shares with the least error by the measure, unless they are. The
 * film has ADAPTIVE_FIRST samples in each pixel. After a cancel, which may be
 * NULL, they are not decided. */
bool adaptive_decide(struct adaptive *a, struct film *film, float exposure,
                     struct pool *pool, const struct cancel *cancel,
                     struct error *err);

#endif
