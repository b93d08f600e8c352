// SPDX-License-Identifier: MIT
/*
 * voxel_grid.h - a sparse grid of numbers in space, such as the density of
 * smoke
 *
 * The centre of voxel (i, j, k) is the point (i, j, k) of index space; between
 * centres values are interpolated. Bricks of 8^3 voxels fill a box, which has
 * every point whose value may differ from the background. Equal bricks are
 * stored once.
 *
 * Units:     index space is in voxels; to_world leads to the units of the file
 * Ownership: voxel_grid_free() frees the members; a zeroed grid has none
 * Threads:   any may read
 * Errors:    false when memory is out
 */
#ifndef GLIM_VOXEL_GRID_H
#define GLIM_VOXEL_GRID_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/geometry.h"
#include "kernels/types.h"

/* Most bricks of the box: 2,048 voxels on each side. */
#define BRICK_PLACES_MAX ((uint64_t)1 << 24)

/* Brick of places where all is background. */
#define BRICK_EMPTY 0

/* Largest magnitude of a value, so that squares stay finite. */
#define VOXEL_VALUE_MAX 1e30f

/* Grids that files of fire have beside the density: first names of flames, then
 * of temperatures, each with those that are preferred first. */
enum { FLAME_NAMES = 3, FIRE_NAMES = 5, VOXEL_NAME_BYTES = 16 };
extern const char *const voxel_fire_names[FIRE_NAMES];

struct voxel_grid {
    /* First and last voxel that is active in the file; first > last: none. */
    int32_t first[3], last[3];
    int32_t origin[3]; /* first voxel of the box, a multiple of 8 */
    uint32_t sides[3]; /* of the box, in bricks */
    uint32_t brick_count;
    float background;
    /* Brick of each place of the box; z is fastest, then y. */
    uint32_t *index;
    /* Bound of the interpolated values of each place: the largest of the brick
     * and of one voxel around it, rounded up. */
    float *majorants;
    float *values; /* BRICK_VOXELS for each brick; z is fastest, then y */
    struct affine to_world;
    uint32_t replaced_count; /* values that were no numbers: 0 */
    /* Bits of voxel_fire_names: grids that the file has, and this one or 0. */
    uint32_t fire_grids, own_fire;
    uint32_t up_is_z; /* 1: the program that wrote it has z up */
};

void voxel_grid_free(struct voxel_grid *grid);

/* Returns the number of places in the box. */
uint64_t voxel_grid_place_count(const struct voxel_grid *grid);

/* Allocates and fills the majorants. */
bool voxel_grid_bound(struct voxel_grid *grid);

/* Turns distances from a surface, whose background is the width of their band,
 * into densities: 0 outside and at the surface, and up to 1 at this width
 * inside. */
bool voxel_grid_fill_level_set(struct voxel_grid *grid);

/* Returns the value of a voxel; outside of the box the background. */
float voxel_grid_value(const struct voxel_grid *grid, int64_t i, int64_t j,
                       int64_t k);

/* Sets the bounds, behind a map, of the box of these voxels: it ends half a
 * voxel beyond their centres. */
void voxel_box_bounds(const double first[3], const double last[3],
                      const struct affine *to, double low[3], double high[3]);

/* Returns the value at a point of index space, interpolated in three directions
 * between the centres of eight voxels. */
float voxel_grid_sample(const struct voxel_grid *grid, const double p[3]);

#endif
