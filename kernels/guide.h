// SPDX-License-Identifier: MIT
/*
 * guide.h - path guiding: directions of light that is hard to find
 *
 * src/world/light/path_guide.c has traced rays for the sky through windows,
 * which BSDF and light samples rarely find. Each cell of a grid over the scene
 * has tables of how much arrives from each of GUIDE_BINS directions (Jensen
 * 1995, "Importance driven path tracing using the photon map"). At a diffuse
 * surface a direction is sampled from the cell's table with a fixed
 * probability, the table's share, and otherwise from the BSDF or the light. Its
 * density is that of the mixture (Vorba et al. 2014, "On-line learning of
 * parametric mixture models for light transport simulation", 5.2), so that any
 * table is unbiased, and a good one has less variance.
 *
 * There are two tables. Light samples are guided to the sky that they can
 * reach; paths are guided to the rest only, the sky behind panes of glass. A
 * path that is guided to a window has left the room, and one that is not counts
 * 1 / (1 - share) times as much at each vertex, which adds up in a white room.
 *
 * Bins are squares of an octahedral map, whose Jacobian needs no trigonometry:
 * the octahedron |x| + |y| + |z| = 1 projected along y, with the solid angle dw
 * = (|x| + |y| + |z|)^3 dA for a unit vector.
 *
 * Units:     normalised scene units, densities per solid angle
 */
#ifndef KERNELS_GUIDE_H
#define KERNELS_GUIDE_H

#include "kernels/surface_point.h"

/* True if the BSDF is diffuse enough for guiding. */
static inline bool guide_helps(const struct bsdf *b)
{
    return b->kind == MATERIAL_DIFFUSE || b->kind == MATERIAL_ROUGH_DIFFUSE ||
           (b->kind == MATERIAL_PLASTIC && !v3_is_zero(base_albedo(b)));
}

/* The class of a unit normal, below GUIDE_FACINGS. */
static inline uint32_t guide_facing(struct vec3 n)
{
    struct vec3 m = v3(fabsf(n.x), fabsf(n.y), fabsf(n.z));

    if (m.x > m.y && m.x > m.z)
        return n.x < 0.0f ? 1u : 0u;
    if (m.y > m.z)
        return n.y < 0.0f ? 3u : 2u;
    return n.z < 0.0f ? 5u : 4u;
}

/* Index of a surface's cell, by its position p and unit normal n. Positions
 * outside the grid are clamped to it. */
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

/* A cell without tables. */
static inline struct guide_cell guide_cell_none(void)
{
    struct guide_cell none = {NO_INDEX, NO_INDEX};

    return none;
}

/* The cell of a surface, without tables if the world has no guide. */
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

/* Maps between a point of the outer half of the square, which has the
 * directions with y < 0, and its mirror image in the inner half. */
static inline struct vec2 guide_fold(struct vec2 p)
{
    return v2((1.0f - fabsf(p.y)) * guide_sign(p.x),
              (1.0f - fabsf(p.x)) * guide_sign(p.y));
}

static inline float guide_norm(struct vec3 d)
{
    return fabsf(d.x) + fabsf(d.y) + fabsf(d.z);
}

/* The place of the unit vector d in the map, both in [-1, 1]. */
static inline struct vec2 guide_place(struct vec3 d)
{
    float scale = 1.0f / guide_norm(d);
    struct vec2 p = v2(d.x * scale, d.z * scale);

    return d.y < 0.0f ? guide_fold(p) : p;
}

/* The bin of the unit vector d. */
static inline uint32_t guide_bin(struct vec3 d)
{
    struct vec2 p = guide_place(d);
    float middle = 0.5f * (float)GUIDE_SIDE;
    float last = (float)(GUIDE_SIDE - 1);

    return (uint32_t)f_min(f_max((p.y + 1.0f) * middle, 0.0f), last) *
               GUIDE_SIDE +
           (uint32_t)f_min(f_max((p.x + 1.0f) * middle, 0.0f), last);
}

/* The direction at point (x, y) of the map, both in [0, GUIDE_SIDE]. */
static inline struct vec3 guide_direction(float x, float y)
{
    float step = 2.0f / (float)GUIDE_SIDE;
    struct vec2 p = v2(x * step - 1.0f, y * step - 1.0f);
    float height = 1.0f - fabsf(p.x) - fabsf(p.y);

    if (height < 0.0f)
        p = guide_fold(p);
    return v3_unit(v3(p.x, height, p.y));
}

/* Share of the table that begins at `first`: the probability to sample it. It
 * is the last number of its cdf. */
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

/* Density of the mixture at the unit vector d, where the other technique has
 * density pdf. */
static inline float guide_mixed_pdf(const struct world *w, uint32_t first,
                                    struct vec3 d, float pdf)
{
    return (1.0f - guide_share(w, first)) * pdf + guide_pdf(w, first, d);
}

/* Remaps u.x, which is not below the table's share, for use by the other
 * technique. */
static inline struct vec2 guide_remap(struct vec2 u, float share)
{
    u.x = f_min((u.x - share) / (1.0f - share), UNIT_FLOAT_MAX);
    return u;
}

/* Samples the table. u.x is below its share. */
static inline struct vec3 guide_sample(const struct world *w, uint32_t first,
                                       struct vec2 u)
{
    uint32_t bin = 0;
    float before, part;

    /* the first bin whose cdf is above u.x */
    for (uint32_t jump = GUIDE_BINS / 2; jump > 0; jump /= 2)
        if (w->guide_cdf[first + bin + jump - 1] <= u.x)
            bin += jump;
    before = guide_cdf_before(w, first, bin);
    part = f_min((u.x - before) / (w->guide_cdf[first + bin] - before), 1.0f);
    return guide_direction((float)(bin % GUIDE_SIDE) + part,
                           (float)(bin / GUIDE_SIDE) + u.y);
}

/* Evaluates the BSDF for a direction that a table has given. Returns false if
 * it is absorbed or blocked by the face. */
static inline bool guide_take(const struct surface_point *v,
                              const struct bsdf *b, struct vec3 wo,
                              struct vec3 wi, struct bsdf_sample *s)
{
    struct vec3 wi_local = surface_to_local(v, wi);
    float pdf;
    struct vec3 f = bsdf_terms(b, wo, wi_local, &pdf);

    return sample_density(s, wi_local, f, pdf) &&
           surface_sides_agree(v, wi, wi_local.z);
}

/* Samples the mixture of table and BSDF. Returns false if the direction is
 * absorbed or blocked by the face. The sample has the BSDF's weight and
 * density, and *scale is multiplied by the BSDF's density over the mixture's.
 * Kept apart like this, the weight does not make roulette end the paths that
 * were worth finding, and MIS weights need no look-up in the table: those of
 * any two densities sum to 1. */
static inline bool guide_scatter(const struct world *w, uint32_t first,
                                 const struct surface_point *v,
                                 const struct bsdf *b, struct vec3 wo,
                                 struct vec2 u, float choice,
                                 struct bsdf_sample *s, struct vec3 *wi,
                                 float *scale)
{
    float share = guide_share(w, first);

    if (u.x < share) {
        *wi = guide_sample(w, first, u);
        if (!guide_take(v, b, wo, *wi, s))
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
