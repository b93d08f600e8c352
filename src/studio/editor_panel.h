// SPDX-License-Identifier: MIT
/*
 * editor_panel.h - the panel in which materials, objects and light are edited
 * while the picture renders beside it
 *
 * A list on top, the knobs of what is selected in it below. Keys that are not
 * the panel's go on to move the camera and so on.
 *
 * Units:     terminal cells
 * Ownership: control and screen stay the caller's; editor_panel_free() frees
 * the rest Threads:   main only Errors:    become messages
 */
#ifndef GLIM_EDITOR_PANEL_H
#define GLIM_EDITOR_PANEL_H

#include <stdbool.h>
#include <stdint.h>

#include "terminal/screen.h"
#include "studio/pick.h"
#include "studio/render_control.h"
#include "studio/selection.h"

#define EDITOR_PANEL_TEXT 512

struct editor_panel {
    struct render_control *control;
    struct screen *screen;
    struct selection selection;
    bool is_open;
    bool is_in_knobs;         /* else the arrows are the list's */
    int knob;                 /* that is selected */
    int list_top, knob_top;   /* the first that is shown, */
    int list_rows, knob_rows; /* and how many are, as drawn last */
    bool is_typing;
    char typed[EDITOR_PANEL_TEXT];
    int turned_id; /* the last knob that was turned, and when */
    uint64_t turned_ns;
};

void editor_panel_init(struct editor_panel *p, struct render_control *control,
                       struct screen *screen);

/* Opens or closes it; the layout must be done anew. */
void editor_panel_open(struct editor_panel *p);
void editor_panel_close(struct editor_panel *p);

/* After the scene was loaded anew: what had these names is selected, and what
 * was being typed goes on. */
void editor_panel_renew(struct editor_panel *p,
                        const struct selection_names *names);

/* Does what the key means here. False if it is not the panel's. */
bool editor_panel_key(struct editor_panel *p, int key);

/* What the mouse does in the panel. False if it is elsewhere. */
bool editor_panel_mouse(struct editor_panel *p, const struct event *event);

/* Selects what was picked. */
void editor_panel_select(struct editor_panel *p, const struct pick *pick);

void editor_panel_free(struct editor_panel *p);

#endif
