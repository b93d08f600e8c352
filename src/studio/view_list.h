// SPDX-License-Identifier: MIT
/*
 * view_list.h - the list of the numbered views, with a picture of the selected
 * one
 *
 * Ownership: a zeroed struct is closed; view_list_free() frees
 * Threads:   main only
 */
#ifndef GLIM_VIEW_LIST_H
#define GLIM_VIEW_LIST_H

#include "inspect/view_modes.h"
#include "studio/list_window.h"

struct view_list {
    struct list_window list;
    struct view_mode *view_mode; /* renders the pictures; the caller's */
    int count;
    int numbers[VIEW_SHOTS]; /* of the views that match the search, from 0 */
    char keys[VIEW_SHOTS][4];
    char texts[VIEW_SHOTS][64];
    struct frame picture;
    int picture_of; /* number of the view of `picture`, plus 1; 0: none */
};

/* Opens the window, for the first time or after a new layout. Returns false if
 * there are no views. */
bool view_list_open(struct view_list *v, struct screen *screen);

/* Takes a key or the mouse. Returns the action of a view that is chosen, or
 * ACTION_NONE. */
enum action view_list_take(struct view_list *v, struct screen *screen,
                           const struct event *event);

void view_list_free(struct view_list *v);

#endif
