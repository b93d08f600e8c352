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

/* The text that printf() would print. */
char *format_text(const char *format, ...)
    __attribute__((format(printf, 1, 2)));
char *format_list(const char *format, va_list values)
    __attribute__((format(printf, 1, 0)));

/* Sets the C library's allocator up for the whole process, before the first
 * allocation: large arrays go back to the system when they are freed. */
void memory_init(void);

/* Returns zeroed memory, or NULL if memory is out or count * size_bytes
 * overflows. A count of 0 does not give NULL. */
void *alloc_array(size_t count, size_t size_bytes);

/* The same aligned to a cache line, and not zeroed. */
void *alloc_aligned(size_t count, size_t size_bytes);

/* Grows *array so that it holds `needed` items, at least doubling. False, with
 * *array unchanged, when memory is out. *capacity counts items. */
bool grow_array(void **array, size_t *capacity, size_t needed,
                size_t size_bytes);

#endif
