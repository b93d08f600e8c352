// SPDX-License-Identifier: MIT
/*
 * batch_handle.h - a handle of libglim from the options
 *
 * Ownership: glim_close() frees a handle
 * Threads:   main only
 * Errors:    those of libglim; files that the scene is read from
 */
#ifndef GLIM_BATCH_HANDLE_H
#define GLIM_BATCH_HANDLE_H

#include "glim/glim.h"

#include "session/command_line.h"

/* Copies the library's error. Returns false. */
bool batch_fail_as(struct error *err, const struct glim_error *why);

/* Opens the scene, applies the options of the picture and prints the warnings
 * about its files. Returns NULL on errors. */
struct glim *batch_handle_open(const struct options *o, struct error *err);

/* Fails if the file of the option is one that the scene was read from. */
bool batch_handle_spares(const struct glim *g, const char *option,
                         const char *path, struct error *err);

/* Brings up the device that the options want. If it fails, the CPU renders,
 * unless the options name the device. A missing GPU is not reported if glim
 * chooses. */
bool batch_handle_use_device(struct glim *g, const struct options *o,
                             struct error *err);

#endif
