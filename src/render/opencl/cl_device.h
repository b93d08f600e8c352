// SPDX-License-Identifier: MIT
/*
 * cl_device.h - lists the machine's OpenCL devices, selects one and opens it
 *
 * Devices are numbered 1, 2, ... in the order of the platforms.
 *
 * Units:     bytes
 * Ownership: cl_devices_free() frees the list and its texts; cl_machine_close()
 *            releases; a zeroed struct is closed
 * Threads:   one at a time
 * Errors:    no library, no platform, no device: one line that says what to do;
 *            messages of an open device name it and the call
 */
#ifndef GLIM_CL_DEVICE_H
#define GLIM_CL_DEVICE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "render/opencl/cl_api.h"
#include "render/opencl/cl_thread.h"

/* ---- devices ---- */

struct cl_device {
    cl_platform_id platform;
    cl_device_id id;
    char *platform_name;
    char *name;
    char *version; /* for example "OpenCL 3.0 ..." */
    char *driver_version;
    bool is_cpu, is_gpu;
    bool has_correct_divide; /* can round division and sqrt as C does */
    uint64_t memory_bytes;
    uint64_t max_alloc_bytes; /* largest size of one buffer */
    uint32_t compute_units;
};

struct cl_devices {
    struct cl_device *items;
    int count;
};

/* Lists all devices of all platforms; it is an error if there are none. Starts
 * the drivers and restores the signal handlers afterwards. */
bool cl_device_list(struct cl_devices *list, struct error *err);

void cl_devices_free(struct cl_devices *list);

/* Returns the device with this number, or the only one whose name or platform
 * name contains the word, in any letter case; NULL for none or several. A word
 * of digits only is a number. Without a word (NULL): the first GPU, else the
 * first device. */
const struct cl_device *cl_device_find(const struct cl_devices *list,
                                       const char *word, struct error *err);

/* Prints a table with a line for each device. */
void cl_devices_print(const struct cl_devices *list, FILE *out);

/* ---- an open device ---- */

struct cl_machine {
    const struct cl_api *api;
    struct cl_devices devices;
    const struct cl_device *device; /* points into the list of devices */
    cl_context context;
    cl_command_queue queue;   /* in order */
    struct cl_thread *thread; /* gets the signs of the driver; may be NULL */
};

/* Opens the device that cl_device_find() selects for the word. */
bool cl_machine_open(struct cl_machine *m, const char *word,
                     struct cl_thread *thread, struct error *err);
void cl_machine_close(struct cl_machine *m);

/* Returns true for CL_SUCCESS; otherwise the error names the call and the
 * code. It is one, too, if the thread was left. */
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

/* Waits for an event without busy waiting, and releases it. Returns false if it
 * has failed, or if the thread was left. */
bool cl_machine_wait(const struct cl_machine *m, cl_event *event,
                     struct error *err);

#endif
