// SPDX-License-Identifier: MIT
/*
 * draco_decode.h - unpacks meshes with libdraco
 *
 * libdraco has C++ functions only: draco_decode.cc is the one file in C++. A
 * program built without libdraco or a C++ compiler has draco_decode_none.c.
 *
 * Threads:   one
 * Errors:    those of libdraco are answers
 */
#ifndef GLIM_DRACO_DECODE_H
#define GLIM_DRACO_DECODE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Answers requests (read/gltf/draco_stream.h) up to the first that fails.
 * Returns false, after a line that says why, if this build cannot. */
bool draco_decode(const char *requests, size_t size_bytes, FILE *to);

#ifdef __cplusplus
}
#endif

#endif
