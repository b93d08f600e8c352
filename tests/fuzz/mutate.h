// SPDX-License-Identifier: MIT
/*
 * mutate.h - changes of inputs that keep their shape
 *
 * libFuzzer calls a target's LLVMFuzzerCustomMutator() to change an input. It
 * changes text by words and numbers, or the bytes inside a part, and sets
 * lengths and checksums right afterwards, so that the change reaches the code
 * behind their checks. replay.c never calls it.
 *
 * Units:     bytes
 * Ownership: the data are libFuzzer's
 * Threads:   one
 * Errors:    a change for which there is no room is left out
 */
#ifndef TESTS_FUZZ_MUTATE_H
#define TESTS_FUZZ_MUTATE_H

#include <ctype.h>
#include <math.h>

#include "fuzz.h"

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max,
                               unsigned seed);

/* libFuzzer's own changes; NULL without it. */
size_t __attribute__((weak))
LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max);

/* An input that changes. */
struct mutation {
    uint8_t *data;
    size_t size, max;
    uint64_t state; /* of random numbers */
};

static inline struct mutation mutation_begin(uint8_t *data, size_t size,
                                             size_t max, unsigned seed)
{
    return (struct mutation){data, size, max, seed};
}

/* Returns a number below the count, or 0. */
static inline size_t mutation_pick(struct mutation *m, size_t count)
{
    m->state = m->state * 6364136223846793005u + 1442695040888963407u;
    return count > 0 ? (m->state >> 33) % count : 0;
}

/* Returns a number of 1 to 8 bytes, the lowest first. */
static inline uint64_t mutation_get(const struct mutation *m, size_t at,
                                    size_t count)
{
    uint64_t number = 0;

    for (size_t i = 0; i < count && at + i < m->size; i++)
        number |= (uint64_t)m->data[at + i] << 8 * i;
    return number;
}

static inline void mutation_put(struct mutation *m, size_t at, size_t count,
                                uint64_t number)
{
    for (size_t i = 0; i < count && at + i < m->size; i++)
        m->data[at + i] = (uint8_t)(number >> 8 * i);
}

/* Replaces a part. Returns false if there is no room. */
static inline bool mutation_replace(struct mutation *m, size_t at,
                                    size_t length, const void *bytes,
                                    size_t count)
{
    if (m->size - length + count > m->max)
        return false;
    memmove(m->data + at + count, m->data + at + length, m->size - at - length);
    if (count > 0)
        memcpy(m->data + at, bytes, count);
    m->size += count - length;
    return true;
}

/* Lets libFuzzer change a part, which grows by less than 64 bytes. Returns its
 * new length. */
static inline size_t mutation_bytes(struct mutation *m, size_t at,
                                    size_t length)
{
    uint8_t *part = malloc(length + 64);
    size_t count;

    require(part != NULL, "memory");
    memcpy(part, m->data + at, length);
    count = LLVMFuzzerMutate(part, length, length + 63);
    if (mutation_replace(m, at, length, part, count))
        length = count;
    free(part);
    return length;
}

/* Sets a number of 1, 2, 4 or 8 bytes to one at the end of a range. */
static inline void mutation_number(struct mutation *m, uint8_t *bytes,
                                   size_t length)
{
    static const float floats[] = {0,     -0.f,   1,    1e-40f,   1e-20f, 1e20f,
                                   3e38f, -3e38f, 1e9f, INFINITY, NAN,    .5f};
    static const int64_t numbers[] = {
        0,   1,   2,     3,     5,         -1,        INT8_MAX,   INT8_MIN,
        255, 256, 32767, 65535, INT32_MAX, INT32_MIN, UINT32_MAX, INT64_MAX};
    size_t count = (size_t)1 << mutation_pick(m, 4), at;
    uint64_t number = (uint64_t)numbers[mutation_pick(m, 16)];

    if (count > length)
        return;
    at = mutation_pick(m, length / count) * count;
    if (count == 4 && mutation_pick(m, 2) == 0)
        memcpy(&number, &floats[mutation_pick(m, 12)], sizeof(float));
    else if (count == 8 && mutation_pick(m, 2) == 0)
        number = (uint64_t)mutation_pick(m, 2047) << 52;
    memcpy(bytes + at, &number, count);
}

/* Changes bytes that keep their number. */
static inline void mutation_fixed(struct mutation *m, uint8_t *bytes,
                                  size_t length)
{
    uint8_t *part;

    if (mutation_pick(m, 2) == 0 || length == 0) {
        mutation_number(m, bytes, length);
        return;
    }
    part = malloc(length);
    require(part != NULL, "memory");
    memcpy(part, bytes, length);
    memcpy(bytes, part, LLVMFuzzerMutate(part, length, length));
    free(part);
}

/* ---- text ---- */

static inline bool is_mutation_word(uint8_t c)
{
    return isalnum(c) || c == '.' || c == '-' || c == '+' || c == '_';
}

/* Returns the length of the word, the brackets with all inside, or the
 * character at a place before the end, and moves *at to its beginning. */
static inline size_t mutation_token(const struct mutation *m, size_t *at,
                                    size_t begin, size_t end)
{
    const uint8_t *p = m->data;
    size_t i = *at;
    int depth = 0;

    if (p[i] == '{' || p[i] == '[') {
        do {
            depth += p[i] == '{' || p[i] == '[';
            depth -= p[i] == '}' || p[i] == ']';
        } while (++i < end && depth > 0);
        return i - *at;
    }
    if (!is_mutation_word(p[i]))
        return 1;
    while (*at > begin && is_mutation_word(p[*at - 1]))
        --*at;
    while (i < end && is_mutation_word(p[i]))
        i++;
    return i - *at;
}

/* Returns the length of the line at a place, and moves *at to its beginning. */
static inline size_t mutation_line(const struct mutation *m, size_t *at,
                                   size_t begin, size_t end)
{
    const uint8_t *nl;

    while (*at > begin && m->data[*at - 1] != '\n')
        --*at;
    nl = memchr(m->data + *at, '\n', end - *at);
    return nl != NULL ? (size_t)(nl + 1 - m->data) - *at : end - *at;
}

/* Changes a word, a number or a line of a text. Returns its new length. */
static inline size_t mutation_text(struct mutation *m, size_t at, size_t length)
{
    static const char *const numbers[] = {
        "0",    "-0",    "1",      "-1",   "2",   "255",        "256",
        ".5",   "65535", "65536",  "1e-7", "nan", "2147483647", "4294967295",
        "1e9",  "1e38",  "-1e38",  "4e38", "inf", "4294967296", "1e-320",
        "1e20", "-1e20", "1e-20",  "1e18", "1e5", "true",       "-1e-40",
        "7",    "1e308", "99e999", "1e40", "1e6", "null",       "1e-40"};
    size_t end = at + length, before = m->size, from, count, to, old;
    size_t kind = mutation_pick(m, 16);
    char copy[4096];

    if (length == 0 || kind == 0)
        return mutation_bytes(m, at, length);
    from = at + mutation_pick(m, length);
    to = at + mutation_pick(m, length);
    if (kind < 4) {
        count = mutation_line(m, &from, at, end);
        old = mutation_line(m, &to, at, end);
        if (kind == 1)
            old = 0; /* the line is inserted */
    } else {
        count = mutation_token(m, &from, at, end);
        old = mutation_token(m, &to, at, end);
    }
    if (kind == 4 || kind == 2 || count > sizeof copy)
        count = 0; /* the old one is deleted */
    memcpy(copy, m->data + from, count);
    if (kind > 9) {
        const char *number =
            numbers[mutation_pick(m, sizeof numbers / sizeof numbers[0])];

        /* numbers replace numbers, mostly */
        for (int i = 0;
             i < 20 && memchr("0123456789.-", m->data[to], 12) == NULL; i++) {
            to = at + mutation_pick(m, length);
            old = mutation_token(m, &to, at, end);
        }
        count = strlen(number);
        memcpy(copy, number, count);
    }
    mutation_replace(m, to, old, copy, count);
    return length + m->size - before;
}

#endif
