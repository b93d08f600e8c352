// SPDX-License-Identifier: MIT
/*
 * cl_start.h - starts an OpenCL device in the background, after a test in a
 * copy of the program
 *
 * Drivers may crash: on a missing linker, a damaged cache, an unknown
 * processor. So a copy of the program first builds the kernels and runs the
 * self-test: device and CPU both render a small room that has every material
 * which needs no further features. Good results are cached beside PoCL's
 * compiled kernels.
 *
 * Ownership: cl_start_end() and cl_probe_free() free; the backend that a start
 *            returns is the caller's; both backends of a self-test stay the
 *            caller's, with another scene loaded
 * Threads:   starts main only, their work runs in a thread of its own; probes
 *            any; a self-test one at a time
 * Errors:    a crash, a device that fails or whose picture differs, errors of
 *            backend_cl_create(); cl_start_end() tells why there is no device
 */
#ifndef GLIM_CL_START_H
#define GLIM_CL_START_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "render/backend.h"
#include "render/opencl/backend_cl.h"

/* ---- the self-test ---- */

/*
 * Both render a small room that has every material which needs no further
 * features.
 */

#define SELFTEST_VERDICT_BYTES 64

/* Runs the test. The verdict is "the CPU's bits", or the number of pixels with
 * small differences. */
bool selftest_run(struct backend *cpu, struct backend *device,
                  uint64_t features, char verdict[SELFTEST_VERDICT_BYTES],
                  struct error *err);

/* ---- probes ---- */

/*
 * Drivers may crash: on a missing linker, a damaged cache, an unknown
 * processor. So a copy of the program first builds the kernels and runs the
 * self-test. Good results are cached beside PoCL's compiled kernels.
 */

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

/* ---- starts ---- */

struct cl_start;

/* Begins in the background. The texts of the request must stay until the end.
 * If `backend` is not NULL, it gets kernels for the request's features;
 * otherwise a backend is created. */
struct cl_start *cl_start_begin(const struct cl_request *request,
                                struct backend *backend, struct error *err);

/* Returns a descriptor that becomes readable when the work is done, with or
 * without success. */
int cl_start_event_fd(const struct cl_start *start);

/* Waits for the end. Returns the backend, or NULL after a failure. *verdict is
 * the self-test's, *log the output of a compiler or driver; both are for
 * free(), or NULL. */
struct backend *cl_start_end(struct cl_start *start, char **verdict, char **log,
                             struct error *err);

/* Cancels the start; a running copy of the program is killed. */
void cl_start_abandon(struct cl_start *start);

#endif
