// SPDX-License-Identifier: MIT
/*
 * film.h - the film: exact integer sums of samples, and pictures made of them
 *
 * A film covers a rectangle (the crop) of the whole picture. Coordinates are
 * relative to the film: (0, 0) is the corner of the crop, row 0 is the top. A
 * pixel without samples shows its neighbour on the next coarser grid that has
 * some: (x & -2, y & -2), (x & -4, y & -4), ...
 *
 * Units:     radiance sums; 8-bit sRGB in frames
 * Ownership: film_free() frees; a zeroed struct is an empty film
 * Threads:   film_add_row() for rows that no other thread adds to; reading
 *            functions from any thread at any time (a lock a row)
 * Errors:    memory: the text says how much was needed
 */
#ifndef GLIM_FILM_H
#define GLIM_FILM_H

#include <pthread.h>
#include <stdatomic.h>

#include "base/error.h"
#include "picture/frame.h"
#include "kernels/pixel.h"
#include "kernels/tone.h"

#define FILM_LOCKS 64

/* The coarsest grid that the first pass begins with; a power of two. */
#define FILM_STRIDE_MAX 32

/* A film with fewer samples a pixel is shown with a draft, if there is one. */
#define FILM_YOUNG_SPP 16

struct film {
    int width, height;
    struct sum *sums; /* 3 a pixel; guarded by locks[y % FILM_LOCKS] */
    uint64_t *counts; /* samples of a pixel; guarded likewise */
    bool *has_row;    /* whether a row has any; guarded likewise */
    pthread_mutex_t locks[FILM_LOCKS];
    atomic_uint_least64_t samples; /* of all pixels */
    atomic_uint_least64_t rays;
    atomic_uint_least64_t non_finite; /* NaN, Inf or negative: count as 0 */
    atomic_uint_least64_t saturated;  /* above 2^62: count as 2^62 */
    atomic_uint_least64_t cut_paths;  /* ended at the hard stop */
};

/* Development of linear light: scaled by 2^exposure, then the tone curve. */
struct develop {
    float exposure;
    uint32_t tone; /* enum tone */
};

static inline struct develop develop_linear(float exposure)
{
    return (struct develop){exposure, TONE_LINEAR};
}

bool film_init(struct film *film, int width, int height, struct error *err);
void film_clear(struct film *film);
void film_free(struct film *film);

/* Returns the samples of a pixel so far, which is the index of its next one.
 * For the thread that adds to it. */
uint64_t film_count(const struct film *film, int x, int y);

/* Adds samples to pixels x, x + stride, ... of row y, counts[i] of them to
 * pixel i. The samples of a pixel follow those of the one before. */
void film_add_row(struct film *film, int x, int y, int stride, int pixel_count,
                  const struct path_sample *samples, const int *counts);

/* Replaces pixels x, x + stride, ... of row y, for a device that keeps sums of
 * its own: `sums` and `counts` begin with those of pixel 0 of the row. What has
 * the same count is the same. */
void film_store_row(struct film *film, int x, int y, int stride,
                    int pixel_count, const struct sum *sums,
                    const uint64_t *counts);

/* Adds to the counters for samples whose sums are stored elsewhere or later. */
void film_count_more(struct film *film, const struct tally *tally);

/* Linear means, 3 floats a pixel, row 0 at the top. */
void film_linear(struct film *film, float *rgb);

/* Samples of each pixel, row 0 at the top. */
void film_counts(struct film *film, float *counts);

/* 8-bit sRGB of the means, developed. `frame` has the film's size and
 * its own memory. */
void film_resolve(struct film *film, struct develop how, struct frame *frame);

/* The same in any size: in light, the mean of those pixels by area. With a
 * draft of the same picture, NULL: none, it comes from the mean of all samples
 * while the film has one a pixel, and from the film's pixels alone from
 * FILM_YOUNG_SPP on. */
void film_preview(struct film *film, struct film *draft, struct develop how,
                  struct frame *frame);

#endif
