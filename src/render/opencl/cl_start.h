// SPDX-License-Identifier: MIT
/*
 * cl_start.h - starts an OpenCL device in the background
 *
 * Ownership: cl_start_end() frees; the backend that it returns is the caller's
 * Threads:   main only; the work runs in a thread of its own
 * Errors:    cl_start_end() tells why there is no device
 */
#ifndef GLIM_CL_START_H
#define GLIM_CL_START_H

#include "render/opencl/backend_cl.h"

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
