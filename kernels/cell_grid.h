// SPDX-License-Identifier: MIT
/*
 * cell_grid.h - cells of space, in which light_cells.h and radiance_cells.h sum
 * light
 *
 * Cells are cubes in octaves of the distance from the eye: of the same width in
 * an octave, and twice as wide in the next. Each block of samples
 * (render/light_block.h) has grids of its own for each half of a pixel's
 * samples, at a random place and of a random octave, and later grids are finer:
 * the mean of all converges to the light (Knaus and Zwicker 2011, "Progressive
 * photon mapping: a probabilistic approach"). A cell is found by hashing its
 * key.
 *
 * What blur leaves is seen in the difference of the halves, as one half has
 * wider cells than the other.
 *
 * Units:     normalised scene units
 */
#ifndef KERNELS_CELL_GRID_H
#define KERNELS_CELL_GRID_H

#include "kernels/rng.h"
#include "kernels/types.h"

/* Largest coordinate of a cell. */
#define CELL_END 131071.0f

/* The cell of a point, and its width. Key 0 is none. */
struct cell_place {
    uint64_t key;
    float width;
};

static inline uint64_t cell_coordinate(float x)
{
    return (uint64_t)(f_min(f_max(floorf(x), -CELL_END), CELL_END) + CELL_END +
                      1.0f);
}

/* The octave of the distance of a point from the eye. */
static inline uint32_t cell_octave(const struct light_grid *g, struct vec3 p)
{
    return float_bits(v3_length(v3_sub(p, g->eye)) * g->distance_scale) >> 23;
}

/* The width of the cells of an octave. */
static inline float cell_width(const struct light_grid *g, uint32_t octave)
{
    return bits_float(octave << 23) * g->width;
}

/* The cell of an octave at a point of a surface. Surfaces at one point with
 * different `side` numbers, which are below 8, have different cells. */
static inline struct cell_place cell_place(const struct light_grid *g,
                                           struct vec3 p, uint32_t octave,
                                           uint32_t side)
{
    struct vec3 d = v3_sub(p, g->eye);
    struct cell_place at = {0, cell_width(g, octave)};
    float scale = 1.0f / at.width;

    if (octave == 0 || octave >= 255 || !(scale <= FLOAT_MAX))
        return at;
    /* no two octaves in use are 128 apart, and coordinates are above 0 */
    at.key = (uint64_t)side << 61 | (uint64_t)(octave & 127u) << 54 |
             cell_coordinate(d.x * scale + g->offset.x) << 36 |
             cell_coordinate(d.y * scale + g->offset.y) << 18 |
             cell_coordinate(d.z * scale + g->offset.z);
    return at;
}

static inline uint32_t cell_hash(uint64_t key)
{
    return hash_u32((uint32_t)key ^ hash_u32((uint32_t)(key >> 32)));
}

/* Finds a cell of a grid. Returns false if it is empty. */
static inline bool cell_find(const struct world *w, const struct light_grid *g,
                             uint64_t key, struct light_cell *cell)
{
    uint32_t slot = cell_hash(key) & g->mask;

    for (;;) {
        *cell = w->light_cells[g->first + slot];
        if (cell->key == key)
            return true;
        if (cell->key == 0)
            return false;
        slot = (slot + 1u) & g->mask;
    }
}

#endif
