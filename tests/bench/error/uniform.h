// SPDX-License-Identifier: MIT
/*
 * uniform.h - replaces the light tree: all lights are equally likely
 */
#ifndef ERROR_UNIFORM_H
#define ERROR_UNIFORM_H

#include "kernels/light_tree.h"

static inline float uniform_probability(const struct world *w,
                                        const struct receiver *r,
                                        uint32_t light)
{
    (void)r;
    (void)light;
    return 1.0f / (float)w->settings.light_count;
}

static inline float uniform_choose(const struct world *w,
                                   const struct receiver *r, struct vec2 choice,
                                   uint32_t *light)
{
    *light = (uint32_t)(choice.x * (float)w->settings.light_count);
    if (*light >= w->settings.light_count) /* by rounding, or without lights */
        return 0.0f;
    return uniform_probability(w, r, *light);
}

#define light_tree_sample uniform_choose
#define light_tree_pmf    uniform_probability

#endif
