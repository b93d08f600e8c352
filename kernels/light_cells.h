// SPDX-License-Identifier: MIT
/*
 * light_cells.h - light of light paths at matte surfaces that the eye sees
 * through glass or in mirrors
 *
 * No light path can be connected to the camera there. Its flux is summed in
 * cells of space instead, which the first matte surface of a path from the eye
 * looks up (photon mapping: Jensen 1996, "Global illumination using photon
 * maps", with cells for the search). The finest cells are about as wide as a
 * pixel seen from the eye. Eight cells are a cell of the next level, so that
 * where there is little light cells are wide and not noisy. Those of one half
 * are four times as wide as those of the other: where blur grows with the
 * square of the width, half the difference of the halves is 15/17 of the mean
 * blur.
 *
 * Units:     normalised scene units; flux, divided by the number of light paths
 */
#ifndef KERNELS_LIGHT_CELLS_H
#define KERNELS_LIGHT_CELLS_H

#include "kernels/cell_grid.h"
#include "kernels/surface_point.h"

/* Levels of cells, each twice as wide as those of the level before. */
#define CELL_LEVELS 4u

/* Moves bit `bit` of each coordinate in a key of cell_grid.h to the bits of its
 * level. */
static inline uint64_t light_bits(uint64_t key, uint32_t bit)
{
    return ((key >> (36u + bit) & 1u) << 2 | (key >> (18u + bit) & 1u) << 1 |
            (key >> bit & 1u))
           << 3u * bit;
}

/* The finest cell of an octave at a point of a surface, whose unit normal ng is
 * on the side of the light. Keys of cells that are one at a higher level differ
 * in their last bits, 3 for each level. */
static inline struct cell_place light_place(const struct light_grid *g,
                                            struct vec3 p, struct vec3 ng,
                                            uint32_t octave)
{
    uint32_t facing = v3_dot(ng, g->facing) > 0.0f ? 1u : 0u;
    struct cell_place at = cell_place(g, p, octave, facing);
    const uint64_t rest = 0x7fff; /* of a coordinate */

    if (at.key != 0)
        at.key = (at.key & (rest << 39 | ~(uint64_t)0 << 54)) |
                 (at.key & rest << 21) << 3 | (at.key & rest << 3) << 6 |
                 light_bits(at.key, 0u) | light_bits(at.key, 1u) |
                 light_bits(at.key, 2u);
    return at;
}

/* The cell of a level which has a finest cell. */
static inline uint64_t light_cell_above(uint64_t key, uint32_t level)
{
    const uint64_t place = ((uint64_t)1 << 54) - 1;

    return (uint64_t)level << 62 | (key & ~place) | (key & place) >> 3u * level;
}

/* Chooses the level of a half's cell at a point, as light_place() has it: the
 * finest at which the other half has enough deposits there. By its own it would
 * take the finer the brighter they are by chance. */
static inline uint32_t light_level(const struct world *w, uint32_t half_number,
                                   struct vec3 p, struct vec3 ng)
{
    struct light_grid g = w->light_grids[1u - half_number];
    uint64_t key = light_place(&g, p, ng, cell_octave(&g, p)).key;
    struct light_cell cell;
    uint32_t level = 0;

    while (level < CELL_LEVELS - 1u &&
           !(cell_find(w, &g, light_cell_above(key, level), &cell) &&
             v3_length(cell.d) >= g.count_min))
        level++;
    return level;
}

/* Mean area of the part of a plane with unit normal n that is in a cell of
 * width 1, where a point of it at random is: the density at 0 of the sum of the
 * components of n times numbers with the density 1 - |x|, of a cell's two ends.
 */
static inline float light_cell_area(struct vec3 n)
{
    float x = fabsf(n.x), y = fabsf(n.y), z = fabsf(n.z);
    float a = f_max(x, f_max(y, z)), c = f_min(x, f_min(y, z));
    float b = f_max(f_min(x, y), f_min(f_max(x, y), z)); /* the middle one */
    float ratio = b > 0.0f ? c / b : 0.0f, beyond = b + c - a;
    float mean =
        b / a *
        (1.0f / 3.0f + ratio * ratio * (1.0f / 6.0f - ratio * (1.0f / 30.0f)));
    float tail = 0.0f;

    if (beyond > 0.0f) {
        float part = beyond * beyond / (b * c);

        tail = beyond * part * part / (60.0f * a);
    }
    return (1.0f - mean + tail) / a;
}

/* The light of a cell, as if all of it came from one direction. */
struct cell_light {
    struct vec3 flux;
    struct vec3 from; /* unit */
    float area;       /* of the surface in the cell; 0: no light */
};

/* Looks up the light of a half that comes to the side ng of a surface. u
 * chooses a place around the point. */
static inline struct cell_light light_cells_at(const struct world *w,
                                               uint32_t half_number,
                                               const struct surface_point *v,
                                               struct vec3 ng, struct vec2 u)
{
    struct cell_light l;
    struct vec3 tangent, bitangent;
    struct light_grid g = w->light_grids[half_number];
    uint32_t octave = cell_octave(&g, v->p);
    uint32_t level = light_level(w, half_number, v->p, ng);
    float width = cell_width(&g, octave) * (float)(1u << level);
    struct cell_place at;
    struct light_cell cell;

    l.area = 0.0f;
    frame_around(ng, &tangent, &bitangent);
    at = light_place(&g,
                     v3_add(v->p,
                            v3_add(v3_scale(tangent, width * (u.x - 0.5f)),
                                   v3_scale(bitangent, width * (u.y - 0.5f)))),
                     ng, octave);
    if (at.key == 0 ||
        !cell_find(w, &g, light_cell_above(at.key, level), &cell))
        return l;
    l.flux = cell.light;
    l.from = v3_unit(cell.d);
    l.area = light_cell_area(ng) * width * width;
    return l;
}

/* Returns the radiance that a surface sends to wo of the light of a cell. */
static inline struct vec3 cell_light_scattered(const struct cell_light *l,
                                               const struct surface_point *v,
                                               const struct bsdf *b,
                                               struct vec3 wo)
{
    struct vec3 wi, f;
    float pdf;

    if (!(l->area > 0.0f))
        return v3(0.0f, 0.0f, 0.0f);
    wi = surface_to_local(v, l->from);
    if (!surface_sides_agree(v, l->from, wi.z))
        return v3(0.0f, 0.0f, 0.0f);
    f = bsdf_terms(b, wo, wi, &pdf);
    return v3_scale(v3_mul(l->flux, f),
                    bsdf_eta_scale(b, wi) / (fabsf(wi.z) * l->area));
}

/* Returns the radiance that a matte surface sends to wo of the light of light
 * paths of a half. u chooses a place around the point. */
static inline struct vec3 light_cells_radiance(const struct world *w,
                                               uint32_t half_number,
                                               const struct surface_point *v,
                                               const struct bsdf *b,
                                               struct vec3 wo, struct vec2 u)
{
    struct cell_light l = light_cells_at(w, half_number, v, v->ng, u);
    struct vec3 sum = cell_light_scattered(&l, v, b, wo);

    if (is_translucent(b)) {
        l = light_cells_at(w, half_number, v, v3_neg(v->ng), u);
        sum = v3_add(sum, cell_light_scattered(&l, v, b, wo));
    }
    return sum;
}

#endif
