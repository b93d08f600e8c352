// SPDX-License-Identifier: MIT
/*
 * world_lamps.h - gives a world the lamps of a view
 *
 * Units:     as world.h
 * Ownership: the world owns its arrays; lamps are copied
 * Threads:   one, while nobody renders the world
 * Errors:    memory: the world stays as before
 */
#ifndef GLIM_WORLD_LAMPS_H
#define GLIM_WORLD_LAMPS_H

#include "world/world.h"

/* Sets the point lights and directional lights of a world to those of the view,
 * of which its sun is one, and builds the light tree if point lights have
 * changed. Lamps without light are left out. */
bool world_set_lamps(struct host_world *host, const struct scene *scene,
                     const struct view *view, struct error *err);

#endif
