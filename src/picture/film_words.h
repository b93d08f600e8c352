// SPDX-License-Identifier: MIT
/*
 * film_words.h - the pixels of a film as 64-bit words, for files and messages
 *
 * A pixel is its number of samples, its sums, those of odd samples, and the
 * sums of its surfaces, if the film has some.
 *
 * Threads:   film_words_put() from any thread, as others add to the film;
 *            film_words_take() while nobody else uses it
 */
#ifndef GLIM_FILM_WORDS_H
#define GLIM_FILM_WORDS_H

#include "picture/film.h"

/* Returns the number of words of a pixel. */
size_t film_words_count(bool has_surfaces);

/* Copies the pixels of a row to width * count words. The sums of a pixel
 * without samples, which are undefined in a film, become 0. */
void film_words_put(struct film *film, int y, uint64_t *to);

/* Replaces the pixels of a row. The counters of the film stay. */
void film_words_take(struct film *film, int y, const uint64_t *from);

#endif
