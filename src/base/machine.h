// SPDX-License-Identifier: MIT
/*
 * machine.h - what this process has of the machine: instruction sets as
 * kernels.mk names them (ISAS), and the quotas of processors and memory
 *
 * Units:     processors, bytes
 * Threads:   any
 * Errors:    a file that cannot be read counts as no limit
 */
#ifndef GLIM_MACHINE_H
#define GLIM_MACHINE_H

#include <stdbool.h>
#include <stdint.h>

/* ---- instruction sets ---- */

bool cpu_has_avx2(void);   /* with FMA and BMI */
bool cpu_has_avx512(void); /* VL, DQ and BW, with the above */

/* ---- quotas ---- */

/*
 * `root` is "" for the files of the system: proc/self/cgroup and sys/fs/cgroup
 * are read below it.
 */

/* Returns the number of processors that the quotas of this process's control
 * group and of its parents grant, rounded up; 0 if there is no quota. */
int cgroup_quota_processors(const char *root);

/* Tightest limit on memory, including memory in use. */
struct memory_quota {
    uint64_t size_bytes;
    const char *place; /* for messages after "3.9 GiB": "under ulimit -v" */
};

/* Returns the smallest of three limits: the machine's memory, the control group
 * with its parents, and the limits of the process. */
struct memory_quota cgroup_quota_memory(const char *root);

#endif
