// SPDX-License-Identifier: MIT
/*
 * smoke.h - media whose density is a grid of numbers
 *
 * A grid has values at the centres of its voxels. Between them the density is
 * trilinear; out to the faces of the box, half a voxel further, it is that of
 * the nearest voxels, and outside there is none. It is a factor of the
 * coefficients. Smokes are outside of all bodies, as the fog is, and add up.
 *
 * Paths find their collisions by delta tracking with a majorant for each brick
 * of voxels (Woodcock et al. 1965; Novak et al. 2018, "Monte Carlo methods for
 * volumetric light transport simulation", section 5). One channel decides, and
 * all are weighted by the balance heuristic, as in Miller, Georgiev and Jarosz
 * 2019, "A null-scattering path integral formulation of light transport".
 * Light samples pass by ratio tracking (Novak, Selle and Jarosz 2014, "Residual
 * ratio tracking for estimating attenuation in participating media").
 *
 * Units:     normalised scene units; "local" points are in voxels from the
 *            first voxel of the first brick
 */
#ifndef KERNELS_SMOKE_H
#define KERNELS_SMOKE_H

#include "kernels/medium.h"
#include "kernels/rng.h"

/* Share of the largest channel below which another does not count. */
#define SHARE_MIN 1e-20f

/* Share of light below which roulette decides whether it comes through. */
#define SMOKE_SHARE_MIN 0.1f

/* ---- values ---- */

static inline struct vec3 field_direction(GLOBAL const struct voxel_field *f,
                                          struct vec3 d)
{
    return v3(v3_dot(f->rows[0], d), v3_dot(f->rows[1], d),
              v3_dot(f->rows[2], d));
}

static inline struct vec3 field_point(GLOBAL const struct voxel_field *f,
                                      struct vec3 p)
{
    return v3_add(field_direction(f, p), f->origin);
}

/* Returns the number of the voxel at or below a coordinate of a point of the
 * box, and the way from there to the point in *t. */
static inline uint32_t field_voxel(float x, float first, float last, float *t)
{
    float inside = f_max(first, f_min(x, last));
    uint32_t i = (uint32_t)inside;

    *t = inside - (float)i;
    return i;
}

static inline uint32_t field_place(GLOBAL const struct voxel_field *f,
                                   uint32_t x, uint32_t y, uint32_t z)
{
    return f->first_place + (x * f->sides[1] + y) * f->sides[2] + z;
}

/* Returns the index of the value of a voxel. */
static inline uint32_t field_value_at(const struct world *w,
                                      GLOBAL const struct voxel_field *f,
                                      uint32_t x, uint32_t y, uint32_t z)
{
    uint32_t place =
        field_place(f, x / BRICK_SIDE, y / BRICK_SIDE, z / BRICK_SIDE);

    return w->voxel_places[place].brick * BRICK_VOXELS +
           (x % BRICK_SIDE * BRICK_SIDE + y % BRICK_SIDE) * BRICK_SIDE +
           z % BRICK_SIDE;
}

static inline float f_between(float a, float b, float t)
{
    return a + (b - a) * t;
}

/* Returns the value at a local point of the box. */
static inline float field_value(const struct world *w,
                                GLOBAL const struct voxel_field *f,
                                struct vec3 p)
{
    float tx, ty, tz, v[8];
    uint32_t x = field_voxel(p.x, f->first.x, f->last.x, &tx);
    uint32_t y = field_voxel(p.y, f->first.y, f->last.y, &ty);
    uint32_t z = field_voxel(p.z, f->first.z, f->last.z, &tz);
    uint32_t at = field_value_at(w, f, x, y, z);

    /* the other corners are in the same brick, or in others */
    if (x % BRICK_SIDE < BRICK_SIDE - 1 && y % BRICK_SIDE < BRICK_SIDE - 1 &&
        z % BRICK_SIDE < BRICK_SIDE - 1) {
        GLOBAL const float *corner = w->voxels + at;

        for (uint32_t i = 0; i < 8; i++)
            v[i] = corner[(i >> 2) * BRICK_SIDE * BRICK_SIDE +
                          (i >> 1 & 1u) * BRICK_SIDE + (i & 1u)];
    } else {
        for (uint32_t i = 0; i < 8; i++)
            v[i] = w->voxels[field_value_at(w, f, tx > 0.0f ? x + (i >> 2) : x,
                                            ty > 0.0f ? y + (i >> 1 & 1u) : y,
                                            tz > 0.0f ? z + (i & 1u) : z)];
    }
    return f_between(f_between(f_between(v[0], v[1], tz),
                               f_between(v[2], v[3], tz), ty),
                     f_between(f_between(v[4], v[5], tz),
                               f_between(v[6], v[7], tz), ty),
                     tx);
}

/* ---- along a ray ---- */

/* The way of a ray through the bricks of a grid. */
struct brick_walk {
    struct vec3 o, d; /* the ray, local */
    struct vec3 next; /* distances to the next brick along each axis */
    uint32_t at[3];   /* the brick */
    float t, t_max;   /* distance; that of the end */
    float majorant;   /* of the density in the brick */
    float extinction; /* for which the tentative collision was sampled */
    uint32_t steps;   /* tentative collisions so far */
};

/* Returns the distance at which a ray leaves its brick along an axis; infinity
 * in the bricks at the border, where the box ends first. */
static inline float brick_exit(float o, float d, uint32_t at, uint32_t side)
{
    uint32_t plane = d > 0.0f ? at + 1u : at;

    if (d == 0.0f || plane == 0 || plane == side)
        return INFINITY;
    return ((float)(plane * BRICK_SIDE) - o) / d;
}

/* Narrows an interval of distances to that between two planes. Nothing is left
 * of it where coordinates are beyond floats. */
static inline void interval_cut(float o, float d, float low, float high,
                                struct vec2 *interval)
{
    float a = (low - o) / d, b = (high - o) / d;

    if (d == 0.0f ? !(o >= low && o <= high) : isnan(a) || isnan(b)) {
        interval->y = -1.0f;
        return;
    }
    if (d == 0.0f)
        return;
    interval->x = f_max(interval->x, f_min(a, b));
    interval->y = f_min(interval->y, f_max(a, b));
}

static inline uint32_t brick_of(float x, uint32_t side)
{
    float brick = f_max(x, 0.0f) * (1.0f / BRICK_SIDE);

    return brick < (float)side ? (uint32_t)brick : side - 1u;
}

static inline void brick_meet(const struct world *w,
                              GLOBAL const struct voxel_field *f,
                              struct brick_walk *b)
{
    b->majorant =
        w->voxel_places[field_place(f, b->at[0], b->at[1], b->at[2])].majorant;
}

/* Begins a walk of a ray whose direction is a unit vector. Returns false if the
 * ray does not meet the box. */
static inline bool brick_walk_begin(const struct world *w,
                                    GLOBAL const struct voxel_field *f,
                                    struct ray r, float t_max,
                                    struct brick_walk *b)
{
    struct vec3 o = field_point(f, r.o), d = field_direction(f, r.d), p;
    struct vec2 part = v2(0.0f, t_max);

    interval_cut(o.x, d.x, f->first.x - 0.5f, f->last.x + 0.5f, &part);
    interval_cut(o.y, d.y, f->first.y - 0.5f, f->last.y + 0.5f, &part);
    interval_cut(o.z, d.z, f->first.z - 0.5f, f->last.z + 0.5f, &part);
    if (!(part.x < part.y))
        return false;
    p = v3_add(o, v3_scale(d, part.x));
    b->o = o;
    b->d = d;
    b->at[0] = brick_of(p.x, f->sides[0]);
    b->at[1] = brick_of(p.y, f->sides[1]);
    b->at[2] = brick_of(p.z, f->sides[2]);
    b->next = v3(brick_exit(o.x, d.x, b->at[0], f->sides[0]),
                 brick_exit(o.y, d.y, b->at[1], f->sides[1]),
                 brick_exit(o.z, d.z, b->at[2], f->sides[2]));
    b->t = part.x;
    b->t_max = part.y;
    b->steps = 0;
    brick_meet(w, f, b);
    return true;
}

/* Goes on into the next brick along the axis of least distance. */
static inline void brick_walk_step(const struct world *w,
                                   GLOBAL const struct voxel_field *f,
                                   struct brick_walk *b)
{
    if (b->next.x <= b->next.y && b->next.x <= b->next.z) {
        b->at[0] += b->d.x > 0.0f ? 1u : ~0u;
        b->next.x = brick_exit(b->o.x, b->d.x, b->at[0], f->sides[0]);
    } else if (b->next.y <= b->next.z) {
        b->at[1] += b->d.y > 0.0f ? 1u : ~0u;
        b->next.y = brick_exit(b->o.y, b->d.y, b->at[1], f->sides[1]);
    } else {
        b->at[2] += b->d.z > 0.0f ? 1u : ~0u;
        b->next.z = brick_exit(b->o.z, b->d.z, b->at[2], f->sides[2]);
    }
    brick_meet(w, f, b);
}

/* Returns the largest extinction of the channels of which something is left: a
 * channel that is stopped at once must not make steps tiny for the others. */
static inline float smoke_most(GLOBAL const struct smoke_medium *s,
                               struct vec3 left)
{
    float x = left.x > 0.0f ? s->extinction.x : 0.0f;
    float y = left.y > 0.0f ? s->extinction.y : 0.0f;
    float z = left.z > 0.0f ? s->extinction.z : 0.0f;

    return f_max(x, f_max(y, z));
}

/* Goes on to the next tentative collision, which is this deep in a medium of
 * the majorant's density and this extinction. Returns false if the ray ends
 * before. */
static inline bool brick_walk_go(const struct world *w,
                                 GLOBAL const struct smoke_medium *s,
                                 float extinction, float depth,
                                 struct brick_walk *b)
{
    b->extinction = extinction;
    for (;;) {
        float end =
            f_min(f_min(b->next.x, b->next.y), f_min(b->next.z, b->t_max));
        float most = b->majorant * extinction;
        float way = f_max(end - b->t, 0.0f);

        if (most * way > depth) {
            b->t += depth / most;
            b->steps++;
            return true;
        }
        depth -= most * way;
        if (!(end < b->t_max))
            return false;
        b->t = f_max(end, b->t);
        brick_walk_step(w, &s->density, b);
    }
}

/* Returns the density at the walk's distance, at most the majorant. */
static inline float brick_walk_density(const struct world *w,
                                       GLOBAL const struct smoke_medium *s,
                                       const struct brick_walk *b)
{
    struct vec3 p = v3_add(b->o, v3_scale(b->d, b->t));

    return f_max(0.0f, f_min(field_value(w, &s->density, p), b->majorant));
}

/* Returns two random numbers of a step, from a key of the ray. */
static inline struct vec2 smoke_2d(uint32_t key, uint32_t step)
{
    uint32_t x = hash_u32(key + 2u * step);
    uint32_t y = hash_u32(key + 2u * step + 1u);

    return v2(unit_float(x), unit_float(y));
}

/* Returns the shares of an even path of tentative collisions that pass one of
 * this density. */
static inline struct vec3 smoke_passing(GLOBAL const struct smoke_medium *s,
                                        float density, float majorant)
{
    float part = density / majorant;

    return v3(f_max(1.0f - s->extinction.x * part, 0.0f),
              f_max(1.0f - s->extinction.y * part, 0.0f),
              f_max(1.0f - s->extinction.z * part, 0.0f));
}

/* Counts a tentative collision of a path. Returns false, and counts one more
 * than there may be, if the path has had all. */
static inline bool smoke_may_step(const struct world *w, uint32_t *steps)
{
    uint32_t most = w->settings.smoke_steps_max;

    return *steps <= most && ++*steps <= most;
}

/* A request for the share of light that comes along a ray, whose direction is a
 * unit vector. */
struct smoke_passage {
    struct ray r;
    float t;             /* the distance */
    struct vec3 weights; /* of the channels, of which the largest is 1: where
                            nothing that counts is left, roulette ends it */
    uint32_t key;
    uint32_t *steps; /* tentative collisions of the path, which grow: no light
                        comes after the limit */
};

/* Estimates the share that comes through one smoke. */
static inline struct vec3 smoke_share(const struct world *w,
                                      GLOBAL const struct smoke_medium *s,
                                      const struct smoke_passage *a)
{
    struct vec3 left = v3(1.0f, 1.0f, 1.0f);
    struct vec2 u = smoke_2d(a->key, 0);
    struct brick_walk b;

    if (!brick_walk_begin(w, &s->density, a->r, a->t, &b))
        return left;
    while (brick_walk_go(w, s, smoke_most(s, left), collision_depth(1.0f, u.x),
                         &b)) {
        struct vec3 part;
        float most;

        if (!smoke_may_step(w, a->steps))
            return v3(0.0f, 0.0f, 0.0f);
        left = v3_mul(left, smoke_passing(s, brick_walk_density(w, s, &b),
                                          b.majorant * b.extinction));
        part = v3_mul(left, a->weights);
        most = v3_max_component(part);
        left = v3(part.x > most * SHARE_MIN ? left.x : 0.0f,
                  part.y > most * SHARE_MIN ? left.y : 0.0f,
                  part.z > most * SHARE_MIN ? left.z : 0.0f);
        u = smoke_2d(a->key, b.steps);
        /* the number is the middle of its step: 0 saves nothing */
        if (most < SMOKE_SHARE_MIN && !(u.y + 0x1p-25f < most))
            return v3(0.0f, 0.0f, 0.0f);
        if (most < SMOKE_SHARE_MIN)
            left = v3_scale(left, 1.0f / most);
    }
    return left;
}

/* Returns a share of the largest channel, or 0 if it does not count. What
 * roulette multiplies stays finite then, and numbers are none of the smallest,
 * with which processors are slow. */
static inline float share_that_counts(float share)
{
    return share > SHARE_MIN ? share : 0.0f;
}

static inline struct vec3 shares_that_count(struct vec3 shares)
{
    return v3(share_that_counts(shares.x), share_that_counts(shares.y),
              share_that_counts(shares.z));
}

/* Returns weights of which the largest is 1, or 0. */
static inline struct vec3 relative_weights(struct vec3 weights)
{
    struct vec3 w = v3_min(v3(FLOAT_MAX, FLOAT_MAX, FLOAT_MAX), weights);
    float most = v3_max_component(w);

    return shares_that_count(v3(w.x / most, w.y / most, w.z / most));
}

/* Estimates the share of light that comes through all smokes. The weights may
 * have any scale. */
APART static struct vec3 smoke_transmittance(const struct world *w,
                                             struct smoke_passage a)
{
    struct vec3 left = v3(1.0f, 1.0f, 1.0f), weights = a.weights;
    uint32_t key = a.key;

    for (uint32_t i = 0; i < w->settings.smoke_count; i++) {
        a.weights = relative_weights(v3_mul(left, weights));
        left = v3(a.weights.x > 0.0f ? left.x : 0.0f,
                  a.weights.y > 0.0f ? left.y : 0.0f,
                  a.weights.z > 0.0f ? left.z : 0.0f);
        if (v3_is_zero(left))
            return left;
        a.key = hash_u32(key + i);
        left = v3_mul(left, smoke_share(w, &w->smokes[i], &a));
    }
    return left;
}

/* ---- collisions ---- */

/* The flight of a path through the smokes, to a collision or the end. */
struct smoke_flight {
    float t;
    uint32_t smoke;   /* NO_INDEX: none collides */
    struct vec3 left; /* of each channel, the likelihood that it comes so far,
                         divided by that of the likeliest */
    struct vec3 glow; /* emission on the way, for a throughput of 1 */
    bool is_cut;
};

/* What flights of a ray have in common. */
struct smoke_ray {
    struct ray r;
    struct medium fog;
    struct vec3 shares; /* probabilities of the channels, */
    uint32_t channel;   /* and the one that decides */
    uint32_t key;       /* of random numbers after the first */
    struct vec2 first;  /* random numbers of the first step */
    uint32_t *steps;    /* as in struct smoke_passage */
};

/* Returns the radiance of a black body of the smoke's temperature there. */
static inline struct vec3 smoke_emission(const struct world *w,
                                         GLOBAL const struct smoke_medium *s,
                                         struct vec3 p)
{
    float at =
        field_value(w, &s->temperature, field_point(&s->temperature, p)) *
        s->glow_scale;
    float inside = f_max(0.0f, f_min(at, (float)(GLOW_ENTRIES - 1)));
    uint32_t i = (uint32_t)f_min(inside, (float)(GLOW_ENTRIES - 2));
    struct vec3 a = w->glows[s->first_glow + i];
    struct vec3 b = w->glows[s->first_glow + i + 1];

    return v3_add(a, v3_scale(v3_sub(b, a), inside - (float)i));
}

/* True if the point is in the box of the field. */
static inline bool field_has(GLOBAL const struct voxel_field *f, struct vec3 p)
{
    struct vec3 q = field_point(f, p);

    return q.x >= f->first.x - 0.5f && q.x <= f->last.x + 0.5f &&
           q.y >= f->first.y - 0.5f && q.y <= f->last.y + 0.5f &&
           q.z >= f->first.z - 0.5f && q.z <= f->last.z + 0.5f;
}

/* Adds what a tentative collision emits: its expected value, by the
 * probability of a real absorption. */
static inline void smoke_glow(const struct world *w,
                              GLOBAL const struct smoke_medium *s,
                              const struct smoke_ray *ray,
                              const struct brick_walk *b, float density,
                              struct smoke_flight *f)
{
    struct vec3 p = v3_add(ray->r.o, v3_scale(ray->r.d, b->t));
    float even = v3_dot(ray->shares, f->left);
    struct vec3 part;

    if (s->first_glow == NO_INDEX || !(even > 0.0f) ||
        !field_has(&s->temperature, p))
        return;
    part = v3_scale(v3_mul(v3_sub(s->extinction, s->scattering), f->left),
                    density / (b->majorant * b->extinction) / even);
    f->glow = v3_add(f->glow, attenuated(v3_mul(part, smoke_emission(w, s, p)),
                                         &ray->fog, ray->r, b->t));
}

/* Takes the tentative collision of a walk. Returns true if it is real. */
static inline bool smoke_meet(const struct world *w,
                              GLOBAL const struct smoke_medium *s,
                              const struct smoke_ray *ray,
                              const struct brick_walk *b, float u,
                              struct smoke_flight *f)
{
    float density = brick_walk_density(w, s, b), most;
    struct vec3 passing =
        smoke_passing(s, density, b->majorant * b->extinction);

    smoke_glow(w, s, ray, b, density, f);
    if (!(u < channel_of(passing, ray->channel)))
        return true;
    f->left = v3_mul(f->left, passing);
    most = v3_max_component(f->left);
    if (most > 0.0f)
        f->left = shares_that_count(v3_scale(f->left, 1.0f / most));
    return false;
}

/* Flies a distance t along the ray, through all smokes at once. */
APART static struct smoke_flight smoke_fly(const struct world *w,
                                           const struct smoke_ray *ray, float t)
{
    struct smoke_flight f = {t, NO_INDEX, v3(1.0f, 1.0f, 1.0f),
                             v3(0.0f, 0.0f, 0.0f), false};
    struct brick_walk walks[SMOKES_MAX];
    uint32_t count = w->settings.smoke_count;

    for (uint32_t i = 0; i < count; i++) {
        GLOBAL const struct smoke_medium *s = &w->smokes[i];
        float u = i == 0 ? ray->first.x : smoke_2d(hash_u32(ray->key + i), 0).x;

        if (!brick_walk_begin(w, &s->density, ray->r, t, &walks[i]) ||
            !brick_walk_go(w, s, s->most, collision_depth(1.0f, u), &walks[i]))
            walks[i].t = INFINITY;
    }
    for (;;) {
        struct brick_walk *b = &walks[0];
        uint32_t nearest = 0;
        struct vec2 u;

        for (uint32_t i = 1; i < count; i++)
            nearest = walks[i].t < walks[nearest].t ? i : nearest;
        b = &walks[nearest];
        if (!(b->t < t))
            return f;
        f.is_cut = !smoke_may_step(w, ray->steps);
        if (f.is_cut)
            return f;
        u = smoke_2d(hash_u32(ray->key + nearest), b->steps);
        if (smoke_meet(w, &w->smokes[nearest], ray, b,
                       nearest == 0 && b->steps == 1 ? ray->first.y : u.y,
                       &f)) {
            f.t = b->t;
            f.smoke = nearest;
            return f;
        }
        if (!brick_walk_go(w, &w->smokes[nearest],
                           smoke_most(&w->smokes[nearest], f.left),
                           collision_depth(1.0f, u.x), b))
            b->t = INFINITY;
    }
}

#endif
