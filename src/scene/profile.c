// SPDX-License-Identifier: MIT
#include "scene/profile.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

struct profile *profile_create(const char *path, uint32_t columns)
{
    struct profile *p = calloc(1, sizeof *p);

    if (p == NULL)
        return NULL;
    atomic_init(&p->references, 1);
    p->columns = columns;
    p->path = strdup(path);
    p->values = alloc_array(profile_value_count(p), sizeof *p->values);
    if (p->path == NULL || p->values == NULL) {
        profile_release(p);
        return NULL;
    }
    return p;
}

struct profile *profile_share(struct profile *p)
{
    if (p != NULL)
        atomic_fetch_add(&p->references, 1);
    return p;
}

void profile_release(struct profile *p)
{
    if (p == NULL || atomic_fetch_sub(&p->references, 1) > 1)
        return;
    free(p->values);
    free(p->path);
    free(p);
}

bool profiles_equal(const struct profile *a, const struct profile *b)
{
    if (a == b || a == NULL || b == NULL)
        return a == b;
    return a->columns == b->columns && strcmp(a->path, b->path) == 0 &&
           memcmp(a->values, b->values,
                  profile_value_count(a) * sizeof *a->values) == 0;
}

struct profile *profile_create_even(const char *path)
{
    struct profile *p = profile_create(path, 1);

    for (uint32_t i = 0; p != NULL && i < profile_value_count(p); i++)
        p->values[i] = 1;
    return p;
}
