// SPDX-License-Identifier: MIT
/*
 * cl_probe.h - does the driver survive us, and compute what the CPU computes?
 *
 * Drivers crash: on a missing linker, a damaged cache, a processor they do not
 * know. So a copy of the program tries first what we are about to do, and runs
 * the self-test. What it finds is remembered beside PoCL's compiled kernels.
 *
 * Ownership: cl_probe_free() frees the texts
 * Threads:   any
 * Errors:    a crash, a failed self-test, what backend_cl_create() says
 */
#ifndef GLIM_CL_PROBE_H
#define GLIM_CL_PROBE_H

#include <stdatomic.h>
#include <stdbool.h>

#include "opencl/backend_cl.h"

struct cl_probe {
    char *device;  /* that was tried: name and driver */
    char *verdict; /* of the self-test */
    char *log;     /* what else the copy printed, compilers' messages mostly */
};

/* Runs the copy: this program with --probe. It is killed when *is_unwanted
 * becomes true. After a failure there is only the log. */
bool cl_probe_run(struct cl_probe *probe, const struct cl_request *request,
                  const atomic_bool *is_unwanted, struct error *err);

/* What the copy does: prints the device and the verdict as its last lines. A
 * failure prints the log, its error is for the last line of stderr. */
bool cl_probe_answer(const struct cl_request *request, struct error *err);

/* What cl_probe_run() found earlier for such a request; false if nothing. The
 * device may have another driver by now. */
bool cl_probe_recall(struct cl_probe *probe, const struct cl_request *request);

/* "NAME, DRIVER" for comparing with what was tried, for free(). */
char *cl_probe_device(const struct backend *backend);

void cl_probe_free(struct cl_probe *probe);

#endif
