// SPDX-License-Identifier: MIT
/*
 * progress_panel.h - shows the progress of the render: measures the threads and
 * draws the text of progress_text.h twice a second
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
    uint64_t due_ns; /* of the next update; 0: as soon as possible */
    struct thread_load load;
    uint64_t load_ns; /* when the load was begun */
};

/* Switches the panel on or off. The caller closes the screen's window if it
 * goes off. */
void progress_panel_switch(struct progress_panel *panel,
                           const struct render_control *control);

/* Time of the next update; UINT64_MAX if nothing will change. */
uint64_t progress_panel_next_ns(const struct progress_panel *panel,
                                const struct render_control *control);

/* Opens the panel or updates its text. */
void progress_panel_draw(struct progress_panel *panel,
                         const struct render_control *control,
                         struct screen *screen, uint64_t now_ns);

void progress_panel_free(struct progress_panel *panel);

#endif
