// SPDX-License-Identifier: MIT
/*
 * view_file.h - the small text file beside a scene that keeps its view
 *
 * Units:     as view.h
 * Ownership: nothing of a file's text is kept
 * Threads:   one thread at a time
 * Errors:    an unreadable file, a malformed or impossible value: file:line
 */
#ifndef GLIM_VIEW_FILE_H
#define GLIM_VIEW_FILE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/file.h"
#include "formats/view_parse.h"

/* view_parse() of a file. */
bool view_read(struct view *view, const char *path, struct warnings *report,
               struct error *err);

/* Writes the file, atomically. Lines of a file that is there keep their order,
 * and those with an unknown key or none stay as they are. A sky path is written
 * relative to the file's folder where that is possible. *change says what was
 * replaced by what; one that someone else writes at the same time is not. What
 * is replaced by another text is kept: before, it is written to the file with
 * the same name and a ~. */
bool view_write(const struct view *view, const char *path,
                struct file_change *change, struct error *err);

/* The text that view_write() puts in the place of this one, for free(). */
bool view_format(const struct view *view, const char *path,
                 const char *old_text, size_t old_bytes, char **text,
                 size_t *size_bytes, struct error *err);

#endif
