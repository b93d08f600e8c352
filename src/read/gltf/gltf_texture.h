// SPDX-License-Identifier: MIT
/*
 * gltf_texture.h - the textures that materials of a glTF document name
 *
 * An image that the document contains is listed in the scene as
 * "model.glb#image3". Each is there once, however many textures show it.
 *
 * Ownership: gltf_textures_end() frees the reader; textures and images are the
 *            scene's
 * Threads:   one for each scene
 * Errors:    memory; the place in the document. Images that glim cannot read
 *            are a warning, and their textures are absent
 */
#ifndef GLIM_GLTF_TEXTURE_H
#define GLIM_GLTF_TEXTURE_H

#include "read/gltf/gltf_value.h"
#include "read/scene_lists.h"

/* Textures of KTX2 images, which no library of Debian 12 decodes. */
#define GLTF_BASISU "KHR_texture_basisu"
#define GLTF_BASISU_EXPECTED                                                 \
    "PNG, JPEG or WebP: 'gltf-transform ktxdecompress IN OUT' converts its " \
    "KTX2 images"

struct gltf_textures {
    const struct gltf_document *document;
    struct scene *scene;
    struct warnings *report;
    struct texture_table table;
    char **paths;   /* of the images; NULL: not needed so far, or unusable */
    bool *is_tried; /* for each image */
    const char **view_paths; /* of the images that are views of a buffer */
    size_t image_count;
};

/* What a material reads from a texture. */
struct gltf_texture_use {
    const char *key;  /* of the member that names it: "normalTexture" */
    bool is_data;     /* not decoded from sRGB */
    uint32_t channel; /* enum texture_channel, of data */
    uint32_t flags;   /* enum texture_flag */
};

/* Begins with the textures of the scene. gltf_textures_end() may be called
 * after a failure. */
bool gltf_textures_begin(struct gltf_textures *textures,
                         const struct gltf_document *document,
                         struct scene *scene, struct warnings *report,
                         struct error *err);
void gltf_textures_end(struct gltf_textures *textures);

/* Reads the texture that a member of `object` names. *texture becomes NO_INDEX
 * if it is absent or unusable. *info is the member. */
bool gltf_texture_read(struct gltf_textures *textures,
                       const struct gltf_value *object,
                       struct gltf_texture_use use, uint32_t *texture,
                       struct gltf_value *info, struct error *err);

/* Returns true if each texture of the document has an image that is not only
 * in KTX2. */
bool gltf_textures_are_readable(const struct gltf_document *document);

#endif
