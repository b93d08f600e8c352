// SPDX-License-Identifier: MIT
/*
 * light_paths.h - paths from the lamps that make the light which paths from the
 * eye hardly find: that whose last surface before the lamp casts light
 *
 * A surface casts if its material reflects or refracts light into few
 * directions, and is matte if it scatters light into all (enum material_role).
 * Light paths make exactly the paths whose first surface from the lamp casts
 * and whose last one, which the eye sees, is matte. Paths from the eye leave
 * exactly these out, so that no weight is needed (Veach 1997, chapter 10, has
 * paths that are connected to the camera). Each begins with a point on a lamp
 * and one on a surface that casts; at each matte surface it is connected to the
 * camera.
 *
 * Units:     normalised scene units, radiance
 * Ownership: light_paths_free() and light_image_free() free; zeroed structs are
 *            empty
 * Threads:   one builds; light_paths_trace() uses those of its pool
 * Errors:    out of memory, as false
 */
#ifndef GLIM_LIGHT_PATHS_H
#define GLIM_LIGHT_PATHS_H

#include <pthread.h>
#include <stdatomic.h>

#include "base/thread_pool.h"
#include "world/bvh/bvh8.h"
#include "world/light/casters.h"
#include "world/light/light_cells.h"
#include "world/light/lights.h"
#include "world/light/sky_spots.h"
#include "kernels/sum.h"

/* A lamp that light paths begin at: a triangle, point or directional light, or
 * all bright spots of the sky. */
struct light_source {
    uint32_t number; /* of the triangle, or the light in its array */
    uint32_t kind;
    float probability;
};

struct light_paths {
    struct light_source *sources;
    struct triangle_cdf choice; /* of numbers of sources */
    struct casters casters;
    struct sky_spots spots;
    float reach; /* a distance at which rays begin outside of the scene */
};

/* Makes the tables of a world, the image of whose sky has this mean radiance.
 * Without lamps whose light casts, there are no sources. */
bool light_paths_build(struct light_paths *paths, const struct world *w,
                       const struct lights *lights, double sky_mean);
void light_paths_free(struct light_paths *paths);

/* Aims the light paths of a world, with its tree, where the light of its lamps
 * arrives. The pool may be NULL. */
void light_paths_aim(struct light_paths *paths, const struct world *w,
                     struct pool *pool);

enum { LIGHT_LOCKS = 64 };

/* Sums of the light that light paths bring to pixels of a film, whose corner is
 * (x0, y0) in the picture, in two halves that are independent. */
struct light_image {
    int width, height, x0, y0;
    struct sum *sums[2];                /* 3 for each pixel */
    pthread_mutex_t locks[LIGHT_LOCKS]; /* of rows */
    _Atomic uint64_t rays;              /* number of rays that were traced */
};

bool light_image_init(struct light_image *image, int width, int height);
void light_image_clear(struct light_image *image);
void light_image_free(struct light_image *image);

/* What light paths bring light to. */
struct light_film {
    struct light_image *image;
    struct light_cells *cells; /* or NULL */
};

/* Traces light paths first to first + count - 1 of each half, and adds their
 * light. A path is a pure function of its number, its half and the seed.
 * Returns false after a cancel. */
bool light_paths_trace(const struct light_paths *paths, const struct world *w,
                       uint64_t first, uint32_t count, struct pool *pool,
                       const struct cancel *cancel, struct light_film film);

/* Writes the mean of `count` light paths of each half: 3 numbers for each pixel
 * of the first half, then those of the second. */
void light_image_means(const struct light_image *image, uint64_t count,
                       float *means);

#endif
