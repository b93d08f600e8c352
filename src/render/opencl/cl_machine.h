// SPDX-License-Identifier: MIT
/*
 * cl_machine.h - an opened OpenCL device
 *
 * Units:     bytes
 * Ownership: cl_machine_close() releases; a zeroed struct is closed
 * Threads:   one at a time
 * Errors:    every message names the device and the call
 */
#ifndef GLIM_CL_MACHINE_H
#define GLIM_CL_MACHINE_H

#include <stdbool.h>
#include <stddef.h>

#include "render/opencl/cl_device.h"

struct cl_machine {
    const struct cl_api *api;
    struct cl_devices devices;
    const struct cl_device *device; /* points into the list of devices */
    cl_context context;
    cl_command_queue queue; /* in order */
};

/* Opens the device that cl_device_find() selects for the word. */
bool cl_machine_open(struct cl_machine *m, const char *word, struct error *err);
void cl_machine_close(struct cl_machine *m);

/* Returns true for CL_SUCCESS; otherwise the error names the call and the
 * code. */
bool cl_machine_check(const struct cl_machine *m, cl_int code, const char *call,
                      struct error *err);

/* Creates a buffer with a copy of the data, or without contents if data is
 * NULL. If `shared`, a CPU device uses the data's memory itself, which must
 * then outlive the buffer. Returns NULL on failure. */
cl_mem cl_machine_buffer(const struct cl_machine *m, const void *data,
                         size_t size_bytes, bool shared, struct error *err);

/* Releases *buffer, unless it is NULL, and sets it to NULL. */
void cl_machine_drop(const struct cl_machine *m, cl_mem *buffer);

/* Sets the buffers as arguments of a kernel, from number `first` on. */
bool cl_machine_set(const struct cl_machine *m, cl_kernel kernel, cl_uint first,
                    const cl_mem *buffers, cl_uint count, struct error *err);

/* Enqueues a kernel with `count` work-items, rounded up to whole groups. */
bool cl_machine_enqueue(const struct cl_machine *m, cl_kernel kernel,
                        size_t count, struct error *err);

/* Waits for an event without busy waiting, and releases it. */
bool cl_machine_wait(const struct cl_machine *m, cl_event *event,
                     struct error *err);

#endif
