// SPDX-License-Identifier: MIT
/*
 * backends.h - the backends of a session: the CPU, and an OpenCL device if one
 * is available
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
#include "session/command_line.h"

struct backends {
    const struct options *options;
    struct backend *cpu;
    struct backend *device; /* NULL if there is none */
    /* the device of this process, which is `device` or belongs to it */
    struct backend *raw_device;
    struct cl_start *start; /* NULL unless it is starting */
    char *verdict;          /* of the device's self-test */
    uint32_t features; /* features that its kernels support, or will after the
                          start */
};

bool backends_open(struct backends *m, const struct options *options,
                   struct error *err);

/* Starts the selected device in the background, with kernels for these
 * features. */
bool backends_begin_device(struct backends *m, uint32_t features,
                           struct error *err);

/* Waits for the device. *log, for free(), is the output of drivers, or NULL. */
bool backends_end_device(struct backends *m, char **log, struct error *err);

/* Starts to build kernels for exactly these features, for a running device. The
 * next picture uses them. A failure is not reported, since general kernels
 * exist. */
void backends_specialise(struct backends *m, uint32_t features);

/* Completes a start that backends_specialise() began. Returns true if it
 * did. */
bool backends_end_specialising(struct backends *m);

/* Cancels a start. */
void backends_abandon_device(struct backends *m);

void backends_close(struct backends *m);

#endif
