// SPDX-License-Identifier: MIT
/*
 * cl_probe.h - tests a device in a copy of the program
 *
 * Drivers may crash: on a missing linker, a damaged cache, an unknown
 * processor. So a copy of the program first builds the kernels and runs the
 * self-test. Good results are cached beside PoCL's compiled kernels.
 *
 * Ownership: cl_probe_free() frees the texts
 * Threads:   any
 * Errors:    a crash, a failed self-test, errors of backend_cl_create()
 */
#ifndef GLIM_CL_PROBE_H
#define GLIM_CL_PROBE_H

#include <stdatomic.h>
#include <stdbool.h>

#include "opencl/backend_cl.h"

struct cl_probe {
    char *device;  /* device that was tested: name and driver */
    char *verdict; /* result of the self-test */
    char *log;     /* other output of the copy, mostly compiler messages */
};

/* Runs the copy: the request's program with --probe. It is killed when
 * *is_unwanted becomes true. After a failure only the log is set. */
bool cl_probe_run(struct cl_probe *probe, const struct cl_request *request,
                  const atomic_bool *is_unwanted, struct error *err);

/* Runs the test, in the copy, which prints the log, and then the device and the
 * verdict as its last lines, or the error. After a failure only the log is
 * set. */
bool cl_probe_answer(struct cl_probe *probe, const struct cl_request *request,
                     struct error *err);

/* Returns the cached result of such a request; false if there is none. The
 * device may have another driver by now. */
bool cl_probe_recall(struct cl_probe *probe, const struct cl_request *request);

/* Returns "NAME, DRIVER" for comparison with probe->device, for free(), or
 * NULL. */
char *cl_probe_device(const struct backend *backend);

void cl_probe_free(struct cl_probe *probe);

#endif
