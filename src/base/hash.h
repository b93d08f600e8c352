// SPDX-License-Identifier: MIT
/*
 * hash.h - the hash FNV-1a of 64 bits (Fowler, Noll and Vo), against accidents
 * and not against attacks
 *
 * Threads:   any
 */
#ifndef GLIM_HASH_H
#define GLIM_HASH_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* The hash of no bytes. */
#define HASH_BEGIN 0xcbf29ce484222325u

/* Returns the hash with more bytes. */
static inline uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t size)
{
    const unsigned char *p = bytes;

    for (size_t i = 0; i < size; i++)
        hash = (hash ^ p[i]) * 0x100000001b3u;
    return hash;
}

/* Returns the hash with more bytes, eight at a time: for large arrays. The
 * shift brings high bits down, which a product does not. */
static inline uint64_t hash_array(uint64_t hash, const void *bytes, size_t size)
{
    const unsigned char *p = bytes;
    uint64_t word;

    for (; size >= sizeof word; size -= sizeof word, p += sizeof word) {
        memcpy(&word, p, sizeof word);
        hash = (hash ^ word) * 0x100000001b3u;
        hash ^= hash >> 29;
    }
    return hash_bytes(hash, p, size);
}

/* Returns the hash with eight more bytes, those of a number, lowest first. */
static inline uint64_t hash_number(uint64_t hash, uint64_t n)
{
    for (int shift = 0; shift < 64; shift += 8)
        hash = (hash ^ (n >> shift & 255)) * 0x100000001b3u;
    return hash;
}

#endif
