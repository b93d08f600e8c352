// SPDX-License-Identifier: MIT
/*
 * sets.h - rays that are timed: from the camera, from what they hit and what
 * those hit, and to lamps
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
    SET_PRIMARY, /* through the middles of pixels, in blocks of 4 x 2 */
    SET_BOUNCE,  /* by the cosine from what those hit */
    SET_BOUNCE2, /* and from what the bounces hit */
    SET_SHADOW,  /* from what primary rays hit to a lamp, or to the sun */
    SETS
};

extern const char *const set_names[SETS];

struct ray_set {
    struct ray *rays;
    uint32_t count;
};

/* The racer's tree is that of the world. */
void sets_make(struct ray_set sets[SETS], const struct world *world,
               const struct racer *racer);
void sets_free(struct ray_set sets[SETS]);

#endif
