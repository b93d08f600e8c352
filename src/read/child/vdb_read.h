// SPDX-License-Identifier: MIT
/*
 * vdb_read.h - reads a grid of an OpenVDB file in a copy of the program
 *
 * The file may be hostile, and libblosc may unpack it: time and memory of the
 * copy are limited. It reads the grid's name from standard input, and sends a
 * struct voxel_grid without its pointers, and the arrays: index, majorants,
 * values.
 *
 * Units:     those of scene/voxel_grid.h
 * Ownership: the grid is for voxel_grid_free(), also after an error
 * Threads:   one for each grid
 * Errors:    those of read/vdb.h, sent as a line; a crash, a limit; a stream
 *            that is cut off or whose numbers are wrong, since the copy may
 *            have been in any state
 */
#ifndef GLIM_VDB_READ_H
#define GLIM_VDB_READ_H

#include <stdbool.h>
#include <stdio.h>

#include "base/library_child.h"
#include "scene/voxel_grid.h"

/* Reads the grid of this name, as vdb_parse() does. `program` is the one that
 * the copy runs. */
bool vdb_read(struct voxel_grid *grid, const char *path, const char *name,
              const char *program, struct error *err);

/* Reads what a copy has sent. The error lacks the file's name. */
bool vdb_stream_read(struct voxel_grid *grid, const char *bytes,
                     size_t size_bytes, struct error *err);

/* Sends the grid of the file, or returns false and sends the message. */
bool vdb_child(const char *path, struct library_limits limits, FILE *to);

#endif
