// SPDX-License-Identifier: MIT
/*
 * texture_table.h - the textures of a scene while materials are read: each
 * image with its options is listed once, under each of its paths
 *
 * Units:     degrees
 * Ownership: texture_table_free() frees the table; the scene keeps textures
 * Threads:   one thread
 * Errors:    memory
 */
#ifndef GLIM_TEXTURE_TABLE_H
#define GLIM_TEXTURE_TABLE_H

#include "base/name_table.h"
#include "scene/scene.h"

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

#endif
