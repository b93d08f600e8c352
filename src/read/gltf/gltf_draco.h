// SPDX-License-Identifier: MIT
/*
 * gltf_draco.h - meshes that KHR_draco_mesh_compression has packed
 *
 * libdraco has C++ functions only, and has crashed on hostile bytes: a copy of
 * the program unpacks the meshes (read/child/draco_child.h). Each packed
 * primitive then becomes a plain one: its indices, and the attributes that were
 * packed, are those of new accessors and views.
 *
 * Ownership: the document owns the unpacked bytes; gltf_packed_free() frees a
 * list Threads:   one Errors:    a build without libdraco; its messages, a
 * crash, a limit; views and attributes that are no numbers of the file
 */
#ifndef GLIM_GLTF_DRACO_H
#define GLIM_GLTF_DRACO_H

#include "read/gltf/draco_stream.h"
#include "read/gltf/gltf_value.h"

/* ---- packed primitives ---- */

#define GLTF_DRACO "KHR_draco_mesh_compression"

/* A primitive that is packed. */
struct gltf_packed {
    const struct gltf_value *primitive;
    struct gltf_value attributes; /* of the primitive: numbers of accessors */
    struct gltf_value extension;
    struct gltf_value ids; /* of the extension: numbers of Draco's attributes */
};

/* An attribute of packed bytes that a primitive wants. */
struct gltf_packed_part {
    uint32_t request, id;
    uint32_t view; /* of what was unpacked */
    struct draco_attribute attribute;
};

/* Packed bytes, which are unpacked once however many primitives show them. */
struct gltf_packed_request {
    uint32_t view; /* of the packed bytes */
    uint32_t first_part, part_count;
    uint32_t vertex_count, tri_count;
    uint32_t index_view; /* of what was unpacked */
};

struct gltf_packed_list {
    uint32_t *view_requests; /* of each view: the request, or NO_INDEX */
    /* in the order of the primitives that show them first */
    struct gltf_packed_request *requests;
    uint32_t request_count;
    size_t request_capacity;
    struct gltf_packed_part *parts; /* by request and id */
    size_t part_count, part_capacity;
};

/* Calls a function for each packed primitive with faces, in the order of the
 * file, until it fails. */
typedef bool gltf_packed_take(void *context, const struct gltf_packed *p,
                              struct error *err);
bool gltf_packed_visit(const struct gltf_document *document,
                       gltf_packed_take *take, void *context,
                       struct error *err);

/* Returns true if the primitive has the attribute of this name, too. */
bool gltf_packed_wants(const struct gltf_packed *p, const char *name);

/* Lists what has to be unpacked. */
bool gltf_packed_read(const struct gltf_document *document,
                      struct gltf_packed_list *list, struct error *err);

/* Returns the request for the bytes of a primitive that was listed. */
struct gltf_packed_request *
gltf_packed_request_of(const struct gltf_packed_list *list,
                       const struct gltf_packed *p);

/* Returns an attribute of a request, by Draco's number. */
const struct gltf_packed_part *
gltf_packed_find(const struct gltf_packed_list *list,
                 const struct gltf_packed_request *request, uint32_t id);

void gltf_packed_free(struct gltf_packed_list *list);

/* ---- unpacking ---- */

/*
 * libdraco has C++ functions only, and has crashed on hostile bytes: a copy of
 * the program unpacks the meshes (read/child/draco_child.h). Each packed
 * primitive then becomes a plain one: its indices, and the attributes that were
 * packed, are those of new accessors and views.
 */

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
