// SPDX-License-Identifier: MIT
/*
 * memory.h - allocation that either says when memory is out or ends the program
 *
 * Units:     bytes
 * Ownership: what the functions return is for free()
 * Threads:   any; the hook is set before they start
 * Errors:    alloc_array(), alloc_aligned() and grow_array() say so; xmalloc()
 *            and friends never return NULL
 */
#ifndef GLIM_MEMORY_H
#define GLIM_MEMORY_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

/* For small things: stops the program when memory is out, after the hook has
 * given the terminal back. */
void *xmalloc(size_t size_bytes);
void *xcalloc(size_t count, size_t size_bytes);
void *xrealloc(void *p, size_t size_bytes);
char *xstrdup(const char *s);
char *xformat(const char *format, ...) __attribute__((format(printf, 1, 2)));
char *xformat_list(const char *format, va_list values)
    __attribute__((format(printf, 1, 0)));
void xmalloc_set_hook(void (*restore_terminal)(void));

/* Before the first allocation: large arrays go back to the system when they are
 * freed. */
void memory_init(void);

/* For what a file or a picture sizes: zeroed memory, or NULL when it is out or
 * count * size_bytes overflows. Never NULL for count 0. */
void *alloc_array(size_t count, size_t size_bytes);

/* The same at the start of a line of memory, not zeroed. */
void *alloc_aligned(size_t count, size_t size_bytes);

/* Grows *array so that it holds `needed` items, at least doubling. False, with
 * *array unchanged, when memory is out. *capacity counts items. */
bool grow_array(void **array, size_t *capacity, size_t needed,
                size_t size_bytes);

#endif
