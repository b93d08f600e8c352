// SPDX-License-Identifier: MIT
/*
 * panel_draw.h - the panel as lines of text with swatches
 *
 * Units:     terminal cells
 * Threads:   main only
 */
#ifndef GLIM_PANEL_DRAW_H
#define GLIM_PANEL_DRAW_H

#include "studio/editor_panel.h"

/* Columns of the second title and the third. */
#define PAGE_2 13
#define PAGE_3 22

/* Shows it as it is now, after layouts and changes. */
void panel_draw(struct editor_panel *p);

/* The knobs of what is selected; their number. One of them is selected too. */
int panel_knobs(struct editor_panel *p, struct parameter knobs[PARAMETERS_MAX]);

/* A name for people: "" is none. */
const char *panel_name(const char *name);

#endif
