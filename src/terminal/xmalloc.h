// SPDX-License-Identifier: MIT
/*
 * xmalloc.h - allocation that ends the program when memory is out
 *
 * These functions are for small objects of the interactive program. Memory for
 * files and pictures comes from base/memory.h, which returns errors.
 *
 * Units:     bytes
 * Ownership: results are for free()
 * Threads:   any; the hook is set before they start
 * Errors:    the program ends with a message, after the hook has restored the
 *            terminal; results are never NULL
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

/* Returns p; ends the program if p is NULL. */
void *xchecked(void *p);

/* Ends the program if has_memory is false. */
void xcheck(bool has_memory);

void xmalloc_set_hook(void (*restore_terminal)(void));

#endif
