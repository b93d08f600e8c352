// SPDX-License-Identifier: MIT
/*
 * help.h - the list of keys, laid out for a window of any size
 *
 * It has two columns where there is room, and as many pages as needed.
 *
 * Units:     terminal cells
 * Threads:   any
 */
#ifndef GLIM_HELP_H
#define GLIM_HELP_H

#include <stdbool.h>

#include "session/keymap.h"

#define HELP_ENTRY_COLS 36
#define HELP_COLUMNS    2
#define HELP_GAP        2
#define HELP_ROWS_MAX   64

#define HELP_LINE_BYTES (HELP_COLUMNS * (HELP_ENTRY_COLS + HELP_GAP) + 1)

struct help_page {
    char lines[HELP_ROWS_MAX][HELP_LINE_BYTES];
    int line_count;
    int page_count; /* pages of the whole help; at least 1 */
};

/* Lays out page `number`, from 0, for cols x rows cells of text. Keys of the
 * panel come first if in_panel; the note is the entry after the last key. */
void help_page(struct help_page *page, const struct keymap *keys, bool in_panel,
               const char *note, int number, int cols, int rows);

#endif
