// SPDX-License-Identifier: MIT
/*
 * gltf_document.h - the JSON and the bytes of a glTF 2.0 file
 *
 * Reads .gltf and .glb, the buffers that they name or contain, and the views
 * of these, also those that EXT_meshopt_compression has packed.
 *
 * Units:     bytes
 * Ownership: gltf_document_close() frees everything; the file's own bytes are
 *            the caller's and must outlive the document
 * Threads:   one opens and closes, any may read
 * Errors:    the place in the JSON, what was found and expected
 */
#ifndef GLIM_GLTF_DOCUMENT_H
#define GLIM_GLTF_DOCUMENT_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/warnings.h"

/* A buffer, or a part of one. */
struct gltf_bytes {
    const unsigned char *bytes;
    size_t size_bytes;
    void *owned; /* NULL: the bytes belong to another */
};

/* A file that buffers name. */
struct gltf_file {
    struct file_identity identity;
    char *path;
    struct gltf_bytes data;
};

/* bufferView */
struct gltf_view {
    struct gltf_bytes data;
    size_t stride_bytes; /* 0: elements follow each other */
};

struct gltf_document {
    const char *path;
    json_t *root;
    struct gltf_bytes chunk;      /* BIN of a .glb file; empty without */
    struct memory_budget *memory; /* of the scene; NULL: without a limit */
    struct gltf_bytes *buffers;
    size_t buffer_count;
    struct gltf_file *files;
    size_t file_count;
    uint64_t buffer_bytes; /* of all buffers */
    struct gltf_view *views;
    size_t view_count;
    void *unpacked; /* bytes of some views: gltf_draco.h */
};

/* Returns true if the bytes begin a .glb file or a text of JSON. */
bool gltf_matches(const char *bytes, size_t size_bytes);

/* Opens the file of these bytes. Refuses versions other than 2, and unknown
 * extensions that it requires; those that it only uses are a warning. The
 * document must be zeroed, except for its memory, and is to be closed also
 * after a failure. */
bool gltf_document_open(struct gltf_document *document, const char *bytes,
                        size_t size_bytes, const char *path,
                        struct warnings *report, struct error *err);
void gltf_document_close(struct gltf_document *document);

#endif
