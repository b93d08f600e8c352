// SPDX-License-Identifier: MIT
/*
 * asset_path.h - finds the files that a scene names
 *
 * Threads:   any
 */
#ifndef GLIM_ASSET_PATH_H
#define GLIM_ASSET_PATH_H

/* Returns the path of the file that the text of `beside` calls `name`, for
 * free(), or NULL if there is none. Names are relative to the folder of
 * `beside`. Candidates, in this order: the name as it is; without backslashes
 * before blanks; with / for each backslash; the last part of the name alone,
 * for folders of another machine; the last two in any letter case. A name of
 * PATH_MAX bytes or more is never found. */
char *asset_path_find(const char *beside, const char *name);

#endif
