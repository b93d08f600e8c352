// SPDX-License-Identifier: MIT
/*
 * ply_data.h - the numbers of a PLY file, one after another, in any encoding
 *
 * Ownership: borrows the bytes
 * Threads:   any
 * Errors:    the end of the file, a word that is no number: one line with the
 *            place
 */
#ifndef GLIM_PLY_DATA_H
#define GLIM_PLY_DATA_H

#include "formats/face_tris.h"
#include "formats/ply_header.h"

/* Position in the data. */
struct ply_data {
    const char *path;
    struct warnings *report;
    struct error *err;
    const char *start; /* of the file */
    const char *p, *end;
    bool is_ascii;
    bool is_swapped; /* the byte order is not that of this machine */
    uint64_t line;   /* of p, in ascii */
};

/* Begins behind the header. */
struct ply_data ply_data_begin(const struct ply_header *header,
                               const char *bytes, size_t size_bytes,
                               const char *path, struct warnings *report,
                               struct error *err);

struct file_place ply_data_place(const struct ply_data *data);

/* Fails with "found WHAT, expected EXPECTED" at the present place. */
bool ply_data_fail(const struct ply_data *data, const char *found,
                   const char *expected);

/* Fails unless all rows of the element fit into the rest of the file, so that
 * no count makes the program ask for more than a few times the file's size. */
bool ply_data_expect(const struct ply_data *data,
                     const struct ply_header *header,
                     const struct ply_element *element);

/* Reads a number; integers of 64 bits are rounded to double. */
bool ply_data_number(struct ply_data *data, enum ply_type type, double *value);

/* Reads whole numbers. Fractions are cut off, with a warning, as by trimesh and
 * others: some scanners write them. */
bool ply_data_integers(struct ply_data *data, enum ply_type type,
                       uint64_t count, int64_t *to);

/* Reads the count of a list of numbers of this type, which fit into the rest
 * of the file. */
bool ply_data_count(struct ply_data *data, const struct ply_property *list,
                    uint64_t *count);

/* Skips numbers. */
bool ply_data_skip(struct ply_data *data, enum ply_type type, uint64_t count);

#endif
