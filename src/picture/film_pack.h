// SPDX-License-Identifier: MIT
/*
 * film_pack.h - the samples of a film in few bytes, packed in a moment, for
 * messages
 *
 * A row has the words of its pixels (film_words.h) one after the other: the
 * first words of all pixels, their second words, and so on. Bytes at either end
 * of a word that are 0 in all pixels are left out, which are most of the 128
 * bits of the sums. All machines have the lowest byte first.
 *
 * Units:     bytes
 * Ownership: the caller frees packed bytes
 * Threads:   those of film_words.h
 * Errors:    out of memory, other bytes than those of film_pack()
 */
#ifndef GLIM_FILM_PACK_H
#define GLIM_FILM_PACK_H

#include "picture/film.h"

/* Returns the packed rows of a film behind `head` bytes for the caller, and the
 * size of all; NULL without memory. */
uint8_t *film_pack(struct film *film, size_t head, size_t *size);

/* Unpacks the next row of a film at *p into row 0 of a film of the same width,
 * with surfaces or without, and moves *p behind it. */
bool film_unpack_row(struct film *row, const uint8_t **p, const uint8_t *end,
                     struct error *err);

#endif
