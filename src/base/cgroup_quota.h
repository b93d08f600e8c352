// SPDX-License-Identifier: MIT
/*
 * cgroup_quota.h - limits on processor time and memory of this process
 *
 * `root` is "" for the files of the system: proc/self/cgroup and sys/fs/cgroup
 * are read below it.
 *
 * Units:     processors, bytes
 * Threads:   any
 * Errors:    a file that cannot be read counts as no limit
 */
#ifndef GLIM_CGROUP_QUOTA_H
#define GLIM_CGROUP_QUOTA_H

#include <stdint.h>

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
