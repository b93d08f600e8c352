// SPDX-License-Identifier: MIT
/*
 * ply_header.h - reads the header of a PLY file: what its data consist of
 *
 * Ownership: ply_header_free() frees; names point into the file's bytes
 * Threads:   any
 * Errors:    a line that cannot be read, an unknown format or type, memory
 */
#ifndef GLIM_PLY_HEADER_H
#define GLIM_PLY_HEADER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "base/lexer.h"

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

#endif
