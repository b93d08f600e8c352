// SPDX-License-Identifier: MIT
/*
 * gltf_meshopt.h - views that EXT_meshopt_compression has packed
 *
 * Units:     bytes
 * Ownership: the view owns its bytes
 * Threads:   any
 * Errors:    what cannot be unpacked, or is too large for its packed bytes
 */
#ifndef GLIM_GLTF_MESHOPT_H
#define GLIM_GLTF_MESHOPT_H

#include "read/gltf/gltf_value.h"

/* Unpacks the view of this extension object. */
bool gltf_meshopt_unpack(const struct gltf_value *extension,
                         struct gltf_view *view, struct error *err);

#endif
