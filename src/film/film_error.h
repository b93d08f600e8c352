// SPDX-License-Identifier: MIT
/*
 * film_error.h - the error of a film, estimated from the two halves of each
 * pixel
 *
 * Halves a and b are independent, so e = (a - b) / 2 has the variance of the
 * pixel x = (a + b) / 2. The error of the picture is its relative root mean
 * square error: the root of the mean over pixels and channels of
 *
 *     (x - truth)^2 / (m^2 + (0.1 / 2^exposure)^2)
 *
 * where m is the mean of the 48 pixels around, by which noise does not weigh
 * itself, or a quarter of the pixel if that is more: the edge of a lamp before
 * a dark wall would otherwise outweigh the picture. The second term keeps
 * pixels that are black on the screen from counting.
 *
 * The estimate is the mean of e^2 with the same weights. It differs from the
 * error of this very picture by the mean of the products of the errors of a and
 * b, because (x - truth)^2 - e^2 is that product. Its variance gives the
 * interval. The lower end is below the estimate by a difference, the upper one
 * above it by a factor: where few pixels carry the error, estimates are mostly
 * a little too low and seldom much too high.
 *
 * Threads:   any; rows of the film are locked
 */
#ifndef GLIM_FILM_ERROR_H
#define GLIM_FILM_ERROR_H

#include <stdbool.h>

#include "base/thread_pool.h"
#include "film/film.h"

/* Square of the light, relative to white, that is black on the screen. */
#define FILM_ERROR_BLACK 0.01f

struct film_error {
    bool is_known; /* every pixel has a sample in each half */
    /* Few pixels do not carry most of the error. Otherwise light that few
     * samples find, a caustic perhaps, may be missing from the estimate. */
    bool is_resolved;
    double error;     /* 0.01 is 1 % */
    double low, high; /* 95 % interval */
};

/* Reads pixel `at` of a film, whose row is locked: its mean, and e. Both are
 * limited, so that sums of their squares are finite. Returns false if a half
 * has no sample. */
bool film_pixel_error(const struct film *film, size_t at, float mean[3],
                      float e[3]);

/* Estimates the error of the film. It has the same bits with any pool; NULL is
 * the caller's thread. The error is unknown after a cancel (NULL: none).
 * Returns false without memory. */
bool film_error(struct film *film, float exposure, struct pool *pool,
                const struct cancel *cancel, struct film_error *error,
                struct error *err);

/* Writes the error of each pixel, as a root mean square over the 5 x 5 pixels
 * around it. The pool may be NULL. Returns false if the error is unknown. */
bool film_error_map(struct film *film, float exposure, struct pool *pool,
                    float *map);

/* Squared relative errors of the pixels of one colour of a chess board. */
struct film_squares {
    struct film *film;
    float exposure;
    int colour;     /* 0: pixels with even x + y, or 1 */
    float *squares; /* of all pixels, the caller's; 0 for the other colour */
    bool is_known;  /* false: a pixel lacks samples, or a cancel came */
};

/* Sets the squares, which depend on pixels of the colour only, and is_known.
 * The pool and the cancel may be NULL. */
void film_error_squares(struct film_squares *s, struct pool *pool,
                        const struct cancel *cancel);

#endif
