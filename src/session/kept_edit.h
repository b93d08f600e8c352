// SPDX-License-Identifier: MIT
/*
 * kept_edit.h - the state of an open scene as texts of a kept session, and back
 *
 * The view is the text of a view file. Each edited material has three lines:
 * its name, that of its original after a = sign (or - if it is in a file), and
 * the set of its maps that are switched off. Its statements are in an MTL text,
 * where the materials are called m0, m1 and so on.
 *
 * Threads:   main only
 * Errors:    texts that cannot be written or parsed
 */
#ifndef GLIM_KEPT_EDIT_H
#define GLIM_KEPT_EDIT_H

#include "session/kept_file.h"
#include "session/session.h"

/* Adds the texts to a kept session. `path` is that of its file. */
bool kept_edit_take(struct kept *k, const struct session *s, const char *path,
                    struct error *err);

/* Changes the edit of a scene that was opened from its files to the kept state,
 * in one step. *missing is the number of edited materials that the scene does
 * not have. */
bool kept_edit_restore(const struct kept *k, struct session *s,
                       const char *path, uint32_t *missing, struct error *err);

#endif
