// SPDX-License-Identifier: MIT
/*
 * backend_cl.h - renders on an OpenCL device
 *
 * Units:     none
 * Ownership: backend_cl_create() takes the machine and the kernels over
 * Threads:   see backend.h
 * Errors:    a device that fails in the middle makes pass() fail
 */
#ifndef GLIM_BACKEND_CL_H
#define GLIM_BACKEND_CL_H

#include "glim/backend.h"
#include "glim/cl_kernels.h"

struct backend *backend_cl_create(const struct cl_machine *machine,
                                  const struct cl_kernels *kernels);

#endif
