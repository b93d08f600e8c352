// SPDX-License-Identifier: MIT
/*
 * gltf_draco.h - meshes that KHR_draco_mesh_compression has packed
 *
 * libdraco has C++ functions only, and has crashed on hostile bytes: a copy of
 * the program unpacks the meshes (read/child/draco_child.h). Each packed
 * primitive then becomes a plain one: its indices, and the attributes that were
 * packed, are those of new accessors and views.
 *
 * Ownership: the document owns the unpacked bytes
 * Threads:   one
 * Errors:    a build without libdraco; its messages, a crash, a limit
 */
#ifndef GLIM_GLTF_DRACO_H
#define GLIM_GLTF_DRACO_H

#include "read/gltf/gltf_packed.h"

#define GLTF_DRACO_NEEDS "libdraco-dev and g++ when glim is built"

/* Unpacks all packed primitives of the document; `program` is the program that
 * the copy runs. A build without libdraco takes the accessors that a file has
 * for readers without the extension. */
bool gltf_draco_unpack(struct gltf_document *document, const char *program,
                       struct error *err);

/* Makes plain primitives of the answers (draco_stream.h), whose bytes must
 * outlive the document. `failure` is the reason of answers that are cut off. */
bool gltf_draco_take(struct gltf_document *document, const char *answers,
                     size_t size_bytes, const char *failure, struct error *err);

/* Returns NULL if this build can unpack, else what is missing. */
const char *gltf_draco_missing(void);

#endif
