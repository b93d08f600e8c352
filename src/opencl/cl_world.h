// SPDX-License-Identifier: MIT
/*
 * cl_world.h - the arrays of a world on an OpenCL device
 *
 * Ownership: cl_world_free() releases; a zeroed struct has no arrays. A device
 *            that is a CPU reads the host's arrays in place
 * Threads:   one at a time
 * Errors:    an array that is larger than the device allows
 */
#ifndef GLIM_CL_WORLD_H
#define GLIM_CL_WORLD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "bvh/bvh.h"
#include "scene/world.h"
#include "opencl/cl_machine.h"

/* Arrays in the order of the arguments of trace_paths(). */
enum cl_array {
    CL_ARRAY_SETTINGS,
    CL_ARRAY_POSITIONS,
    CL_ARRAY_NORMALS,
    CL_ARRAY_UVS,
    CL_ARRAY_COLORS,
    CL_ARRAY_TRIS,
    CL_ARRAY_MATERIALS,
    CL_ARRAY_TEXTURES,
    CL_ARRAY_TEXELS,
    CL_ARRAY_LINEAR_OF_SRGB,
    CL_ARRAY_SKY_TEXELS,
    CL_ARRAY_NODES,
    CL_ARRAY_LEAF_TRIS,
    CL_ARRAY_LIGHTS,
    CL_ARRAY_TRI_LIGHTS,
    CL_ARRAY_LIGHT_NODES,
    CL_ARRAY_SKY_SUMS,
    CL_ARRAY_GUIDE_CELLS,
    CL_ARRAY_GUIDE_SUMS,
    CL_ARRAY_POINT_LIGHTS,
    CL_ARRAY_DIRECTIONAL_LIGHTS,
    CL_ARRAY_PROFILES,
    CL_ARRAY_CAUSTIC_CELLS,
    CL_ARRAY_CAUSTIC_GROUPS,
    CL_ARRAY_CAUSTIC_BINS,
    CL_ARRAY_COUNT
};

struct cl_world {
    cl_mem buffers[CL_ARRAY_COUNT];
    uint64_t versions[CL_ARRAY_COUNT]; /* versions of the contents */
};

/* Uploads the settings, and the arrays whose version differs from the buffer's.
 * Adds their number to *upload_count. `world` is lent from the host; `bvh` is
 * the tree of the host's shape. */
bool cl_world_update(struct cl_world *c, const struct cl_machine *m,
                     const struct host_world *host, const struct world *world,
                     const struct bvh *bvh, uint64_t *upload_count,
                     struct error *err);

void cl_world_free(struct cl_world *c, const struct cl_machine *m);

#endif
