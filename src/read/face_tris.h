// SPDX-License-Identifier: MIT
/*
 * face_tris.h - makes triangles of the faces of a scene file
 *
 * Ownership: triangles go to the scene; face_tris_free() frees the rest
 * Threads:   one thread
 * Errors:    memory; a face that cannot be used is a warning
 */
#ifndef GLIM_FACE_TRIS_H
#define GLIM_FACE_TRIS_H

#include "read/triangulate.h"
#include "scene/scene.h"

/* Indices of one corner, from 0; NO_INDEX if it has none. */
struct corner {
    uint32_t v, vt, vn;
};

/* Place in a file: a line of a text, or a byte where `line` is 0. */
struct file_place {
    uint64_t line, byte;
};

/* ":12" or ": byte 12", for behind the path in a message. */
struct place_text {
    char text[32];
};
struct place_text file_place_text(struct file_place place);

/* Returns a texture coordinate of a file, reduced to its fraction if it is
 * large, since textures repeat. Coordinates that are not finite become 0. */
float texture_coordinate(double x);

/* The caller sets the first three members and leaves the others zero. */
struct face_tris {
    struct scene *scene;
    const char *path;
    struct warnings *report;
    uint32_t face_count; /* faces of the file so far, dropped ones included */
    /* of the next face; the caller writes the first `corner_count` of both */
    struct corner *corners;
    double *points; /* 3 coordinates for each corner */
    uint32_t corner_count;
    size_t corner_capacity;
    struct polygon polygon;
    size_t tri_capacity;
};

/* Makes room for `corners` and `points`. Returns false when memory is out. */
bool face_tris_reserve(struct face_tris *f, size_t corner_count);

/* Makes room for more triangles in the scene. */
bool face_tris_reserve_tris(struct face_tris *f, size_t more);

/* Adds the triangles of the face in `corners`, with the number `face_count`. A
 * face with fewer than three corners or with a vertex that is not finite is
 * dropped and reported. Returns false when memory is out. */
bool face_tris_add(struct face_tris *f, uint32_t object, uint32_t material,
                   struct file_place place);

/* Adds one triangle for each three corners, which are those of a face whose
 * vertices are finite. Returns false when memory is out. */
bool face_tris_add_triangles(struct face_tris *f, const struct corner *corners,
                             uint32_t count, uint32_t object,
                             uint32_t material);

void face_tris_free(struct face_tris *f);

#endif
