// SPDX-License-Identifier: MIT
/*
 * cl_device.h - the OpenCL devices of this machine, and which one is meant
 *
 * Devices have the numbers 1, 2, ... in the order in which the platforms name
 * them.
 *
 * Units:     bytes
 * Ownership: cl_devices_free() frees the list, with the texts of its devices
 * Threads:   one at a time
 * Errors:    no library, no platform, no device: one line that says what to do
 */
#ifndef GLIM_CL_DEVICE_H
#define GLIM_CL_DEVICE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "opencl/cl_api.h"

struct cl_device {
    cl_platform_id platform;
    cl_device_id id;
    char *platform_name;
    char *name;
    char *version; /* "OpenCL 3.0 ..." */
    char *driver_version;
    bool is_cpu, is_gpu;
    bool has_correct_divide; /* can round division and sqrt as C does */
    uint64_t memory_bytes;
    uint64_t max_alloc_bytes; /* of one buffer */
    uint32_t compute_units;
};

struct cl_devices {
    struct cl_device *items;
    int count;
};

/* All devices of all platforms; no device at all is an error. Starts the
 * drivers, and leaves the handlers of signals as they were. */
bool cl_device_list(struct cl_devices *list, struct error *err);

void cl_devices_free(struct cl_devices *list);

/* The device of that number, or the only one with the word in its name or its
 * platform's name, whatever the case; NULL for none or several. Digits alone
 * are a number. Without a word (NULL): the first GPU, else the first device. */
const struct cl_device *cl_device_find(const struct cl_devices *list,
                                       const char *word, struct error *err);

/* A table with a line for each device. */
void cl_devices_print(const struct cl_devices *list, FILE *out);

#endif
