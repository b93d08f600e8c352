// SPDX-License-Identifier: MIT
/*
 * world.h - the arrays that the kernels read, made from a scene and the sky of
 * its view
 *
 * struct host_world owns all arrays that are computed from the scene's files:
 * materials with their textures, lights, the sky's image and table, the path
 * guide, the tree. struct world of kernels/types.h points to these arrays and
 * to those of the scene ("is lent"). The list of all arrays is for those who
 * copy or hash them.
 *
 * Units:     file units in the view, normalised units in the world; bytes
 * Ownership: world_free() frees; a zeroed struct is an empty world. Lent arrays
 *            are valid until the next function that changes the world
 * Threads:   one thread changes a world, while nobody renders it. Only
 *            world_ensure_tree() may run while other threads read the rest
 * Errors:    impossible cameras; images; memory
 */
#ifndef GLIM_WORLD_H
#define GLIM_WORLD_H

#include <stdatomic.h>

#include "scene/scene.h"
#include "scene/view.h"
#include "world/bvh/bvh8.h"
#include "world/light/light_paths.h"
#include "world/light/lights.h"
#include "world/light/path_guide.h"
#include "world/light/sky_table.h"

/*
 * struct host_world owns all arrays that are computed from the scene's files:
 * materials with their textures, lights, the sky's image and table, the path
 * guide, the tree. struct world of kernels/types.h points to these arrays and
 * to those of the scene ("is lent").
 */

/* Parts of a world. The arrays of a part are built together and share a
 * version. */
enum world_part {
    WORLD_FIXED,     /* vertices and the sRGB curve: no edit changes them */
    WORLD_SHAPE,     /* corners of all triangles, of which trees are made */
    WORLD_TRIS,      /* triangles with their materials */
    WORLD_MATERIALS, /* materials and their sources */
    WORLD_TEXTURES,
    WORLD_TEXELS,
    WORLD_SKY,    /* image and table of the sky */
    WORLD_LIGHTS, /* area lights, point lights and their tree */
    WORLD_DIRECTIONAL_LIGHTS,
    WORLD_GUIDE,
    WORLD_SMOKES,
    WORLD_VOXELS, /* grids of smokes */
    WORLD_PARTS
};

struct host_world {
    /* size of world_pool(); 1 means the calling thread alone */
    int thread_count;

    /* Versions of the parts. Equal versions mean equal contents, also between
     * worlds of the process: no number is used twice, and 0 is none. */
    uint64_t versions[WORLD_PARTS];
    uint64_t generation; /* latest version: changes with every part */

    /* Triangles with the materials of assigned objects, or NULL if no object
     * was assigned a material: then the scene's triangles are used. */
    struct tri *tris;
    struct instance *instances; /* likewise, with their materials */
    /* for each object the assigned material, or NO_INDEX for that of the file;
     * NULL without tris */
    uint32_t *assigned;

    struct material *materials;
    struct material_values *sources; /* statements of the materials */
    bool *material_is_used;          /* true if a triangle uses the material */
    bool has_vertex_colors, has_vertex_alphas, has_tangents;
    bool has_instances;
    uint32_t material_count; /* materials of the scene and of edits */

    struct texture *textures; /* textures of the scene, with texels */
    uint32_t texture_count;   /* edits add some to the scene */
    bool *texture_is_tried;   /* loading was tried */
    uint32_t *texels;
    size_t texel_count;

    /* path of the sky image that loading was last tried for, or NULL; the sun
     * that replaces it */
    char *sky_path;
    struct sun sun;
    struct vec3 *sky_texels; /* NULL without an image */
    uint32_t sky_width, sky_height;
    struct sky_table sky_table;

    /* lamps of the view: point lights as they were given to `lights` */
    struct point_light *point_lights;
    uint32_t point_light_count;
    float *profiles; /* of all point lights */
    uint32_t profile_value_count;
    struct directional_light *directional_lights;
    uint32_t directional_light_count;

    /* world_smoke.c: grids of files, and the smokes of the view */
    struct world_grid *grids;
    uint32_t grid_count;
    struct voxel_place *voxel_places;
    float *voxels;
    uint32_t voxel_place_count, voxel_count;
    struct smoke_medium *smokes;
    struct vec3 *glows;
    uint32_t smoke_count, glow_count;

    struct lights lights;
    struct path_guide guide;
    struct light_paths light_paths;
    uint64_t light_paths_version; /* sum of those of the parts it is made of */
    double light_paths_sky;       /* mean radiance of its sky */

    struct bvh8 tree; /* tree of the triangles, valid if has_tree */
    atomic_bool has_tree;

    float linear_of_srgb[256];
};

/* Makes the world of a scene without edits, sky and lamps: reads textures and
 * builds lights. Missing images are warnings in the report. */
bool world_init(struct host_world *host, const struct scene *scene,
                int thread_count, struct warnings *report, struct error *err);

/* Loads the sky image that the view names, or makes that of its sun, or removes
 * the image if it has neither. After an error the previous image stays, and
 * world_has_sky() returns true nevertheless, so that it is not tried again. */
bool world_load_sky(struct host_world *host, const struct view *view,
                    struct warnings *report, struct error *err);

/* Returns true if loading was last tried for the view's sky image or sun. */
bool world_has_sky(const struct host_world *host, const struct view *view);

/* Builds the tables of light paths, and the path guide, which guides paths to
 * light that is hard to find, unless they are current for the world and the
 * view's sky. Builds the tree
 * first if the guide needs rays. Without the guide pictures have the same mean,
 * and more noise. */
bool world_guide(struct host_world *host, const struct scene *scene,
                 const struct view *view, struct error *err);

/* Starts a thread pool for work on the world. Each world has its own, because a
 * reload may build one world while another renders. Returns NULL if
 * thread_count is 1 or no thread can start; pool_each() and the builders of
 * trees then use the caller's thread. The caller destroys the pool. */
struct pool *world_pool(const struct host_world *host);

/* Builds the tree if there is none yet, and lends it to `world`, which is lent
 * from `host`. With pool NULL the caller's thread builds. Callable from any
 * thread. */
bool world_ensure_tree(struct host_world *host, struct world *world,
                       struct pool *pool, struct error *err);

/* Returns the tree, or NULL if it has not been built. Callable from any
 * thread. */
const struct bvh8 *world_tree(const struct host_world *host);

/* Frees the tree. */
void world_drop_tree(struct host_world *host);

/* Moves the tree, if there is one, and the version of the shape from a world
 * with the same shape. */
void world_take_shape(struct host_world *host, struct host_world *from);

/* Gives a part a new version, after its arrays have changed. */
void world_renew(struct host_world *host, enum world_part part);

/* Returns the material that the statements describe, with lengths in normalised
 * units. Its warnings were reported when the file was read. */
struct material world_material(const struct scene *scene,
                               const struct material_values *source);

/* Returns the triangles with the materials that are rendered. */
const struct tri *world_tris(const struct host_world *host,
                             const struct scene *scene);

/* Returns the instances with the materials that are rendered. */
const struct instance *world_instances(const struct host_world *host,
                                       const struct scene *scene);

/* Returns a world with the arrays and counts that do not depend on the view,
 * and the tree if it has been built. */
struct world world_arrays(const struct host_world *host,
                          const struct scene *scene);

/* Fills *world for a view: world_arrays(), camera, sky and settings. Returns
 * false for an impossible camera. */
bool world_lend(const struct host_world *host, const struct scene *scene,
                const struct view *view, uint32_t seed, struct world *world,
                struct error *err);

/* Returns the kernel features that the world needs, a set of features.h. */
uint64_t world_features(const struct host_world *host);

/* Returns the features that the fog of a view needs beside these. */
uint64_t view_features(const struct view *view);

/* Returns true if a used material emits light. */
bool world_has_emitters(const struct host_world *host);

void world_free(struct host_world *host);

/* ---- the list of arrays ---- */

/* The arrays in the order of the struct, with their lengths for a world *w and
 * its settings *s. Those of the tree, `nodes` and `roots`, have the lengths
 * that struct bvh8 says, `light_grids` and `light_cells` those of a pass. The
 * table of the sky has its whole length, even if the view does not use it. */
#define WORLD_LIST(X)                                                   \
    X(positions, s->position_count, WORLD_FIXED)                        \
    X(normals, s->normal_count, WORLD_FIXED)                            \
    X(uvs, s->uv_count, WORLD_FIXED)                                    \
    X(uvs2, s->uv2_count, WORLD_FIXED)                                  \
    X(colors, s->color_count, WORLD_FIXED)                              \
    X(alphas, s->alpha_count, WORLD_FIXED)                              \
    X(tangents, s->tangent_count, WORLD_FIXED)                          \
    X(tris, s->tri_count, WORLD_TRIS)                                   \
    X(instances, s->instance_count, WORLD_TRIS)                         \
    X(materials, s->material_count, WORLD_MATERIALS)                    \
    X(textures, s->texture_count, WORLD_TEXTURES)                       \
    X(texels, s->texel_count, WORLD_TEXELS)                             \
    X(linear_of_srgb, 256, WORLD_FIXED)                                 \
    X(sky_texels, (size_t)s->sky.width * s->sky.height, WORLD_SKY)      \
    X(nodes, 0, WORLD_SHAPE)                                            \
    X(roots, 0, WORLD_SHAPE)                                            \
    X(lights, s->light_count, WORLD_LIGHTS)                             \
    X(tri_lights, s->light_count > 0 ? s->tri_count : 0, WORLD_LIGHTS)  \
    X(light_nodes, s->light_node_count, WORLD_LIGHTS)                   \
    X(sky_cdf, sky_table_length(s->sky), WORLD_SKY)                     \
    X(guide_cells, guide_cell_count(&s->guide), WORLD_GUIDE)            \
    X(guide_cdf, (size_t)s->guide.table_count *GUIDE_BINS, WORLD_GUIDE) \
    X(point_lights, s->point_light_count, WORLD_LIGHTS)                 \
    X(directional_lights, s->directional_light_count,                   \
      WORLD_DIRECTIONAL_LIGHTS)                                         \
    X(profiles, s->profile_value_count, WORLD_LIGHTS)                   \
    X(light_grids, 0, WORLD_FIXED)                                      \
    X(light_cells, 0, WORLD_FIXED)                                      \
    X(smokes, s->smoke_count, WORLD_SMOKES)                             \
    X(voxel_places, s->voxel_place_count, WORLD_VOXELS)                 \
    X(voxels, s->voxel_count, WORLD_VOXELS)                             \
    X(glows, s->glow_count, WORLD_SMOKES)

#define WORLD_LIST_NAME(name, count, part) WORLD_LIST_##name,
enum world_list_index { WORLD_LIST(WORLD_LIST_NAME) WORLD_LIST_COUNT };
#undef WORLD_LIST_NAME

struct world_array {
    const void *data; /* may be NULL */
    size_t size_bytes;
    enum world_part part; /* whose version the array has */
};

/* Lists the arrays of a world. */
void world_list(const struct world *world,
                struct world_array list[WORLD_LIST_COUNT]);

/* Makes an array of the world point to these data. */
void world_list_set(struct world *world, enum world_list_index index,
                    const void *data);

#endif
