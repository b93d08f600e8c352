// SPDX-License-Identifier: MIT
/*
 * backends.h - the backends of a session: the CPU, always, and an OpenCL
 * device when it is up
 *
 * Ownership: backends_close() frees, after the render has let go of them
 * Threads:   main only
 * Errors:    why there is no device; nothing else fails
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
    struct backend *device; /* NULL: not up */
    struct cl_start *start; /* NULL: not on its way */
    char *verdict;          /* of the device's self-test */
    uint32_t features;      /* that it has kernels for, or will have */
};

bool backends_open(struct backends *m, const struct options *options,
                   struct error *err);

/* Begins to bring the device of the options up, with kernels for these
 * features. */
bool backends_begin_device(struct backends *m, uint32_t features,
                           struct error *err);

/* Waits until it is up. *log, for free(), is what drivers said, or NULL. */
bool backends_end_device(struct backends *m, char **log, struct error *err);

/* Begins to build kernels for just these features, for a device that is up.
 * The next picture is made with them. Without them nothing is missing, so
 * nothing is said. */
void backends_specialise(struct backends *m, uint32_t features);

/* If the start that is over is that of backends_specialise(): ends it. */
bool backends_end_specialising(struct backends *m);

/* Nobody wants it any more. */
void backends_abandon_device(struct backends *m);

void backends_close(struct backends *m);

#endif
