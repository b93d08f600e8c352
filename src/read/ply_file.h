// SPDX-License-Identifier: MIT
/*
 * ply_file.h - the elements of a PLY file: its header, the properties that have
 * a meaning, and its numbers one after another, in any encoding
 *
 * Ownership: ply_header_free() frees; names point into the bytes of the file,
 *            which stay the caller's
 * Threads:   any
 * Errors:    a line that cannot be read, an unknown format or type, memory; the
 *            end of the file, a word that is no number: one line with the place
 */
#ifndef GLIM_PLY_FILE_H
#define GLIM_PLY_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "base/lexer.h"
#include "read/face_tris.h"
#include "kernels/types.h"

/* ---- header ---- */

enum ply_encoding { PLY_ASCII, PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN };

enum ply_type {
    PLY_NONE,
    PLY_INT8,
    PLY_UINT8,
    PLY_INT16,
    PLY_UINT16,
    PLY_INT32,
    PLY_UINT32,
    PLY_INT64,
    PLY_UINT64,
    PLY_FLOAT32,
    PLY_FLOAT64
};

struct ply_property {
    struct word name;
    enum ply_type type;
    enum ply_type count_type; /* of a list; PLY_NONE: a single number */
};

struct ply_element {
    struct word name;
    uint64_t line; /* of the header */
    uint64_t count;
    uint32_t first_property, property_count;
};

struct ply_header {
    enum ply_encoding encoding;
    struct ply_element *elements;
    struct ply_property *properties;
    uint32_t element_count, property_count;
    size_t element_capacity, property_capacity;
    struct word *textures; /* files named by comments "TextureFile" */
    uint32_t texture_count;
    size_t texture_capacity;
    bool is_of_blender;
    size_t size_bytes;   /* the data follow */
    uint64_t line_count; /* of the header */
};

/* Returns true if the bytes begin a PLY file. */
bool ply_matches(const char *bytes, size_t size_bytes);

bool ply_header_parse(struct ply_header *header, const char *bytes,
                      size_t size_bytes, const char *path, struct error *err);

/* Returns the bytes of a number of this type. */
unsigned ply_type_bytes(enum ply_type type);

void ply_header_free(struct ply_header *header);

/* ---- properties ---- */

/* Meaning of a property of one number. */
enum ply_role {
    PLY_X,
    PLY_Y,
    PLY_Z,
    PLY_NX,
    PLY_NY,
    PLY_NZ,
    PLY_RED,
    PLY_GREEN,
    PLY_BLUE,
    PLY_U,
    PLY_V,
    PLY_TEXTURE, /* number of a face's texture */
    PLY_ROLES
};

/* Meanings of lists of faces. */
enum ply_list { PLY_LIST_VERTICES, PLY_LIST_UVS, PLY_LISTS };

/* Element with the numbers of its properties that have a meaning. */
struct ply_table {
    const struct ply_element *element; /* NULL: the file has none */
    const struct ply_property *items;  /* its properties */
    uint32_t numbers[PLY_ROLES];       /* by role; NO_INDEX: none */
    uint32_t lists[PLY_LISTS];
    uint32_t count; /* of rows */
};

/* Finds the properties by their names. Fails for more rows than indices. */
bool ply_table_init(struct ply_table *table, const struct ply_header *header,
                    const struct ply_element *element, const char *path,
                    struct error *err);

/* Returns true if the element has `count` roles from `first` on. */
bool ply_table_has(const struct ply_table *table, enum ply_role first,
                   int count);

/* Decodes the sRGB colours of its rows. Whole numbers go up to the largest of
 * their type, fractions up to 1, or to 255 if one is above 1. */
void ply_table_decode(const struct ply_table *table, struct vec3 *colors);

/* ---- numbers ---- */

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
