// SPDX-License-Identifier: MIT
/*
 * workspace.h - what is on the screen: the picture, the panel beside it, one
 * window over it, the last line; and when each is drawn
 *
 * Help, progress, directions and a path share one window: the help hides the
 * others while it is open, and there is room either for progress or for the
 * panel.
 *
 * Units:     nanoseconds of clock_ns()
 * Ownership: control and camera stay the caller's and outlive it;
 * workspace_free() frees the rest Threads:   main only Errors:    become
 * messages
 */
#ifndef GLIM_WORKSPACE_H
#define GLIM_WORKSPACE_H

#include <stdbool.h>
#include <stdint.h>

#include "terminal/screen.h"
#include "studio/camera_control.h"
#include "studio/editor_panel.h"
#include "studio/inspector.h"
#include "studio/progress_panel.h"
#include "studio/render_control.h"

struct workspace {
    struct render_control *control;
    struct camera_control *camera;
    struct screen screen;
    struct frame frame; /* of the size that the screen wants */
    struct inspector inspector;
    struct editor_panel panel;
    struct progress_panel progress_panel; /* hidden while the help is open */
    int help_number;                      /* the page that is shown, */
    int help_left;                        /* with those behind it; 0: no help */
    const char *prompt; /* in the last line; NULL: nothing is asked */

    uint64_t lack_ns; /* when to ask why there are no pixels; 0: never */

    bool is_settled;         /* nothing of the picture is left to be shown */
    uint64_t frame_ns;       /* when the next frame is due */
    uint64_t status_ns;      /* when to look for a new status line */
    int width_px, height_px; /* of the picture that has been laid out */
};

/* Says what the next restart's draft is like, before there is a screen. */
void workspace_expect(struct session *s);

void workspace_init(struct workspace *workspace, struct render_control *control,
                    struct camera_control *camera);

/* After tty_open(). */
void workspace_open(struct workspace *workspace);

/* Everything anew, for the terminal's size of now. */
void workspace_layout(struct workspace *workspace);

/* Draws again as soon as possible. */
void workspace_refresh(struct workspace *workspace);

/* NULL: the status line again. */
void workspace_ask(struct workspace *workspace, const char *prompt);

void workspace_switch_progress(struct workspace *workspace);
void workspace_open_panel(struct workspace *workspace);
void workspace_next_drawing(struct workspace *workspace);
void workspace_next_colors(struct workspace *workspace);
void workspace_next_glyphs(struct workspace *workspace);

/* Only the picture, or the status line as well. */
void workspace_hide(struct workspace *workspace);

void workspace_open_help(struct workspace *workspace);

/* While the help is open: its next page, or its end. */
void workspace_turn_help(struct workspace *workspace, bool closes);

/* After the scene was loaded anew. */
void workspace_renew(struct workspace *workspace,
                     const struct selection_names *names);

/* Looks how far the render is, and what of it is to be shown. */
void workspace_look(struct workspace *workspace);

/* Draws what is due. False if the terminal takes nothing any more. */
bool workspace_draw(struct workspace *workspace, uint64_t now_ns);

/* When to look and draw again if nothing happens; UINT64_MAX: never. */
uint64_t workspace_next_ns(const struct workspace *workspace, uint64_t now_ns);

/* After tty_close(). */
void workspace_free(struct workspace *workspace);

#endif
