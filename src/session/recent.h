// SPDX-License-Identifier: MIT
/*
 * recent.h - the scenes that were opened last
 *
 * The file `recent` in the user's state folder has one path a line, the last
 * one first. Without such a folder nothing is remembered.
 *
 * Ownership: state_list_free() frees a list
 * Threads:   main only
 */
#ifndef GLIM_RECENT_H
#define GLIM_RECENT_H

#include <stdio.h>

#include "session/state_list.h"

#define RECENT_MAX 20

/* Reads the absolute paths of the remembered scenes whose files still exist. */
void recent_read(struct state_list *r);

/* Adds a scene in the first place. */
void recent_add(const char *path);

/* Shows the list and lets the user choose by number or enter another path.
 * Returns the path for free(), or NULL. */
char *recent_choose(const struct state_list *r, FILE *in, FILE *out);

#endif
