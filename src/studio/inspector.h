// SPDX-License-Identifier: MIT
/*
 * inspector.h - the view modes on the screen, and drawings over the picture
 *
 * Drawings are the boxes of the tree, the directions that a surface scatters
 * light to, and the path of one sample. Directions and path stay where they
 * were picked while the camera moves.
 *
 * Units:     frames' pixels
 * Ownership: control, screen and cursor stay the caller's and outlive it;
 *            inspector_free() frees the rest
 * Threads:   main only
 * Errors:    errors become messages
 */
#ifndef GLIM_INSPECTOR_H
#define GLIM_INSPECTOR_H

#include <stdbool.h>
#include <stdint.h>

#include "inspect/path_record.h"
#include "inspect/view_modes.h"
#include "studio/camera/pick_cursor.h"

enum inspector_drawing {
    INSPECTOR_NOTHING,
    INSPECTOR_BOXES,
    INSPECTOR_LOBES,
    INSPECTOR_PATH,    /* with words, */
    INSPECTOR_NUMBERS, /* or as a table */
    INSPECTOR_DRAWINGS
};

struct inspector {
    struct live_render *control;
    struct screen *screen;
    struct pick_cursor *cursor;
    struct view_mode view_mode;
    enum inspector_drawing drawing;
    uint32_t level; /* level of the boxes that are drawn */
    /* Directions and path begin at pixel (x, y) of this camera. */
    struct camera camera;
    uint32_t x, y;
    bool is_picked;     /* the cursor has picked the pixel */
    double position[3]; /* point of the pick, in file units */
    bool is_surface;    /* the pixel shows a surface, not the sky */
    uint64_t sample;    /* sample whose path is drawn */
    int step;           /* number of steps of the path that are drawn */
    struct path_record trail;
    struct path_record_lobes lobes;
    bool has_table; /* the table of the drawing is in the window */
};

void inspector_init(struct inspector *inspector, struct live_render *control,
                    struct screen *screen, struct pick_cursor *cursor);

/* Fill a frame for the screen with the render in the current view mode, without
 * or with the drawings over it. */
void inspector_picture(struct inspector *inspector, struct frame *frame);
void inspector_preview(struct inspector *inspector, struct frame *frame);

/* Switches to the next (1) or previous (-1) view mode: light, preview, normals,
 * and so on. Normal mode has only those made from light. */
void inspector_turn_view(struct inspector *inspector, int by);

/* Switches the denoising filter of the screen off and on. */
void inspector_switch_filter(struct inspector *inspector);

/* Switches to the next drawing: boxes, directions, a path, nothing. */
void inspector_next_drawing(struct inspector *inspector);

/* Changes the level of the boxes, or the step of the path, by 1 or -1. */
void inspector_change(struct inspector *inspector, int by);

/* Save the picture as it is shown, filtered and with drawings, as PNG; with its
 * noise, as PNG, or HDR and EXR (light alone); or as coloured text. */
void inspector_save(struct inspector *inspector);
void inspector_save_raw(struct inspector *inspector);
void inspector_save_hdr(struct inspector *inspector);
void inspector_save_exr(struct inspector *inspector);
void inspector_save_text(struct inspector *inspector);

/* Removes the drawings and their table. */
void inspector_stop_drawing(struct inspector *inspector);

/* Moves the drawings to a new pick, if there is one. */
void inspector_step(struct inspector *inspector);

/* Switches back to light. */
void inspector_show_light(struct inspector *inspector);

/* Switches back to light if the view mode has samples of its own, because
 * normal mode renders light only. */
void inspector_leave(struct inspector *inspector);

/* Close the table before another window opens, and open it again afterwards. */
void inspector_close_table(struct inspector *inspector);
void inspector_open_table(struct inspector *inspector);

void inspector_free(struct inspector *inspector);

#endif
