// SPDX-License-Identifier: MIT
/*
 * smoke_load.h - reads the grids of a view's smokes, and gives them to a world
 *
 * Ownership: the world owns its arrays
 * Threads:   one, while nobody renders the world
 * Errors:    those of read/child/voxel_file.h and world/world_smoke.h
 */
#ifndef GLIM_SMOKE_LOAD_H
#define GLIM_SMOKE_LOAD_H

#include "world/world.h"

/* Sets the smokes of a world to those of the view. Reads the grids that it does
 * not have. */
bool smoke_load(struct host_world *host, const struct scene *scene,
                const struct view *view, struct warnings *report,
                struct error *err);

#endif
