// SPDX-License-Identifier: MIT
/*
 * cl_machine.h - an opened OpenCL device
 *
 * Units:     bytes
 * Ownership: cl_machine_close() releases; a zeroed struct is closed
 * Threads:   one at a time
 * Errors:    every text names the device and the call
 */
#ifndef GLIM_CL_MACHINE_H
#define GLIM_CL_MACHINE_H

#include <stdbool.h>
#include <stddef.h>

#include "opencl/cl_device.h"

struct cl_machine {
    const struct cl_api *api;
    struct cl_devices devices;
    const struct cl_device *device; /* one of them */
    cl_context context;
    cl_command_queue queue; /* in order */
};

/* Opens the device that cl_device_find() finds for the word. */
bool cl_machine_open(struct cl_machine *m, const char *word, struct error *err);
void cl_machine_close(struct cl_machine *m);

/* True for CL_SUCCESS; else the text says that this call failed, and how. */
bool cl_machine_check(const struct cl_machine *m, cl_int code, const char *call,
                      struct error *err);

/* A buffer with these contents, or of this size if data is NULL. A device that
 * is a CPU reads and writes `data` itself when `shared`, which then must
 * stay as long as the buffer. NULL on failure. */
cl_mem cl_machine_buffer(const struct cl_machine *m, const void *data,
                         size_t size_bytes, bool shared, struct error *err);

/* Releases *buffer, if any, and sets it to NULL. */
void cl_machine_drop(const struct cl_machine *m, cl_mem *buffer);

/* Sets buffers as a kernel's arguments from number `first` on. */
bool cl_machine_set(const struct cl_machine *m, cl_kernel kernel, cl_uint first,
                    const cl_mem *buffers, cl_uint count, struct error *err);

/* Puts a kernel for so many work-items, or some more, into the queue. */
bool cl_machine_enqueue(const struct cl_machine *m, cl_kernel kernel,
                        size_t count, struct error *err);

/* Waits for an event without burning a core, and releases it. */
bool cl_machine_wait(const struct cl_machine *m, cl_event *event,
                     struct error *err);

#endif
