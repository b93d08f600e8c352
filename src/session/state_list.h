// SPDX-License-Identifier: MIT
/*
 * state_list.h - a short list of lines in the user's state folder, the last one
 * first
 *
 * Without such a folder nothing is remembered.
 *
 * Ownership: state_list_free() frees a list
 * Threads:   main only
 */
#ifndef GLIM_STATE_LIST_H
#define GLIM_STATE_LIST_H

#define STATE_LIST_MAX 50

struct state_list {
    char *lines[STATE_LIST_MAX];
    const char *keys[STATE_LIST_MAX]; /* parts of the lines */
    int count;
};

struct state_list_file {
    const char *name; /* in the state folder */
    int lines_max;    /* at most STATE_LIST_MAX */
    /* Returns the part of a line that no other line of the list has, or NULL
     * for a line that is left out. */
    const char *(*key)(const char *line);
};

void state_list_read(struct state_list *list,
                     const struct state_list_file *file);

/* Puts a line first, in the place of the one with the same key. */
void state_list_put(const struct state_list_file *file, const char *line);

void state_list_free(struct state_list *list);

#endif
