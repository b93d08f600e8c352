// SPDX-License-Identifier: MIT
/*
 * vdb_bytes.h - takes numbers, texts and packed values from the bytes of an
 * OpenVDB file
 *
 * Units:     bytes; numbers are little-endian
 * Ownership: borrows the bytes; texts and parts point into them
 * Threads:   any, with a reader of their own
 * Errors:    a file that ends too early, packed values that are broken; no
 *            libblosc
 */
#ifndef GLIM_VDB_BYTES_H
#define GLIM_VDB_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "base/lexer.h"

/* Debian's package of the library that unpacks blosc. */
#define BLOSC_PACKAGE "libblosc1"

/* Function of libblosc. */
typedef int vdb_unblosc(const void *from, void *to, size_t size_bytes,
                        int thread_count);

struct vdb_reader {
    const uint8_t *bytes;
    uint64_t size, at; /* at <= size */
    struct error *err;
    vdb_unblosc *unblosc; /* NULL until it is needed */
};

/* Returns a part and moves behind it, or NULL if the file ends before that. */
const uint8_t *vdb_take(struct vdb_reader *r, uint64_t size_bytes);

bool vdb_take_u8(struct vdb_reader *r, uint32_t *to);
bool vdb_take_u32(struct vdb_reader *r, uint32_t *to);
bool vdb_take_i64(struct vdb_reader *r, int64_t *to);
bool vdb_take_float(struct vdb_reader *r, float *to);
bool vdb_take_doubles(struct vdb_reader *r, double *to, int count);
bool vdb_take_ints(struct vdb_reader *r, int32_t to[3]);

/* Takes a text behind its length. */
bool vdb_take_text(struct vdb_reader *r, struct word *to);

/* Flags of compression of a grid. */
enum { VDB_ZIP = 1, VDB_ACTIVE_MASK = 2, VDB_BLOSC = 4, VDB_FLAGS = 7 };

/* Takes values that are packed as the flags say, into `size_bytes` of `to`. */
bool vdb_take_packed(struct vdb_reader *r, uint32_t flags, void *to,
                     uint32_t size_bytes);

/* Returns the numbers at p. */
uint32_t vdb_u32(const uint8_t *p);
float vdb_float(const uint8_t *p);
float vdb_half(const uint8_t *p);

#endif
