// SPDX-License-Identifier: MIT
/*
 * cl_kernels.h - kernels, built for one device and one set of features
 *
 * Ownership: cl_kernels_free() releases; a zeroed struct is empty
 * Threads:   one at a time
 * Errors:    a text that does not compile: its first message, and the log
 */
#ifndef GLIM_CL_KERNELS_H
#define GLIM_CL_KERNELS_H

#include <stdbool.h>
#include <stdint.h>

#include "opencl/cl_machine.h"

struct cl_kernels {
    cl_program program;
    cl_kernel clear;
    cl_kernel generate;
    cl_kernel trace;
    cl_kernel add;
    uint32_t features;
};

/* Builds the kernels. Takes seconds unless the driver has cached a build of
 * this text. After a failure *log is the compiler's output, for free();
 * otherwise it is NULL. */
bool cl_kernels_build(struct cl_kernels *k, const struct cl_machine *m,
                      const char *text, uint32_t features, char **log,
                      struct error *err);

void cl_kernels_free(struct cl_kernels *k, const struct cl_machine *m);

#endif
