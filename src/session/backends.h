// SPDX-License-Identifier: MIT
/*
 * backends.h - the backends of a session: the CPU, always, and an OpenCL
 * device when it is up
 *
 * Units:     none
 * Ownership: machines_close() frees, after the render has let go of them
 * Threads:   main only
 * Errors:    why there is no device; nothing else fails
 */
#ifndef GLIM_BACKENDS_H
#define GLIM_BACKENDS_H

#include "render/backend.h"
#include "opencl/cl_start.h"
#include "session/command_line.h"

struct machines {
    const struct options *options;
    struct backend *cpu;
    struct backend *device; /* NULL: not up */
    struct cl_start *start; /* NULL: not on its way */
    char *verdict;          /* of the device's self-test */
    uint32_t features;      /* that it has kernels for, or will have */
};

bool machines_open(struct machines *m, const struct options *options,
                   struct error *err);

/* Begins to bring the device of the options up, with kernels for these
 * features. */
bool machines_begin_device(struct machines *m, uint32_t features,
                           struct error *err);

/* Waits until it is up. *log, for free(), is what drivers said, or NULL. */
bool machines_end_device(struct machines *m, char **log, struct error *err);

/* Begins to build kernels for just these features, for a device that is up.
 * The next picture is made with them. Without them nothing is missing, so
 * nothing is said. */
void machines_specialise(struct machines *m, uint32_t features);

/* If the start that is over is that of machines_specialise(): ends it. */
bool machines_end_specialising(struct machines *m);

/* Nobody wants it any more. */
void machines_abandon_device(struct machines *m);

void machines_close(struct machines *m);

#endif
