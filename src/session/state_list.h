// SPDX-License-Identifier: MIT
/*
 * state_list.h - lists in the user's state folder, the last entry first: the
 * scenes that were opened, the glyphs that were chosen on each terminal
 *
 * Without such a folder nothing is remembered.
 *
 * Ownership: state_list_free() frees a list
 * Threads:   main only
 */
#ifndef GLIM_STATE_LIST_H
#define GLIM_STATE_LIST_H

#include "terminal/term_caps.h"

/* ---- lists ---- */

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

/* Puts a line first, in the place of the one with the same key. A thread writes
 * the file, so that nobody waits for a slow disk. Nothing is written if the
 * lines of before cannot be read, or if another program writes the file for
 * long. */
void state_list_put(const struct state_list_file *file, const char *line);

/* Blocks until all lines are in their files. */
void state_list_finish(void);

void state_list_free(struct state_list *list);

/* ---- scenes ---- */

/*
 * The file `recent` in the user's state folder has one path a line, the last
 * one first. Without such a folder nothing is remembered.
 */

#define RECENT_MAX 20

/* Reads the absolute paths of the remembered scenes whose files still exist. */
void recent_read(struct state_list *r);

/* Adds a scene in the first place. */
void recent_add(const char *path);

/* ---- glyphs ---- */

/*
 * The file `glyphs` in the user's state folder has one terminal a line, the
 * last one first: the kind of glyphs and the terminal's name. Without such a
 * folder nothing is remembered.
 */

/* Returns the remembered choice for a terminal; GLYPH_AUTO if there is none. */
enum glyph_mode glyph_memory_read(const char *terminal);

void glyph_memory_write(const char *terminal, enum glyph_mode mode);

#endif
