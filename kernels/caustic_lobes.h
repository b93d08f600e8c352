// SPDX-License-Identifier: MIT
/*
 * caustic_lobes.h - guided directions to caustics of lamps, such as the sun
 *
 * Light that glass or metal sends to a place comes from few directions if its
 * source is small: those of the sun fill a hundredth of a bin of guide.h. The
 * leaves of a k-d tree over the photons of caustics have lobes instead
 * (light/caustic_lobes.c). A lobe is a density on a plane through the points of
 * the caster that its photons came from, so that places far from each other
 * still aim at the same point (Ruppert et al. 2020, "Robust fitting of
 * parallax-aware mixtures for path guiding"). Its middle moves on the plane in
 * proportion to the place, as an image of the sun does on a curved surface.
 *
 * The density is that of Student's t with two degrees of freedom, 1 / (pi (1 +
 * r^2)^2). It needs no exponential, and far from the middle it is still high
 * enough that light which the photons have missed makes no specks.
 *
 * Units:     normalised scene units, densities per solid angle
 */
#ifndef KERNELS_CAUSTIC_LOBES_H
#define KERNELS_CAUSTIC_LOBES_H

#include "kernels/guide.h"

/* The leaf of a surface by its position p and unit normal n, or NO_INDEX if it
 * has no lobes. */
static inline uint32_t caustic_leaf_at(const struct world *w, struct vec3 p,
                                       struct vec3 n)
{
    uint32_t i = guide_facing(n);
    uint32_t next;

    if (w->settings.caustic_node_count == 0)
        return NO_INDEX;
    for (next = w->caustic_nodes[i].next; (next & 3u) != 3u;
         next = w->caustic_nodes[i].next)
        i = (next >> 2) +
            (v3_axis(p, next & 3u) < w->caustic_nodes[i].split ? 0u : 1u);
    return next == NO_INDEX ? NO_INDEX : i;
}

/* Probability to sample the lobes of a leaf. */
static inline float caustic_share(const struct world *w, uint32_t leaf)
{
    return w->caustic_nodes[leaf].split;
}

/* Density of a lobe at the unit vector d from p. */
static inline float caustic_lobe_pdf(const struct caustic_lobe *l,
                                     struct vec3 p, struct vec3 d)
{
    float height = l->height - v3_dot(l->axis, p);
    float cosine = v3_dot(l->axis, d);
    float u, v, tail;

    if (!(height > 0.0f && cosine > 0.0f))
        return 0.0f;
    /* all times the cosine, for one division */
    u = height * v3_dot(l->u, d) + cosine * (v3_dot(l->du, p) + l->u0);
    v = height * v3_dot(l->v, d) + cosine * (v3_dot(l->dv, p) + l->v0);
    tail = cosine * cosine + (u * u + v * v);
    return l->scale * height * height * cosine / (tail * tail);
}

/* Samples a lobe for a surface at p. Returns false if p is behind its plane. */
static inline bool caustic_lobe_sample(const struct caustic_lobe *l,
                                       struct vec3 p, struct vec2 u,
                                       struct vec3 *d)
{
    float height = l->height - v3_dot(l->axis, p);
    float radius = sqrtf(u.x / (1.0f - u.x));
    struct vec2 turn = cos_sin_turns(u.y);
    struct vec3 across = v3_cross(l->v, l->axis);
    float scale = 1.0f / v3_dot(l->u, across);
    float x = scale * (radius * turn.x - (v3_dot(l->du, p) + l->u0));
    float y = scale * (radius * turn.y - (v3_dot(l->dv, p) + l->v0));

    if (!(height > 0.0f))
        return false;
    *d = v3_unit(v3_add(v3_scale(l->axis, height),
                        v3_add(v3_scale(across, x),
                               v3_scale(v3_cross(l->axis, l->u), y))));
    return true;
}

/* Density of caustic_sample() at the unit vector d, times the leaf's share. */
static inline float caustic_pdf(const struct world *w, uint32_t leaf,
                                struct vec3 p, struct vec3 d)
{
    uint32_t i = w->caustic_nodes[leaf].next >> 2;
    float before = 0.0f, sum = 0.0f;

    for (; before < 1.0f; i++) {
        struct caustic_lobe l = w->caustic_lobes[i];

        sum += (l.sum - before) * caustic_lobe_pdf(&l, p, d);
        before = l.sum;
    }
    return caustic_share(w, leaf) * sum;
}

/* Samples a lobe of a leaf for a surface at p. u.x is below the leaf's share.
 * Returns false if p is behind the lobe's plane. */
static inline bool caustic_sample(const struct world *w, uint32_t leaf,
                                  struct vec3 p, struct vec2 u, struct vec3 *d)
{
    float choice = f_min(u.x / caustic_share(w, leaf), UNIT_FLOAT_MAX);
    uint32_t i = w->caustic_nodes[leaf].next >> 2;
    struct caustic_lobe l = w->caustic_lobes[i];
    float before = 0.0f;

    while (l.sum <= choice) {
        before = l.sum;
        i++;
        l = w->caustic_lobes[i];
    }
    u.x = f_min((choice - before) / (l.sum - before), UNIT_FLOAT_MAX);
    return caustic_lobe_sample(&l, p, u, d);
}

/* As guide_scatter(), with the lobes of a leaf. `first` is a table of guide.h
 * or NO_INDEX. */
static inline bool
caustic_scatter(const struct world *w, uint32_t leaf, uint32_t first,
                const struct surface_point *v, const struct bsdf *b,
                struct vec3 wo, struct vec2 u, float choice,
                struct bsdf_sample *s, struct vec3 *wi, float *scale)
{
    float share = caustic_share(w, leaf);
    float pdf, others = 1.0f;

    if (u.x < share) {
        if (!caustic_sample(w, leaf, v->p, u, wi) ||
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
    *scale *= s->pdf / ((1.0f - share) * pdf + caustic_pdf(w, leaf, v->p, *wi));
    return true;
}

#endif
