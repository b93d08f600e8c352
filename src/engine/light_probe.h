// SPDX-License-Identifier: MIT
/*
 * light_probe.h - how much light a scene has where the camera looks
 *
 * A few thousand paths through a small picture measure the light that surfaces
 * reflect. Emission and sky that the camera sees itself count on request: a
 * lamp that shines into the camera need not show anything else.
 *
 * Units:     luminance of the picture after its exposure, 1 is white
 * Threads:   those of world_pool(); the result does not depend on them
 * Errors:    memory, or an impossible camera
 */
#ifndef GLIM_LIGHT_PROBE_H
#define GLIM_LIGHT_PROBE_H

#include "world/world.h"

struct light_probe {
    double mean;  /* mean luminance, of which each sample adds 1 at most */
    double shown; /* share of the picture that is not black */
};

/* Measures the world with the lamps that it has, and the sky and camera of the
 * view. Builds the world's tree. */
bool light_probe_take(struct light_probe *probe, struct host_world *host,
                      const struct scene *scene, const struct view *view,
                      bool counts_seen, struct error *err);

/* Returns true if this light does enough beside the light that could be added:
 * `with` is measured with both. Light that shows nothing never does. */
bool light_probe_suffices(const struct light_probe *own,
                          const struct light_probe *with);

#endif
