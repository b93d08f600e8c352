// SPDX-License-Identifier: MIT
#include "opencl/cl_world.h"

static bool upload(cl_mem *buffer, const struct cl_machine *m, const void *data,
                   size_t size_bytes, bool shared, struct error *err)
{
    cl_machine_drop(m, buffer);
    *buffer = cl_machine_buffer(m, data, size_bytes, shared, err);
    return *buffer != NULL;
}

bool cl_world_update(struct cl_world *c, const struct cl_machine *m,
                     const struct host_world *host, const struct world *w,
                     const struct bvh *bvh, uint64_t *upload_count,
                     struct error *err)
{
    struct world_array list[WORLD_LIST_COUNT];

    world_list(w, list);
    list[WORLD_LIST_nodes].data = bvh->nodes;
    list[WORLD_LIST_nodes].size_bytes = bvh->node_count * sizeof *bvh->nodes;
    list[WORLD_LIST_leaf_tris].data = bvh->leaf_tris;
    list[WORLD_LIST_leaf_tris].size_bytes =
        bvh->leaf_tri_count * sizeof *bvh->leaf_tris;
    if (!upload(&c->buffers[CL_SETTINGS], m, &w->settings, sizeof w->settings,
                false, err))
        return false;
    ++*upload_count;
    for (int i = 0; i < WORLD_LIST_COUNT; i++) {
        uint64_t version = host->versions[list[i].part];
        cl_mem *buffer = &c->buffers[CL_ARRAYS + i];

        if (*buffer != NULL && c->versions[i] == version)
            continue;
        if (!upload(buffer, m, list[i].data, list[i].size_bytes, true, err))
            return false;
        c->versions[i] = version;
        ++*upload_count;
    }
    return true;
}

void cl_world_free(struct cl_world *c, const struct cl_machine *m)
{
    for (int i = 0; i < CL_BUFFER_COUNT; i++)
        cl_machine_drop(m, &c->buffers[i]);
    *c = (struct cl_world){0};
}
