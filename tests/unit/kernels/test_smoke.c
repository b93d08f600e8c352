// SPDX-License-Identifier: MIT
/*
 * test_smoke.c - grids along rays: values, bricks and majorants against brute
 * force, transmittance against quadrature
 */
#include <float.h>
#include <math.h>

#include "tests/unit/smoke_world.h"
#include "kernels/smoke.h"

/* Voxels of a grid that several bricks hold, the last ones in part. */
#define NX 29
#define NY 18
#define NZ 37

static const uint32_t size[3] = {NX, NY, NZ};

/* First and last voxel that the file has as active, and its first voxel. */
static const int32_t first[3] = {2, 0, 5}, last[3] = {26, 17, 33};
static const int32_t origin[3] = {-16, 8, -40};

static float numbers[NZ][NY][NX];

struct grid {
    struct smoke_world parts;
    struct voxel_grid grid;
    struct world world;
};

/* Opens a smoke of random densities, some bricks of which are empty. One of its
 * units is a voxel, and voxel 0 0 0 of the file is at 0 0 0. */
static void open_grid(struct grid *g, struct vec3 extinction)
{
    uint64_t seed = 7;
    struct smoke_numbers *n;

    for (int z = 0; z < NZ; z++)
        for (int y = 0; y < NY; y++)
            for (int x = 0; x < NX; x++)
                numbers[z][y][x] = (x / 8 + y / 8 + z / 8) % 3 == 0 ? 0
                                   : x / 8 == 1
                                       ? (float)check_random(&seed) / 50
                                       : (float)(4 * check_random(&seed) *
                                                 check_random(&seed));
    *g = (struct grid){.world.voxels = NULL};
    smoke_world_init(&g->parts);
    g->grid = grid_of(size, &numbers[0][0][0]);
    for (int a = 0; a < 3; a++) {
        g->grid.first[a] = first[a] + origin[a];
        g->grid.last[a] = last[a] + origin[a];
        g->grid.origin[a] = origin[a];
        g->grid.to_world.m[a][3] = 0;
    }
    assert_true(world_add_grid(&g->parts.host, SMOKE_FILE, "d", &g->grid,
                               &(struct error){""}));
    n = smoke_world_fill(&g->parts, "d", "", 0, 0);
    assert_false(smoke_has_box(n));
    set3(n->absorb, (double)extinction.x, (double)extinction.y,
         (double)extinction.z);
    smoke_world_lend(&g->parts, &g->world);
    assert_int_equal(g->world.settings.smoke_count, 1);
    assert_int_equal(g->grid.brick_count * BRICK_VOXELS,
                     g->world.settings.voxel_count);
}

static void close_grid(struct grid *g)
{
    voxel_grid_free(&g->grid);
    smoke_world_free(&g->parts);
}

/* ---- truth ---- */

/* Returns the value at a point counted from the first brick's first voxel, by
 * interpolation in doubles. Points up to half a voxel outside of the active
 * voxels have the value of the nearest point between their centres. */
static double value_at(const double point[3])
{
    double sum = 0, t[3];
    int low[3];

    for (int a = 0; a < 3; a++) {
        double x = fmax(first[a], fmin(point[a], last[a]));

        low[a] = (int)fmin(floor(x), last[a] - 1);
        t[a] = x - low[a];
    }
    for (int i = 0; i < 8; i++) {
        int d[3] = {i & 1, i >> 1 & 1, i >> 2};
        double weight = 1;

        for (int a = 0; a < 3; a++)
            weight *= d[a] != 0 ? t[a] : 1 - t[a];
        sum += weight *
               (double)numbers[low[2] + d[2]][low[1] + d[1]][low[0] + d[0]];
    }
    return sum;
}

/* Returns a coordinate in the box, often one of a border. */
static float any_coordinate(int axis, uint64_t *seed)
{
    float low = (float)first[axis] - 0.5f, high = (float)last[axis] + 0.5f;
    float x = low + (high - low) * (float)check_random(seed);

    switch ((int)(8 * check_random(seed))) {
    case 0: x = roundf(x / 8) * 8; break;
    case 1: x = nextafterf(roundf(x / 8) * 8, -1); break;
    case 2: x = roundf(x); break;
    case 3: x = check_random(seed) < 0.5 ? low : high; break;
    case 4: x = check_random(seed) < 0.5 ? low + 0.5f : high - 0.5f; break;
    default: break;
    }
    return fmaxf(low, fminf(x, high));
}

static struct vec3 any_point(uint64_t *seed)
{
    float x = any_coordinate(0, seed), y = any_coordinate(1, seed);

    return v3(x, y, any_coordinate(2, seed));
}

/* Returns a local point in the units of the scene. */
static struct vec3 placed(struct vec3 p)
{
    return v3(p.x + (float)origin[0], p.y + (float)origin[1],
              p.z + (float)origin[2]);
}

/* Returns the local point at a distance of a ray of the scene. */
static void point_on(const struct ray *r, double t, double p[3])
{
    p[0] = (double)r->o.x - origin[0] + (double)r->d.x * t;
    p[1] = (double)r->o.y - origin[1] + (double)r->d.y * t;
    p[2] = (double)r->o.z - origin[2] + (double)r->d.z * t;
}

/* ---- values ---- */

static void values_are_trilinear(void **state)
{
    struct grid g;
    uint64_t seed = 1;

    (void)state;
    open_grid(&g, v3(1, 1, 1));
    for (int i = 0; i < 20000; i++) {
        GLOBAL const struct voxel_field *f = &g.world.smokes[0].density;
        struct vec3 p = any_point(&seed);
        struct vec3 local = field_point(f, placed(p));
        const double q[3] = {(double)p.x, (double)p.y, (double)p.z};
        double in_index[3];
        bool is_between = true;

        check_close((double)v3_length(v3_sub(local, p)), 0, 1e-5);
        check_close((double)field_value(&g.world, f, p), value_at(q), 2e-6);
        for (int a = 0; a < 3; a++) {
            in_index[a] = q[a] + origin[a];
            is_between = is_between && q[a] >= first[a] && q[a] <= last[a];
        }
        if (is_between)
            check_close((double)field_value(&g.world, f, p),
                        (double)voxel_grid_sample(&g.grid, in_index), 2e-6);
    }
    close_grid(&g);
}

/* ---- bricks ---- */

/* Returns a ray that often lies along an axis or in a plane of two, or begins
 * in the box, at a border, or far away. */
static struct ray any_ray(uint64_t *seed)
{
    struct vec3 at = placed(any_point(seed)), d;
    struct ray r = {.t_max = FLOAT_MAX};
    double away = check_random(seed);

    do {
        d = v3((float)(2 * check_random(seed) - 1),
               (float)(2 * check_random(seed) - 1),
               (float)(2 * check_random(seed) - 1));
        if (check_random(seed) < 0.2)
            d.x = check_random(seed) < 0.5 ? 0.0f : -0.0f;
        if (check_random(seed) < 0.2)
            d.y = 0;
        if (check_random(seed) < 0.2)
            d.z = 0;
    } while (v3_is_zero(d));
    r.d = v3_unit(d);
    if (check_random(seed) < 0.1) /* beside the box, perhaps */
        at.y += 60 * (float)check_random(seed) - 30;
    r.o = away < 0.4   ? at
          : away < 0.9 ? v3_sub(at, v3_scale(r.d, 60))
                       : v3_sub(at, v3_scale(r.d, 1000));
    return r;
}

/* Returns the range of distances at which a ray is in the box, in doubles. */
static bool box_range(const struct ray *r, double t_max, double range[2])
{
    double from[3], to[3];

    point_on(r, 0, from);
    point_on(r, 1, to);
    range[0] = 0;
    range[1] = t_max;
    for (int a = 0; a < 3; a++) {
        double d = a == 0   ? (double)r->d.x
                   : a == 1 ? (double)r->d.y
                            : (double)r->d.z;
        double low = first[a] - 0.5, high = last[a] + 0.5;

        if (d == 0 && !(from[a] >= low && from[a] <= high))
            return false;
        if (d == 0)
            continue;
        range[0] =
            fmax(range[0], fmin((low - from[a]) / d, (high - from[a]) / d));
        range[1] =
            fmin(range[1], fmax((low - from[a]) / d, (high - from[a]) / d));
    }
    return range[0] < range[1];
}

/* Distances of points from bricks and boxes that count as nearby, since floats
 * are rounded: from places some 1,000 voxels away. */
#define NEAR 5e-4

/* Checks a part of a ray that the walk has in one brick. Returns the number of
 * points at which the brick is known. */
static int check_brick(const struct grid *g, const struct ray *r,
                       const struct brick_walk *b, double end)
{
    GLOBAL const struct voxel_field *f = &g->world.smokes[0].density;
    int count = 0;

    for (int i = 0; i <= 16; i++) {
        double t = (double)b->t + (end - (double)b->t) * i / 16, p[3];
        bool is_known = true;

        point_on(r, t, p);
        for (int a = 0; a < 3; a++) {
            double low = 8. * b->at[a], high = low + 8;

            if (b->at[a] > 0)
                check_at_most(low - p[a], NEAR);
            if (b->at[a] + 1 < f->sides[a])
                check_at_most(p[a] - high, NEAR);
            is_known = is_known && p[a] > low + NEAR && p[a] < high - NEAR;
        }
        if (is_known)
            check_at_most(value_at(p), (double)b->majorant);
        count += is_known;
        check_at_most((double)field_value(&g->world, f,
                                          v3_add(b->o,
                                                 v3_scale(b->d, (float)t))),
                      (double)b->majorant + 4 * 2 * NEAR);
    }
    return count;
}

static void walks_visit_the_bricks_of_the_ray(void **state)
{
    struct grid g;
    uint64_t seed = 2;
    int met = 0, missed = 0, known = 0;

    (void)state;
    open_grid(&g, v3(1, 1, 1));
    for (int i = 0; i < 20000; i++) {
        GLOBAL const struct voxel_field *f = &g.world.smokes[0].density;
        struct ray r = any_ray(&seed);
        float t_max = i % 4 == 0 ? 70 * (float)check_random(&seed) : FLOAT_MAX;
        double range[2] = {0, 0};
        bool meets = box_range(&r, (double)t_max, range);
        struct brick_walk b;
        int bricks = 0;
        float end;

        if (!brick_walk_begin(&g.world, f, r, t_max, &b)) {
            check_at_most(range[1] - range[0], meets ? NEAR : HUGE_VAL);
            missed++;
            continue;
        }
        met++;
        if (!meets) { /* it touches the box */
            check_at_most((double)(b.t_max - b.t), NEAR);
            continue;
        }
        check_close((double)b.t, range[0], NEAR);
        check_close((double)b.t_max, range[1], NEAR);
        while ((end = f_min(f_min(b.next.x, b.next.y),
                            f_min(b.next.z, b.t_max))) < b.t_max) {
            check_at_most((double)(b.t - end), NEAR);
            known += check_brick(&g, &r, &b, (double)end);
            b.t = end;
            brick_walk_step(&g.world, f, &b);
            assert_in_range(++bricks, 1, 30);
            for (int a = 0; a < 3; a++)
                assert_true(b.at[a] < f->sides[a]);
        }
        known += check_brick(&g, &r, &b, (double)b.t_max);
    }
    assert_true(met > 15000 && missed > 500 && known > 100000);
    close_grid(&g);
}

/* ---- transmittance ---- */

/* Returns the integral of the density along a ray. */
static double depth_of(const struct ray *r, double t_max)
{
    double range[2], sum = 0;
    const int n = 20000;

    if (!box_range(r, t_max, range))
        return 0;
    for (int i = 0; i < n; i++) {
        double p[3];

        point_on(r, range[0] + (range[1] - range[0]) * (i + 0.5) / n, p);
        sum += value_at(p);
    }
    return sum * (range[1] - range[0]) / n;
}

/* Checks means over independent keys against exp(-extinction depth). A mean of
 * n numbers differs by more than 4.9 standard errors once in a million; the
 * rounding of floats adds 1e-5. */
static void check_transmittance(const struct grid *g, const struct ray *r,
                                float t_max, struct vec3 weights, uint32_t seed)
{
    const struct vec3 e = g->world.smokes[0].extinction;
    const double extinction[3] = {(double)e.x, (double)e.y, (double)e.z};
    double depth = depth_of(r, (double)t_max);
    double sum[3] = {0}, squares[3] = {0};
    const int n = 4000;

    for (int i = 0; i < n; i++) {
        uint32_t steps = 0;
        struct vec3 s = smoke_transmittance(
            &g->world,
            (struct smoke_passage){*r, t_max, weights,
                                   hash_u32(seed + (uint32_t)i), &steps});
        const double share[3] = {(double)s.x, (double)s.y, (double)s.z};

        for (int k = 0; k < 3; k++) {
            assert_true(share[k] >= 0 && isfinite(share[k]));
            sum[k] += share[k] / n;
            squares[k] += share[k] * share[k] / n;
        }
    }
    for (int k = 0; k < 3; k++) {
        double error = sqrt(fmax(squares[k] - sum[k] * sum[k], 0) / n);

        check_close(sum[k], exp(-extinction[k] * depth), 4.9 * error + 1e-5);
    }
}

static void light_that_passes_obeys_beer(void **state)
{
    static const struct vec3 extinctions[] = {{0.01f, 0.01f, 0.01f},
                                              {0.05f, 0.2f, 0.1f},
                                              {0, 0.03f, 1},
                                              {0.3f, 0.6f, 0.4f}};
    uint64_t seed = 3;
    struct grid g;

    (void)state;
    for (size_t i = 0; i < sizeof extinctions / sizeof *extinctions; i++) {
        open_grid(&g, extinctions[i]);
        for (uint32_t k = 0; k < 12; k++) {
            struct ray r = any_ray(&seed);

            check_transmittance(&g, &r, k % 3 == 0 ? 25.f : FLOAT_MAX,
                                k % 2 == 0 ? v3(1, 1, 1) : v3(9, 2, .5f),
                                (uint32_t)i * 999999937u + k * 7777777u);
        }
        close_grid(&g);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_trilinear),
        cmocka_unit_test(walks_visit_the_bricks_of_the_ray),
        cmocka_unit_test(light_that_passes_obeys_beer),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
