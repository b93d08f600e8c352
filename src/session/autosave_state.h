// SPDX-License-Identifier: MIT
/*
 * autosave_state.h - the state of an open scene as texts of an autosaved
 * session, with its undo history, and back
 *
 * The view is the text of a view file. Each edited material has three lines:
 * its name, that of its original after a = sign (or - if it is in a file), and
 * the set of its maps that are switched off. Its statements are in an MTL text,
 * where the materials are called m0, m1 and so on.
 *
 * The history is a list of states before and after the present one, each with
 * these texts. A line has the numbers of both, and each state begins with a
 * line of the sizes of its texts. A restored state is one step, which changes
 * what the step of the autosaved session has changed.
 *
 * Threads:   main only
 * Errors:    texts that cannot be written or parsed
 */
#ifndef GLIM_AUTOSAVE_STATE_H
#define GLIM_AUTOSAVE_STATE_H

#include "session/autosave_file.h"
#include "session/session.h"

/* ---- one state ---- */

/* Adds the texts to an autosaved session. `path` is that of its file. */
bool autosave_edit_take(struct autosave_file *k, const struct session *s,
                        const char *path, struct error *err);

/* Changes the edit of a scene that was opened from its files to the kept state,
 * in one step. *missing is the number of edited materials that the scene does
 * not have. */
bool autosave_edit_restore(const struct autosave_file *k, struct session *s,
                           const char *path, uint32_t *missing,
                           struct error *err);

/* ---- history ---- */

/*
 * It is a list of states before and after the present one, each with the texts
 * of autosave_edit.h. A line has the numbers of both, and each state begins
 * with a line of the sizes of its texts. A restored state is one step, which
 * changes what the step of the autosaved session has changed.
 */

/* Most steps that are kept, to undo and to redo: the texts of a state are made
 * in 5 to 10 us, while the screen waits. Fewer are if a state is so large that
 * they would have about this many bytes each way. */
#define AUTOSAVE_STEPS_MAX   200
#define AUTOSAVE_STEPS_BYTES ((size_t)1 << 20)

/* Adds the texts of the present state and the history to an autosaved session.
 * The edit is the same afterwards. `path` is that of its file. */
bool autosave_history_take(struct autosave_file *k, struct session *s,
                           const char *path, struct error *err);

/* Changes the edit of a scene that was just opened to the kept state, and its
 * history to the kept one. *missing is as in autosave_edit_restore(). */
bool autosave_history_restore(const struct autosave_file *k, struct session *s,
                              const char *path, uint32_t *missing,
                              struct error *err);

#endif
