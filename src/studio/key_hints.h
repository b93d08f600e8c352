// SPDX-License-Identifier: MIT
/*
 * key_hints.h - what keys do now, as a row of keys and words
 *
 * Units:     terminal cells
 * Ownership: texts stay the caller's
 * Threads:   main only
 */
#ifndef GLIM_KEY_HINTS_H
#define GLIM_KEY_HINTS_H

#include "terminal/curses_windows.h"

struct key_hint {
    const char *key;
    const char *does; /* one word or two; NULL ends a list */
};

/* Writes hints into `cols` columns of a row until the next one does not fit.
 * Returns those that are left. */
const struct key_hint *key_hints_draw(enum window_part part, int row, int col,
                                      int cols, const struct key_hint *hints);

#endif
