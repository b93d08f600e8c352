// SPDX-License-Identifier: MIT
/*
 * voxel_file.h - reads grids of OpenVDB and NumPy files, and scenes that are
 * one of them
 *
 * Units:     those of scene/voxel_grid.h
 * Ownership: the grid is for voxel_grid_free(), also after an error
 * Threads:   one for each grid
 * Errors:    those of vdb_read.h, and of read/npy.h with the file's name
 */
#ifndef GLIM_VOXEL_FILE_H
#define GLIM_VOXEL_FILE_H

#include "scene/scene.h"
#include "scene/voxel_grid.h"

/* Reads the grid of this name. NULL or "": that of the name "density", else the
 * first one. `program` is for vdb_read(). */
bool voxel_file_read(struct voxel_grid *grid, const char *path,
                     const char *name, const char *program, struct error *err);

/* Returns true if the bytes begin a file of one of both formats. */
bool voxel_file_matches(const char *bytes, size_t size_bytes);

/* Makes a model of a grid: white smoke that is dense where the grid's values
 * are largest. */
bool voxel_scene_parse(struct scene *scene, const char *bytes,
                       size_t size_bytes, const char *path,
                       struct warnings *report, struct error *err);

#endif
