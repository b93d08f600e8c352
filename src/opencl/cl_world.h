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
#include "scene/world_list.h"
#include "opencl/cl_machine.h"

/* Buffers in the order of the arguments of trace_paths(): the settings, and the
 * arrays of world_list.h. */
#define CL_SETTINGS     0
#define CL_ARRAYS       1
#define CL_BUFFER_COUNT (CL_ARRAYS + WORLD_LIST_COUNT)

struct cl_world {
    cl_mem buffers[CL_BUFFER_COUNT];
    uint64_t versions[WORLD_LIST_COUNT]; /* of the arrays in the buffers */
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
