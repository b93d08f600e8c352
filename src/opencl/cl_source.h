// SPDX-License-Identifier: MIT
/*
 * cl_source.h - the kernels as one text for a driver
 *
 * Drivers differ in how they search included files, and some keep a compiled
 * program although an included file has changed. So the lines
 *     #include "kernels/x.h"
 * are replaced by the file, each file once, whatever #if stands around it;
 * #line marks let the driver's messages name our files.
 *
 * Ownership: cl_source_text() returns a text for free()
 * Threads:   any
 * Errors:    a file that is not there, with the line that wants it
 */
#ifndef GLIM_CL_SOURCE_H
#define GLIM_CL_SOURCE_H

#include <stdint.h>

#include "base/error.h"

/* The files of kernels/ as they were when the program was built; the last one
 * has no name. */
struct cl_source_file {
    const char *name; /* "kernels/x.h" */
    const char *text;
};
extern const struct cl_source_file cl_source_files[];

/* All kernels with what they include, from the folder, or from within the
 * program if that is NULL. */
char *cl_source_text(const char *folder, struct error *err);

/* Equal texts have equal numbers: for the names of cached things. */
uint64_t cl_source_hash(const char *text);

#endif
