// SPDX-License-Identifier: MIT
/*
 * progress_panel.h - the panel of progress on the screen: when it is drawn, and what it
 * measures for that
 *
 * Units:     nanoseconds of clock_ns()
 * Ownership: gauge_free() frees; a zeroed struct is switched off
 * Threads:   main only
 * Errors:    none
 */
#ifndef GLIM_PROGRESS_PANEL_H
#define GLIM_PROGRESS_PANEL_H

#include "terminal/screen.h"
#include "studio/render_control.h"

struct gauge {
    bool is_on;
    uint64_t due_ns; /* when it is drawn next; 0: as soon as possible */
    struct load load;
    uint64_t load_ns; /* when that was begun */
};

/* On or off; the canvas's window is to be closed if it goes off. */
void gauge_switch(struct gauge *g, const struct work *work);

/* When it wants to be drawn: UINT64_MAX, never, if nothing changes. */
uint64_t gauge_next_ns(const struct gauge *g, const struct work *work);

/* Opens the panel, or changes its text. */
void gauge_draw(struct gauge *g, const struct work *work, struct canvas *canvas,
                uint64_t now_ns);

void gauge_free(struct gauge *g);

#endif
