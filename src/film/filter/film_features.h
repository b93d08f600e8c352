// SPDX-License-Identifier: MIT
/*
 * film_features.h - features of a film's first surfaces, for the filter
 *
 * Each pixel of the film has surfaces, and at least one sample.
 *
 * Threads:   any; the film's rows are locked one by one
 */
#ifndef GLIM_FILM_FEATURES_H
#define GLIM_FILM_FEATURES_H

#include "film/film.h"
#include "film/filter/filter.h"

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

#endif
