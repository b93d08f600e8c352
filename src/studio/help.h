// SPDX-License-Identifier: MIT
/*
 * help.h - the keys, laid out for a window of any size
 *
 * In two columns where there is room, and on as many pages as it takes.
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
    int page_count; /* of the whole help; at least 1 */
};

/* Page `number`, from 0, where cols x rows cells are free for text; with those
 * of the panel, or without; the note stands behind the last key. */
void help_page(struct help_page *page, const struct keymap *keys, bool in_panel,
               const char *note, int number, int cols, int rows);

#endif
