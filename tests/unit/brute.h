// SPDX-License-Identifier: MIT
/*
 * brute.h - the ray query by brute force, with which all others must agree
 *
 * Units:     normalised scene units
 * Threads:   any; the state of random numbers is the caller's
 */
#ifndef TESTS_BRUTE_H
#define TESTS_BRUTE_H

#include <math.h>

#include "tests/unit/check.h"
#include "kernels/hit.h"

/* Tests every triangle, with the same test and the same rule for ties. */
static inline bool brute_force(const struct world *w, struct ray r,
                               struct hit *best)
{
    struct shear s = shear_of(r);

    best->t = r.t_max;
    best->tri = NO_INDEX;
    for (uint32_t i = 0; i < w->settings.tri_count; i++) {
        struct hit h;

        if (!triangle_hit(r, s,
                          (struct leaf_tri){w->positions[w->tris[i].v[0]],
                                            w->positions[w->tris[i].v[1]],
                                            w->positions[w->tris[i].v[2]],
                                            NO_INDEX},
                          best->t, &h) ||
            h.t == best->t)
            continue;
        h.tri = i;
        *best = h;
    }
    return best->tri != NO_INDEX;
}

/* Uniform in [-half, half]. */
static inline float random_span(uint64_t *seed, float half)
{
    return (float)(2 * check_random(seed) - 1) * half;
}

static inline struct vec3 random_point(uint64_t *seed, float half)
{
    float x = random_span(seed, half), y = random_span(seed, half);
    float z = random_span(seed, half);

    return v3(x, y, z);
}

/* Returns a point of a triangle, or one 1e-9 to 1e-3 away. */
static inline struct vec3 near_point(const struct vec3 p[3], uint64_t *seed)
{
    float u = (float)check_random(seed), v = (float)check_random(seed);
    float away = powf(10.0f, -9.0f + 6.0f * (float)check_random(seed));

    return v3_add(v3_lerp(v3_lerp(p[0], p[1], u), p[2], v),
                  random_point(seed, away));
}

/* Returns a ray to a point of a triangle, often on its edge, from a point
 * almost in its plane. */
static inline struct ray grazing_ray(const struct vec3 p[3], uint64_t *seed)
{
    float u = check_random(seed) < 0.5 ? 0.0f : (float)check_random(seed);
    struct vec3 at =
        v3_lerp(v3_lerp(p[0], p[1], u), p[2], (float)check_random(seed));
    float height = powf(10.0f, -6.0f + 5.0f * (float)check_random(seed));
    struct ray r = {random_point(seed, 1.2f), {0, 0, 0}, FLOAT_MAX, 0, 0};
    struct vec3 n;

    if (triangle_normal(p[0], p[1], p[2], &n))
        r.o = v3_sub(r.o,
                     v3_scale(n, v3_dot(v3_sub(r.o, at), n) * (1.0f - height)));
    r.d = v3_unit(v3_sub(at, r.o));
    return r;
}

#endif
