// SPDX-License-Identifier: MIT
/*
 * embree_racer.h - ray queries through Embree 3
 *
 * Units:     normalised scene units, seconds, bytes
 * Ownership: embree_free() frees; a zeroed struct is empty
 * Threads:   one builds; queries from any
 * Errors:    the program ends, since there is nothing to compare
 */
#ifndef RAYS_EMBREE_RACER_H
#define RAYS_EMBREE_RACER_H

#include <stdbool.h>

#include "racer.h"

struct embree {
    struct racer racer;
    const struct world *world;
    void *device;
    void *scene;
};

enum embree_kind {
    EMBREE_FAST,   /* high quality, with spatial splits */
    EMBREE_MEDIUM, /* without spatial splits */
    EMBREE_ROBUST  /* watertight; it does not support spatial splits */
};

void embree_build(struct embree *e, const struct world *world,
                  enum embree_kind kind, int thread_count);
void embree_free(struct embree *e);

#endif
