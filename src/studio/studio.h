// SPDX-License-Identifier: MIT
/*
 * studio.h - the interactive program: its parts, and commands that concern
 * several of them
 *
 * Units:     nanoseconds of clock_ns()
 * Threads:   main only
 * Errors:    errors become messages
 */
#ifndef GLIM_STUDIO_H
#define GLIM_STUDIO_H

#include <stdbool.h>
#include <stdint.h>

#include "terminal/tty_input.h"
#include "studio/camera_control.h"
#include "studio/questions.h"
#include "studio/render_control.h"
#include "studio/session_keeper.h"
#include "studio/workspace.h"

struct studio {
    struct render_control control;
    struct camera_control camera;
    struct workspace workspace;
    struct session_keeper keeper;
    struct tty_input input;
    uint64_t byte_ns; /* time of the last byte of input */
    bool has_mouse;
    enum question question; /* question that waits for an answer */
    bool is_ending;
    bool is_gone; /* the terminal has gone */
    int status;   /* exit status */
};

/* Ends the loop; the program exits with this status. */
void studio_end(struct studio *studio, int status);

/* End the program as Ctrl-C and Ctrl-\ do. */
void studio_interrupt(struct studio *studio);
void studio_abort(struct studio *studio);

/* Stops the program until the shell continues it. */
void studio_suspend(struct studio *studio);

/* Switches to live or normal mode. The render of normal mode is lost. */
void studio_set_live(struct studio *studio, bool is_live);

/* Ask first if something would be lost. */
void studio_change_mode(struct studio *studio);
void studio_restart(struct studio *studio);
void studio_quit(struct studio *studio);

/* Asks for the number under which to keep the view. */
void studio_keep_view(struct studio *studio);

/* Switches the mouse on or off. */
void studio_switch_mouse(struct studio *studio);

#endif
