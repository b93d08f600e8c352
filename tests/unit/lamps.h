// SPDX-License-Identifier: MIT
/*
 * lamps.h - worlds of lamps for tests, and random receivers in them
 *
 * Units:     normalised scene units
 * Ownership: discard() frees mesh and lights
 * Threads:   one
 * Errors:    a test ends when memory is out
 */
#ifndef TESTS_LAMPS_H
#define TESTS_LAMPS_H

#include <math.h>

#include "tests/unit/check.h"
#include "tests/unit/mesh.h"
#include "world/light/lights.h"
#include "kernels/light.h"
#include "kernels/rng.h"

/* Means of n numbers are compared with the truth within 4.9 standard errors,
 * which chance exceeds once in a million. Seeds are fixed. */
#define Z_LIMIT 4.9

#define LAMP 1

static inline float between(uint64_t *seed, double lo, double hi)
{
    return (float)(lo + (hi - lo) * check_random(seed));
}

static inline struct vec3 point_between(uint64_t *seed, double lo, double hi)
{
    float x = between(seed, lo, hi);
    float y = between(seed, lo, hi);

    return v3(x, y, between(seed, lo, hi));
}

static inline struct vec3 any_direction(uint64_t *seed)
{
    float z = between(seed, -1, 1);
    struct vec2 turn = cos_sin_turns(between(seed, 0, 1));
    float r = sqrtf(1.0f - z * z);

    return v3(r * turn.x, r * turn.y, z);
}

static inline struct receiver any_receiver(uint64_t *seed)
{
    struct receiver r = {point_between(seed, -1, 1), any_direction(seed),
                         check_random(seed) < 0.3, false};

    return r;
}

static inline struct vec2 any_choice(uint64_t *seed)
{
    float x = unit_float((uint32_t)(check_random(seed) * 4294967296.0));

    return v2(x, unit_float((uint32_t)(check_random(seed) * 4294967296.0)));
}

/* Adds triangles of about this size at random places in the unit cube. */
static inline void add_lamps(struct mesh *m, int count, double size,
                             uint64_t *seed)
{
    for (int i = 0; i < count; i++) {
        struct vec3 p = point_between(seed, -0.9, 0.9);
        struct vec3 e = point_between(seed, -size, size);

        mesh_add(m, p, v3_add(p, e),
                 v3_add(p, point_between(seed, -size, size)), LAMP);
    }
}

/* Adds the triangle beginning with another of its corners. */
static inline void add_turned(struct mesh *m, const struct vec3 p[3],
                              uint32_t turn)
{
    mesh_add(m, p[turn % 3], p[(turn + 1) % 3], p[(turn + 2) % 3], LAMP);
}

/* Adds both triangles of a ring of four corners, divided from the first to the
 * third. */
static inline void add_ring(struct mesh *m, const struct vec3 p[4],
                            uint32_t turns)
{
    const struct vec3 second[3] = {p[0], p[2], p[3]};

    add_turned(m, p, turns % 3);
    add_turned(m, second, turns / 3);
}

/* Adds parallelograms of about this size at random places in the unit cube. */
static inline void add_quads(struct mesh *m, int count, double size,
                             uint64_t *seed)
{
    for (int i = 0; i < count; i++) {
        struct vec3 p = point_between(seed, -0.9, 0.9);
        struct vec3 a = v3_add(p, point_between(seed, -size, size));
        struct vec3 b = v3_add(p, point_between(seed, -size, size));
        const struct vec3 ring[4] = {p, a, v3_sub(v3_add(a, b), p), b};

        add_ring(m, ring, (uint32_t)i % 9);
    }
}

/* Fills point lights at random places in the unit cube: points, spots and
 * spheres in turn. */
static inline void fill_points(struct point_light *points, uint32_t count,
                               uint64_t *seed)
{
    for (uint32_t i = 0; i < count; i++) {
        float intensity = between(seed, 0.5, 4);
        struct point_light l = {.p = point_between(seed, -0.9, 0.9),
                                .cone_offset = 1};

        if (i % 3 == 1) { /* between 30 and 60 degrees */
            l.axis = any_direction(seed);
            l.cone_scale = 2.7320508f;
            l.cone_offset = -1.3660254f;
        }
        if (i % 3 == 2) {
            l.radius = between(seed, 0.001, 0.05);
            intensity /= PI * l.radius * l.radius;
        }
        l.emission = v3(intensity, intensity, intensity);
        points[i] = l;
    }
}

static inline void finish(struct mesh *m, struct lights *lights)
{
    struct error err;

    m->materials[0] = mesh_material(MATERIAL_DIFFUSE, 0.5f);
    if (v3_is_zero(m->materials[LAMP].emission)) {
        m->materials[LAMP] = mesh_material(MATERIAL_DIFFUSE, 0);
        m->materials[LAMP].emission = v3(1, 2, 3);
    }
    mesh_set_normals(m);
    m->world.positions = m->positions;
    m->world.tris = m->tris;
    m->world.settings.tri_count = m->tri_count;
    m->world.settings.material_count = MESH_MATERIALS;
    m->world.materials = m->materials;
    *lights = (struct lights){.lights = NULL};
    assert_true(lights_build(lights, &m->world, &err));
    lights_lend(lights, &m->world);
}

static inline void discard(struct mesh *m, struct lights *lights)
{
    lights_free(lights);
    mesh_free(m);
}

/* Sums the probabilities of all lights for a receiver. */
static inline double sum_of_probabilities(const struct world *w,
                                          const struct receiver *r)
{
    double sum = 0;

    for (uint32_t i = 0; i < light_tree_count(w); i++)
        sum += (double)light_tree_pmf(w, r, i);
    return sum;
}

/* Returns the irradiance by n independent light samples, and its standard
 * error. */
static inline double irradiance(const struct world *w, const struct receiver *r,
                                int n, uint64_t *seed, double *error)
{
    double sum = 0, squares = 0;

    for (int i = 0; i < n; i++) {
        struct light_sample s;
        struct vec2 point = any_choice(seed);
        double e = 0;

        if (light_sample(w, r, NO_INDEX, point, any_choice(seed), &s))
            e = (double)(s.radiance.x * f_max(v3_dot(s.wi, r->n), 0) / s.pdf);
        sum += e;
        squares += e * e;
    }
    *error = sqrt(fmax(squares / n - pow(sum / n, 2), 0) / (n - 1));
    return sum / n;
}

#endif
