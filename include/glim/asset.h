// SPDX-License-Identifier: MIT
/*
 * asset.h - finds the files that a scene names
 *
 * Units:     none
 * Ownership: asset_find() returns memory for free()
 * Threads:   any
 * Errors:    NULL
 */
#ifndef GLIM_ASSET_H
#define GLIM_ASSET_H

/* The path of the file `name` as written in the file `beside`: relative to its
 * folder, with \ for / if there is no such file, and at last without the
 * folders in it, which were those of another machine. NULL: none exists. */
char *asset_find(const char *beside, const char *name);

#endif
