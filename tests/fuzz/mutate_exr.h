// SPDX-License-Identifier: MIT
/*
 * mutate_exr.h - changes of OpenEXR files: values of attributes, and packed
 * pixels with their sizes and places
 *
 * Threads:   one
 */
#ifndef TESTS_FUZZ_MUTATE_EXR_H
#define TESTS_FUZZ_MUTATE_EXR_H

#include "mutate.h"

static const uint8_t exr_magic[4] = {0x76, 0x2f, 0x31, 0x01};

/* Returns the place behind a name that ends with NUL. */
static inline size_t mutation_exr_name(const struct mutation *m, size_t at)
{
    while (at < m->size && m->data[at] != 0)
        at++;
    return at + 1;
}

/* Changes the value of one attribute. Returns the place of the table of
 * chunks. */
static inline size_t mutation_exr_head(struct mutation *m, bool has_change)
{
    size_t at = 8, count = 0, value = 0, length = 0;

    while (at < m->size && m->data[at] != 0) {
        size_t next = mutation_exr_name(m, mutation_exr_name(m, at));
        size_t bytes = (size_t)mutation_get(m, next, 4);

        if (next + 4 + bytes > m->size)
            break;
        if (mutation_pick(m, ++count) == 0) {
            value = next + 4;
            length = bytes;
        }
        at = next + 4 + bytes;
    }
    if (has_change && length > 0)
        mutation_fixed(m, m->data + value, length);
    return at + 1;
}

/* Changes the bytes of a chunk, and sets its size and the places of those
 * behind it. */
static inline void mutation_exr_chunk(struct mutation *m, size_t table)
{
    size_t first = (size_t)mutation_get(m, table, 8);
    size_t count = first > table && first < m->size ? (first - table) / 8 : 0;
    size_t place =
        (size_t)mutation_get(m, table + 8 * mutation_pick(m, count), 8);
    bool is_tiled = (m->data[5] & 2) != 0;
    size_t at = place + (is_tiled ? 20 : 8), length, before = m->size;

    if (count == 0 || place > m->size || at > m->size)
        return;
    length = (size_t)mutation_get(m, at - 4, 4);
    if (length == 0 || length > m->size - at)
        return;
    if (mutation_pick(m, 2) == 0) {
        mutation_fixed(m, m->data + at, length);
        return;
    }
    mutation_put(m, at - 4, 4, mutation_bytes(m, at, length));
    for (size_t i = 0; i < count; i++) {
        uint64_t to = mutation_get(m, table + 8 * i, 8);

        if (to > place && to <= before)
            mutation_put(m, table + 8 * i, 8, to + m->size - before);
    }
}

/* Changes an OpenEXR file. */
static inline void mutation_exr(struct mutation *m)
{
    size_t kind = mutation_pick(m, 8);
    size_t table = mutation_exr_head(m, kind < 2);

    if (kind == 2)
        m->size = LLVMFuzzerMutate(m->data, m->size, m->max);
    else if (kind > 2)
        mutation_exr_chunk(m, table);
}

/* Changes an image of any kind. */
static inline void mutation_image(struct mutation *m)
{
    if (m->size > 8 && memcmp(m->data, exr_magic, sizeof exr_magic) == 0)
        mutation_exr(m);
    else
        m->size = LLVMFuzzerMutate(m->data, m->size, m->max);
}

#endif
