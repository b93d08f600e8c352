// SPDX-License-Identifier: MIT
/*
 * inspector.h - pictures of what happens inside: other views than light, and
 * drawings over any of them
 *
 * Boxes of the tree, scattered directions and a path are drawn over the
 * picture; those two stay where they were picked while the camera moves.
 *
 * Units:     frames' pixels
 * Ownership: control, screen and cursor stay the caller's and outlive it;
 *            inspector_free() frees the rest
 * Threads:   main only
 * Errors:    become messages
 */
#ifndef GLIM_INSPECTOR_H
#define GLIM_INSPECTOR_H

#include <stdbool.h>
#include <stdint.h>

#include "inspect/path_record.h"
#include "inspect/view_modes.h"
#include "studio/pick_cursor.h"

enum inspector_drawing {
    INSPECTOR_NOTHING,
    INSPECTOR_BOXES,
    INSPECTOR_LOBES,
    INSPECTOR_PATH,
    INSPECTOR_DRAWINGS
};

struct inspector {
    struct render_control *control;
    struct screen *screen;
    struct pick_cursor *cursor;
    struct view_mode view_mode;
    enum inspector_drawing drawing;
    uint32_t level; /* of boxes */
    /* where lobes and path begin: a pixel of a picture that was */
    struct camera camera;
    uint32_t x, y;
    bool is_picked; /* by the cursor, at */
    double place[3];
    bool is_surface; /* else the sky is there */
    uint64_t sample;
    int step; /* of the path: so many are shown */
    struct path_record trail;
    struct path_record_lobes lobes;
    bool has_panel;
};

void inspector_init(struct inspector *inspector, struct render_control *control,
                    struct screen *screen, struct pick_cursor *cursor);

/* Fills a frame for the screen: the render in the present view mode, with
 * drawings over it. */
void inspector_preview(struct inspector *inspector, struct frame *frame);

/* Light, preview, normals, and so on. */
void inspector_next_view(struct inspector *inspector);
void inspector_previous_view(struct inspector *inspector);

/* Boxes, directions, a path, nothing. */
void inspector_next_drawing(struct inspector *inspector);

/* The level of boxes, or the step of the path. */
void inspector_less(struct inspector *inspector);
void inspector_more(struct inspector *inspector);

/* Saves the picture with the present view mode and drawings: as PNG, light
 * alone as HDR, or as coloured text. */
void inspector_save(struct inspector *inspector);
void inspector_save_hdr(struct inspector *inspector);
void inspector_save_text(struct inspector *inspector);

/* Nothing is drawn over the picture any more. */
void inspector_stop_drawing(struct inspector *inspector);

/* The scene is another one: what was made of the old one is dropped. */
void inspector_renew(struct inspector *inspector);

/* Follows a new pick. */
void inspector_step(struct inspector *inspector);

/* Back to light: normal mode has no samples of other views. */
void inspector_leave(struct inspector *inspector);

/* Closes the panel before another window opens, and opens it behind that. */
void inspector_close_panel(struct inspector *inspector);
void inspector_open_panel(struct inspector *inspector);

void inspector_free(struct inspector *inspector);

#endif
