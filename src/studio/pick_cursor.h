// SPDX-License-Identifier: MIT
/*
 * pick_cursor.h - a cursor on the picture, and what it or a click has picked
 *
 * The last line says what is under the cursor.
 *
 * Units:     terminal cells
 * Ownership: control and screen stay the caller's and outlive the cursor
 * Threads:   main only
 * Errors:    become messages
 */
#ifndef GLIM_PICK_CURSOR_H
#define GLIM_PICK_CURSOR_H

#include <stdbool.h>
#include <stdint.h>

#include "terminal/screen.h"
#include "session/keymap.h"
#include "studio/pick.h"
#include "studio/render_control.h"

struct pick_cursor {
    struct render_control *control;
    struct screen *screen; /* has its cell, and whether it is shown */
    struct pick pick;
    bool has_pick;
    bool is_pick_new; /* until the event loop has told the panel */
    bool is_outdated; /* the last line does not say yet what is under it */
    int held_right, held_down; /* the last step of the arrows, */
    uint64_t held_ns;          /* when it was made, */
    int held_count;            /* and how often before without a pause */
};

/* The part of the picture that is on the screen, in pixels. */
struct rect pick_cursor_shown_rect(const struct pick_cursor *cursor);

/* Shows the cursor where it was last; in the middle at first. */
void pick_cursor_show(struct pick_cursor *cursor);
void pick_cursor_hide(struct pick_cursor *cursor);

/* A step of an arrow key: one of both is 1 or -1. Held keys get faster. */
void pick_cursor_move(struct pick_cursor *cursor, int right, int down);

/* Picks what is under the cursor and hides the cursor. Returns false, with a
 * message, if that is only the sky. */
bool pick_cursor_pick(struct pick_cursor *cursor);

/* Picks what is at a cell of the screen, from 0. Returns false if that is only
 * the sky. */
bool pick_cursor_click(struct pick_cursor *cursor, int col, int row);

/* Picks what is under the cursor if it is shown. Returns false, with a message,
 * if nothing is picked after that. */
bool pick_cursor_need_pick(struct pick_cursor *cursor);

/* Finds what is in the middle of the picture, without picking it. Returns false
 * if that is only the sky. */
bool pick_cursor_find_center(const struct pick_cursor *cursor,
                             struct pick *pick);

/* Says in the last line what is under the cursor, if that may have changed. */
void pick_cursor_step(struct pick_cursor *cursor);

/* The name of an object, or words for none. */
const char *pick_cursor_object_name(const struct pick_cursor *cursor,
                                    uint32_t object);

#endif
