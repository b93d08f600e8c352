// SPDX-License-Identifier: MIT
/*
 * faces.h - reads the f statements of OBJ text
 *
 * Ownership: triangles go to the scene
 * Threads:   one thread
 * Errors:    memory; a face that cannot be used is a warning
 */
#ifndef GLIM_FACES_H
#define GLIM_FACES_H

#include "base/lexer.h"
#include "formats/face_tris.h"

/* Reads the rest of an f statement and adds its triangles. A face with a bad
 * index is dropped and reported, like those that face_tris_add() drops. */
bool faces_read(struct face_tris *faces, struct lexer *lex, uint32_t object,
                uint32_t material, struct error *err);

#endif
