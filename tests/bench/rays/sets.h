// SPDX-License-Identifier: MIT
/*
 * sets.h - rays that are timed: from the camera, from their hits and the next
 * hits, and to lamps
 *
 * Units:     normalised scene units
 * Ownership: sets_free() frees
 * Threads:   one
 * Errors:    memory: the program ends
 */
#ifndef RAYS_SETS_H
#define RAYS_SETS_H

#include "racer.h"

enum set {
    SET_PRIMARY, /* through the centres of pixels, in blocks of 4 x 2 */
    SET_BOUNCE,  /* cosine-distributed, from hits of primary rays */
    SET_BOUNCE2, /* from hits of bounces */
    SET_SHADOW,  /* from hits of primary rays to a lamp, or to the sun */
    SETS
};

extern const char *const set_names[SETS];

struct ray_set {
    struct ray *rays;
    uint32_t count;
    bool is_any; /* any hit is enough */
};

/* The racer's tree is the world's. */
void sets_make(struct ray_set sets[SETS], const struct world *world,
               const struct racer *racer);
void sets_free(struct ray_set sets[SETS]);

#endif
