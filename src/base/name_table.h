// SPDX-License-Identifier: MIT
/*
 * name_table.h - a hash table that numbers names from 0 in the order of arrival
 *
 * Ownership: names are copied; name_table_free() frees; a zeroed struct is
 * empty Threads:   one thread at a time Errors:    NO_NAME when memory is out
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
    uint32_t *slots;     /* index into items + 1; 0: free */
    uint32_t slot_count; /* a power of two */
};

/* Returns the number of the name, which is added if it is new. */
uint32_t name_table_add(struct name_table *names, const char *name);

/* Returns the number of the name, or NO_NAME. */
uint32_t name_table_find(const struct name_table *names, const char *name);

void name_table_free(struct name_table *names);

#endif
