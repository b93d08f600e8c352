// SPDX-License-Identifier: MIT
/*
 * screen_halves.h - what the screen's filter is given: halves of the light of
 * film and draft, and the detail above the resolution of a filtered picture
 *
 * Ownership: screen_halves_free() and screen_detail_free() free; zeroed structs
 *            are empty
 * Threads:   one at a time; the films' rows are locked one by one
 * Errors:    out of memory
 */
#ifndef GLIM_SCREEN_HALVES_H
#define GLIM_SCREEN_HALVES_H

#include "film/film.h"
#include "film/filter/filter_loops.h"

/* ---- halves ---- */

/*
 * A pixel of the screen is the mean over its area of the film's pixels and of
 * the draft's pixel, weighted by samples. The even samples of a pixel belong to
 * one half, the odd ones to the other; which one depends on the pixel, so that
 * a single sample of each pixel gives both.
 */

struct half_cell;

struct screen_halves {
    int width, height;
    const struct filter_loops *loops;
    float *memory;
    /* a row: means of each half, its samples, and the mean of both, 3 numbers
     * for each pixel */
    float *light[2][3];
    float *count[2];
    float *raw;
    struct half_cell *cells, *next_cells; /* sums of a row and of the next */
};

/* Returns false, with an empty struct, if memory is out. */
bool screen_halves_init(struct screen_halves *s, int width, int height,
                        const struct filter_loops *loops);
void screen_halves_free(struct screen_halves *s);

/* Begins a picture. */
void screen_halves_begin(struct screen_halves *s);

/* Computes row y of the picture, which follows row y - 1. The film is at least
 * as large as the screen; the draft has its size. Either may be NULL. A pixel
 * needs a sample in one of them. */
void screen_halves_row(struct screen_halves *s, struct film *film,
                       struct film *draft, int y);

/* ---- detail ---- */

/*
 * Frames of many pixels are filtered at a lower resolution. The result is
 * enlarged, and the film's own detail is added: the difference between its
 * pixels and their means over the pixels of the filtered picture, times a
 * weight. The weight is that of Wiener's filter, 1 - noise / energy, where the
 * noise of the detail is known from the two halves of the samples. So detail
 * appears as soon as it is stronger than its noise, and the sum becomes the
 * film's picture.
 */

struct screen_detail {
    struct screen_halves halves;
    int width, height;         /* of the result */
    int low_width, low_height; /* of the filtered picture */
    bool has_detail;           /* the film has samples in both halves */
    float *memory;
    float *detail; /* of the film's pixels, 3 numbers each */
    /* for each pixel of the filtered picture; 4 numbers are red, green and blue
     * times a weight, and the weight, which is the share of light that is not
     * seen */
    float *filtered; /* 4 numbers */
    float *low;      /* means of the film's pixels; 4 numbers */
    float *count;    /* of these pixels */
    float *noise;    /* sum of their variances */
    float *energy;   /* sum of the squares of the detail */
    float *weight;   /* of the detail */
    /* rows */
    float *between; /* of a picture, between two rows; 4 numbers each */
    float *row;     /* of the result; room for 4 numbers each */
    float *weights; /* of the result */
};

/* Prepares for results of width x height pixels. Returns false, with an empty
 * struct, without memory. */
bool screen_detail_init(struct screen_detail *d, int width, int height,
                        int low_width, int low_height,
                        const struct filter_loops *loops);

/* Finds the detail of the film, which has at least the pixels of the result,
 * and its weights. A film without two samples for each pixel has none. The
 * pixels of the filtered picture have 3 numbers each, and the share of their
 * light that is seen. Seen light is not enlarged. Blocks. */
void screen_detail_find(struct screen_detail *d, struct film *film,
                        const float *filtered, const float *seen);

/* Computes row y of the result, 3 numbers for each pixel. A pixel of seen light
 * is undefined. */
const float *screen_detail_row(struct screen_detail *d, int y);

void screen_detail_free(struct screen_detail *d);

#endif
