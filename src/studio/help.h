// SPDX-License-Identifier: MIT
/*
 * help.h - what keys do: the help, which is searched by typing, and the bar
 * that the picture leaves free for the keys of now
 *
 * Units:     terminal cells
 * Ownership: texts stay the caller's
 * Threads:   main only
 */
#ifndef GLIM_HELP_H
#define GLIM_HELP_H

#include <stdbool.h>

#include "session/keymap.h"
#include "session/live_render.h"
#include "terminal/curses_windows.h"
#include "terminal/screen.h"

/* ---- the bar ---- */

/*
 * A picture of another shape than the window is moved to the left or the top,
 * so that there is one bar, at the right or at the bottom. Keys are at its
 * foot, in one row or one below the other. The rest of it is for the progress.
 */

/* ---- hints ---- */

struct key_hint {
    const char *key;
    const char *does; /* one word or two; NULL ends a list */
};

/* Writes hints into `cols` columns of a row until the next one does not fit.
 * Returns those that are left. */
const struct key_hint *key_hints_draw(enum window_part part, int row, int col,
                                      int cols, const struct key_hint *hints);

/* ---- the bar ---- */

/* What the person is doing. */
enum keys_state {
    KEYS_NONE, /* nothing is drawn */
    KEYS_LIVE,
    KEYS_PAUSED,
    KEYS_NORMAL,
    KEYS_CURSOR,
    KEYS_PANEL, /* its own keys are at its foot */
    KEYS_PANEL_NORMAL,
    KEYS_ORBIT,
    KEYS_VIEW,    /* a view other than light */
    KEYS_DRAWING, /* over the picture */
    KEYS_COMPARE,
    KEYS_STATES
};

struct keys_bar {
    enum keys_state state;   /* that is drawn; KEYS_NONE: has to be drawn */
    struct window_rect area; /* of the bar; no columns: there is none */
    int key_rows;            /* at its foot */
};

/* Moves the picture of a new layout, and finds the bar beside or below it. */
void keys_bar_lay_out(struct keys_bar *bar, struct screen *screen);

/* Returns the part above the keys if it has room for the progress, or NULL. */
const struct window_rect *keys_bar_room(const struct keys_bar *bar,
                                        struct window_rect *room);

/* Draws the keys of a state, if it is another one than before. */
void keys_bar_draw(struct keys_bar *bar, const struct live_render *control,
                   struct screen *screen, enum keys_state state);

/* ---- the help ---- */

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
