// SPDX-License-Identifier: MIT
/*
 * scaling - the cost of a ray in terrains of 1,000 to 10 million triangles:
 * nanoseconds of processor time on one thread, and the increase per doubling
 *
 * usage: scaling [ISA]
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/thread_pool.h"
#include "racer.h"
#include "sets.h"
#include "shapes.h"
#include "terminal/xmalloc.h"
#include "tests/bench/median.h"
#include "world/bvh/bvh8.h"

#define REPEATS 5

/* Number of squares of the terrains along x. */
static const uint32_t columns[] = {32, 100, 316, 1000, 3162};

enum { SIZES = sizeof columns / sizeof columns[0] };

/* Sets in the order of the printed columns. */
static const enum set timed[] = {SET_PRIMARY, SET_BOUNCE, SET_SHADOW};

enum { TIMED = sizeof timed / sizeof timed[0] };

static uint64_t thread_cpu_ns(void)
{
    struct timespec t;

    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

/* Returns the median nanoseconds per ray. */
static double ray_ns(const struct racer *r, const struct ray_set *set, bool any,
                     struct answer *answers)
{
    double ns[REPEATS];

    for (int i = 0; i < REPEATS; i++) {
        uint64_t begin_ns = thread_cpu_ns();

        (any ? r->any : r->closest)(r->tree, set->rays, set->count, answers);
        ns[i] = (double)(thread_cpu_ns() - begin_ns) / set->count;
    }
    return median(ns, REPEATS);
}

static bool time_size(struct racer r, struct pool *pool, uint32_t across,
                      double *doublings, double ns[TIMED], struct error *err)
{
    struct shape shape;
    struct bvh8 tree = {.nodes = NULL};
    struct ray_set sets[SETS];
    struct world world;
    struct answer *answers;
    uint64_t begin_ns;
    uint32_t count;
    bool ok = shape_make_terrain(&shape, across, err);

    if (!ok)
        return false;
    count = shape.world.settings.tri_count;
    begin_ns = clock_ns();
    ok = bvh8_build(&tree, &shape.world, pool, err);
    if (ok) {
        double build_s = seconds_between(begin_ns, clock_ns());

        world = shape.world;
        bvh8_lend(&tree, &world);
        r.tree = &world;
        sets_make(sets, &shape.world, &r);
        answers = xcalloc(sets[SET_PRIMARY].count, sizeof *answers);
        printf("  %9u %8.3f %6.1f", count, build_s,
               (double)bvh8_bytes(&tree) / count);
        for (int i = 0; i < TIMED; i++) {
            ns[i] =
                ray_ns(&r, &sets[timed[i]], timed[i] == SET_SHADOW, answers);
            printf(" %8.1f", ns[i]);
        }
        printf("\n");
        fflush(stdout);
        *doublings = log2(count);
        free(answers);
        sets_free(sets);
    }
    bvh8_free(&tree);
    shape_free(&shape);
    return ok;
}

/* Returns the slope of a straight line through the points, by least squares. */
static double slope_of(const double *x, double y[SIZES][TIMED], int column)
{
    double mx = 0, my = 0, xy = 0, xx = 0;

    for (int i = 0; i < SIZES; i++) {
        mx += x[i] / SIZES;
        my += y[i][column] / SIZES;
    }
    for (int i = 0; i < SIZES; i++) {
        xy += (x[i] - mx) * (y[i][column] - my);
        xx += (x[i] - mx) * (x[i] - mx);
    }
    return xy / xx;
}

static bool run(const struct racer *racer, struct error *err)
{
    double doublings[SIZES], ns[SIZES][TIMED];
    struct pool *pool = pool_create(usable_threads(), err);
    bool ok = pool != NULL;

    printf("terrains: nanoseconds of a ray on one thread\n"
           "  triangles  build_s  bytes");
    for (int i = 0; i < TIMED; i++)
        printf(" %8s", set_names[timed[i]]);
    printf("\n");
    for (int i = 0; ok && i < SIZES; i++)
        ok = time_size(*racer, pool, columns[i], &doublings[i], ns[i], err);
    if (ok) {
        printf("  each doubling adds       ");
        for (int i = 0; i < TIMED; i++)
            printf(" %8.1f", slope_of(doublings, ns, i));
        printf("\n");
    }
    pool_destroy(pool);
    return ok;
}

int main(int argc, char **argv)
{
    const struct cpu_kernel *paths = cpu_kernel_best();
    struct error err;

    memory_init();
    if (argc > 1 && argv[1][0] != '\0')
        paths = cpu_kernel_named(argv[1], &err);
    if (paths == NULL || !run(racer_of(paths), &err)) {
        fprintf(stderr, "scaling: %s\n", err.text);
        return 1;
    }
    return 0;
}
