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

#include "session/live_render.h"
#include "terminal/screen.h"

struct progress_panel {
    bool is_on;      /* over the picture */
    bool leaves_bar; /* the person has removed it from the bar */
    uint64_t due_ns; /* time of the next update; 0 means at once */
    struct thread_load load;
    uint64_t load_ns; /* time when the measurement of the load began */
};

/* Returns the time of the next update of a panel that is shown, or UINT64_MAX
 * if nothing will change. */
uint64_t progress_panel_next_ns(const struct progress_panel *panel,
                                const struct live_render *control);

/* Updates the text: in a bar beside or below the picture, as many lines as it
 * has (NULL: there is none), and in the window, which is opened first. */
void progress_panel_draw(struct progress_panel *panel,
                         const struct live_render *control,
                         struct screen *screen, const struct window_rect *bar,
                         uint64_t now_ns);

void progress_panel_free(struct progress_panel *panel);

#endif
