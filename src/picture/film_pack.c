// SPDX-License-Identifier: MIT
#include "picture/film_pack.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "picture/film_words.h"

/* Bytes before those of a word: the number of low bytes that are left out, and
 * that of the bytes that are there. */
#define WORD_HEAD 2

/* Bytes behind the last row. Words are stored and read with all their bytes,
 * of which those that are left out belong to the next word. */
#define SLACK 8

/* Packs a word of `count` pixels, which have `stride` words. Returns the end.
 */
static uint8_t *pack_word(uint8_t *to, const uint64_t *words, size_t stride,
                          size_t count)
{
    uint64_t bits = 0;
    int low = 0, high = 0;

    for (size_t i = 0; i < count; i++)
        bits |= words[i * stride];
    if (bits != 0) {
        low = __builtin_ctzll(bits) / 8;
        high = 8 - __builtin_clzll(bits) / 8;
    }
    *to++ = (uint8_t)low;
    *to++ = (uint8_t)(high - low);
    for (size_t i = 0; i < count && bits != 0; i++, to += high - low) {
        uint64_t word = words[i * stride] >> 8 * low;

        memcpy(to, &word, sizeof word);
    }
    return to;
}

uint8_t *film_pack(struct film *film, size_t head, size_t *size)
{
    size_t words = film_words_count(film->surfaces != NULL);
    size_t width = (size_t)film->width;
    size_t row_most = words * (WORD_HEAD + width * sizeof(uint64_t));
    uint64_t *row = alloc_aligned(width * words, sizeof *row);
    uint8_t *bytes =
        alloc_array(head + (size_t)film->height * row_most + SLACK, 1);
    uint8_t *to;

    if (row == NULL || bytes == NULL) {
        free(row);
        free(bytes);
        return NULL;
    }
    to = bytes + head;
    for (int y = 0; y < film->height; y++) {
        film_words_put(film, y, row);
        for (size_t w = 0; w < words; w++)
            to = pack_word(to, row + w, words, width);
    }
    free(row);
    *size = (size_t)(to - bytes) + SLACK;
    return bytes;
}

/* Reads a word of 1 to 8 bytes, the lowest first. */
static uint64_t read_word(const uint8_t *p, size_t width)
{
    uint64_t word;

    memcpy(&word, p, sizeof word);
    return word & UINT64_MAX >> (64 - 8 * width);
}

/* Unpacks a word of `count` pixels. Returns its end, or NULL. */
static const uint8_t *unpack_word(uint64_t *words, size_t stride, size_t count,
                                  const uint8_t *p, const uint8_t *end)
{
    size_t low, width;

    if (end - p < WORD_HEAD + SLACK)
        return NULL;
    low = p[0];
    width = p[1];
    p += WORD_HEAD;
    if (low + width > sizeof *words ||
        (size_t)(end - SLACK - p) / count < width)
        return NULL;
    for (size_t i = 0; i < count; i++, p += width)
        words[i * stride] = width > 0 ? read_word(p, width) << 8 * low : 0;
    return p;
}

bool film_unpack_row(struct film *row, const uint8_t **p, const uint8_t *end,
                     struct error *err)
{
    size_t words = film_words_count(row->surfaces != NULL);
    size_t width = (size_t)row->width;
    uint64_t *pixels = alloc_aligned(width * words, sizeof *pixels);
    const uint8_t *from = *p;

    if (pixels == NULL)
        return fail(err, "out of memory for a row of the film");
    for (size_t w = 0; w < words && from != NULL; w++)
        from = unpack_word(pixels + w, words, width, from, end);
    if (from != NULL)
        film_words_take(row, 0, pixels);
    free(pixels);
    *p = from;
    return from != NULL || fail(err, "found damaged rows of a film");
}
