// SPDX-License-Identifier: MIT
/*
 * faces.h - reads the f statements of OBJ text and triangulates them
 *
 * Ownership: triangles go to the scene; faces_free() frees the rest
 * Threads:   one thread
 * Errors:    memory; a face that cannot be used is a warning
 */
#ifndef GLIM_FACES_H
#define GLIM_FACES_H

#include "base/lexer.h"
#include "scene/scene.h"
#include "formats/triangulate.h"

/* Indices of one corner, from 0; NO_INDEX if it has none. */
struct corner {
    uint32_t v, vt, vn;
};

/* Reader of faces. The caller sets the first three members and leaves the
 * others zero. */
struct faces {
    struct scene *scene;
    const char *path;
    struct warnings *report;
    uint32_t face_count; /* faces of the file so far, dropped ones included */
    struct corner *corners;
    double *points; /* 3 coordinates for each corner */
    size_t corner_capacity;
    uint32_t corner_count;
    struct polygon polygon;
    size_t tri_capacity;
};

/* Reads the rest of an f statement. A face with a bad index, with fewer than
 * three corners or with a vertex that is not finite is dropped and reported. */
bool faces_read(struct faces *faces, struct lexer *lex, uint32_t object,
                uint32_t material, struct error *err);

void faces_free(struct faces *faces);

#endif
