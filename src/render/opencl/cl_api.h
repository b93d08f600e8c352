// SPDX-License-Identifier: MIT
/*
 * cl_api.h - the functions of OpenCL 1.2, loaded while the program runs
 *
 * glim is not linked with libOpenCL, so it also starts without one. The types
 * of the functions are those of CL/cl.h.
 *
 * Ownership: the table lives as long as the program
 * Threads:   any; OpenCL allows one thread at a time to set a kernel's
 *            arguments
 * Errors:    cl_api_open() tells what is missing; cl_error_name() names codes
 */
#ifndef GLIM_CL_API_H
#define GLIM_CL_API_H

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
