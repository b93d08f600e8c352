// SPDX-License-Identifier: MIT
/*
 * backends.h - the backends of an engine: the CPU, and an OpenCL device if one
 * is wanted and available
 *
 * Ownership: backends_close() frees, after the renderer has released them
 * Threads:   main only
 * Errors:    why there is no device
 */
#ifndef GLIM_BACKENDS_H
#define GLIM_BACKENDS_H

#include <stdbool.h>
#include <stdint.h>

#include "render/backend.h"
#include "opencl/cl_start.h"

struct backends {
    struct backend *cpu;
    struct backend *device; /* NULL if there is none */
    /* the device of this process, which is `device` or belongs to it */
    struct backend *raw_device;
    struct cl_start *start; /* NULL unless it is starting */
    char *verdict;          /* of the device's self-test */
    /* features that its kernels support, or will after the start */
    uint32_t features;
};

/* Creates the backend of the CPU, with the best kernel if `kernel` is NULL. */
bool backends_open(struct backends *b, const struct cpu_kernel *kernel,
                   int thread_count, struct error *err);

/* Starts the device of the request in the background. A running device only
 * gets new kernels. */
bool backends_begin_device(struct backends *b, const struct cl_request *request,
                           struct error *err);

/* Waits for the device. *log, for free(), is the output of drivers, or NULL. */
bool backends_end_device(struct backends *b, char **log, struct error *err);

/* Starts to build kernels for exactly the features of the request, for a
 * running device. The next picture uses them. A failure is not reported, since
 * general kernels exist. */
void backends_specialise(struct backends *b, const struct cl_request *request);

/* Completes a start that backends_specialise() began. Returns true if it
 * did. */
bool backends_end_specialising(struct backends *b);

/* Cancels a start. */
void backends_abandon_device(struct backends *b);

/* Destroys one of them, which the renderer does not use. */
void backends_drop_cpu(struct backends *b);
void backends_drop_device(struct backends *b);

void backends_close(struct backends *b);

#endif
