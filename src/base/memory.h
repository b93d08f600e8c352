// SPDX-License-Identifier: MIT
/*
 * memory.h - memory allocation with a result when memory is out
 *
 * Units:     bytes
 * Ownership: the functions return memory for free()
 * Threads:   any
 * Errors:    NULL or false when memory is out
 */
#ifndef GLIM_MEMORY_H
#define GLIM_MEMORY_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

/* Returns the text that printf() would print. */
char *format_text(const char *format, ...)
    __attribute__((format(printf, 1, 2)));
char *format_list(const char *format, va_list values)
    __attribute__((format(printf, 1, 0)));

/* Sets up the C library's allocator for the whole process, so that large arrays
 * go back to the system when they are freed. Call it before the first
 * allocation. */
void memory_init(void);

/* Returns zeroed memory, or NULL if memory is out or count * size_bytes
 * overflows. A count of 0 gives memory too. */
void *alloc_array(size_t count, size_t size_bytes);

/* Returns memory that is aligned to a cache line and not zeroed; NULL as
 * alloc_array(). */
void *alloc_aligned(size_t count, size_t size_bytes);

/* Grows *array so that it holds `needed` items, at least doubling it. Returns
 * false, with *array unchanged, if memory is out. *capacity counts items. */
bool grow_array(void **array, size_t *capacity, size_t needed,
                size_t size_bytes);

#endif
