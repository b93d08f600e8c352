// SPDX-License-Identifier: MIT
/*
 * gltf_extensions.h - the extensions of glTF that glim knows
 *
 * Threads:   any
 * Errors:    an unknown extension that the file requires
 */
#ifndef GLIM_GLTF_EXTENSIONS_H
#define GLIM_GLTF_EXTENSIONS_H

#include "gltf/gltf_document.h"

/* Refuses unknown extensions that are required. Those that are only used are a
 * warning. */
bool gltf_extensions_check(const struct gltf_document *document,
                           struct warnings *report, struct error *err);

#endif
