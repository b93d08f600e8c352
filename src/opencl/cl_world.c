// SPDX-License-Identifier: MIT
#include "opencl/cl_world.h"

#include "light/guide_grid.h"
#include "kernels/sky.h"

/* An array of the world, on the host. */
struct source {
    const void *data;
    size_t size_bytes;
};

/* The part of the world whose version an array has; settings have none. */
static const enum world_part parts[CL_ARRAY_COUNT] = {
    [CL_ARRAY_POSITIONS] = WORLD_FIXED,
    [CL_ARRAY_NORMALS] = WORLD_FIXED,
    [CL_ARRAY_UVS] = WORLD_FIXED,
    [CL_ARRAY_COLORS] = WORLD_FIXED,
    [CL_ARRAY_TRIS] = WORLD_TRIS,
    [CL_ARRAY_MATERIALS] = WORLD_MATERIALS,
    [CL_ARRAY_TEXTURES] = WORLD_TEXTURES,
    [CL_ARRAY_TEXELS] = WORLD_TEXELS,
    [CL_ARRAY_LINEAR_OF_SRGB] = WORLD_FIXED,
    [CL_ARRAY_SKY_TEXELS] = WORLD_SKY,
    [CL_ARRAY_NODES] = WORLD_SHAPE,
    [CL_ARRAY_LEAF_TRIS] = WORLD_SHAPE,
    [CL_ARRAY_LIGHTS] = WORLD_LIGHTS,
    [CL_ARRAY_TRI_LIGHTS] = WORLD_LIGHTS,
    [CL_ARRAY_LIGHT_NODES] = WORLD_LIGHTS,
    [CL_ARRAY_SKY_SUMS] = WORLD_SKY,
    [CL_ARRAY_GUIDE_CELLS] = WORLD_GUIDE,
    [CL_ARRAY_GUIDE_SUMS] = WORLD_GUIDE,
    [CL_ARRAY_POINT_LIGHTS] = WORLD_LIGHTS,
    [CL_ARRAY_DIRECTIONAL_LIGHTS] = WORLD_DIRECTIONAL_LIGHTS,
    [CL_ARRAY_PROFILES] = WORLD_LIGHTS,
    [CL_ARRAY_CAUSTIC_CELLS] = WORLD_GUIDE,
    [CL_ARRAY_CAUSTIC_GROUPS] = WORLD_GUIDE,
    [CL_ARRAY_CAUSTIC_BINS] = WORLD_GUIDE,
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
    return c->buffers[which] != NULL;
}

/* Returns the length of the whole table, even if the view does not use it,
 * since the buffer outlives the view. */
static size_t sky_cdf_length(const struct world *w)
{
    const struct sky sky = w->settings.sky;

    return w->sky_cdf != NULL ? sky_row_cdf(sky, sky.height) : 0;
}

bool cl_world_update(struct cl_world *c, const struct cl_machine *m,
                     const struct host_world *host, const struct world *w,
                     const struct bvh *bvh, uint64_t *upload_count,
                     struct error *err)
{
    const struct settings *s = &w->settings;
    const struct source sources[CL_ARRAY_COUNT] = {
        [CL_ARRAY_SETTINGS] = SOURCE(s, 1),
        [CL_ARRAY_POSITIONS] = SOURCE(w->positions, s->position_count),
        [CL_ARRAY_NORMALS] = SOURCE(w->normals, s->normal_count),
        [CL_ARRAY_UVS] = SOURCE(w->uvs, s->uv_count),
        [CL_ARRAY_COLORS] = SOURCE(w->colors, s->color_count),
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
        [CL_ARRAY_SKY_SUMS] = SOURCE(w->sky_cdf, sky_cdf_length(w)),
        [CL_ARRAY_GUIDE_CELLS] =
            SOURCE(w->guide_cells, guide_cell_count(&s->guide)),
        [CL_ARRAY_GUIDE_SUMS] =
            SOURCE(w->guide_cdf, (size_t)s->guide.table_count * GUIDE_BINS),
        [CL_ARRAY_POINT_LIGHTS] = SOURCE(w->point_lights, s->point_light_count),
        [CL_ARRAY_DIRECTIONAL_LIGHTS] =
            SOURCE(w->directional_lights, s->directional_light_count),
        [CL_ARRAY_PROFILES] = SOURCE(w->profiles, s->profile_value_count),
        [CL_ARRAY_CAUSTIC_CELLS] =
            SOURCE(w->caustic_cells, s->caustic_cell_count),
        [CL_ARRAY_CAUSTIC_GROUPS] =
            SOURCE(w->caustic_groups, s->caustic_group_count),
        [CL_ARRAY_CAUSTIC_BINS] = SOURCE(w->caustic_bins, s->caustic_bin_count),
    };

    for (int i = 0; i < CL_ARRAY_COUNT; i++) {
        uint64_t version = host->versions[parts[i]];

        if (c->buffers[i] != NULL && i != CL_ARRAY_SETTINGS &&
            c->versions[i] == version)
            continue;
        if (!upload(c, m, (enum cl_array)i, sources[i], err))
            return false;
        c->versions[i] = version;
        (*upload_count)++;
    }
    return true;
}

void cl_world_free(struct cl_world *c, const struct cl_machine *m)
{
    for (int i = 0; i < CL_ARRAY_COUNT; i++)
        cl_machine_drop(m, &c->buffers[i]);
    *c = (struct cl_world){0};
}
