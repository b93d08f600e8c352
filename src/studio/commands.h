// SPDX-License-Identifier: MIT
/*
 * commands.h - runs the commands of the actions of the keymap
 *
 * The table from actions to functions is in commands.c, the one from keys to
 * actions in session/keymap.c. Keys of the editor panel have their own in
 * editor_panel.c, answers to questions in questions.c.
 *
 * Threads:   main only
 */
#ifndef GLIM_COMMANDS_H
#define GLIM_COMMANDS_H

#include <stdbool.h>

#include "session/keymap.h"
#include "studio/studio.h"

/* Runs the command of an action. ACTION_NONE does nothing. */
void command_run(struct studio *studio, enum action action);

/* Runs the command that an action has while the cursor is shown. Returns false
 * if the cursor is not shown, or if the action has no other command then. */
bool command_run_at_cursor(struct studio *studio, enum action action);

#endif
