// SPDX-License-Identifier: MIT
/*
 * view_file.h - reads and writes the view file beside a scene
 *
 * Units:     as in view.h
 * Threads:   one thread at a time
 * Errors:    an unreadable file, a malformed or impossible value: file:line
 */
#ifndef GLIM_VIEW_FILE_H
#define GLIM_VIEW_FILE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/file.h"
#include "read/view_parse.h"

/* Reads a view file with view_parse(). */
bool view_read(struct view *view, const char *path, struct warnings *report,
               struct error *err);

/* Writes the file atomically. Lines of an existing file keep their order; lines
 * without a known key are copied. A sky path is written relative to the file's
 * folder where possible. *change tells which file was replaced by which; a file
 * that another process has changed in between is not replaced. If the text
 * changes, the old text is first written to the file's name with a ~
 * appended. */
bool view_write(const struct view *view, const char *path,
                struct file_change *change, struct error *err);

/* Makes the text with which view_write() replaces the old one, for free(). */
bool view_format(const struct view *view, const struct file_bytes *old,
                 char **text, size_t *size_bytes, struct error *err);

#endif
