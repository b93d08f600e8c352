// SPDX-License-Identifier: MIT
/*
 * import_stream.h - a scene as the child that reads it with libassimp sends it
 *
 * The head is followed by the arrays in this order, packed, in the byte order
 * of the machine:
 *
 *     positions   3 doubles for each vertex
 *     normals     3 floats for each vertex, with IMPORT_HAS_NORMALS; 0 if
 *                 its mesh has none
 *     uvs         2 floats for each vertex, with IMPORT_HAS_UVS
 *     colors      3 floats for each vertex in sRGB, with IMPORT_HAS_COLORS
 *     tris        struct import_tri
 *     names       a text with a NUL for each object
 *     cameras     struct import_camera
 *     lamps       struct import_lamp
 *     images      for each a size as uint64_t, and the bytes of its file
 *     materials   MTL text; image 2 of model.fbx is model.fbx#image2
 *
 * Units:     those of the scene file
 * Ownership: everything that is read belongs to the scene
 * Threads:   one for each scene
 * Errors:    memory; a stream that is cut off, or whose indices are too large:
 *            the child that wrote it may have been in any state
 */
#ifndef GLIM_IMPORT_STREAM_H
#define GLIM_IMPORT_STREAM_H

#include "scene/scene.h"

#define IMPORT_MAGIC "glimscn2"

enum { IMPORT_HAS_NORMALS = 1, IMPORT_HAS_UVS = 2, IMPORT_HAS_COLORS = 4 };

struct import_head {
    char magic[8];
    uint32_t flags;
    uint32_t vertex_count;
    uint32_t tri_count;
    uint32_t object_count;
    uint32_t material_count;
    uint32_t image_count;
    uint32_t camera_count;
    uint32_t lamp_count;
    uint32_t skipped_count; /* lights of other kinds */
    uint32_t clamped_count; /* materials with an impossible roughness */
    uint64_t name_bytes;
    uint64_t material_bytes;
};

struct import_tri {
    uint32_t v[3];
    uint32_t material; /* from 0 */
    uint32_t object;   /* from 0 */
};

struct import_camera {
    char name[128];
    double eye[3], forward[3], up[3];
    double yfov; /* radians, from edge to edge */
};

struct import_lamp {
    uint32_t kind; /* enum lamp_kind */
    uint32_t padding;
    double position[3], forward[3], rgb[3];
    double inner, outer; /* radians from the axis, of spots */
};

/* Adds the contents of a stream to a zeroed scene, which the caller frees, also
 * after an error. */
bool import_stream_read(struct scene *scene, const char *bytes,
                        size_t size_bytes, const char *path,
                        struct warnings *report, struct error *err);

#endif
