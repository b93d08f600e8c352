// SPDX-License-Identifier: MIT
/*
 * film_pack.h - the pixels of a film as 64-bit words, for files and messages,
 * and the words packed in a moment
 *
 * A pixel is its number of samples, its sums, those of odd samples, and the
 * sums of its surfaces, if the film has some. A packed row has the words of its
 * pixels one after the other: the first words of all pixels, their second
 * words, and so on. Bytes at either end of a word that are 0 in all pixels are
 * left out, which are most of the 128 bits of the sums. All machines have the
 * lowest byte first.
 *
 * Units:     bytes
 * Ownership: the caller frees packed bytes
 * Threads:   film_words_put() from any thread, as others add to the film;
 *            film_words_take() while nobody else uses it
 * Errors:    out of memory, other bytes than those of film_pack()
 */
#ifndef GLIM_FILM_PACK_H
#define GLIM_FILM_PACK_H

#include "film/film.h"

/* ---- words ---- */

/* Returns the number of words of a pixel. */
size_t film_words_count(bool has_surfaces);

/* Copies the pixels of a row to width * count words. The sums of a pixel
 * without samples, which are undefined in a film, become 0. */
void film_words_put(struct film *film, int y, uint64_t *to);

/* Replaces the pixels of a row. The counters of the film stay. */
void film_words_take(struct film *film, int y, const uint64_t *from);

/* ---- messages ---- */

/*
 * A row has the words of its pixels (film_words.h) one after the other: the
 * first words of all pixels, their second words, and so on. Bytes at either end
 * of a word that are 0 in all pixels are left out, which are most of the 128
 * bits of the sums. All machines have the lowest byte first.
 */

/* Returns the packed rows of a film behind `head` bytes for the caller, and the
 * size of all; NULL without memory. */
uint8_t *film_pack(struct film *film, size_t head, size_t *size);

/* Unpacks the next row of a film at *p into row 0 of a film of the same width,
 * with surfaces or without, and moves *p behind it. */
bool film_unpack_row(struct film *row, const uint8_t **p, const uint8_t *end,
                     struct error *err);

#endif
