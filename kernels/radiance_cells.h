// SPDX-License-Identifier: MIT
/*
 * radiance_cells.h - radiance that matte surfaces reflect, in cells of space,
 * at which paths from the eye end after a wide bounce
 *
 * Paths that are traced first for each block of samples
 * (render/radiance_training.h) give the cells estimates of the radiance, from
 * each of their matte vertices (Ward, Rubinstein and Clear 1988, "A ray tracing
 * solution for diffuse interreflection"; with a path for each estimate, Jensen
 * 1996). It is divided by the color of the surface, so that textures stay
 * sharp. Grids, and how their blur is seen and vanishes, are those of
 * cell_grid.h.
 *
 * Where light paths bring light of lamps by way of surfaces that cast
 * (FEATURE_LIGHT_PATHS), cells leave it out, and only paths that leave it out
 * give estimates or end at cells.
 *
 * Units:     normalised scene units; radiance divided by color
 */
#ifndef KERNELS_RADIANCE_CELLS_H
#define KERNELS_RADIANCE_CELLS_H

#include "kernels/cell_grid.h"
#include "kernels/path_state.h"

/* The first grid of radiance cells in world.light_grids. */
#define RADIANCE_GRID 2u

/* Least number of estimates of a cell at which a path ends. */
#define RADIANCE_COUNT_MIN 2.0f

/* Least way to a cell at which a path ends, in widths of the cell. */
#define RADIANCE_WAY_MIN 2.0f

/* Reflectance at normal incidence below which a highlight hides in the light of
 * the surface. */
#define RADIANCE_SPECULAR_MAX 0.1f

/* Least cosine between a surface's normal and a ray that ends at its cell.
 * Rays that graze a surface see into gaps, such as that behind a lamp, which
 * other rays to the cell do not. */
#define RADIANCE_COS_MIN 0.35f

/* Density per solid angle of a ray's direction, from which on a bounce is not
 * wide: that of a lobe with a GGX roughness of about .28. */
#define RADIANCE_PDF_MAX 1.0f

/* Least part of the largest channel that a channel of an estimate's weight
 * must have: the others would not know theirs. */
#define RADIANCE_WEIGHT_MIN 1e-4f

static inline bool radiance_is_diffuse(const struct bsdf *b)
{
    return guide_helps(b) && b->kind != MATERIAL_PLASTIC;
}

/* True if a surface sends nearly the same radiance into all directions. */
static inline bool radiance_is_even(const struct bsdf *b)
{
    return radiance_is_diffuse(b) ||
           ((guide_helps(b) || (bsdf_is_principled(b) && b->metalness < 0.5f &&
                                !bsdf_is_glass(b))) &&
            v3_max_component(b->specular) < RADIANCE_SPECULAR_MAX);
}

/* By which radiance is divided in cells. */
static inline struct vec3 radiance_color(const struct bsdf *b)
{
    return radiance_is_diffuse(b) ? base_albedo(b)
                                  : v3_add(base_albedo(b), b->specular);
}

/* The cell of a point of a surface with unit normal ng on the eye's side. Each
 * material has cells of its own. */
static inline struct cell_place radiance_place(const struct light_grid *g,
                                               struct vec3 p, struct vec3 ng,
                                               uint32_t material)
{
    struct cell_place at =
        cell_place(g, p, cell_octave(g, p), guide_facing(ng));

    if (at.key != 0)
        at.key ^= (uint64_t)hash_u32(material) << 1;
    return at;
}

/* True if the path's ray comes a long way to a cell of this width, from a wide
 * bounce, or from the camera or a delta lobe, whose density is 0. */
static inline bool radiance_is_far(const struct path *p, float way, float width)
{
    float least = RADIANCE_WAY_MIN * width;

    return p->pdf < RADIANCE_PDF_MAX &&
           way * way > f_max(PI * p->pdf, 1.0f) * least * least;
}

/* Notes a vertex of a path, before its light samples and its next ray. */
static inline void radiance_note(struct path *p, const struct bsdf *b,
                                 uint64_t key)
{
    struct vec3 weight = path_part(p, radiance_color(b), 1.0f);
    struct cell_estimate *to = &p->estimates->at[p->estimates->count];

    /* further glass would show a wavelength's light in place of the mean */
    if (HAS(FEATURE_DISPERSION) && p->wavelength > 0.0f)
        return;
    if (p->estimates->count == CELL_ESTIMATES_MAX ||
        !(f_min(weight.x, f_min(weight.y, weight.z)) >
          RADIANCE_WEIGHT_MIN * v3_max_component(weight)))
        return;
    p->estimates->count++;
    to->key = key;
    to->weight = weight;
    to->radiance = p->out.radiance;
}

static inline float radiance_since(float before, float now, float weight)
{
    return f_max(now - before, 0.0f) / weight;
}

/* Completes the estimates at the end of the path. */
static inline void radiance_estimate(struct path *p)
{
    struct vec3 now = p->out.radiance;

    for (uint32_t i = 0; i < p->estimates->count; i++) {
        struct cell_estimate *to = &p->estimates->at[i];
        struct vec3 before = to->radiance;

        to->radiance = v3(radiance_since(before.x, now.x, to->weight.x),
                          radiance_since(before.y, now.y, to->weight.y),
                          radiance_since(before.z, now.z, to->weight.z));
    }
}

/* Adds the radiance of the surface's cell. Returns false if the path has to go
 * on in its place. */
static inline bool radiance_end(const struct world *w, struct path *p,
                                const struct light_grid *g,
                                const struct bsdf *b, uint64_t key)
{
    struct light_cell cell;

    if (!cell_find(w, g, key, &cell) || cell.d.x < RADIANCE_COUNT_MIN)
        return false;
    path_add(p, v3_mul(cell.light, radiance_color(b)), 1.0f);
    return true;
}

/* Gives the cell of a vertex an estimate, or ends the path there. Both are done
 * after the same bounces, as other vertices of a cell, in a gap behind a lamp,
 * may be much brighter; diffuse surfaces that the eye sees, directly or in a
 * mirror, give estimates as well. Returns true if the path ends. */
APART static bool radiance_meet(const struct world *w, struct path *p,
                                const struct surface_point *v,
                                const struct bsdf *b, uint32_t tri, float way)
{
    struct light_grid g = w->light_grids[RADIANCE_GRID + p->half_number];
    struct cell_place at;

    if (!radiance_is_even(b))
        return false;
    if (HAS(FEATURE_LIGHT_PATHS) && w->settings.has_light_paths != 0 &&
        !p->drops)
        return false;
    if (fabsf(v3_dot(p->ray.d, v->ng)) < RADIANCE_COS_MIN)
        return false;
    at = radiance_place(&g, v->p, v->ng, tri_material(w, tri, v->instance));
    if (at.key == 0 || !radiance_is_far(p, way, at.width))
        return false;
    if (p->estimates == NULL)
        return p->pdf > 0.0f && radiance_end(w, p, &g, b, at.key);
    if (p->pdf > 0.0f || radiance_is_diffuse(b))
        radiance_note(p, b, at.key);
    return false;
}

#endif
