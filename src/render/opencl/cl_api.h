// SPDX-License-Identifier: MIT
/*
 * cl_api.h - the functions of OpenCL 1.2, loaded while the program runs, and
 * the environment of drivers: variables, signals, cache
 *
 * glim is not linked with libOpenCL, so it also starts without one. The types
 * of the functions are those of CL/cl.h. Drivers run in glim's process: they
 * read its environment, replace its signal handlers and write to the user's
 * cache folder. A process that has used a driver must not fork without exec:
 * the child would hang.
 *
 * Ownership: the table lives as long as the program
 * Threads:   any; OpenCL allows one thread at a time to set a kernel's
 *            arguments. cl_environment_prepare() runs before other threads
 *            start; signal handlers belong to the process, so no other thread
 *            may set them between cl_signals_keep() and cl_signals_put_back()
 * Errors:    cl_api_open() tells what is missing; cl_error_name() names codes;
 *            a cache folder that is not writable
 */
#ifndef GLIM_CL_API_H
#define GLIM_CL_API_H

#include <signal.h>
#include <stdbool.h>

#include "base/error.h"

/* ---- environment ---- */

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

/* ---- functions ---- */

/*
 * glim is not linked with libOpenCL, so it also starts without one. The types
 * of the functions are those of CL/cl.h.
 */

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <CL/cl_ext.h>

#include "base/error.h"

/* The functions that glim calls, without the prefix cl. */
#define CL_API_FUNCTIONS(X)    \
    X(GetPlatformIDs)          \
    X(GetPlatformInfo)         \
    X(GetDeviceIDs)            \
    X(GetDeviceInfo)           \
    X(CreateContext)           \
    X(ReleaseContext)          \
    X(CreateCommandQueue)      \
    X(ReleaseCommandQueue)     \
    X(CreateProgramWithSource) \
    X(BuildProgram)            \
    X(GetProgramBuildInfo)     \
    X(ReleaseProgram)          \
    X(CreateKernel)            \
    X(SetKernelArg)            \
    X(ReleaseKernel)           \
    X(CreateBuffer)            \
    X(ReleaseMemObject)        \
    X(EnqueueNDRangeKernel)    \
    X(EnqueueReadBuffer)       \
    X(EnqueueWriteBuffer)      \
    X(EnqueueReadBufferRect)   \
    X(EnqueueFillBuffer)       \
    X(WaitForEvents)           \
    X(GetEventInfo)            \
    X(ReleaseEvent)            \
    X(Flush)                   \
    X(Finish)

struct cl_api {
#define CL_API_MEMBER(name) __typeof__(cl##name) *name;
    CL_API_FUNCTIONS(CL_API_MEMBER)
#undef CL_API_MEMBER
};

/* Loads libOpenCL.so.1 at the first call. Returns NULL if the library or one of
 * the functions is missing. */
const struct cl_api *cl_api_open(struct error *err);

/* Returns the name of an error code, such as "CL_OUT_OF_RESOURCES" for -5. */
const char *cl_error_name(cl_int code);

#endif
