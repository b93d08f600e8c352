// SPDX-License-Identifier: MIT
/*
 * light_cells.h - light of light paths at matte surfaces that the eye sees
 * through glass or in mirrors
 *
 * No light path can be connected to the camera there. Its flux is summed in
 * cells of space instead, which the first matte surface of a path from the eye
 * looks up (photon mapping: Jensen 1996, "Global illumination using photon
 * maps", with cells for the search). Cells are about as wide as a pixel seen
 * from the eye. Those of one half are four times as wide as those of the other:
 * where blur grows with the square of the width, half the difference of the
 * halves is 15/17 of the mean blur.
 *
 * Units:     normalised scene units; flux, divided by the number of light paths
 */
#ifndef KERNELS_LIGHT_CELLS_H
#define KERNELS_LIGHT_CELLS_H

#include "kernels/cell_grid.h"
#include "kernels/surface_point.h"

/* The cell of a point of a surface, whose unit normal ng is on the side of the
 * light. */
static inline struct cell_place light_place(const struct light_grid *g,
                                            struct vec3 p, struct vec3 ng)
{
    return cell_place(g, p, v3_dot(ng, g->facing) > 0.0f ? 1u : 0u);
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

/* Returns the radiance that a matte surface sends to wo of the light of light
 * paths. u chooses a place around the point. */
static inline struct vec3 light_cells_radiance(const struct world *w,
                                               uint32_t grid,
                                               const struct surface_point *v,
                                               const struct bsdf *b,
                                               struct vec3 wo, struct vec2 u)
{
    struct vec3 none = v3(0.0f, 0.0f, 0.0f), tangent, bitangent, wi, f;
    struct light_grid g = w->light_grids[grid];
    struct cell_place at = light_place(&g, v->p, v->ng);
    struct light_cell cell;
    float pdf, area;

    frame_around(v->ng, &tangent, &bitangent);
    at = light_place(
        &g,
        v3_add(v->p, v3_add(v3_scale(tangent, at.width * (u.x - 0.5f)),
                            v3_scale(bitangent, at.width * (u.y - 0.5f)))),
        v->ng);
    if (at.key == 0 || !cell_find(w, &g, at.key, &cell))
        return none;
    wi = surface_to_local(v, cell.d);
    if (!surface_sides_agree(v, cell.d, wi.z))
        return none;
    f = bsdf_terms(b, wo, wi, &pdf);
    area = light_cell_area(v->ng) * at.width * at.width;
    return v3_scale(v3_mul(cell.light, f),
                    bsdf_eta_scale(b, wi) / (fabsf(wi.z) * area));
}

#endif
