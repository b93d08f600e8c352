// SPDX-License-Identifier: MIT
/*
 * scene_lists.h - adds materials, textures and colours of vertices to the lists
 * of a scene
 *
 * The caller keeps the capacity of each list, which is that of its parallel
 * arrays; at first it is the list's count. While materials are read, each image
 * with its options is listed once, under each of its paths. Red, green and blue
 * of vertices are sRGB. In OBJ files they are from 0 to 1, or to 255 if one of
 * the file is above 1, and vertices without a colour are white.
 *
 * Units:     degrees; linear Rec.709 in the scene
 * Ownership: names and paths are copied for the scene, which keeps textures and
 *            colours; texture_table_free() frees the table
 * Threads:   one for each scene
 * Errors:    false when memory is out
 */
#ifndef GLIM_SCENE_LISTS_H
#define GLIM_SCENE_LISTS_H

#include "base/name_table.h"
#include "scene/scene.h"

/* ---- materials and textures ---- */

bool scene_add_material(struct scene *scene, size_t *capacity, const char *name,
                        const struct material *material,
                        const struct material_origin *origin);

bool scene_add_texture(struct scene *scene, size_t *capacity, const char *path,
                       const struct texture *texture,
                       const struct texture_origin *origin);

/* ---- tables of textures ---- */

struct texture_table {
    struct scene *scene;
    struct name_table names;  /* with the numbers of the scene's textures */
    struct name_table images; /* files, or paths of images that are no file */
    size_t capacity;
};

/* Begins a table with the textures that the scene has. Returns false when
 * memory is out; texture_table_free() may be called then. */
bool texture_table_init(struct texture_table *table, struct scene *scene);

/* Returns the number of the texture with this path and these options; adds one
 * without texels if it is new. The table sets the image of its origin. NO_INDEX
 * when memory is out. */
uint32_t texture_table_add(struct texture_table *table, const char *path,
                           const struct texture *texture,
                           const struct texture_origin *origin);

void texture_table_free(struct texture_table *table);

/* Returns the options of a texture without any. */
struct texture texture_default(void);

/* Sets the rotation. An angle that is not finite has no effect. */
void texture_rotate(struct texture *texture, double angle_deg);

/* ---- colours of vertices ---- */

/*
 * Red, green and blue are sRGB. In OBJ files they are from 0 to 1, or to 255 if
 * one of the file is above 1, and vertices without a colour are white.
 */

/* Sets the colour of the scene's last vertex. *capacity counts items of the
 * array; it is 0 at first. */
bool vertex_colors_put(struct scene *scene, size_t *capacity,
                       const double rgb[3]);

/* Sets the colour of vertex `index`, which the scene has. */
bool vertex_colors_set(struct scene *scene, size_t *capacity, uint32_t index,
                       const double rgb[3]);

/* Gives the other vertices a colour, and decodes all. */
bool vertex_colors_finish(struct scene *scene, size_t *capacity);

/* Returns the colour with 0 for numbers that are none and for those below 0. */
struct vec3 vertex_color_encoded(const double rgb[3]);

/* Returns 255 if a number is above 1, else 1. */
float vertex_colors_white(const struct vec3 *colors, size_t count);

/* Decodes sRGB colours, of which `white` is the largest number. */
void vertex_colors_decode(struct vec3 *colors, size_t count, float white);

#endif
