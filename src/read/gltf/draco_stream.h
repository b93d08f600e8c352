// SPDX-License-Identifier: MIT
/*
 * draco_stream.h - what goes to a copy of the program that unpacks meshes with
 * libdraco, and what comes back
 *
 * For each mesh the copy reads a struct draco_request, its attributes' numbers
 * as uint32_t, and the packed bytes. It writes a struct draco_answer; for each
 * requested attribute a struct draco_attribute and the elements of all
 * vertices, filled up to a multiple of 4 bytes; and three vertices as uint32_t
 * for each triangle. Everything is in the byte order of the machine. A mesh
 * that cannot be unpacked ends the answers.
 *
 * This header is C and C++.
 *
 * Units:     bytes
 */
#ifndef GLIM_DRACO_STREAM_H
#define GLIM_DRACO_STREAM_H

#include <stdint.h>

struct draco_request {
    uint64_t size_bytes;
    uint32_t attribute_count;
    uint32_t padding;
};

struct draco_answer {
    char failure[120]; /* "": the mesh follows */
    uint32_t vertex_count, tri_count;
};

struct draco_attribute {
    uint32_t component; /* enum gltf_component */
    uint32_t component_count;
};

#endif
