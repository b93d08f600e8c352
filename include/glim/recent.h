// SPDX-License-Identifier: MIT
/*
 * recent.h - the scenes that were opened last, to choose one
 *
 * The file `recent` in the folder of the person's state has a path a line, the
 * last opened first.
 *
 * Units:     none
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

/* Shows the list and lets the person choose by number, or write another name.
 * The path is for free(); NULL: none. */
char *recent_choose(const struct recent *r, FILE *in, FILE *out);

void recent_free(struct recent *r);

#endif
