// SPDX-License-Identifier: MIT
/*
 * cl_start.h - brings an OpenCL device up while something else goes on
 *
 * Ownership: cl_start_end() frees; the backend that it returns is the caller's
 * Threads:   main only; the work is done in a thread of its own
 * Errors:    cl_start_end() says why there is no device
 */
#ifndef GLIM_CL_START_H
#define GLIM_CL_START_H

#include "opencl/backend_cl.h"

struct cl_start;

/* Returns at once. The texts of the request must stay until the end. With a
 * backend it is this one that gets kernels for the request's features. */
struct cl_start *cl_start_begin(const struct cl_request *request,
                                struct backend *backend, struct error *err);

/* A descriptor that becomes readable when the device is up, or is not. */
int cl_start_event_fd(const struct cl_start *start);

/* Waits, and returns the backend, or NULL if nothing came of it. *verdict is
 * that of the self-test, *log what a compiler or a driver said; both for
 * free(), or NULL. */
struct backend *cl_start_end(struct cl_start *start, char **verdict, char **log,
                             struct error *err);

/* For those who no longer want it: what takes long is killed. */
void cl_start_abandon(struct cl_start *start);

#endif
