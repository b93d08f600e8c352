// SPDX-License-Identifier: MIT
/*
 * panel_draw.h - draws the editor panel
 *
 * Units:     terminal cells
 * Threads:   main only
 */
#ifndef GLIM_PANEL_DRAW_H
#define GLIM_PANEL_DRAW_H

#include "studio/editor_panel.h"

/* Columns where the titles of the second and the third page begin. */
#define PAGE_2 12
#define PAGE_3 21

/* Columns of the sliders. A narrow panel cuts them. */
#define PANEL_SLIDER_COL  26
#define PANEL_SLIDER_COLS 11

/* Cells of the ball. */
#define BALL_COLS 24
#define BALL_ROWS 12

/* Draws the panel if it is open. Call it after a layout and after a change. */
void panel_draw(struct editor_panel *p);

/* Lists the parameters of the selected material, object or light and returns
 * their number. If there are fewer than before, the last one is selected. */
int panel_parameters(struct editor_panel *p,
                     struct parameter list[PARAMETERS_MAX]);

#endif
