// SPDX-License-Identifier: MIT
/*
 * kept_folder.h - the folder of kept sessions: one file for each scene, named
 * after the hash of the scene's absolute path
 *
 * It is `sessions` in the user's state folder. Files are removed when they are
 * older than 30 days, and the oldest ones when all together have more than
 * 1 GiB.
 *
 * Units:     bytes, seconds
 * Threads:   kept_prune() any; the others main only
 */
#ifndef GLIM_KEPT_FOLDER_H
#define GLIM_KEPT_FOLDER_H

#include <stdio.h>

#include "session/kept_file.h"

#define KEPT_DAYS_MAX  30
#define KEPT_BYTES_MAX ((uint64_t)1 << 30)

/* Size of the text of kept_describe(). */
#define KEPT_TEXT_BYTES 96

/* Returns the absolute path of a scene, for free(), or NULL if it cannot be
 * found or cannot be in the head of a file. */
char *kept_scene(const char *scene_path);

/* Returns the path of the file of a scene with this absolute path, for free(),
 * or NULL without a state folder. */
char *kept_path(const char *scene);

/* Locks the file for this process, until the descriptor that is returned is
 * closed. Returns -1 if another process has it. */
int kept_lock(const char *path);

/* Removes files that are too old, then the oldest above a size of all together.
 * Returns how many. */
int kept_prune(const char *path, int days_max, uint64_t bytes_max);

/* Writes what a file has, such as "3 min 20 s of render and unsaved changes".
 */
void kept_describe(char text[KEPT_TEXT_BYTES], const struct kept *k);

/* Removes what is too old or too much, and prints a line for each file, the
 * last one first. Fails without a state folder. */
bool kept_print_list(FILE *to, struct error *err);

#endif
