// SPDX-License-Identifier: MIT
/*
 * gltf_buffer.h - the bytes of a glTF document: buffers, their views, and files
 *
 * Units:     bytes
 * Ownership: buffers and views are the document's
 * Threads:   one
 * Errors:    a file that cannot be read, bytes that are too short or too many,
 * what cannot be unpacked or is too large for its packed bytes
 */
#ifndef GLIM_GLTF_BUFFER_H
#define GLIM_GLTF_BUFFER_H

#include "read/gltf/gltf_document.h"
#include "read/gltf/gltf_value.h"

/* ---- EXT_meshopt_compression ---- */

/* Unpacks the view of this extension object. */
bool gltf_meshopt_unpack(const struct gltf_value *extension,
                         struct gltf_view *view, struct error *err);

/* ---- buffers ---- */

/* Read the arrays "buffers" and "bufferViews" of the document. */
bool gltf_buffers_read(struct gltf_document *document, struct error *err);
bool gltf_views_read(struct gltf_document *document, struct error *err);

/* Reads the data of a URI that holds them: base64 or percent-encoded.
 * to->owned is for free(). `value` has the URI and is the place of failures. */
bool gltf_uri_read(const struct gltf_value *value, const char *uri,
                   struct gltf_bytes *to, struct error *err);

/* Finds the bytes that the members buffer, byteOffset and byteLength name. */
bool gltf_buffer_part(const struct gltf_value *value, struct gltf_bytes *to,
                      struct error *err);

/* Returns true for a URI that holds its data. */
bool gltf_uri_is_data(const char *uri);

/* Finds the file that a URI names, which is no data. *path is for free(). */
bool gltf_uri_find(const struct gltf_value *value, const char *uri, char **path,
                   struct error *err);

#endif
