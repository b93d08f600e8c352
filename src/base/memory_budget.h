// SPDX-License-Identifier: MIT
/*
 * memory_budget.h - one counter for all memory that a file makes the program
 * take
 *
 * A few bytes of a file can stand for much memory: instances, packed meshes,
 * names that many objects share. Each part is taken from the budget before it
 * is allocated, with all that is made of it until the scene can be rendered,
 * and is never given back. So the budget bounds time as well.
 *
 * Units:     bytes
 * Threads:   one at a time
 */
#ifndef GLIM_MEMORY_BUDGET_H
#define GLIM_MEMORY_BUDGET_H

#include <stdbool.h>
#include <stdint.h>

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
