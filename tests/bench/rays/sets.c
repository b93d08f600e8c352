// SPDX-License-Identifier: MIT
#include "sets.h"

#include <stdlib.h>

#include "terminal/xmalloc.h"

#include "kernels/camera.h"
#include "kernels/instance.h"
#include "kernels/rng.h"

/* Rays begin this far above a surface, which exceeds the errors of all racers;
 * otherwise their hits would differ. */
#define LIFT 2e-5f

/* A shadow ray ends at this part of the distance, so that no racer hits the
 * lamp itself. */
#define REACH 0.999f

/* Target of shadow rays in scenes without lamps. */
static const struct vec3 sun = {0.5f, 0.5f, 0.2f};

const char *const set_names[SETS] = {"primary", "bounce", "bounce2", "shadow"};

/* Squares of 8 x 8 pixels consist of blocks of 4 x 2, so that any eight
 * consecutive rays are neighbours. */
static void make_primary(struct ray_set *to, const struct camera *c)
{
    uint32_t width = (uint32_t)c->width, height = (uint32_t)c->height;

    to->rays = xcalloc((size_t)width * height, sizeof *to->rays);
    to->count = 0;
    for (uint32_t i = 0; i < width / 8 * (height / 8) * 64; i++) {
        uint32_t square = i / 64, block = i / 8 % 8;
        uint32_t x = square % (width / 8) * 8 + block % 2 * 4 + i % 4;
        uint32_t y = square / (width / 8) * 8 + block / 2 * 2 + i / 4 % 2;

        to->rays[to->count++] = camera_ray(*c, x, y, v2(0.5f, 0.5f));
    }
}

/* Returns the point where a ray leaves the hit, and the normal on the incident
 * side. Returns false if nothing was hit. */
static bool leave(const struct world *w, const struct ray *r, struct answer a,
                  struct ray *next, struct vec3 *n)
{
    struct placed_tri t;

    if (a.tri == NO_INDEX)
        return false;
    t = tri_placed(w, a.tri);
    if (!triangle_normal(t.p[0], t.p[1], t.p[2], n))
        return false;
    if (v3_dot(*n, r->d) > 0.0f)
        *n = v3_neg(*n);
    next->o = v3_add(v3_add(r->o, v3_scale(r->d, a.t)), v3_scale(*n, LIFT));
    next->t_max = FLOAT_MAX;
    next->from = a.tri + 1u;
    return true;
}

/* Returns two independent random numbers of ray i. */
static struct vec2 random_pair(uint32_t i, uint32_t dimension)
{
    uint32_t key = hash_u32(i + hash_u32(dimension + 1u));

    return v2(unit_float(key), unit_float(hash_u32(key + 1u)));
}

static bool bounce(const struct world *w, struct vec2 u, struct vec2 choice,
                   struct vec3 n, struct ray *r)
{
    struct vec3 d = cosine_hemisphere(u);
    struct vec3 t, b;

    (void)w;
    (void)choice;
    frame_around(n, &t, &b);
    r->d = v3_unit(
        v3_add(v3_add(v3_scale(t, d.x), v3_scale(b, d.y)), v3_scale(n, d.z)));
    return true;
}

/* Makes a ray to a point of a lamp. Returns false if it is behind the
 * surface. */
static bool shadow(const struct world *w, struct vec2 u, struct vec2 choice,
                   struct vec3 n, struct ray *r)
{
    uint32_t count = w->settings.light_count;
    float distance;

    r->d = sun;
    if (count > 0) {
        const struct light *l = &w->lights[(uint32_t)(choice.x * (float)count)];
        bool is_second = l->tris[1] != NO_INDEX && choice.y < 0.5f;
        const uint32_t *v = w->tris[l->tris[is_second ? 1 : 0]].v;
        float root = sqrtf(u.x);
        struct vec3 p =
            v3_add(v3_add(v3_scale(w->positions[v[0]], 1.0f - root),
                          v3_scale(w->positions[v[1]], root * (1.0f - u.y))),
                   v3_scale(w->positions[v[2]], root * u.y));

        r->d = v3_sub(p, r->o);
    }
    distance = v3_length(r->d);
    if (!(distance > LIFT) || v3_dot(r->d, n) <= 0.0f)
        return false;
    if (count > 0)
        r->t_max = distance * REACH;
    r->d = v3_scale(r->d, 1.0f / distance);
    return true;
}

/* Makes rays that continue from the answers. */
static void make_next(struct ray_set *to, const struct world *w,
                      const struct ray_set *from, const struct answer *answers,
                      uint32_t dimension,
                      bool (*aim)(const struct world *, struct vec2,
                                  struct vec2, struct vec3, struct ray *))
{
    to->rays = xcalloc(from->count, sizeof *to->rays);
    to->count = 0;
    for (uint32_t i = 0; i < from->count; i++) {
        struct ray *r = &to->rays[to->count];
        struct vec3 n;

        if (leave(w, &from->rays[i], answers[i], r, &n) &&
            aim(w, random_pair(i, dimension), random_pair(i, dimension + 1), n,
                r))
            to->count++;
    }
}

void sets_make(struct ray_set sets[SETS], const struct world *world,
               const struct racer *racer)
{
    struct ray_set *primary = &sets[SET_PRIMARY];
    struct ray_set *first = &sets[SET_BOUNCE];
    struct answer *answers;

    make_primary(primary, &world->settings.camera);
    answers = xcalloc(primary->count, sizeof *answers);
    racer->closest(racer->tree, primary->rays, primary->count, answers);
    make_next(&sets[SET_SHADOW], world, primary, answers, 0, shadow);
    sets[SET_SHADOW].is_any = true;
    make_next(first, world, primary, answers, 2, bounce);
    racer->closest(racer->tree, first->rays, first->count, answers);
    make_next(&sets[SET_BOUNCE2], world, first, answers, 4, bounce);
    free(answers);
}

void sets_free(struct ray_set sets[SETS])
{
    for (int i = 0; i < SETS; i++) {
        free(sets[i].rays);
        sets[i] = (struct ray_set){.rays = NULL};
    }
}
