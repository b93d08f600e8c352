// SPDX-License-Identifier: MIT
#include "scene/voxel_grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

const char *const voxel_fire_names[FIRE_NAMES] = {
    "flame", "flames", "flame_noise", "temperature", "heat",
};

void voxel_grid_free(struct voxel_grid *grid)
{
    free(grid->index);
    free(grid->majorants);
    free(grid->values);
    memset(grid, 0, sizeof *grid);
}

uint64_t voxel_grid_place_count(const struct voxel_grid *grid)
{
    return (uint64_t)grid->sides[0] * grid->sides[1] * grid->sides[2];
}

/* ---- values ---- */

/* Returns the brick of a place, which may be outside of the box. */
static uint32_t brick_at(const struct voxel_grid *grid, int64_t x, int64_t y,
                         int64_t z)
{
    const uint32_t *n = grid->sides;

    if (x < 0 || y < 0 || z < 0 || x >= n[0] || y >= n[1] || z >= n[2])
        return BRICK_EMPTY;
    return grid->index[((uint64_t)x * n[1] + (uint64_t)y) * n[2] + (uint64_t)z];
}

static const float *values_of(const struct voxel_grid *grid, uint32_t brick)
{
    return grid->values + (size_t)brick * BRICK_VOXELS;
}

float voxel_grid_value(const struct voxel_grid *grid, int64_t i, int64_t j,
                       int64_t k)
{
    int64_t x = i - grid->origin[0];
    int64_t y = j - grid->origin[1];
    int64_t z = k - grid->origin[2];
    uint32_t brick;

    if (x < 0 || y < 0 || z < 0)
        return grid->background;
    brick = brick_at(grid, x / BRICK_SIDE, y / BRICK_SIDE, z / BRICK_SIDE);
    if (brick == BRICK_EMPTY)
        return grid->background;
    return values_of(
        grid, brick)[x % BRICK_SIDE * 64 + y % BRICK_SIDE * 8 + z % BRICK_SIDE];
}

static float between(float a, float b, float t)
{
    return a + (b - a) * t;
}

float voxel_grid_sample(const struct voxel_grid *grid, const double p[3])
{
    int64_t low[3];
    float t[3], v[8];

    for (int a = 0; a < 3; a++) {
        double first = grid->origin[a] - 1;
        double end = grid->origin[a] + (double)grid->sides[a] * BRICK_SIDE;

        if (!(p[a] >= first && p[a] < end))
            return grid->background;
        low[a] = (int64_t)floor(p[a]);
        t[a] = (float)(p[a] - (double)low[a]);
    }
    for (int c = 0; c < 8; c++)
        v[c] = voxel_grid_value(grid, low[0] + (c >> 2), low[1] + (c >> 1 & 1),
                                low[2] + (c & 1));
    return between(between(between(v[0], v[1], t[2]), between(v[2], v[3], t[2]),
                           t[1]),
                   between(between(v[4], v[5], t[2]), between(v[6], v[7], t[2]),
                           t[1]),
                   t[0]);
}

void voxel_box_bounds(const double first[3], const double last[3],
                      const struct affine *to, double low[3], double high[3])
{
    for (int corner = 0; corner < 8; corner++) {
        double p[3], q[3];

        for (int a = 0; a < 3; a++)
            p[a] = (corner >> a & 1) != 0 ? last[a] + 0.5 : first[a] - 0.5;
        affine_point(to, p, q);
        for (int a = 0; a < 3; a++) {
            low[a] = corner == 0 ? q[a] : fmin(low[a], q[a]);
            high[a] = corner == 0 ? q[a] : fmax(high[a], q[a]);
        }
    }
}

/* ---- majorants ---- */

/* Range of voxels of a brick along one axis that touch the neighbour at this
 * offset: -1 and 1 are the layers of one voxel. */
static void touching(int offset, int *first, int *last)
{
    *first = offset < 0 ? BRICK_SIDE - 1 : 0;
    *last = offset > 0 ? 0 : BRICK_SIDE - 1;
}

/* Returns the largest value of the part of a brick that touches the brick from
 * which it is seen at this offset. */
static float largest(const float *values, const int offset[3])
{
    int first[3], last[3];
    float most = -INFINITY;

    for (int a = 0; a < 3; a++)
        touching(offset[a], &first[a], &last[a]);
    for (int x = first[0]; x <= last[0]; x++)
        for (int y = first[1]; y <= last[1]; y++)
            for (int z = first[2]; z <= last[2]; z++)
                most = fmaxf(most, values[x * 64 + y * 8 + z]);
    return most;
}

/* Neighbours of a brick and itself. */
#define AROUND 27

static void offset_of(int around, int offset[3])
{
    offset[0] = around / 9 - 1;
    offset[1] = around / 3 % 3 - 1;
    offset[2] = around % 3 - 1;
}

/* The margin of 2^-20 covers the rounding of an interpolation in floats, which
 * would otherwise exceed its corners by some units of the last place. */
static float rounded_up(float most)
{
    return most + fabsf(most) * 0x1p-20f;
}

/* Returns the bound of the place at these numbers. `parts` has the largest
 * values of each brick, as seen from each direction. */
static float bound_at(const struct voxel_grid *grid, const float *parts,
                      const int64_t at[3])
{
    float most = -INFINITY;

    for (int n = 0; n < AROUND; n++) {
        int d[3];

        offset_of(n, d);
        most = fmaxf(most, parts[(size_t)brick_at(grid, at[0] + d[0],
                                                  at[1] + d[1], at[2] + d[2]) *
                                     AROUND +
                                 (size_t)n]);
    }
    return rounded_up(most);
}

/* Bounds the places around one that is not empty, where none has yet been
 * found. */
static void bound_around(struct voxel_grid *grid, const float *parts,
                         const int64_t at[3])
{
    const uint32_t *n = grid->sides;

    for (int k = 0; k < AROUND; k++) {
        int64_t to[3];
        int d[3];
        float *bound;

        offset_of(k, d);
        for (int a = 0; a < 3; a++)
            to[a] = at[a] + d[a];
        if (to[0] < 0 || to[1] < 0 || to[2] < 0 || to[0] >= n[0] ||
            to[1] >= n[1] || to[2] >= n[2])
            continue;
        bound =
            &grid->majorants[((uint64_t)to[0] * n[1] + (uint64_t)to[1]) * n[2] +
                             (uint64_t)to[2]];
        if (isnan(*bound))
            *bound = bound_at(grid, parts, to);
    }
}

bool voxel_grid_bound(struct voxel_grid *grid)
{
    uint64_t count = voxel_grid_place_count(grid);
    float *parts = alloc_array(grid->brick_count, AROUND * sizeof *parts);
    const uint32_t *n = grid->sides;

    grid->majorants = alloc_array(count, sizeof *grid->majorants);
    if (parts == NULL || grid->majorants == NULL) {
        free(parts);
        return false;
    }
    for (size_t i = 0; i < (size_t)grid->brick_count * AROUND; i++) {
        int d[3];

        offset_of((int)(i % AROUND), d);
        parts[i] = largest(values_of(grid, (uint32_t)(i / AROUND)), d);
    }
    for (uint64_t i = 0; i < count; i++)
        grid->majorants[i] = NAN;
    for (uint64_t i = 0; i < count; i++)
        if (grid->index[i] != BRICK_EMPTY)
            bound_around(grid, parts,
                         (const int64_t[3]){(int64_t)(i / n[2] / n[1]),
                                            (int64_t)(i / n[2] % n[1]),
                                            (int64_t)(i % n[2])});
    for (uint64_t i = 0; i < count; i++)
        if (isnan(grid->majorants[i]))
            grid->majorants[i] = rounded_up(grid->background);
    free(parts);
    return true;
}

/* ---- level sets ---- */

bool voxel_grid_fill_level_set(struct voxel_grid *grid)
{
    float width = grid->background;

    for (size_t i = 0; i < (size_t)grid->brick_count * BRICK_VOXELS; i++)
        grid->values[i] = fminf(fmaxf(-grid->values[i] / width, 0), 1);
    grid->background = 0;
    free(grid->majorants);
    return voxel_grid_bound(grid);
}
