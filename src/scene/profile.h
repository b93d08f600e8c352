// SPDX-License-Identifier: MIT
/*
 * profile.h - emission profiles: how much a lamp emits in each direction
 *
 * Profiles do not change after they were made, so that copies of a view share
 * them.
 *
 * Units:     factors of a lamp's intensity, in the rows and columns of
 *            PROFILE_ROWS in kernels/types.h
 * Ownership: profile_create() and profile_share() return a reference for
 *            profile_release()
 * Threads:   any
 * Errors:    memory, by NULL
 */
#ifndef GLIM_PROFILE_H
#define GLIM_PROFILE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "kernels/types.h"

struct profile {
    atomic_uint references;
    uint32_t columns;
    float *values;
    char *path; /* of its file */
};

/* Makes a profile with room for its values. */
struct profile *profile_create(const char *path, uint32_t columns);

/* Makes one that emits the same in all directions. */
struct profile *profile_create_even(const char *path);

/* Both accept NULL. */
struct profile *profile_share(struct profile *profile);
void profile_release(struct profile *profile);

/* Returns true if paths and values are the same; NULL equals NULL. */
bool profiles_equal(const struct profile *a, const struct profile *b);

static inline uint32_t profile_value_count(const struct profile *profile)
{
    return PROFILE_ROWS * profile->columns;
}

#endif
