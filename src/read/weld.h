// SPDX-License-Identifier: MIT
/*
 * weld.h - finds equal positions
 *
 * A table of hashes: positions are equal if their numbers are, bit for bit but
 * for the sign of zero.
 *
 * Ownership: weld_free() frees; the positions are the caller's
 * Threads:   one at a time
 * Errors:    false when memory is out
 */
#ifndef GLIM_WELD_H
#define GLIM_WELD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct weld {
    uint32_t *slots;   /* index into the positions + 1; 0 if free */
    size_t slot_count; /* a power of two */
    uint32_t count;    /* of used slots */
};

/* Makes room for `count` different positions, which save later growth. */
bool weld_init(struct weld *weld, size_t count);

/* Returns in *place the first position added that equals number `index` of
 * `positions` (3 doubles each), which is `index` if it is new. */
bool weld_add(struct weld *weld, const double *positions, uint32_t index,
              uint32_t *place);

void weld_free(struct weld *weld);

#endif
