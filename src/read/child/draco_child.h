// SPDX-License-Identifier: MIT
/*
 * draco_child.h - unpacks meshes of glTF with libdraco, in a copy of the
 * program
 *
 * Threads:   one
 * Errors:    sent as a line; the limits end the process by a signal
 */
#ifndef GLIM_DRACO_CHILD_H
#define GLIM_DRACO_CHILD_H

#include <stdbool.h>
#include <stdio.h>

#include "base/library_child.h"

/* Answers the requests of standard input (read/gltf/draco_stream.h), or returns
 * false and sends the message. */
bool draco_child(struct library_limits limits, FILE *to);

#endif
