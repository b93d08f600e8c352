// SPDX-License-Identifier: MIT
/*
 * world_smoke.h - gives a world the smokes of a view
 *
 * The grids of files are added by whoever reads files; those of other views
 * stay, for the way back.
 *
 * Units:     as world.h
 * Ownership: the world owns its arrays; grids and smokes are copied
 * Threads:   one, while nobody renders the world
 * Errors:    memory, grids that are flat: the world stays as before
 */
#ifndef GLIM_WORLD_SMOKE_H
#define GLIM_WORLD_SMOKE_H

#include "scene/voxel_grid.h"
#include "world/world.h"

/* Returns true if the world has this grid of the file. */
bool world_has_grid(const struct host_world *host, const char *path,
                    const char *name);

bool world_add_grid(struct host_world *host, const char *path, const char *name,
                    const struct voxel_grid *grid, struct error *err);

/* Sets the smokes of a world to those of the view, whose grids it has. Smokes
 * without effect are left out. */
bool world_set_smokes(struct host_world *host, const struct scene *scene,
                      const struct smokes *smokes, struct error *err);

/* Frees grids and smokes; world_free() calls it. */
void world_free_smokes(struct host_world *host);

#endif
