// SPDX-License-Identifier: MIT
/*
 * name_table.h - a hash table that numbers names from 0 in the order of arrival
 *
 * Ownership: names are copied; name_table_free() frees them; a zeroed struct is
 *            an empty table
 * Threads:   one thread at a time
 * Errors:    NO_NAME if memory is out
 */
#ifndef GLIM_NAME_TABLE_H
#define GLIM_NAME_TABLE_H

#include <stddef.h>
#include <stdint.h>

#define NO_NAME 0xffffffffu

struct name_table {
    char **items;
    uint32_t count;
    size_t capacity;
    uint32_t *slots;     /* index into items + 1; 0 if free */
    uint32_t slot_count; /* a power of two */
};

/* Returns the number of the name, and adds it if it is new; NO_NAME if memory
 * is out. */
uint32_t name_table_add(struct name_table *names, const char *name);

/* Returns the number of the name, or NO_NAME if it is not in the table. */
uint32_t name_table_find(const struct name_table *names, const char *name);

void name_table_free(struct name_table *names);

#endif
