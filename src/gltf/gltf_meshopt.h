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

#include "gltf/gltf_value.h"

/* Most bytes that a packed byte stands for: 2 bits for a group of 16 bytes. */
#define GLTF_MESHOPT_RATIO 64u

/* Unpacks the view of this extension object, to at most `limit` bytes. */
bool gltf_meshopt_unpack(const struct gltf_value *extension, uint64_t limit,
                         struct gltf_view *view, struct error *err);

#endif
