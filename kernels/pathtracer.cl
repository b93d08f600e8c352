// SPDX-License-Identifier: MIT
/*
 * pathtracer.cl - traces the paths of a task, one work-item a path
 */
#include "kernels/simd_cl.h"

#include "kernels/traverse.h"

#include "kernels/path.h"
#include "kernels/cl_task.h"

/* The result of a path that was not traced has 0 rays. `surfaces` is NULL if
 * the samples have no first surfaces, as are those of the film. */
__kernel void trace_paths(
    struct task task, volatile __global const uint *cancel,
    __global const struct camera_sample *starts,
    __global struct path_sample *samples,
    __global struct first_surface *surfaces,
    __global const struct settings *settings,
    __global const struct vec3 *positions, __global const struct vec3 *normals,
    __global const struct vec2 *uvs, __global const struct vec2 *uvs2,
    __global const struct vec3 *colors, __global const float *alphas,
    __global const struct tangent *tangents, __global const struct tri *tris,
    __global const struct instance *instances,
    __global const struct material *materials,
    __global const struct texture *textures, __global const uint *texels,
    __global const float *linear_of_srgb,
    __global const struct vec3 *sky_texels,
    __global const struct bvh8_node *nodes, __global const uint *roots,
    __global const struct light *lights, __global const uint *tri_lights,
    __global const struct light_node *light_nodes,
    __global const float *sky_cdf,
    __global const struct guide_cell *guide_cells,
    __global const float *guide_cdf,
    __global const struct point_light *point_lights,
    __global const struct directional_light *directional_lights,
    __global const float *profiles,
    __global const struct light_grid *light_grids,
    __global const struct light_cell *light_cells,
    __global const struct smoke_medium *smokes,
    __global const struct voxel_place *voxel_places,
    __global const float *voxels, __global const struct vec3 *glows)
{
    uint i = (uint)get_global_id(0);

    if (i / task.samples >= task.count)
        return;
    samples[i].rays = 0;
    if (*cancel == 0 && starts[i].ray.t_max > 0.0f) {
        struct world w = {*settings,
                          positions,
                          normals,
                          uvs,
                          uvs2,
                          colors,
                          alphas,
                          tangents,
                          tris,
                          instances,
                          materials,
                          textures,
                          texels,
                          linear_of_srgb,
                          sky_texels,
                          nodes,
                          roots,
                          lights,
                          tri_lights,
                          light_nodes,
                          sky_cdf,
                          guide_cells,
                          guide_cdf,
                          point_lights,
                          directional_lights,
                          profiles,
                          light_grids,
                          light_cells,
                          smokes,
                          voxel_places,
                          voxels,
                          glows};

        struct first_surface surface;

        samples[i] = path_trace(&w, starts[i], &surface);
        if (has_first_surface(&w))
            surfaces[i] = surface;
    }
}
