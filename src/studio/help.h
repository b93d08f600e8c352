// SPDX-License-Identifier: MIT
/*
 * help.h - the help: keys in groups, searched by typing
 *
 * Units:     terminal cells
 * Threads:   main only
 */
#ifndef GLIM_HELP_H
#define GLIM_HELP_H

#include <stdbool.h>

#include "session/keymap.h"
#include "terminal/screen.h"

#define HELP_ENTRY_COLS  36
#define HELP_KEY_COLS    8
#define HELP_COLUMNS_MAX 3
#define HELP_GAP         2
#define HELP_ROWS_MAX    40
#define HELP_SEARCH      24

struct help {
    bool is_open;
    char search[HELP_SEARCH]; /* "": all keys are shown */
    int page, page_count;
};

/* A key or the title of a group, in its place on the page. */
struct help_item {
    int row, column;
    struct keymap_help entry; /* a title has no keys, and its text */
};

#define HELP_ITEMS_MAX (HELP_COLUMNS_MAX * HELP_ROWS_MAX)

struct help_page {
    struct help_item items[HELP_ITEMS_MAX];
    int count;
    int rows, columns; /* in use */
};

/* Lays out the page that is open for cols x rows cells of text. Keys of the
 * panel come first if in_panel. Groups without a key that matches the search
 * are left out. Sets help->page_count and keeps the page within it. */
void help_lay_out(struct help_page *page, struct help *help,
                  const struct keymap *keys, bool in_panel, int cols, int rows);

/* Opens the window with the page. The note says how the screen is drawn. */
void help_draw(struct help *help, const struct keymap *keys, bool in_panel,
               const char *note, struct screen *screen);

/* Handles a key: letters search, Esc and Enter close, arrows turn the page. */
void help_key(struct help *help, int key);

#endif
