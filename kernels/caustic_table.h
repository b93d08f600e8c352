// SPDX-License-Identifier: MIT
/*
 * caustic_table.h - guided directions to caustics of spheres and of discs, such
 * as the sun
 *
 * Light that glass or metal sends to a place comes from few directions if its
 * source is small: those of the sun fill a hundredth of a bin of guide.h. Here
 * each cell has a table of groups of fine bins (light/caustic_tables.h). As the
 * directions of a group change with the place, its bins move over the map of
 * directions in proportion to it. Bins that have left the map are not sampled.
 * The first grid is around the places of most flux, the second around the
 * scene.
 *
 * Units:     normalised scene units, densities per solid angle
 */
#ifndef KERNELS_CAUSTIC_TABLE_H
#define KERNELS_CAUSTIC_TABLE_H

#include "kernels/guide.h"

/* Bins along a side of the octahedral map: 2^level. */
#define CAUSTIC_LEVEL_LEAST 4u
#define CAUSTIC_LEVEL_MOST  12u

/* The bin of a place in the map among those of a level. */
static inline uint32_t caustic_bin(struct vec2 place, uint32_t level)
{
    float side = (float)(1u << level);
    float x = f_min(f_max((place.x + 1.0f) * 0.5f * side, 0.0f), side - 1.0f);
    float y = f_min(f_max((place.y + 1.0f) * 0.5f * side, 0.0f), side - 1.0f);

    return ((uint32_t)y << level) + (uint32_t)x;
}

static inline bool is_in_map(struct vec2 place)
{
    return fabsf(place.x) <= 1.0f && fabsf(place.y) <= 1.0f;
}

static inline bool is_in_grid(const struct guide_grid *g, struct vec3 p)
{
    struct vec3 at = v3_scale(v3_sub(p, g->lo), g->cells_per_unit);

    return at.x >= 0.0f && at.x < (float)g->width && at.y >= 0.0f &&
           at.y < (float)g->height && at.z >= 0.0f && at.z < (float)g->depth;
}

/* Index of a surface's cell among those of both grids. */
static inline uint32_t caustic_cell_index(const struct guide_grid grids[2],
                                          struct vec3 p, struct vec3 n)
{
    uint32_t before =
        grids[0].width * grids[0].height * grids[0].depth * GUIDE_FACINGS;

    return is_in_grid(&grids[0], p)
               ? guide_cell_index(&grids[0], p, n)
               : before + guide_cell_index(&grids[1], p, n);
}

/* The first group of a surface, or NO_INDEX if it has none. */
static inline uint32_t caustic_table_at(const struct world *w, struct vec3 p,
                                        struct vec3 n)
{
    if (w->settings.caustic_cell_count == 0)
        return NO_INDEX;
    return w
        ->caustic_cells[caustic_cell_index(w->settings.caustic_grids, p, n)];
}

/* Share of the table that begins with a group: the probability to sample it. */
static inline float caustic_share(const struct world *w, uint32_t first)
{
    return w->caustic_groups[first].share;
}

/* The first bin of the group with a sum above u. */
static inline uint32_t caustic_find_sum(const struct world *w,
                                        const struct caustic_group *g, float u)
{
    uint32_t bin = g->first_bin;

    for (uint32_t count = g->bin_count; count > 1;) {
        uint32_t jump = count / 2;
        bool is_behind = w->caustic_bins[bin + jump - 1].sum <= u;

        bin += is_behind ? jump : 0u;
        count = is_behind ? count - jump : jump;
    }
    return bin;
}

/* The group's bin of this index, or NO_INDEX. */
static inline uint32_t caustic_find_bin(const struct world *w,
                                        const struct caustic_group *g,
                                        uint32_t index)
{
    uint32_t bin = g->first_bin;

    for (uint32_t count = g->bin_count; count > 1;) {
        uint32_t jump = count / 2;
        bool is_behind = w->caustic_bins[bin + jump - 1].index < index;

        bin += is_behind ? jump : 0u;
        count = is_behind ? count - jump : jump;
    }
    return w->caustic_bins[bin].index == index ? bin : NO_INDEX;
}

/* Sum of the bins before this one. */
static inline float caustic_sum_before(const struct world *w,
                                       const struct caustic_group *g,
                                       uint32_t bin)
{
    return bin == g->first_bin ? g->before : w->caustic_bins[bin - 1].sum;
}

/* How far a group's bins are moved in the map at p. */
static inline struct vec2 caustic_shift(const struct caustic_group *g,
                                        struct vec3 p)
{
    struct vec3 way = v3_sub(p, g->p);

    return v2(v3_dot(g->dx, way), v3_dot(g->dy, way));
}

/* The group's bin of a place in the map, or NO_INDEX. */
static inline uint32_t caustic_bin_at(const struct world *w,
                                      const struct caustic_group *g,
                                      struct vec3 p, struct vec2 place)
{
    struct vec2 shift = caustic_shift(g, p);

    place = v2(place.x - shift.x, place.y - shift.y);
    return is_in_map(place)
               ? caustic_find_bin(w, g, caustic_bin(place, g->level))
               : NO_INDEX;
}

/* Density of caustic_sample() at the unit vector d, times the table's share. d
 * is from bin `known`, if that is not NO_INDEX: it may round to the next one.
 */
static inline float caustic_pdf(const struct world *w, uint32_t first,
                                struct vec3 p, struct vec3 d, uint32_t known)
{
    struct vec2 place = guide_place(d);
    float norm = guide_norm(d);
    float sum = 0.0f;

    for (uint32_t i = first; i != NO_INDEX;) {
        struct caustic_group g = w->caustic_groups[i];
        uint32_t bin = known - g.first_bin < g.bin_count
                           ? known
                           : caustic_bin_at(w, &g, p, place);

        if (bin != NO_INDEX)
            sum += (w->caustic_bins[bin].sum - caustic_sum_before(w, &g, bin)) *
                   (0.25f * (float)(1u << 2 * g.level));
        i = g.next;
    }
    return sum / (norm * norm * norm);
}

/* Samples the table for a surface at p. u.x is below its share. Returns false
 * for a place outside of the map. */
static inline bool caustic_sample(const struct world *w, uint32_t first,
                                  struct vec3 p, struct vec2 u, uint32_t *bin,
                                  struct vec3 *d)
{
    struct caustic_group g = w->caustic_groups[first];
    struct vec2 place, shift;
    float before, part, step;
    uint32_t index;

    while (g.next != NO_INDEX && w->caustic_groups[g.next].before <= u.x)
        g = w->caustic_groups[g.next];
    *bin = caustic_find_sum(w, &g, u.x);
    before = caustic_sum_before(w, &g, *bin);
    part = f_min((u.x - before) / (w->caustic_bins[*bin].sum - before), 1.0f);
    step = 2.0f / (float)(1u << g.level);
    index = w->caustic_bins[*bin].index;
    shift = caustic_shift(&g, p);
    place = v2(((float)(index & ((1u << g.level) - 1u)) + part) * step - 1.0f +
                   shift.x,
               ((float)(index >> g.level) + u.y) * step - 1.0f + shift.y);
    *d = guide_direction((place.x + 1.0f) * (0.5f * (float)GUIDE_SIDE),
                         (place.y + 1.0f) * (0.5f * (float)GUIDE_SIDE));
    return is_in_map(place);
}

/* As guide_scatter(), with the table of caustics that begins with a group.
 * `first` is a table of guide.h or NO_INDEX. */
static inline bool
caustic_scatter(const struct world *w, uint32_t group, uint32_t first,
                const struct surface_point *v, const struct bsdf *b,
                struct vec3 wo, struct vec2 u, float choice,
                struct bsdf_sample *s, struct vec3 *wi, float *scale)
{
    float share = caustic_share(w, group);
    float pdf, others = 1.0f;
    uint32_t bin = NO_INDEX;

    if (u.x < share) {
        if (!caustic_sample(w, group, v->p, u, &bin, wi) ||
            !guide_take(v, b, wo, *wi, s))
            return false;
    } else if (HAS(FEATURE_GUIDE) && first != NO_INDEX) {
        if (!guide_scatter(w, first, v, b, wo, guide_remap(u, share), choice, s,
                           wi, &others))
            return false;
    } else if (!surface_scatter(v, b, wo, guide_remap(u, share), choice, s,
                                wi)) {
        return false;
    }
    if (s->is_delta) {
        *scale *= others / (1.0f - share);
        return true;
    }
    pdf = HAS(FEATURE_GUIDE) && first != NO_INDEX
              ? guide_mixed_pdf(w, first, *wi, s->pdf)
              : s->pdf;
    *scale *=
        s->pdf / ((1.0f - share) * pdf + caustic_pdf(w, group, v->p, *wi, bin));
    return true;
}

#endif
