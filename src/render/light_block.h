// SPDX-License-Identifier: MIT
/*
 * light_block.h - the light that the samples of a block share
 *
 * Samples of all pixels with indices in the same block get the same light from
 * light paths (world/light/light_paths.h), those with even indices that of one
 * half of the paths, those with odd ones that of the other, so that the two
 * halves of a pixel stay independent. What the eye sees through glass or in
 * mirrors gets it from light cells (kernels/light_cells.h) of the block, and
 * paths from the eye end at radiance cells (kernels/radiance_cells.h) of the
 * block. Blocks double up to a number that depends on the size of the picture,
 * so that none keeps the screen waiting. The light of a block depends on
 * nothing but the world, the picture and the block. Pilots (light_pilot.h,
 * radiance_training.h) tell what helps at equal time, and how many light paths
 * there should be.
 *
 * Units:     samples of each pixel
 * Ownership: light_block_free() frees; a zeroed struct has no block
 * Threads:   one; light paths are traced by those of the pool
 * Errors:    out of memory
 */
#ifndef GLIM_LIGHT_BLOCK_H
#define GLIM_LIGHT_BLOCK_H

#include "render/light_pilot.h"
#include "world/light/light_paths.h"

struct light_block {
    struct light_pilot *pilot; /* in progress: a cancel loses little of it */
    bool is_decided;           /* the choice is that of this picture */
    struct light_choice choice;
    bool may_train;    /* radiance cells may help, or do */
    bool has_radiance; /* they do */
    struct light_image image;
    struct light_cells cells;
    float *means;            /* of light_image_means() */
    uint64_t end;            /* 0: there is no block */
    struct pass_light light; /* of the block */
};

/* Decides whether and how many light paths help to render a picture, unless it
 * is decided, and whether light cells help if its world may have cells
 * (settings.has_light_cells). The host has its tree. Returns PASS_CANCELLED
 * after a cancel. */
enum pass_result light_block_decide(struct light_block *b,
                                    const struct backend_picture *picture,
                                    struct pool *pool,
                                    const struct cancel *cancel,
                                    struct error *err);

/* Returns the world whose paths from the eye leave out what light paths bring,
 * and end at radiance cells. */
struct world light_block_world(const struct light_block *b,
                               const struct world *world);

/* True if samples share light, or may. */
bool light_block_is_needed(const struct light_block *b);

/* Returns the end of the block of a sample of the camera's picture. */
uint64_t light_block_end(const struct camera *camera, uint64_t sample);

/* Finds the light of the block of a sample, unless it is known. It may decide
 * on radiance cells, which changes light_block_world(). The host has its tree.
 * Returns PASS_CANCELLED after a cancel. */
enum pass_result light_block_find(struct light_block *b,
                                  const struct backend_picture *picture,
                                  uint64_t sample, struct pool *pool,
                                  const struct cancel *cancel,
                                  struct error *err);

/* Forgets the block: the next one is of another picture. */
void light_block_reset(struct light_block *b);
void light_block_free(struct light_block *b);

#endif
