// SPDX-License-Identifier: MIT
/*
 * gltf_accessor.h - the elements of accessors as numbers
 *
 * Elements may be interleaved, normalised integers, or sparse: then some
 * replace those of the view, or zeros. All bounds are checked at opening.
 *
 * Ownership: the bytes are the document's
 * Threads:   any
 * Errors:    an accessor beyond its view, of another type, or of numbers that
 *            glTF does not have
 */
#ifndef GLIM_GLTF_ACCESSOR_H
#define GLIM_GLTF_ACCESSOR_H

#include "read/gltf/gltf_value.h"

/* componentType */
enum gltf_component {
    GLTF_I8 = 5120,
    GLTF_U8 = 5121,
    GLTF_I16 = 5122,
    GLTF_U16 = 5123,
    GLTF_U32 = 5125,
    GLTF_FLOAT = 5126
};

/* Elements of the same distance. */
struct gltf_elements {
    const unsigned char *bytes; /* NULL: all are zero */
    size_t stride_bytes;
    uint32_t component; /* enum gltf_component */
};

/* Returns the size of a number of this type; 0 for others than those above. */
static inline uint32_t gltf_component_bytes(uint64_t component)
{
    switch (component) {
    case GLTF_I8:
    case GLTF_U8: return 1;
    case GLTF_I16:
    case GLTF_U16: return 2;
    case GLTF_U32:
    case GLTF_FLOAT: return 4;
    default: return 0;
    }
}

struct gltf_accessor {
    uint32_t count;
    uint32_t component_count; /* 1 to 4, or those of a matrix */
    bool is_normalized;
    struct gltf_elements dense;
    /* the numbers, rising, of elements that replace those of `dense` */
    uint32_t sparse_count;
    struct gltf_elements sparse_indices, sparse_values;
};

/* Opens accessor `index` of the document. */
bool gltf_accessor_open(const struct gltf_document *document, uint32_t index,
                        struct gltf_accessor *a, struct error *err);

/* Read `count` elements from `first` on. Floats follow each other by
 * component_count; signed normalised integers are cut at -1. */
void gltf_accessor_floats(const struct gltf_accessor *a, uint32_t first,
                          uint32_t count, float *to);
void gltf_accessor_integers(const struct gltf_accessor *a, uint32_t first,
                            uint32_t count, uint32_t *to);

#endif
