// SPDX-License-Identifier: MIT
/*
 * editor_panel.h - the panel in which materials, objects and light are edited while
 * the picture renders beside it
 *
 * A list on top, the knobs of what is selected in it below. Keys that are not
 * the panel's go on to move the camera and so on.
 *
 * Units:     terminal cells
 * Ownership: work and canvas stay the caller's; panel_free() frees the rest
 * Threads:   main only
 * Errors:    become messages
 */
#ifndef GLIM_EDITOR_PANEL_H
#define GLIM_EDITOR_PANEL_H

#include "terminal/screen.h"
#include "studio/pick.h"
#include "studio/selection.h"
#include "studio/render_control.h"

#define PANEL_TEXT 512

struct panel {
    struct work *work;
    struct canvas *canvas;
    struct selection selection;
    bool is_open;
    bool is_in_knobs;         /* else the arrows are the list's */
    int knob;                 /* that is selected */
    int list_top, knob_top;   /* the first that is shown, */
    int list_rows, knob_rows; /* and how many are, as drawn last */
    bool is_typing;
    char typed[PANEL_TEXT];
    int turned_id; /* the last knob that was turned, and when */
    uint64_t turned_ns;
};

void panel_init(struct panel *p, struct work *work, struct canvas *canvas);

/* Opens or closes it; the layout must be done anew. */
void panel_open(struct panel *p);
void panel_close(struct panel *p);

/* After the scene was loaded anew: what had these names is selected, and what
 * was being typed goes on. */
void panel_renew(struct panel *p, const struct selection_names *names);

/* Does what the key means here. False if it is not the panel's. */
bool panel_key(struct panel *p, int key);

/* What the mouse does in the panel. False if it is elsewhere. */
bool panel_mouse(struct panel *p, const struct event *event);

/* Selects what was picked. */
void panel_select(struct panel *p, const struct pick *pick);

void panel_free(struct panel *p);

#endif
