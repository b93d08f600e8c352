// SPDX-License-Identifier: MIT
/*
 * cl_environment.h - what has to be set up around OpenCL drivers
 *
 * Drivers live in our process: they read its environment, take over its
 * signals and write to the person's cache folder. A process that has used a
 * driver must never fork without exec: the child would hang.
 *
 * Units:     threads
 * Threads:   cl_environment_prepare() before there are any; handlers belong to
 *            the whole process, so nobody else may set those that
 *            cl_signals_put_back() puts back in between
 * Errors:    a cache folder that cannot be written to
 */
#ifndef GLIM_CL_ENVIRONMENT_H
#define GLIM_CL_ENVIRONMENT_H

#include <signal.h>
#include <stdbool.h>

#include "base/error.h"

/* Tells PoCL how many threads it may use (0: what the process may use), where
 * to keep what it compiles, and to leave SIGFPE alone. The first two are the
 * person's where the environment has them. */
void cl_environment_prepare(int thread_count);

/* Makes PoCL's cache folder with those above it. Without one it has no
 * device. */
bool cl_cache_open(struct error *err);

#define CL_SIGNAL_COUNT 15

struct cl_signals {
    struct sigaction actions[CL_SIGNAL_COUNT];
};

/* Around calls that start a driver's compiler (the list of devices, builds,
 * first launches): LLVM puts its handlers over ours, and PoCL one that lets
 * the whole program go on after a division by zero. */
void cl_signals_keep(struct cl_signals *s);
void cl_signals_put_back(const struct cl_signals *s);

#endif
