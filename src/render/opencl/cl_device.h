// SPDX-License-Identifier: MIT
/*
 * cl_device.h - lists the machine's OpenCL devices and selects one
 *
 * Devices are numbered 1, 2, ... in the order of the platforms.
 *
 * Units:     bytes
 * Ownership: cl_devices_free() frees the list and its texts
 * Threads:   one at a time
 * Errors:    no library, no platform, no device: one line that says what to do
 */
#ifndef GLIM_CL_DEVICE_H
#define GLIM_CL_DEVICE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "render/opencl/cl_api.h"

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

#endif
