// SPDX-License-Identifier: MIT
/*
 * backend_cl.h - renders on an OpenCL device
 *
 * Ownership: see backend.h; the caller frees *log
 * Threads:   see backend.h
 * Errors:    no such device; kernels that do not compile: *log is the output of
 *            the compiler then, otherwise NULL; pass() fails if the device does
 */
#ifndef GLIM_BACKEND_CL_H
#define GLIM_BACKEND_CL_H

#include <stdbool.h>
#include <stdint.h>

#include "render/backend.h"

struct cl_request {
    const char *program; /* path of the program that cl_probe_run() starts */
    /* name or number for cl_device_find(); NULL chooses the best */
    const char *device;
    /* folder of the kernels, or NULL for those built into the program */
    const char *kernels_path;
    bool needs_gpu;    /* fail if the device is not a GPU */
    uint64_t features; /* features that the kernels are built with */
};

/* Creates the backend. Returns NULL on errors. Some drivers crash here, so call
 * cl_probe() first. */
struct backend *backend_cl_create(const struct cl_request *request, char **log,
                                  struct error *err);

/* Builds kernels with only these features, for the next begin() to use; the
 * bits are the same. Callable from any thread, also while the backend renders,
 * but not during destroy(). */
bool backend_cl_specialise(struct backend *backend, uint64_t features,
                           char **log, struct error *err);

#endif
