// SPDX-License-Identifier: MIT
/*
 * pick_cursor.h - a cursor on the picture, and what it or a click has picked
 *
 * What is under the cursor is said in the last line.
 *
 * Units:     terminal cells
 * Ownership: work and canvas stay the caller's and outlive the cursor
 * Threads:   main only
 * Errors:    become messages
 */
#ifndef GLIM_PICK_CURSOR_H
#define GLIM_PICK_CURSOR_H

#include "terminal/screen.h"
#include "session/keymap.h"
#include "studio/pick.h"
#include "studio/render_control.h"

struct cursor {
    struct work *work;
    struct canvas *canvas; /* knows where it is, and whether it is shown */
    struct pick pick;
    bool has_pick;
    bool is_pick_new; /* whom it concerns clears it */
    bool must_look;   /* what is under it is not yet said */
    enum action held; /* the arrow that came last, when, */
    uint64_t held_ns;
    int held_count; /* and how often without a pause */
};

/* The part of the picture that is on the screen, in pixels. */
struct rect cursor_shown_rect(const struct cursor *c);

/* Does what the action says while the cursor is shown, and shows it. False if
 * the action is nothing of its own. */
bool cursor_act(struct cursor *c, enum action action);

/* Picks what is at a cell of the screen, from 0; false: only the sky. */
bool cursor_click(struct cursor *c, int col, int row);

/* Picks what the cursor is on if it is shown. False, with a message, if then
 * nothing is picked. */
bool cursor_need_pick(struct cursor *c);

/* What is in the middle of the picture, unpicked. */
bool cursor_look_ahead(const struct cursor *c, struct pick *pick);

/* Says what is under the cursor if that may have changed. */
void cursor_step(struct cursor *c);

/* The name of an object, or words for none. */
const char *cursor_object_name(const struct cursor *c, uint32_t object);

#endif
