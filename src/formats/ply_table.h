// SPDX-License-Identifier: MIT
/*
 * ply_table.h - the properties of a PLY element that have a meaning
 *
 * Ownership: borrows the header
 * Threads:   any
 */
#ifndef GLIM_PLY_TABLE_H
#define GLIM_PLY_TABLE_H

#include "kernels/types.h"
#include "formats/ply_header.h"

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

#endif
