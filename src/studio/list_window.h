// SPDX-License-Identifier: MIT
/*
 * list_window.h - a window with a list that is searched by typing and chosen
 * from, by keys or the mouse
 *
 * Beside the list may be a pane for a picture, where the terminal has room.
 * The caller has the rows and finds those that match the search. Rows have a
 * key at the left; while nothing is searched for, each group has its title
 * above its first row.
 *
 * Units:     terminal cells
 * Ownership: texts of rows are the caller's
 * Threads:   main only
 */
#ifndef GLIM_LIST_WINDOW_H
#define GLIM_LIST_WINDOW_H

#include <stdbool.h>

#include "terminal/screen.h"
#include "terminal/tty_input.h"

struct list_row {
    const char *key, *text, *group;
};

#define LIST_SEARCH 32

struct list_window {
    bool is_open;
    char search[LIST_SEARCH]; /* "": all rows match */
    int selected;             /* row */
    int top;                  /* first line that is shown */
    int rows;                 /* lines that the window has for the list */
    struct window_rect at;
    const char *does; /* what Enter does */
    bool has_pane;    /* a pane for a picture is wanted beside the list, and */
    struct window_rect pane; /* what there is, in the window; 0 cols: none */
};

/* Opens the window for at most `count` rows, and no more than the terminal has
 * room for. */
void list_window_open(struct list_window *l, struct screen *screen,
                      const char *title, const struct list_row *rows,
                      int count);

/* Draws the rows that match, and their number of `all`. */
void list_window_draw(struct list_window *l, struct screen *screen,
                      const struct list_row *rows, int count, int all);

/* Shows a picture in the pane; NULL: none. */
void list_window_picture(const struct list_window *l,
                         const struct screen *screen,
                         const struct frame *picture);

enum list_result {
    LIST_STAYS,    /* the selection or the search may have changed */
    LIST_CHOSEN,   /* the selected row is chosen; the list is closed */
    LIST_CANCELLED /* the list is closed */
};

/* Takes a key. Esc ends a search first. */
enum list_result list_window_key(struct list_window *l, int key, int count);

/* Takes a key or the mouse. A press outside of the window closes it. */
enum list_result list_window_take(struct list_window *l,
                                  const struct event *event,
                                  const struct list_row *rows, int count);

#endif
