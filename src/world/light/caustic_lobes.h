// SPDX-License-Identifier: MIT
/*
 * caustic_lobes.h - caustics of lamps, for the path guide
 *
 * Photons find the directions that caustics come from. kernels/caustic_lobes.h
 * samples them.
 *
 * Units:     normalised scene units
 * Ownership: caustic_lobes_free() frees; a zeroed struct has no lobes
 * Threads:   one thread builds, with the threads of a pool if there is one;
 *            read only after
 * Errors:    memory, by false
 */
#ifndef GLIM_CAUSTIC_LOBES_H
#define GLIM_CAUSTIC_LOBES_H

#include "base/thread_pool.h"
#include "world/bvh/bvh8.h"
#include "world/light/lights.h"

struct caustic_lobes {
    struct caustic_node *nodes; /* NULL: there are no lobes */
    struct caustic_lobe *lobes;
    uint32_t node_count;
    uint32_t lobe_count;
};

/* Replaces the lobes by those of a world, which has triangles. */
bool caustic_lobes_build(struct caustic_lobes *lobes,
                         const struct bvh8_world *w,
                         const struct lights *lights, struct pool *pool);

/* Lends the lobes to the world. */
void caustic_lobes_lend(const struct caustic_lobes *lobes, struct world *world);

void caustic_lobes_free(struct caustic_lobes *lobes);

#endif
