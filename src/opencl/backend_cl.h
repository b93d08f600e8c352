// SPDX-License-Identifier: MIT
/*
 * backend_cl.h - renders on an OpenCL device
 *
 * Ownership: see backend.h; *log is the caller's to free
 * Threads:   see backend.h
 * Errors:    no such device, kernels that do not compile: *log is what the
 *            compiler said then, else NULL; a device that fails in the middle
 *            makes pass() fail
 */
#ifndef GLIM_BACKEND_CL_H
#define GLIM_BACKEND_CL_H

#include <stdbool.h>
#include <stdint.h>

#include "render/backend.h"

struct cl_request {
    const char *program;      /* the copy to try first: cl_probe_run() */
    const char *device;       /* as cl_device_find() has it; NULL: the best */
    const char *kernels_path; /* folder, or NULL for those in the program */
    bool needs_gpu;           /* else any kind of device will do */
    uint32_t features;        /* what the kernels are built for */
};

/* Drivers have been seen to crash here: cl_probe() first. */
struct backend *backend_cl_create(const struct cl_request *request, char **log,
                                  struct error *err);

/* Builds kernels that leave out what a world without other features does not
 * need; the next begin() takes them, with the same bits. From any thread, also
 * while the backend renders, but not beside destroy(). */
bool backend_cl_specialise(struct backend *backend, uint32_t features,
                           char **log, struct error *err);

#endif
