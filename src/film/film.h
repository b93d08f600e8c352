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
 * Threads:   film_add_row() for rows that no other thread adds to; film_merge()
 *            locks the rows of the film one by one, and nobody else uses the
 *            part; reading functions from any thread at any time (rows are
 *            locked)
 * Errors:    out of memory; the text says how much was needed
 */
#ifndef GLIM_FILM_H
#define GLIM_FILM_H

#include <pthread.h>
#include <stdatomic.h>

#include "base/error.h"
#include "image/frame.h"
#include "kernels/pixel.h"
#include "kernels/tone.h"

#define FILM_LOCKS 64

/* Bytes of a pixel without surfaces: two sums of three channels, and a count.
 */
#define FILM_PIXEL_BYTES (6 * sizeof(struct sum) + sizeof(uint64_t))

/* Stride of the coarsest grid, with which the first pass begins; a power of
 * two. */
#define FILM_STRIDE_MAX 32

/* Samples per pixel up to which a film is shown with its draft, if any. */
#define FILM_YOUNG_SPP 16

struct film {
    int width, height;
    /* index of the first sample of each pixel: even, so that samples with even
     * indices come first */
    uint64_t first_sample;
    struct sum *sums;     /* 3 per pixel; guarded by locks[y % FILM_LOCKS] */
    struct sum *odd_sums; /* likewise, of samples with odd indices only */
    /* of each pixel, guarded likewise; NULL: not wanted */
    struct surface_sums *surfaces;
    uint64_t *counts; /* samples of each pixel; guarded likewise */
    bool *has_row;    /* whether a row has samples; guarded likewise */
    pthread_mutex_t locks[FILM_LOCKS];
    atomic_uint_least64_t samples; /* of all pixels */
    atomic_uint_least64_t rays;
    atomic_uint_least64_t non_finite; /* NaN, infinite or negative samples,
                                         counted as 0 */
    atomic_uint_least64_t saturated;  /* samples above 2^62, or above the room
                                         in their sums, cut to that */
    atomic_uint_least64_t cut_paths;  /* paths ended by the limit on their
                                         length */
};

/* Development of linear light: scaling by 2^exposure, then the tone curve. */
struct develop {
    float exposure;
    uint32_t tone; /* enum tone */
};

static inline struct develop develop_linear(float exposure)
{
    return (struct develop){exposure, TONE_LINEAR};
}

/* Returns 2^exposure, within the range of normal floats. */
float develop_factor(struct develop how);

/* Develops pixels, 3 numbers each, to 8-bit sRGB. */
void develop_row(struct develop how, int count, const float *rgb,
                 uint8_t *bytes);

/* Return how many of the first `count` samples of a pixel are in each half:
 * those with even indices, and those with odd ones. */
static inline uint64_t film_even_count(uint64_t count)
{
    return (count + 1) / 2;
}

static inline uint64_t film_odd_count(uint64_t count)
{
    return count / 2;
}

bool film_init(struct film *film, int width, int height, struct error *err);

/* Gives an empty film sums of first surfaces, for the denoising filter. */
bool film_init_surfaces(struct film *film, struct error *err);
void film_clear(struct film *film);
void film_free(struct film *film);

/* Locks a row, for direct access to its sums and counts. */
void film_lock_row(struct film *film, int y);
void film_unlock_row(struct film *film, int y);

/* Returns the number of samples of a pixel so far. Only the thread that adds to
 * the row may call it. */
uint64_t film_count(const struct film *film, int x, int y);

/* Pixels x, x + stride, ... of row y. */
struct film_pixels {
    int x, y, stride, count;
};

/* Adds samples to pixels of a row: counts[i] samples to the i-th of them.
 * `samples` holds them pixel after pixel; so does `surfaces`, if the film has
 * surfaces. */
void film_add_row(struct film *film, struct film_pixels at,
                  const struct path_sample *samples,
                  const struct first_surface *surfaces, const int *counts);

/* Replaces pixels of a row by sums that a device keeps. The
 * arrays begin with pixel 0 of the row. Pixels whose count is unchanged are
 * skipped. */
void film_store_row(struct film *film, struct film_pixels at,
                    const struct sum *sums, const struct sum *odd_sums,
                    const struct surface_sums *surfaces,
                    const uint64_t *counts);

/* Exchanges the samples of two films of the same size. Nobody else uses them
 * meanwhile. */
void film_swap(struct film *a, struct film *b);

/* Copies the pixels of another film into an uninitialised one. The counters
 * stay 0. */
bool film_copy(struct film *to, struct film *from, struct error *err);

/* Adds to the counters for samples whose sums are stored elsewhere or later. */
void film_count_more(struct film *film, const struct tally *tally);

/* Counts the samples of all pixels again, where a tally was lost. */
void film_count_again(struct film *film);

/* Writes linear means, 3 floats per pixel, row 0 at the top. */
void film_linear(struct film *film, float *rgb);

/* Writes the number of samples of each pixel, row 0 at the top. */
void film_counts(struct film *film, float *counts);

/* Develops the means to 8-bit sRGB. `frame` has the film's size and its own
 * memory. */
void film_resolve(struct film *film, struct develop how, struct frame *frame);

/* Develops the film into a frame of any size; pixels of the frame average
 * pixels of the film in linear light by area. With a draft of the same picture
 * (may be NULL), the frame shows the mean of all samples while the film has one
 * per pixel, and the film alone from FILM_YOUNG_SPP on. */
void film_preview(struct film *film, struct film *draft, struct develop how,
                  struct frame *frame);

/* The same for pixels of a row of the frame; their stride is 1. */
void film_preview_part(struct film *film, struct film *draft,
                       struct develop how, struct film_pixels part,
                       struct frame *frame);

/* ---- merging ---- */

/* Adds sums, numbers of samples and counters of a part, whose first row is row
 * y of the film. Both have the same width, and surfaces or none. Pixels of the
 * part without samples have sums of 0. */
void film_merge(struct film *film, int y, const struct film *part);

#endif
