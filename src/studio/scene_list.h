// SPDX-License-Identifier: MIT
/*
 * scene_list.h - the list of scenes to open: those opened last, a folder to
 * browse, and those of glim, with the last picture of the selected one
 *
 * Units:     terminal cells
 * Ownership: scene_list_free() frees; a zeroed struct is closed and empty
 * Threads:   main only
 * Errors:    what cannot be read is not in the list
 */
#ifndef GLIM_SCENE_LIST_H
#define GLIM_SCENE_LIST_H

#include "session/scene_files.h"
#include "studio/list_window.h"

struct scene_list {
    struct list_window list;
    struct scene_files files;
    struct list_row *rows; /* of the files that match the search, */
    int *found;            /* and their numbers */
    int count;
    int picture_of; /* number of the file of `picture`; -1: none is read */
    struct frame picture;
};

/* Opens the window, for the first time or after a new layout. */
void scene_list_open(struct scene_list *s, struct screen *screen);

/* Takes a key or the mouse. Returns the path of a scene that is chosen, for
 * free(), or NULL. Folders are entered; the window may close. */
char *scene_list_take(struct scene_list *s, struct screen *screen,
                      const struct event *event);

void scene_list_free(struct scene_list *s);

#endif
