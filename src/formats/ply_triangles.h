// SPDX-License-Identifier: MIT
/*
 * ply_triangles.h - reads the faces of most binary PLY files, which are all
 * triangles and have nothing but their vertices, with several threads
 *
 * Ownership: the triangles belong to the scene
 * Threads:   those of the pool
 */
#ifndef GLIM_PLY_TRIANGLES_H
#define GLIM_PLY_TRIANGLES_H

#include "base/thread_pool.h"
#include "formats/ply_data.h"
#include "formats/ply_table.h"

/* Returns true if the rows of the element can be faces of this kind: one list
 * of 32-bit numbers with a count of one byte, in binary. */
bool ply_triangles_fit(const struct ply_data *data, const struct ply_table *t);

/* Fills the triangles of a scene without any, whose arrays have room for all
 * rows, as face_tris_add() would, and moves `data` behind them. Corners have
 * the texture coordinates of their vertices if has_uvs. Returns false, and
 * leaves the scene without triangles, if a row is no good triangle: the rows
 * are then read one by one. `pool` may be NULL. */
bool ply_triangles_read(struct ply_data *data, const struct ply_table *t,
                        struct scene *scene, bool has_uvs, uint32_t material,
                        struct pool *pool);

#endif
