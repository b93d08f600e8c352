// SPDX-License-Identifier: MIT
/*
 * studio.h - the interactive program: its parts, the commands of actions, and
 * questions in the last line
 *
 * The table from actions to functions is in studio.c, the one from keys to
 * actions in session/keymap.c. Keys of the editor panel have their own in
 * editor_panel.c.
 *
 * Units:     nanoseconds of clock_ns(); keys are bytes or enum tty_key
 * Threads:   main only
 * Errors:    errors become messages
 */
#ifndef GLIM_STUDIO_H
#define GLIM_STUDIO_H

#include <stdbool.h>
#include <stdint.h>

#include "session/keymap.h"
#include "session/live_render.h"
#include "studio/autosave.h"
#include "studio/camera/camera_control.h"
#include "studio/workspace.h"
#include "terminal/tty_input.h"

/* Most questions come before something is lost. */
enum question {
    QUESTION_NONE,
    QUESTION_QUIT,
    QUESTION_EDIT, /* quit without saving edits */
    QUESTION_LIVE, /* leave normal mode */
    QUESTION_RESTART,
    QUESTION_NUMBER, /* number for a view */
    QUESTION_KEPT    /* go on with an autosaved session */
};

struct studio {
    struct live_render control;
    struct camera_control camera;
    struct workspace workspace;
    struct autosave autosave;
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

/* Stops the program until the shell continues it. */
void studio_suspend(struct studio *studio);

/* Switches to live or normal mode. The render of normal mode is lost. */
void studio_set_live(struct studio *studio, bool is_live);

/* Ends the loop. Asks first if something would be lost. */
void studio_quit(struct studio *studio);

/* Runs the command of an action. ACTION_NONE does nothing. */
void studio_run(struct studio *studio, enum action action);

/* Runs the command that an action has while the cursor is shown. Returns false
 * if the cursor is not shown, or if the action has no other command then. */
bool studio_run_at_cursor(struct studio *studio, enum action action);

/* Shows a question instead of the status line. QUESTION_NONE removes it. */
void question_ask(struct studio *studio, enum question question);

/* Takes any key as the answer and removes the question. Returns false if the
 * key is to have its effect, too. */
bool question_answer(struct studio *studio, int key);

#endif
