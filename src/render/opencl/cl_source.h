// SPDX-License-Identifier: MIT
/*
 * cl_source.h - joins the kernels to one text for a driver
 *
 * Drivers search included files in different ways, and some use a cached
 * program although an included file has changed. So each line
 *     #include "kernels/x.h"
 * is replaced by the file, once, without regard to surrounding #if lines.
 * #line marks make compiler messages name the original files.
 *
 * Ownership: cl_source_text() returns a text for free()
 * Threads:   any
 * Errors:    a missing file, with the line that includes it
 */
#ifndef GLIM_CL_SOURCE_H
#define GLIM_CL_SOURCE_H

#include <stdint.h>

#include "base/error.h"

/* File of kernels/ as built into the program; the list ends with a name of
 * NULL. */
struct cl_source_file {
    const char *name; /* "kernels/x.h" */
    const char *text;
};
extern const struct cl_source_file cl_source_files[];

/* Returns all kernels with their included files, from the folder, or from the
 * program itself if `folder` is NULL. */
char *cl_source_text(const char *folder, struct error *err);

/* Returns a hash of the text, for the names of cache files and for films. */
uint64_t cl_source_hash(const char *text);

#endif
