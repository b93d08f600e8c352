// SPDX-License-Identifier: MIT
/*
 * photons.h - photons of caustics: flux that lights send by glass and metal
 *
 * Photons leave the lights for casters only, which are glass and metal
 * (projection maps of Jensen 1996, "Global illumination using photon maps").
 * They land on diffuse surfaces. Those that land are in the order of their
 * numbers, so that threads do not matter.
 *
 * Units:     normalised scene units
 * Ownership: photons_free() frees, also after a failure
 * Threads:   those of the pool, or without one the caller's
 * Errors:    memory, by false
 */
#ifndef GLIM_PHOTONS_H
#define GLIM_PHOTONS_H

#include <stdbool.h>

#include "base/thread_pool.h"
#include "world/bvh/bvh8.h"
#include "world/light/lights.h"

/* The lights of a search. Paths never meet points and single directions, so
 * their photons count only if the first surface is rough. */
enum photon_source {
    PHOTONS_OF_TRIANGLES,
    PHOTONS_OF_LAMPS /* point and directional lights of all sizes */
};

/* The arrival of a photon at a diffuse surface. */
struct landing {
    struct vec3 p;
    struct vec3 n;    /* unit normal of the face */
    struct vec3 wi;   /* unit vector against the photon's way */
    struct vec3 from; /* where it left the last surface */
    uint32_t chain;   /* hash of its light and the surfaces that it has met */
    float radiance;   /* of the light; 0 if a surface was rough */
    float flux;       /* 0: there was none */
};

struct photons {
    struct landing *landings;
    uint32_t landing_count;
    double power;       /* that of all of the lights */
    double caster_area; /* 0: there are none */
};

/* Returns true if the material reflects or refracts light into few directions.
 */
bool photons_cast(const struct material *m);

/* The material for photons, without colours: casters are white, others grey. */
struct material photons_material(struct material m);

/* Returns true if the world has lights of this kind, and casters. */
bool photons_possible(const struct world *w, enum photon_source source);

/* Returns true if all lights of this kind are points or single directions. */
bool photons_need_rough(const struct world *w, enum photon_source source);

/* Photons to be sent. */
struct photon_plan {
    enum photon_source source;
    uint32_t count;
    uint32_t landings_each; /* the first ones of each photon are kept */
    double box;             /* surface area of the box around the scene */
};

/* Sends photons. One of flux 1 stands for the power of the lights times the
 * area of the casters over the number of photons. */
bool photons_trace(const struct bvh8_world *w, const struct lights *lights,
                   const struct photon_plan *plan, struct pool *pool,
                   struct photons *photons);

void photons_free(struct photons *photons);

#endif
