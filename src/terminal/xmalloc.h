// SPDX-License-Identifier: MIT
/*
 * xmalloc.h - allocation that ends the program when memory is out
 *
 * For small things of the interactive program. What a file or a picture sizes
 * comes from base/memory.h, which returns an error.
 *
 * Units:     bytes
 * Ownership: what the functions return is for free()
 * Threads:   any; the hook is set before they start
 * Errors:    never NULL: the program ends with a message, after the hook has
 *            given the terminal back
 */
#ifndef GLIM_XMALLOC_H
#define GLIM_XMALLOC_H

#include <stdbool.h>
#include <stddef.h>

void *xmalloc(size_t size_bytes);
void *xcalloc(size_t count, size_t size_bytes);
void *xrealloc(void *p, size_t size_bytes);
char *xstrdup(const char *s);
char *xformat(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Returns the pointer of another function, which is NULL when memory is out. */
void *xchecked(void *p);

/* The same for a function that returns false when memory is out. */
void xcheck(bool has_memory);

void xmalloc_set_hook(void (*restore_terminal)(void));

#endif
