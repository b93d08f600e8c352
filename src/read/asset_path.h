// SPDX-License-Identifier: MIT
/*
 * asset_path.h - finds the files that a scene names
 *
 * Threads:   any
 * Errors:    false when memory is out
 */
#ifndef GLIM_ASSET_PATH_H
#define GLIM_ASSET_PATH_H

#include <stdbool.h>

/* Finds the path of the file that the text of `beside` calls `name`. *path is
 * for free(), or NULL if there is none. Names are relative to the folder of
 * `beside`. Candidates, in this order: the name as it is; without double
 * quotes around it; without backslashes before blanks; with / for each
 * backslash; the last part of the name alone, for folders of another machine;
 * the last two in any letter case. A name of PATH_MAX bytes or more is never
 * found. */
bool asset_path_find(const char *beside, const char *name, char **path);

#endif
