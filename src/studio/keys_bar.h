// SPDX-License-Identifier: MIT
/*
 * keys_bar.h - the keys of now, in the bar that the picture leaves free
 *
 * A picture of another shape than the window is moved to the left or the top,
 * so that there is one bar, at the right or at the bottom. Keys are at its
 * foot, in one row or one below the other. The rest of it is for the
 * graph of the error.
 *
 * Units:     terminal cells
 * Ownership: texts stay the caller's
 * Threads:   main only
 */
#ifndef GLIM_KEYS_BAR_H
#define GLIM_KEYS_BAR_H

#include <stdbool.h>

#include "session/keymap.h"
#include "session/live_render.h"
#include "terminal/curses_windows.h"
#include "terminal/screen.h"

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

#define HINTS_MAX 10

struct keys_bar {
    enum keys_state state;   /* that is drawn; KEYS_NONE: has to be drawn */
    struct window_rect area; /* of the bar; no columns: there is none */
    int key_rows;            /* at its foot */
    /* hints that are drawn, one row each, with their actions */
    struct hint_spot {
        struct window_rect at;
        enum action action; /* ACTION_NONE: of several */
    } spots[HINTS_MAX];
    int spot_count;
};

/* Moves the picture of a new layout, and finds the bar beside or below it. */
void keys_bar_lay_out(struct keys_bar *bar, struct screen *screen);

/* Finds the part above the keys. Returns false if it has no room for a graph.
 */
bool keys_bar_room(const struct keys_bar *bar, struct window_rect *room);

/* Returns the action of the hint in a cell, or ACTION_NONE. */
enum action keys_bar_action_at(const struct keys_bar *bar, int col, int row);

/* Draws the keys of a state, if it is another one than before. */
void keys_bar_draw(struct keys_bar *bar, const struct live_render *control,
                   struct screen *screen, enum keys_state state);

#endif
