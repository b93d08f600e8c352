// SPDX-License-Identifier: MIT
/*
 * panel.h - the panel in which materials, objects and light are edited while
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
#ifndef GLIM_PANEL_H
#define GLIM_PANEL_H

#include "glim/canvas.h"
#include "glim/knob.h"
#include "glim/look.h"
#include "glim/pick.h"
#include "glim/work.h"

#define PANEL_TEXT 512

struct panel {
    struct work *work;
    struct canvas *canvas;
    uint32_t *first_tris; /* one an object; NO_INDEX: it has none */
    bool is_open;
    enum knob_page page;
    uint32_t material, object; /* selected */
    bool is_in_knobs;          /* else the arrows are the list's */
    bool by_hsv;
    int knob;               /* that is selected */
    int list_top, knob_top; /* the first that is shown */
    bool is_typing;
    char typed[PANEL_TEXT];
    int turned_id; /* the last knob that was turned, and when */
    uint64_t turned_ns;
};

void panel_init(struct panel *p, struct work *work, struct canvas *canvas);

/* Opens or closes it; the layout must be done anew. */
void panel_open(struct panel *p);
void panel_close(struct panel *p);

/* Does what the key means here. False if it is not the panel's. */
bool panel_key(struct panel *p, int key);

/* Selects what was picked. */
void panel_select(struct panel *p, const struct pick *pick);

/* Shows it as it is now, after layouts and changes. */
void panel_draw(struct panel *p);

void panel_free(struct panel *p);

#endif
