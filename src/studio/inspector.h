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
    uint32_t level; /* of the boxes that are drawn */
    /* Directions and path begin at this camera's pixel (x, y). */
    struct camera camera;
    uint32_t x, y;
    bool is_picked;     /* the cursor has picked the pixel, */
    double position[3]; /* at this point, in file units */
    bool is_surface;    /* the pixel shows a surface, not the sky */
    uint64_t sample;    /* whose path is drawn */
    int step;           /* so many steps of the path are drawn */
    struct path_record trail;
    struct path_record_lobes lobes;
    bool has_table; /* its table is in the window */
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

/* Removes drawings and their table. */
void inspector_stop_drawing(struct inspector *inspector);

/* Draws from a new pick, if there is one. */
void inspector_step(struct inspector *inspector);

/* Goes back to light if the view mode has samples of its own: normal mode
 * renders light only. */
void inspector_leave(struct inspector *inspector);

/* Close the table before another window opens, and open it again after that. */
void inspector_close_table(struct inspector *inspector);
void inspector_open_table(struct inspector *inspector);

void inspector_free(struct inspector *inspector);

#endif
