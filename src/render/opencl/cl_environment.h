// SPDX-License-Identifier: MIT
/*
 * cl_environment.h - the environment of OpenCL drivers: variables, signals,
 * cache
 *
 * Drivers run in glim's process: they read its environment, replace its signal
 * handlers and write to the user's cache folder. A process that has used a
 * driver must not fork without exec: the child would hang.
 *
 * Threads:   cl_environment_prepare() runs before other threads start; signal
 *            handlers belong to the process, so no other thread may set them
 *            between cl_signals_keep() and cl_signals_put_back()
 * Errors:    a cache folder that is not writable
 */
#ifndef GLIM_CL_ENVIRONMENT_H
#define GLIM_CL_ENVIRONMENT_H

#include <signal.h>
#include <stdbool.h>

#include "base/error.h"

/* Sets variables for PoCL: the number of threads (0: all available), the cache
 * folder, no handling of SIGFPE. The user's values of the first two have
 * priority. */
void cl_environment_prepare(int thread_count);

/* Creates PoCL's cache folder and its parents. PoCL has no device without
 * it. */
bool cl_cache_open(struct error *err);

#define CL_SIGNAL_COUNT 15

struct cl_signals {
    struct sigaction actions[CL_SIGNAL_COUNT];
};

/* Save and restore signal handlers around calls that start a driver's compiler
 * (device list, builds, first launches). LLVM replaces handlers, and PoCL's own
 * lets the program continue after a division by zero. */
void cl_signals_keep(struct cl_signals *s);
void cl_signals_put_back(const struct cl_signals *s);

#endif
