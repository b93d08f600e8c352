// SPDX-License-Identifier: MIT
/*
 * keys_bar.h - the row above the status line that says what keys do now, and
 * how a state is left
 *
 * It is drawn where the picture leaves a row free.
 *
 * Units:     terminal cells
 * Threads:   main only
 */
#ifndef GLIM_KEYS_BAR_H
#define GLIM_KEYS_BAR_H

#include "terminal/screen.h"
#include "studio/render_control.h"

/* What the person is doing. */
enum keys_state {
    KEYS_NONE, /* nothing is drawn */
    KEYS_LIVE,
    KEYS_PAUSED,
    KEYS_NORMAL,
    KEYS_CURSOR,
    KEYS_PANEL, /* its own keys are at its foot */
    KEYS_ORBIT,
    KEYS_VIEW,    /* a view other than light */
    KEYS_DRAWING, /* over the picture */
    KEYS_COMPARE,
    KEYS_STATES
};

struct keys_bar {
    enum keys_state state; /* that is drawn; KEYS_NONE: has to be drawn */
    int cols;
};

/* Draws the bar for a state, if it is another one than before. */
void keys_bar_draw(struct keys_bar *bar, const struct render_control *control,
                   struct screen *screen, enum keys_state state);

#endif
