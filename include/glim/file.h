// SPDX-License-Identifier: MIT
/*
 * file.h - whole files in, whole files out
 *
 * Units:     bytes
 * Ownership: file_read() returns memory for file_release(); path functions
 *            return strings for free()
 * Threads:   any
 * Errors:    the system's words, with the path
 */
#ifndef GLIM_FILE_H
#define GLIM_FILE_H

#include "glim/util.h"

/* Reads a regular file (a folder or a device is an error). text[size_bytes]
 * is a NUL that is not counted. */
bool file_read(const char *path, char **text, size_t *size_bytes,
               struct error *err);

/* Replaces the file atomically: temporary file beside it, fsync, rename.
 * If must_be_new, an existing file is left alone and *exists is set. */
bool file_write(const char *path, const void *data, size_t size_bytes,
                bool must_be_new, bool *exists, struct error *err);

/* `name` seen from the folder of `beside`; absolute names stay. */
char *path_beside(const char *beside, const char *name);

/* The path without the ending of its last part: a/b.obj gives a/b. */
char *path_stem(const char *path);

#endif
