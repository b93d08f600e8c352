// SPDX-License-Identifier: MIT
/*
 * shapes.h - meshes that rays are timed in: scans and rooms from ../shared, and
 * terrains that are made here
 *
 * Units:     normalised scene units
 * Ownership: shape_free() frees; a zeroed struct is none
 * Threads:   one
 * Errors:    files that cannot be read, memory
 */
#ifndef RAYS_SHAPES_H
#define RAYS_SHAPES_H

#include "scene/world.h"

#define SHAPES 5

struct shape {
    struct scene scene;
    struct host_world host;
    struct world world; /* as the shape's camera sees it */
};

extern const char *const shape_names[SHAPES];

/* False with an empty text: there is no such file below `shared`. */
bool shape_load(struct shape *shape, int i, const char *shared,
                struct error *err);

/* Squares along x, half as many along z; each is two triangles. */
bool shape_make_terrain(struct shape *shape, uint32_t across,
                        struct error *err);

void shape_free(struct shape *shape);

#endif
