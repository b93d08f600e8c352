// SPDX-License-Identifier: MIT
/*
 * quota.h - how much processor time the control group grants
 *
 * Units:     processors
 * Ownership: none
 * Threads:   any
 * Errors:    none: what cannot be read limits nothing
 */
#ifndef GLIM_QUOTA_H
#define GLIM_QUOTA_H

/* Processors that the quotas of this process's control group and of its
 * parents grant, rounded up; 0 if there is no quota. Reads proc/self/cgroup
 * and sys/fs/cgroup below root: "" for the system's own. */
int quota_processors(const char *root);

#endif
