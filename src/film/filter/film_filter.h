// SPDX-License-Identifier: MIT
/*
 * film_filter.h - the denoising filter of a film with first surfaces, and the
 * features of these
 *
 * Direct and indirect light are filtered apart. Lamps and the sky stay as a
 * pinhole camera sees them. Each pixel of the film has surfaces, and at least
 * one sample.
 *
 * Units:     radiance
 * Ownership: the film stays the caller's
 * Threads:   one filter at a time; the film's rows are locked one by one
 * Errors:    out of memory
 */
#ifndef GLIM_FILM_FILTER_H
#define GLIM_FILM_FILTER_H

#include "base/thread_pool.h"
#include "film/film_error.h"
#include "film/filter/filter.h"

/* ---- features ---- */

/* Returns the greatest mean depth of the surfaces of every `stride`-th pixel
 * each way, which rays that leave the scene get. */
float film_features_far(struct film *film, int stride);

/* Pixels of a row: `count` of them, `step` apart. */
struct film_columns {
    int first, step, count;
};

/* Writes the features of pixels of row y and their noise. The counts stay as
 * they are. */
void film_features(struct film *film, float far, int y,
                   struct film_columns columns, const struct filter_row *to);

/* ---- filter ---- */

/* Returns true if the film can be filtered: it has surfaces, and each pixel has
 * a sample in each half, and features, which a late share of the samples has
 * not. */
bool film_filter_applies(struct film *film);

/* Sets the squares that noise leaves after the filter, as film_error_squares()
 * does before it: only pixels of the colour are filtered, as a picture of half
 * the width. So the numbers are too high by a factor, which is about the same
 * for all. The film can be filtered, and has two pixels in a row. The cancel
 * may be NULL. */
bool film_filter_squares(struct film_squares *s, struct pool *pool,
                         const struct cancel *cancel, struct error *err);

/* Adds the filtered picture to an empty film of the same size, as one sample of
 * each pixel. The pool may be NULL. Blocks. */
bool film_filter(struct film *film, struct pool *pool, struct film *filtered,
                 struct error *err);

/* Makes *filtered, which is uninitialised, the filtered picture, with threads
 * of its own. It is empty after an error. */
bool film_filter_copy(struct film *film, int thread_count,
                      struct film *filtered, struct error *err);

#endif
