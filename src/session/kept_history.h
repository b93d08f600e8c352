// SPDX-License-Identifier: MIT
/*
 * kept_history.h - the undo history of a kept session
 *
 * It is a list of states before and after the present one, each with the texts
 * of kept_edit.h. A line has the numbers of both, and each state begins with a
 * line of the sizes of its texts. A restored state is one step, which changes
 * what the step of the kept session has changed.
 *
 * Threads:   main only
 * Errors:    texts that cannot be written or parsed
 */
#ifndef GLIM_KEPT_HISTORY_H
#define GLIM_KEPT_HISTORY_H

#include "session/kept_edit.h"

/* Most steps that are kept, to undo and to redo: the texts of a state are made
 * in 5 to 10 us, while the screen waits. Fewer are if a state is so large that
 * they would have about this many bytes each way. */
#define KEPT_STEPS_MAX   200
#define KEPT_STEPS_BYTES ((size_t)1 << 20)

/* Adds the texts of the present state and the history to a kept session. The
 * edit is the same afterwards. `path` is that of its file. */
bool kept_history_take(struct kept *k, struct session *s, const char *path,
                       struct error *err);

/* Changes the edit of a scene that was just opened to the kept state, and its
 * history to the kept one. *missing is as in kept_edit_restore(). */
bool kept_history_restore(const struct kept *k, struct session *s,
                          const char *path, uint32_t *missing,
                          struct error *err);

#endif
