// SPDX-License-Identifier: MIT
/*
 * editor_panel.h - the panel in which materials, objects and light are edited
 * while the picture renders beside it
 *
 * The list of the page is on top, below it are the parameters of what is
 * selected in the list. The panel takes its own keys and leaves the others to
 * the camera.
 *
 * Units:     terminal cells
 * Ownership: control and screen stay the caller's; editor_panel_free() frees
 *            the rest
 * Threads:   main only
 * Errors:    errors become messages
 */
#ifndef GLIM_EDITOR_PANEL_H
#define GLIM_EDITOR_PANEL_H

#include <stdbool.h>
#include <stdint.h>

#include "image/image_folder.h"
#include "inspect/material_ball.h"
#include "inspect/outline.h"
#include "session/live_render.h"
#include "studio/camera/surfaces.h"
#include "studio/parameter.h"
#include "terminal/screen.h"

#define EDITOR_PANEL_TEXT 512

struct editor_panel {
    struct live_render *control;
    struct screen *screen;
    struct selection selection;
    bool is_open;
    bool is_in_parameters;         /* the arrow keys move in the parameters,
                                      else in the list */
    int parameter;                 /* row of the selected parameter */
    int list_top, parameter_top;   /* first rows that are shown */
    int list_rows, parameter_rows; /* numbers of rows in the last drawing */
    bool is_dragging; /* the mouse moves the slider of the selected parameter */
    bool is_typing;
    bool is_finding; /* a name in the list, instead of a value */
    char typed[EDITOR_PANEL_TEXT];
    struct image_folder images; /* one of which is chosen; empty: none is */
    int image, image_top;
    enum mtl_map image_map; /* that it is chosen for */
    uint64_t textures;      /* version of those that are shown */
    bool shows_ball;        /* the last drawing had room for it */
    struct material_ball ball;
    struct frame ball_frame;
    struct cells ball_cells;
    struct outline outline; /* of what is selected */
};

void editor_panel_init(struct editor_panel *p, struct live_render *control,
                       struct screen *screen);

/* Open or close the panel. The caller then calls workspace_layout(). */
void editor_panel_open(struct editor_panel *p);
void editor_panel_close(struct editor_panel *p);

/* Turns to a page. */
void editor_panel_show(struct editor_panel *p, enum selection_page page);

/* Copies the selected lamp of the page of light, or adds a point light. */
void editor_panel_add_lamp(struct editor_panel *p);

/* Adapts the panel to a scene that was loaded again: selects the material and
 * object with these names, and keeps the text that is being typed. */
void editor_panel_renew(struct editor_panel *p,
                        const struct selection_names *names);

/* Handles a key. Returns false if the key means nothing in the panel. */
bool editor_panel_key(struct editor_panel *p, int key);

/* Handles an event of the mouse. Returns false if it is outside the panel. */
bool editor_panel_mouse(struct editor_panel *p, const struct event *event);

/* Adds samples to the ball of the selected material. Returns true if the panel
 * has to be drawn again, also for new textures. */
bool editor_panel_step(struct editor_panel *p);

/* Draws the outline of the selected material or object, or of the picked object
 * while the panel is closed, into a frame that the camera sees: not while
 * values are changed, or the camera moves. */
void editor_panel_outline(struct editor_panel *p, const struct camera *camera,
                          struct frame *frame);

/* Returns true if editor_panel_step() has more to do. */
bool editor_panel_is_busy(const struct editor_panel *p);

/* Selects the material and the object of the pick. */
void editor_panel_select(struct editor_panel *p, const struct pick *pick);

void editor_panel_free(struct editor_panel *p);

#endif
