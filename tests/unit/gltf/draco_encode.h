// SPDX-License-Identifier: MIT
/*
 * draco_encode.h - packs meshes with libdraco for tests
 *
 * Units:     bytes
 * Ownership: draco_encode() returns memory for free()
 * Threads:   one
 */
#ifndef TESTS_DRACO_ENCODE_H
#define TESTS_DRACO_ENCODE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct draco_source_attribute {
    const char *name; /* of glTF */
    uint32_t id;      /* of Draco */
    uint32_t component;
    uint32_t component_count;
    bool is_normalized;
    const void *data;
};

struct draco_source {
    uint32_t vertex_count, tri_count, attribute_count;
    const uint32_t *indices;
    const struct draco_source_attribute *attributes;
    bool is_cloud; /* points without triangles */
    /* the order of vertices stays; else edgebreaker changes it */
    bool is_sequential;
};

#ifdef __cplusplus
extern "C" {
#endif

/* Packs without loss. Returns NULL if libdraco refuses. */
void *draco_encode(const struct draco_source *source, size_t *size_bytes);

#ifdef __cplusplus
}
#endif

#endif
