// SPDX-License-Identifier: MIT
/*
 * radiance_training.h - paths from the eye that give radiance cells their light
 *
 * They begin in random pixels of the whole picture. Each is a function of its
 * number and the world's seed, so that the cells of a block of samples are the
 * same for everybody who renders a part of it.
 *
 * Threads:   one; paths are traced by those of the pool
 * Errors:    memory
 */
#ifndef GLIM_RADIANCE_TRAINING_H
#define GLIM_RADIANCE_TRAINING_H

#include "render/backend.h"
#include "world/light/light_cells.h"

/* Samples of all pixels before the first block with radiance cells: the pilot
 * takes a tenth of their time, and the first picture does not wait. */
#define RADIANCE_SAMPLES_MIN 65536

/* Returns the number of training paths before that of a sample. */
uint64_t radiance_training_before(const struct camera *camera, uint64_t sample);

/* Lets the paths of a world end at the radiance cells. */
void radiance_training_lend(struct world *world,
                            const struct light_cells *cells);

/* Adds the estimates of paths to the radiance cells of both halves. Returns
 * false after a cancel. */
bool radiance_training_run(struct light_cells *cells, const struct world *world,
                           uint64_t first, uint32_t count, struct pool *pool,
                           const struct cancel *cancel);

/* Finds whether radiance cells save rays in a picture, by a few samples of a
 * small picture of the whole with and without them. With `has_light_paths`,
 * paths leave out what light paths bring. Returns PASS_CANCELLED after a
 * cancel, and PASS_FAILED when memory is out. */
enum pass_result radiance_training_pays(const struct backend_picture *picture,
                                        bool has_light_paths, struct pool *pool,
                                        const struct cancel *cancel,
                                        bool *pays);

#endif
