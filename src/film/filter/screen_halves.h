// SPDX-License-Identifier: MIT
/*
 * screen_halves.h - independent halves of the light of film and draft, at the
 * size of the screen
 *
 * A pixel of the screen is the mean over its area of the film's pixels and of
 * the draft's pixel, weighted by samples. The even samples of a pixel belong to
 * one half, the odd ones to the other; which one depends on the pixel, so that
 * a single sample of each pixel gives both.
 *
 * Ownership: screen_halves_free() frees; a zeroed struct is empty
 * Threads:   one at a time; the films' rows are locked one by one
 */
#ifndef GLIM_SCREEN_HALVES_H
#define GLIM_SCREEN_HALVES_H

#include "film/film.h"
#include "film/filter/filter_loops.h"

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

#endif
