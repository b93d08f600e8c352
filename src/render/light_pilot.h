// SPDX-License-Identifier: MIT
/*
 * light_pilot.h - a pilot that tells whether light paths help a picture
 *
 * A few samples of a small picture of the whole, and a few light paths, give
 * the noise of both. The pilot is the same for everybody who renders a part of
 * the picture, with any number of threads.
 *
 * Units:     samples of each pixel
 * Ownership: light_pilot_free() frees
 * Threads:   one; it uses those of the pool
 * Errors:    out of memory
 */
#ifndef GLIM_LIGHT_PILOT_H
#define GLIM_LIGHT_PILOT_H

#include "render/backend.h"

/* Least limit of vertices for cells: light that comes to them by paths near the
 * limit is longer than paths from the eye are. */
#define CELL_VERTICES_MIN 32

/* Size of the small picture of a pilot. */
#define PILOT_WIDTH  24
#define PILOT_HEIGHT 14
#define PILOT_PIXELS (PILOT_WIDTH * PILOT_HEIGHT)

/* Returns the camera of a pilot for the picture of a camera. */
struct camera light_pilot_camera(const struct camera *camera);

struct light_choice {
    double paths;   /* light paths for each sample; 0: none */
    bool has_cells; /* light cells, for what the eye sees through glass */
};

/* Returns a pilot for a picture, whose host has its tree and light paths, or
 * NULL when memory is out. */
struct light_pilot *light_pilot_begin(const struct backend_picture *picture);

/* Decides. After a cancel another call goes on with what is done. */
enum pass_result light_pilot_run(struct light_pilot *pilot, struct pool *pool,
                                 const struct cancel *cancel,
                                 struct light_choice *choice,
                                 struct error *err);

/* Returns the world whose paths from the eye leave out what light paths bring,
 * and what light cells bring, unless `cells` is NULL. */
struct world light_pilot_world(const struct world *world,
                               const struct light_cells *cells);

/* Frees the pilot, which may be NULL. */
void light_pilot_free(struct light_pilot *pilot);

#endif
