// SPDX-License-Identifier: MIT
/*
 * vdb.h - reads one grid of an OpenVDB file
 *
 * The reader takes grids of floats, also those that are saved as half floats,
 * in trees 5-4-3, from version 222 of the file on, plain or packed with zip,
 * active masks and blosc. Values are those that OpenVDB's getValue() returns,
 * also of inactive voxels. A level set becomes the density of what it encloses,
 * as OpenVDB's sdfToFogVolume() makes it. Other metadata tell which axis is up.
 *
 * The parser checks every count and offset. Its memory is bounded by the size
 * of the file and by BRICK_PLACES_MAX. But libblosc is not as careful:
 * read/child/vdb_read.h runs the parser in a copy of the program.
 *
 * Units:     bytes; those of scene/voxel_grid.h
 * Ownership: the grid is for voxel_grid_free(), also after an error
 * Threads:   any
 * Errors:    what was found and what was expected, without the file's name,
 *            which the caller adds
 */
#ifndef GLIM_VDB_H
#define GLIM_VDB_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"
#include "scene/voxel_grid.h"

/* Reads the grid of this name. NULL or "": that of the name "density", else the
 * first that can be read. */
bool vdb_parse(struct voxel_grid *grid, const void *bytes, size_t size_bytes,
               const char *name, struct error *err);

#endif
