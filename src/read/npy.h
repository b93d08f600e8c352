// SPDX-License-Identifier: MIT
/*
 * npy.h - reads a NumPy file of three axes as a grid
 *
 * The last axis of the array is x, the first is z, and voxel 0 fills the space
 * from 0 to 1. The reader takes versions 1 to 3 of the format with numbers of
 * the types f2, f4, f8, u1 and u2, in both orders of bytes and of axes. NaN and
 * infinite numbers become 0, and are counted.
 *
 * Units:     a voxel is a unit long
 * Ownership: the grid is for voxel_grid_free(), also after an error
 * Threads:   any
 * Errors:    what was found and what was expected, without the file's name,
 *            which the caller adds
 */
#ifndef GLIM_NPY_H
#define GLIM_NPY_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"
#include "scene/voxel_grid.h"

/* Returns true if the bytes begin such a file. */
bool npy_matches(const char *bytes, size_t size_bytes);

bool npy_parse(struct voxel_grid *grid, const char *bytes, size_t size_bytes,
               struct error *err);

#endif
