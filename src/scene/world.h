// SPDX-License-Identifier: MIT
/*
 * world.h - the arrays that are made of a scene and of its view's sky, and what
 * a sample reads of them
 *
 * struct host_world owns all that is not as the files have it: materials with
 * their textures, lights, the sky's image and table, the path guide, the tree.
 * struct world of kernels/types.h is lent from it and from the scene.
 *
 * Units:     the view's are the file's, the world's normalised
 * Ownership: world_free() frees; a zeroed struct is a world of nothing. What is
 *            lent is valid until the next function that changes the world
 * Threads:   one changes it, while nobody renders; world_need_tree() is the
 *            exception: one thread may call it while others read the rest
 * Errors:    impossible cameras; images; memory
 */
#ifndef GLIM_WORLD_H
#define GLIM_WORLD_H

#include <stdatomic.h>

#include "bvh/bvh8.h"
#include "light/lights.h"
#include "light/path_guide.h"
#include "light/sky_table.h"
#include "scene/scene.h"
#include "scene/view.h"

/* Arrays that are made together, and have a version together. */
enum world_part {
    WORLD_FIXED,     /* vertices and the sRGB curve: no edit changes them */
    WORLD_SHAPE,     /* corners of all triangles, of which trees are made */
    WORLD_TRIS,      /* triangles with their materials */
    WORLD_MATERIALS, /* and what they were made from */
    WORLD_TEXTURES,
    WORLD_TEXELS,
    WORLD_SKY, /* its image and table */
    WORLD_LIGHTS,
    WORLD_GUIDE,
    WORLD_PARTS
};

struct host_world {
    int thread_count; /* of pools that work on it; 1: the caller's thread */

    /* Equal versions are equal contents, in any world of the process: no number
     * comes twice, and 0 is none. */
    uint64_t versions[WORLD_PARTS];
    uint64_t generation; /* the last of them: another after any change */

    /* NULL: the scene's triangles, no object has another material */
    struct tri *tris;
    uint32_t *assigned; /* its material for each object, or NO_INDEX: the
                           file's; NULL without tris */

    struct material *materials;
    struct mtl_source *sources; /* of the materials */
    bool *material_is_used;     /* by a triangle */
    uint32_t material_count;    /* the scene's, and those of edits */

    struct texture *textures; /* the scene's, with texels */
    bool *texture_is_tried;   /* its image was looked for */
    uint32_t *texels;
    size_t texel_count;

    char *sky_path; /* of the image that was looked for last; NULL: none */
    struct vec3 *sky_texels; /* NULL: no image */
    uint32_t sky_width, sky_height;
    struct sky_table sky_table;

    struct lights lights;
    struct path_guide guide;

    struct bvh8 tree; /* of the triangles, if has_tree */
    atomic_bool has_tree;

    float linear_of_srgb[256];
};

/* Makes the world as the files have it, without a sky: reads textures, finds
 * lights. What is missing is in the report. */
bool world_init(struct host_world *host, const struct scene *scene,
                int thread_count, struct warnings *report, struct error *err);

/* Loads the image of the view's sky, or removes it if there is none. After an
 * error the image before stays; world_has_sky() is true nevertheless. */
bool world_load_sky(struct host_world *host, const struct view *view,
                    struct warnings *report, struct error *err);

/* Returns true if the image of the view's sky was the last to be looked for. */
bool world_has_sky(const struct host_world *host, const struct view *view);

/* Makes the table that leads paths to light that is hard to find, if there is
 * none yet for the world as it is and the view's sky. Without it pictures are
 * as bright, and noisier. Builds the tree for it if there is none yet. */
bool world_guide(struct host_world *host, const struct scene *scene,
                 const struct view *view, struct error *err);

/* Starts the threads for some work on the world: a reload may go on while the
 * world before it renders, so each world has its own. Returns NULL, for which
 * pool_each() and the builders of trees take the caller's thread, if it is to
 * have one thread or no other can start. The caller destroys it. */
struct pool *world_pool(const struct host_world *host);

/* Builds the tree of the triangles of `world`, which was lent from this one, if
 * there is none yet. Without a pool the caller's thread builds. */
bool world_need_tree(struct host_world *host, const struct world *world,
                     struct pool *pool, struct error *err);

/* NULL: nobody has needed it yet. From any thread. */
const struct bvh8 *world_tree(const struct host_world *host);

void world_drop_tree(struct host_world *host);

/* For a world with the shape of another: takes the version of that and the
 * tree, if it has one. */
void world_take_shape(struct host_world *host, struct host_world *from);

/* The arrays of this part are others now. */
void world_renew(struct host_world *host, enum world_part part);

const struct tri *world_tris(const struct host_world *host,
                             const struct scene *scene);

/* The part of a world that no view changes. */
struct world world_arrays(const struct host_world *host,
                          const struct scene *scene);

/* Lends all of *world but nodes and leaf_tris. False for an impossible camera.
 */
bool world_lend(const struct host_world *host, const struct scene *scene,
                const struct view *view, uint32_t seed, struct world *world,
                struct error *err);

/* Enum feature, or-ed: what samples of this world need. */
uint32_t world_features(const struct host_world *host);

/* True if one of the used materials shines. */
bool world_has_emitters(const struct host_world *host);

void world_free(struct host_world *host);

/* Sets eye and at so that the whole scene is seen, keeping fovy, size and up.
 */
void scene_frame(const struct scene *scene, struct view *view);

#endif
