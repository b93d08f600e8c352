// SPDX-License-Identifier: MIT
/*
 * pick_cursor.h - a cursor on the picture, and the surface picked with it or by
 * a click
 *
 * The status line describes the surface under the cursor.
 *
 * Units:     terminal cells
 * Ownership: control and screen are the caller's and outlive the cursor
 * Threads:   main only
 * Errors:    become messages
 */
#ifndef GLIM_PICK_CURSOR_H
#define GLIM_PICK_CURSOR_H

#include <stdbool.h>
#include <stdint.h>

#include "session/keymap.h"
#include "session/live_render.h"
#include "studio/camera/surfaces.h"
#include "terminal/screen.h"

struct pick_cursor {
    struct live_render *control;
    struct screen *screen; /* has cursor_col, cursor_row, has_cursor */
    struct pick pick;
    bool has_pick;
    bool is_pick_new; /* set until the panel knows the pick */
    /* the description in the status line is outdated */
    bool is_outdated;
    int held_right, held_down; /* direction of the last step, */
    uint64_t held_ns;          /* its time, */
    int held_count;            /* and number of repeats before it */
};

/* Returns the part of the picture that is on the screen, in pixels. */
struct rect pick_cursor_shown_rect(const struct pick_cursor *cursor);

/* Computes the point of the picture at the centre of a cell. The picture has
 * width_px x height_px pixels and covers the cells of `fit`. Returns false for
 * a cell outside of these. */
bool pick_cursor_point(const struct cells_rect *fit, int width_px,
                       int height_px, int col, int row, double point_px[2]);

/* Show the cursor at its last cell, at first in the middle, or hide it. */
void pick_cursor_show(struct pick_cursor *cursor);
void pick_cursor_hide(struct pick_cursor *cursor);

/* Moves by a step of an arrow key: one of the two is 1 or -1, the other 0.
 * Steps of held keys grow. */
void pick_cursor_move(struct pick_cursor *cursor, int right, int down);

/* Picks the surface under the cursor and hides the cursor. Returns false, with
 * a message, if there is only sky. */
bool pick_cursor_pick(struct pick_cursor *cursor);

/* Picks the surface at a cell of the screen, from 0. Returns false if there is
 * only sky. */
bool pick_cursor_click(struct pick_cursor *cursor, int col, int row);

/* Picks the surface under the cursor if the cursor is shown. Returns false,
 * with a message, if there is no pick then. */
bool pick_cursor_need_pick(struct pick_cursor *cursor);

/* Finds the surface in the middle of the picture, without picking it. Returns
 * false if there is only sky. */
bool pick_cursor_find_center(const struct pick_cursor *cursor,
                             struct pick *pick);

/* Describes the surface under the cursor in the status line, if outdated. */
void pick_cursor_step(struct pick_cursor *cursor);

/* Returns the name of an object, or words for an object without name. */
const char *pick_cursor_object_name(const struct pick_cursor *cursor,
                                    uint32_t object);

#endif
