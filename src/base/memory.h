// SPDX-License-Identifier: MIT
/*
 * memory.h - memory allocation with a result when memory is out, and one
 * counter for all memory that a file makes the program take
 *
 * A few bytes of a file can stand for much memory: instances, packed meshes,
 * names that many objects share. Each part is taken from the budget before it
 * is allocated, with all that is made of it until the scene can be rendered,
 * and is never given back. So the budget bounds time as well.
 *
 * Units:     bytes
 * Ownership: the functions return memory for free()
 * Threads:   any; a budget one at a time
 * Errors:    NULL or false when memory is out
 */
#ifndef GLIM_MEMORY_H
#define GLIM_MEMORY_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* ---- allocation ---- */

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

/* ---- budgets ---- */

/* A zeroed budget has no limit. */
struct memory_budget {
    uint64_t file_bytes; /* of the files that were read */
    uint64_t size_bytes, taken_bytes;
    const char *place; /* for messages after the size: "in this machine" */
};

/* Adds a file of this size: the budget grows with the bytes that stand for the
 * scene, up to what the machine holds. */
void memory_budget_add_file(struct memory_budget *budget, uint64_t file_bytes);

/* Takes `count` items. Returns false, with nothing taken, if they are too
 * much. */
bool memory_budget_take(struct memory_budget *budget, uint64_t count,
                        uint64_t item_bytes);

/* Returns what is left; UINT64_MAX without a limit. */
uint64_t memory_budget_left(const struct memory_budget *budget);

#endif
