// SPDX-License-Identifier: MIT
/*
 * shapes.h - meshes in which rays are timed: scans and rooms from ../shared, a
 * scene of instances, and generated terrains
 *
 * Units:     normalised scene units
 * Ownership: shape_free() frees; a zeroed struct is empty
 * Threads:   one
 * Errors:    files that cannot be read, memory
 */
#ifndef RAYS_SHAPES_H
#define RAYS_SHAPES_H

#include "world/world.h"

#define SHAPES 6

struct shape {
    struct scene scene;
    struct host_world host;
    struct world world; /* for the shape's camera */
};

extern const char *const shape_names[SHAPES];

/* Returns false with an empty text if `shared`, or the working folder for the
 * scene of instances, has no such file. */
bool shape_load(struct shape *shape, int i, const char *shared,
                struct error *err);

/* Makes a terrain of this many squares along x and half as many along z; each
 * is two triangles. */
bool shape_make_terrain(struct shape *shape, uint32_t across,
                        struct error *err);

void shape_free(struct shape *shape);

#endif
