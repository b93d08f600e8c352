// SPDX-License-Identifier: MIT
#include "opencl/cl_world.h"

#include "light/guide_grid.h"

/* What an array of the world is on the host. */
struct source {
    const void *data;
    size_t size_bytes;
};

#define SOURCE(array, count)                       \
    {                                              \
        (array), (size_t)(count) * sizeof *(array) \
    }

static bool upload(struct cl_world *c, const struct cl_machine *m,
                   enum cl_array which, struct source source, struct error *err)
{
    bool shared = which != CL_ARRAY_SETTINGS;

    cl_machine_drop(m, &c->buffers[which]);
    c->buffers[which] =
        cl_machine_buffer(m, source.data, source.size_bytes, shared, err);
    c->sources[which] = source.data;
    c->sizes_bytes[which] = source.size_bytes;
    c->upload_count++;
    return c->buffers[which] != NULL;
}

bool cl_world_update(struct cl_world *c, const struct cl_machine *m,
                     const struct world *w, const struct bvh *bvh,
                     struct error *err)
{
    const struct settings *s = &w->settings;
    const struct source sources[CL_ARRAY_COUNT] = {
        [CL_ARRAY_SETTINGS] = SOURCE(s, 1),
        [CL_ARRAY_POSITIONS] = SOURCE(w->positions, s->position_count),
        [CL_ARRAY_NORMALS] = SOURCE(w->normals, s->normal_count),
        [CL_ARRAY_UVS] = SOURCE(w->uvs, s->uv_count),
        [CL_ARRAY_TRIS] = SOURCE(w->tris, s->tri_count),
        [CL_ARRAY_MATERIALS] = SOURCE(w->materials, s->material_count),
        [CL_ARRAY_TEXTURES] = SOURCE(w->textures, s->texture_count),
        [CL_ARRAY_TEXELS] = SOURCE(w->texels, s->texel_count),
        [CL_ARRAY_LINEAR_OF_SRGB] =
            SOURCE(w->linear_of_srgb, w->linear_of_srgb != NULL ? 256 : 0),
        [CL_ARRAY_SKY_TEXELS] =
            SOURCE(w->sky_texels, (size_t)s->sky.width * s->sky.height),
        [CL_ARRAY_NODES] = SOURCE(bvh->nodes, bvh->node_count),
        [CL_ARRAY_LEAF_TRIS] = SOURCE(bvh->leaf_tris, bvh->leaf_tri_count),
        [CL_ARRAY_LIGHTS] = SOURCE(w->lights, s->light_count),
        [CL_ARRAY_TRI_LIGHTS] =
            SOURCE(w->tri_lights, s->light_count > 0 ? s->tri_count : 0),
        [CL_ARRAY_LIGHT_NODES] = SOURCE(w->light_nodes, s->light_node_count),
        [CL_ARRAY_SKY_SUMS] = SOURCE(w->sky_cdf, s->sky_cdf_count),
        [CL_ARRAY_GUIDE_CELLS] =
            SOURCE(w->guide_cells, guide_cell_count(&s->guide)),
        [CL_ARRAY_GUIDE_SUMS] =
            SOURCE(w->guide_cdf, (size_t)s->guide.table_count * GUIDE_BINS),
    };

    for (int i = 0; i < CL_ARRAY_COUNT; i++) {
        bool is_there = c->buffers[i] != NULL && i != CL_ARRAY_SETTINGS &&
                        c->sources[i] == sources[i].data &&
                        c->sizes_bytes[i] == sources[i].size_bytes;

        if (!is_there && !upload(c, m, (enum cl_array)i, sources[i], err))
            return false;
    }
    return true;
}

void cl_world_free(struct cl_world *c, const struct cl_machine *m)
{
    for (int i = 0; i < CL_ARRAY_COUNT; i++)
        cl_machine_drop(m, &c->buffers[i]);
    *c = (struct cl_world){0};
}
