// SPDX-License-Identifier: MIT
/*
 * guide.h - directions that light comes from which is hard to find
 *
 * What chance finds rarely: caustics, and the sky through windows.
 * src/light/path_guide.c has traced some rays, and a grid over the scene says
 * for each way that surfaces face in each of its cubes how much came from which
 * of GUIDE_BINS directions (Jensen 1995, "Importance driven path tracing using
 * the photon map"). At what is diffuse a direction is drawn from the cell's
 * table with the probability that is the table's share, else as elsewhere; its
 * density is that of the mixture (Vorba et al. 2014, "On-line learning of
 * parametric mixture models for light transport simulation", 5.2), so that any
 * table is right, and a good one fast.
 *
 * What light samples can find they are led to, and paths only to the rest:
 * caustics, and the sky behind panes. A path that is led to a window has left
 * the room, and one that stays counts 1 / (1 - share) times as much at each
 * vertex, which in a white room is many times more after the many it has there.
 *
 * Bins are the squares of an octahedral map, whose Jacobian needs no
 * trigonometry: on |x| + |y| + |z| = 1, seen along y, dw = (|x| + |y| + |z|)^3
 * dA for a unit vector.
 *
 * Units:     normalised scene units, densities per solid angle
 */
#ifndef KERNELS_GUIDE_H
#define KERNELS_GUIDE_H

#include "kernels/surface_point.h"

/* A mirror, or as good as one: what it throws on other things is for guiding.
 */
#define GUIDE_ALPHA_MAX 0.3f

/* Where guiding helps: the BSDF hardly knows where to look. */
static inline bool guide_helps(const struct bsdf *b)
{
    return b->kind == MATERIAL_DIFFUSE || b->kind == MATERIAL_ROUGH_DIFFUSE ||
           (b->kind == MATERIAL_PLASTIC && !v3_is_zero(b->color));
}

/* Of GUIDE_FACINGS, for a unit normal. */
static inline uint32_t guide_facing(struct vec3 n)
{
    struct vec3 m = v3(fabsf(n.x), fabsf(n.y), fabsf(n.z));

    if (m.x > m.y && m.x > m.z)
        return n.x < 0.0f ? 1u : 0u;
    if (m.y > m.z)
        return n.y < 0.0f ? 3u : 2u;
    return n.z < 0.0f ? 5u : 4u;
}

/* The cell of a surface with this normal: in the cube that p is in or, outside
 * the grid, nearest to. */
static inline uint32_t guide_cell_index(const struct guide_grid *g,
                                        struct vec3 p, struct vec3 n)
{
    struct vec3 at = v3_scale(v3_sub(p, g->lo), g->cells_per_unit);
    uint32_t x = (uint32_t)f_min(f_max(at.x, 0.0f), (float)(g->width - 1));
    uint32_t y = (uint32_t)f_min(f_max(at.y, 0.0f), (float)(g->height - 1));
    uint32_t z = (uint32_t)f_min(f_max(at.z, 0.0f), (float)(g->depth - 1));

    return ((z * g->height + y) * g->width + x) * GUIDE_FACINGS +
           guide_facing(n);
}

/* A cell without directions. */
static inline struct guide_cell guide_cell_none(void)
{
    struct guide_cell none = {NO_INDEX, NO_INDEX};

    return none;
}

/* What the surface's cell has. */
static inline struct guide_cell guide_at(const struct world *w, struct vec3 p,
                                         struct vec3 n)
{
    if (w->settings.guide.width == 0)
        return guide_cell_none();
    return w->guide_cells[guide_cell_index(&w->settings.guide, p, n)];
}

static inline float guide_sign(float x)
{
    return x < 0.0f ? -1.0f : 1.0f;
}

/* Turns the square's corners over its edges: the half below y = 0, and back. */
static inline struct vec2 guide_fold(struct vec2 p)
{
    return v2((1.0f - fabsf(p.y)) * guide_sign(p.x),
              (1.0f - fabsf(p.x)) * guide_sign(p.y));
}

static inline float guide_norm(struct vec3 d)
{
    return fabsf(d.x) + fabsf(d.y) + fabsf(d.z);
}

/* The bin that unit vector d is in. */
static inline uint32_t guide_bin(struct vec3 d)
{
    float scale = 1.0f / guide_norm(d);
    struct vec2 p = v2(d.x * scale, d.z * scale);
    float middle = 0.5f * (float)GUIDE_SIDE;
    float last = (float)(GUIDE_SIDE - 1);

    if (d.y < 0.0f)
        p = guide_fold(p);
    return (uint32_t)f_min(f_max((p.y + 1.0f) * middle, 0.0f), last) *
               GUIDE_SIDE +
           (uint32_t)f_min(f_max((p.x + 1.0f) * middle, 0.0f), last);
}

/* The direction at (x, y) of the whole map, both in [0, GUIDE_SIDE]. */
static inline struct vec3 guide_direction(float x, float y)
{
    float step = 2.0f / (float)GUIDE_SIDE;
    struct vec2 p = v2(x * step - 1.0f, y * step - 1.0f);
    float height = 1.0f - fabsf(p.x) - fabsf(p.y);

    if (height < 0.0f)
        p = guide_fold(p);
    return v3_unit(v3(p.x, height, p.y));
}

/* How often, of one, the table that begins at `first` is asked: its last sum.
 */
static inline float guide_share(const struct world *w, uint32_t first)
{
    return w->guide_cdf[first + GUIDE_BINS - 1];
}

static inline float guide_cdf_before(const struct world *w, uint32_t first,
                                     uint32_t bin)
{
    return bin == 0 ? 0.0f : w->guide_cdf[first + bin - 1];
}

/* Density of guide_sample() at the unit vector d, times the table's share. */
static inline float guide_pdf(const struct world *w, uint32_t first,
                              struct vec3 d)
{
    uint32_t bin = guide_bin(d);
    float norm = guide_norm(d);

    return (w->guide_cdf[first + bin] - guide_cdf_before(w, first, bin)) *
           (0.25f * (float)GUIDE_BINS) / (norm * norm * norm);
}

/* Density at the unit vector d of the mixture of the table and of what is asked
 * in the other cases, where that has density pdf. */
static inline float guide_mixed_pdf(const struct world *w, uint32_t first,
                                    struct vec3 d, float pdf)
{
    return (1.0f - guide_share(w, first)) * pdf + guide_pdf(w, first, d);
}

/* What is left of u.x, no less than the table's share, for the other cases. */
static inline struct vec2 guide_remap(struct vec2 u, float share)
{
    u.x = f_min((u.x - share) / (1.0f - share), UNIT_FLOAT_MAX);
    return u;
}

/* A direction for u.x below the table's share. */
static inline struct vec3 guide_sample(const struct world *w, uint32_t first,
                                       struct vec2 u)
{
    uint32_t bin = 0;
    float before, part;

    /* the first bin whose sum is above u.x */
    for (uint32_t jump = GUIDE_BINS / 2; jump > 0; jump /= 2)
        if (w->guide_cdf[first + bin + jump - 1] <= u.x)
            bin += jump;
    before = guide_cdf_before(w, first, bin);
    part = f_min((u.x - before) / (w->guide_cdf[first + bin] - before), 1.0f);
    return guide_direction((float)(bin % GUIDE_SIDE) + part,
                           (float)(bin / GUIDE_SIDE) + u.y);
}

/* Draws a direction from the mixture; false if there is none, or the face is in
 * its way. The sample's weight and density are as if the BSDF had drawn it, and
 * *scale is multiplied by the BSDF's density over the mixture's: roulette would
 * end the paths that were worth finding, and weights of light samples need no
 * look-up, for those of any two densities sum to 1. */
static inline bool guide_scatter(const struct world *w, uint32_t first,
                                 const struct surface_point *v,
                                 const struct bsdf *b, struct vec3 wo,
                                 struct vec2 u, float choice,
                                 struct bsdf_sample *s, struct vec3 *wi,
                                 float *scale)
{
    float share = guide_share(w, first);
    float pdf;

    if (u.x < share) {
        struct vec3 wi_local, f;

        *wi = guide_sample(w, first, u);
        wi_local = surface_to_local(v, *wi);
        f = bsdf_terms(b, wo, wi_local, &pdf);
        if (!sample_density(s, wi_local, f, pdf) ||
            !surface_sides_agree(v, *wi, wi_local.z))
            return false;
    } else if (!surface_scatter(v, b, wo, guide_remap(u, share), choice, s,
                                wi)) {
        return false;
    }
    if (s->is_delta)
        *scale /= 1.0f - share;
    else
        *scale *= s->pdf / guide_mixed_pdf(w, first, *wi, s->pdf);
    return true;
}

#endif
