// SPDX-License-Identifier: MIT
/*
 * ply_vertices.h - reads the vertices of a PLY file, those of binary files with
 * several threads
 *
 * Ownership: the vertices belong to the scene
 * Threads:   starts those that may load the scene
 * Errors:    memory, and those of ply_data.h
 */
#ifndef GLIM_PLY_VERTICES_H
#define GLIM_PLY_VERTICES_H

#include "formats/ply_data.h"
#include "formats/ply_table.h"

/* Fills positions, normals, texture coordinates and colours of a scene without
 * any, and moves `data` behind the rows, which must have x, y and z. */
bool ply_vertices_read(struct ply_data *data, const struct ply_table *t,
                       struct scene *scene);

#endif
