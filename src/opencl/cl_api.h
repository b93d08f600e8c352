// SPDX-License-Identifier: MIT
/*
 * cl_api.h - the functions of OpenCL 1.2, found while the program runs
 *
 * glim is not linked with libOpenCL, so it starts where there is none. The
 * types of the functions are those of CL/cl.h.
 *
 * Ownership: the table is the program's, for good
 * Threads:   any; as OpenCL says, only one at a time for one kernel's arguments
 * Errors:    cl_api_open() says what is missing; cl_error_name() names codes
 */
#ifndef GLIM_CL_API_H
#define GLIM_CL_API_H

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <CL/cl_ext.h>

#include "base/error.h"

/* What glim calls, without the cl in front. */
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

/* Loads libOpenCL.so.1 at the first call. NULL if it, or one of its functions,
 * is missing. */
const struct cl_api *cl_api_open(struct error *err);

/* "CL_OUT_OF_RESOURCES" for -5. */
const char *cl_error_name(cl_int code);

#endif
