// SPDX-License-Identifier: MIT
/*
 * mutate_gltf.h - changes of glTF: its JSON, and the bytes of its buffers apart
 *
 * The chunks of a GLB file have their lengths afterwards. Buffers in the JSON
 * are changed behind their base64.
 *
 * Threads:   one
 */
#ifndef TESTS_FUZZ_MUTATE_GLTF_H
#define TESTS_FUZZ_MUTATE_GLTF_H

#include "mutate.h"

/* Bytes before the text of a GLB file, and before its second chunk. */
enum { GLB_TEXT = 20, GLB_CHUNK = 8 };

/* Changes the JSON of a GLB file, which ends with blanks, or its buffer. */
static inline void mutation_glb(struct mutation *m)
{
    size_t length = (size_t)mutation_get(m, 12, 4);
    size_t bin = GLB_TEXT + length + GLB_CHUNK;

    if (bin < m->size && mutation_pick(m, 2) == 0) {
        mutation_fixed(m, m->data + bin, m->size - bin);
        return;
    }
    length = mutation_text(m, GLB_TEXT, length);
    while (length % 4 != 0 && mutation_replace(m, GLB_TEXT + length, 0, " ", 1))
        length++;
    bin = GLB_TEXT + length + GLB_CHUNK;
    mutation_put(m, 8, 4, m->size);
    mutation_put(m, 12, 4, length);
    if (bin <= m->size)
        mutation_put(m, bin - GLB_CHUNK, 4, m->size - bin);
}

static const char mutation_digits[] =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/* Changes 3 * count bytes in 4 * count characters of base64. */
static inline void mutation_base64(struct mutation *m, uint8_t *text,
                                   size_t count)
{
    uint8_t *bytes = calloc(count + 1, 3);

    require(bytes != NULL, "memory");
    for (size_t i = 0; i < 4 * count; i++) {
        const char *digit = memchr(mutation_digits, text[i], 64);
        unsigned bits = digit != NULL ? (unsigned)(digit - mutation_digits) : 0;

        for (size_t k = 0; k < 6; k++)
            bytes[(6 * i + k) / 8] |=
                (uint8_t)((bits >> (5 - k) & 1) << (7 - (6 * i + k) % 8));
    }
    mutation_fixed(m, bytes, 3 * count);
    for (size_t i = 0; i < 4 * count; i++) {
        unsigned bits = 0;

        for (size_t k = 0; k < 6; k++)
            bits = bits << 1 |
                   (bytes[(6 * i + k) / 8] >> (7 - (6 * i + k) % 8) & 1);
        text[i] = (uint8_t)mutation_digits[bits];
    }
    free(bytes);
}

/* Changes a buffer in the JSON. Returns false if none is found. */
static inline bool mutation_data_uri(struct mutation *m)
{
    static const char mark[] = ";base64,";
    size_t from = mutation_pick(m, m->size), length = 0;
    uint8_t *p = memmem(m->data + from, m->size - from, mark, sizeof mark - 1);

    if (p == NULL)
        return false;
    p += sizeof mark - 1;
    while (p + length < m->data + m->size && p[length] != '"' &&
           p[length] != '=')
        length++;
    mutation_base64(m, p, length / 4);
    return true;
}

/* Changes a glTF file. */
static inline void mutation_gltf(struct mutation *m)
{
    if (m->size > GLB_TEXT && memcmp(m->data, "glTF", 4) == 0 &&
        mutation_get(m, 12, 4) <= m->size - GLB_TEXT)
        mutation_glb(m);
    else if (mutation_pick(m, 3) != 0 || !mutation_data_uri(m))
        mutation_text(m, 0, m->size);
}

#endif
