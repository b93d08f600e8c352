// SPDX-License-Identifier: MIT
/*
 * cgroup_quota.h - how much processor time and memory this process may use
 *
 * `root` is "" for the system's own files: proc/self/cgroup and sys/fs/cgroup
 * are read below it.
 *
 * Units:     processors, bytes
 * Threads:   any
 * Errors:    none: what cannot be read limits nothing
 */
#ifndef GLIM_CGROUP_QUOTA_H
#define GLIM_CGROUP_QUOTA_H

#include <stdint.h>

/* Processors that the quotas of this process's control group and of its
 * parents grant, rounded up; 0 if there is no quota. */
int cgroup_quota_processors(const char *root);

/* The tightest of the limits on memory, in use or not. */
struct memory_quota {
    uint64_t size_bytes;
    const char *place; /* reads well after "3.9 GiB": "under ulimit -v" */
};

/* Looks at the machine's memory, the control group with its parents, and the
 * limits of the process. */
struct memory_quota cgroup_quota_memory(const char *root);

#endif
