// SPDX-License-Identifier: MIT
/*
 * progress_panel.h - the panel of progress on the screen: when it is drawn, and
 * what it measures for that
 *
 * Units:     nanoseconds of clock_ns()
 * Ownership: progress_panel_free() frees; a zeroed struct is switched off
 * Threads:   main only
 */
#ifndef GLIM_PROGRESS_PANEL_H
#define GLIM_PROGRESS_PANEL_H

#include <stdbool.h>
#include <stdint.h>

#include "terminal/screen.h"
#include "studio/render_control.h"

struct progress_panel {
    bool is_on;
    uint64_t due_ns; /* when it is drawn next; 0: as soon as possible */
    struct thread_load load;
    uint64_t load_ns; /* when that was begun */
};

/* On or off; the screen's window is to be closed if it goes off. */
void progress_panel_switch(struct progress_panel *panel,
                           const struct render_control *control);

/* When it wants to be drawn: UINT64_MAX, never, if nothing changes. */
uint64_t progress_panel_next_ns(const struct progress_panel *panel,
                                const struct render_control *control);

/* Opens the panel, or changes its text. */
void progress_panel_draw(struct progress_panel *panel,
                         const struct render_control *control,
                         struct screen *screen, uint64_t now_ns);

void progress_panel_free(struct progress_panel *panel);

#endif
