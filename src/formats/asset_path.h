// SPDX-License-Identifier: MIT
/*
 * asset_path.h - finds the files that a scene names
 *
 * Ownership: asset_path_find() returns memory for free()
 * Threads:   any
 * Errors:    NULL
 */
#ifndef GLIM_ASSET_PATH_H
#define GLIM_ASSET_PATH_H

/* The path of the file `name` as written in the file `beside`: relative to its
 * folder. If there is none: without backslashes before blanks, with \ for /,
 * then without its folders, which were those of another machine, and at last
 * with other capital and small letters. NULL: none exists, as of a name of
 * PATH_MAX bytes or more, which no system call takes. */
char *asset_path_find(const char *beside, const char *name);

#endif
