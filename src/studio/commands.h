// SPDX-License-Identifier: MIT
/*
 * commands.h - what each action of the keymap does
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

/* Does what the action means; ACTION_NONE does nothing. */
void command_run(struct studio *studio, enum action action);

/* Does what the action means while the cursor is shown. Returns false if it is
 * not shown, or the action means the same as without it. */
bool command_run_at_cursor(struct studio *studio, enum action action);

#endif
