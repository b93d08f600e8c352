// SPDX-License-Identifier: MIT
/*
 * recent.h - the scenes that were opened last, and the picture of a session
 * that was lost
 *
 * The file `recent` in the folder of the person's state has a path a line, the
 * last opened first. The one file `lost.png` beside it has the picture: a later
 * one replaces it.
 *
 * Ownership: recent_free() frees a list
 * Threads:   main only
 * Errors:    none: without such a folder nothing is remembered
 */
#ifndef GLIM_RECENT_H
#define GLIM_RECENT_H

#include <stdio.h>

#define RECENT_MAX 20

struct recent {
    char *paths[RECENT_MAX]; /* absolute */
    int count;
};

/* The remembered scenes that are still there. */
void recent_read(struct recent *r);

/* Remembers this one as the last. */
void recent_add(const char *path);

/* Where the picture of a session is written that is being lost; for free(),
 * NULL: nowhere. */
char *recent_lost_path(void);

/* The picture, if a session was lost since recent_add() was called last: so the
 * next one tells of it, and only that. For free(); NULL: none. */
char *recent_find_lost(void);

/* Shows the list and lets the person choose by number, or write another name.
 * The path is for free(); NULL: none. */
char *recent_choose(const struct recent *r, FILE *in, FILE *out);

void recent_free(struct recent *r);

#endif
