// SPDX-License-Identifier: MIT
/*
 * instance_trees.h - the worlds from which the trees of a world with instances
 * are built: one of each mesh, one of the triangles outside of meshes, and one
 * of stand-ins
 *
 * A stand-in is a triangle with the box of an instance. Its number is that of
 * the instance. The last one stands for the triangles outside of meshes, if
 * there are any.
 *
 * Units:     normalised scene units
 * Ownership: instance_trees_free() frees; a zeroed struct has no trees. The
 *            arrays of the world stay the caller's
 * Threads:   instance_trees_init() uses those of its pool; read only after
 * Errors:    memory
 */
#ifndef GLIM_INSTANCE_TREES_H
#define GLIM_INSTANCE_TREES_H

#include <stdbool.h>

#include "base/thread_pool.h"
#include "kernels/types.h"

struct instance_trees {
    struct world stand_ins;
    struct world *meshes; /* the last one has the other triangles */
    uint32_t mesh_count;
    struct tri *tris;
    struct vec3 *corners;
};

/* Prepares for a world with instances. Returns false if memory is out. */
bool instance_trees_init(struct instance_trees *t, const struct world *world,
                         struct pool *pool);

void instance_trees_free(struct instance_trees *t);

/* Triangles of instances that a search for their bounds looks at. The boxes of
 * those beyond have to do: thousands of instances may be in one place. */
#define INSTANCE_TRIS_MAX (UINT64_C(1) << 20)

/* The box around a mesh: that of the last call of instance_box_corners(). */
struct mesh_box {
    uint32_t mesh; /* at first NO_INDEX */
    struct vec3 lo, hi;
};

/* Fills the corners of the box around the mesh of an instance, moved to their
 * places. Reads the whole mesh, unless *box has it. */
void instance_box_corners(const struct world *world, uint32_t instance,
                          struct mesh_box *box, struct vec3 corners[8]);

#endif
