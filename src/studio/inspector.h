// SPDX-License-Identifier: MIT
/*
 * inspector.h - pictures of what happens inside: other views than light, and
 * drawings over any of them
 *
 * Boxes of the tree, scattered directions and a path are drawn over the
 * picture; those two stay where they were picked while the camera moves.
 *
 * Units:     frames' pixels
 * Ownership: work, canvas and cursor stay the caller's and outlive it;
 *            inside_free() frees the rest
 * Threads:   main only
 * Errors:    become messages
 */
#ifndef GLIM_INSPECTOR_H
#define GLIM_INSPECTOR_H

#include "studio/pick_cursor.h"
#include "inspect/view_modes.h"
#include "inspect/path_record.h"

enum inside_drawing {
    INSIDE_NOTHING,
    INSIDE_BOXES,
    INSIDE_LOBES,
    INSIDE_PATH,
    INSIDE_DRAWINGS
};

struct inside {
    struct work *work;
    struct canvas *canvas;
    struct cursor *cursor;
    struct show show;
    enum inside_drawing drawing;
    uint32_t level; /* of boxes */
    /* where lobes and path begin: a pixel of a picture that was */
    struct camera camera;
    uint32_t x, y;
    bool is_picked; /* by the cursor, at */
    double place[3];
    bool is_surface; /* else the sky is there */
    uint64_t sample;
    int step; /* of the path: so many are shown */
    struct trail trail;
    struct trail_lobes lobes;
    bool has_panel;
};

/* Takes over the canvas's painter. */
void inside_init(struct inside *in, struct work *work, struct canvas *canvas,
                 struct cursor *cursor);

/* Does what the action says of views and drawings, and saves what is shown.
 * False if it is not one. */
bool inside_act(struct inside *in, enum action action);

/* Nothing is drawn over the picture any more. */
void inside_stop_drawing(struct inside *in);

/* The scene is another one: what was made of the old one is dropped. */
void inside_renew(struct inside *in);

/* Follows a new pick. */
void inside_step(struct inside *in);

/* Back to light: normal mode has no samples of other views. */
void inside_leave(struct inside *in);

/* Closes the panel before another window opens, and opens it behind that. */
void inside_close_panel(struct inside *in);
void inside_open_panel(struct inside *in);

void inside_free(struct inside *in);

#endif
