// SPDX-License-Identifier: MIT
/*
 * rays - ray queries of glim and Embree: the same rays in one process, medians
 * of interleaved repeats, and every hit compared
 *
 * usage: rays SHARED [PART of the meshes' names [ISA]]
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "embree_racer.h"
#include "referee.h"
#include "sets.h"
#include "shapes.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/thread_pool.h"
#include "render/cpu_dispatch.h"
#include "terminal/xmalloc.h"
#include "tests/bench/median.h"
#include "world/bvh/bvh8.h"
#include "world/bvh/bvh_reinsert.h"
#include "kernels/instance.h"

#define REPEATS     7
#define BUILDS      5
#define SETTLE_NS   20000000
#define THREADS_MAX 2

/* Number of rays in a job. */
#define CHUNK 4096

/* Rays of a set that differ and are decided. */
#define DECIDED_MAX 1000

/* Racers that trace, builders, and lines of output about builds. */
enum {
    GLIM,
    ROBUST,
    FAST,
    RACERS,
    MEDIUM = RACERS,
    BUILDERS,
    BINNED = BUILDERS, /* glim's tree without reinsertion */
    BUILD_LINES
};

static const enum embree_kind embree_kinds[BUILDERS] = {
    [ROBUST] = EMBREE_ROBUST, [FAST] = EMBREE_FAST, [MEDIUM] = EMBREE_MEDIUM};

struct contest {
    struct shape shape;
    struct bvh8 tree;
    struct world world;
    struct embree embrees[BUILDERS]; /* GLIM's is empty */
    struct racer racers[RACERS];
    struct ray_set sets[SETS];
    struct answer *answers[RACERS];
};

/* One racer's measurement. */
struct heat {
    racer_query *query;
    const void *tree;
    const struct ray_set *set;
    struct answer *answers;
};

struct times {
    double cpu_s[REPEATS]; /* of all threads */
    double s[REPEATS];
};

/* Sums of logarithms of ratios, for the geometric mean. */
struct mean {
    double robust, fast;
    int count;
};

/* Means for rays scattered by the scene, of which glim knows the triangle that
 * they leave or does not, and for camera rays in groups. */
static struct mean scattered, unknown, grouped;

static void trace_chunk(void *context, uint32_t item, int worker)
{
    const struct heat *h = context;
    uint32_t first = item * CHUNK;
    uint32_t left = h->set->count - first;

    (void)worker;
    h->query(h->tree, h->set->rays + first, left < CHUNK ? left : CHUNK,
             h->answers + first);
}

static double cpu_s(const struct pool *pool)
{
    double sum = 0.0;

    for (int i = 0; i < pool_thread_count(pool); i++)
        sum += (double)pool_cpu_ns(pool, i) * 1e-9;
    return sum;
}

static void time_heat(struct pool *pool, struct heat *h, struct times *times,
                      int repeat)
{
    struct cancel cancel = {0};
    double before_s = cpu_s(pool);
    uint64_t begin_ns = clock_ns();

    pool_run(pool, (h->set->count + CHUNK - 1) / CHUNK, trace_chunk, h,
             &cancel);
    times->s[repeat] = seconds_between(begin_ns, clock_ns());
    times->cpu_s[repeat] = cpu_s(pool) - before_s;
}

static float distance_of(struct answer a)
{
    return a.tri == NO_INDEX ? FLT_MAX : a.t;
}

static bool is_same(struct answer a, struct answer b)
{
    return referee_is_same(distance_of(a), distance_of(b));
}

/* Numbers of right answers. */
struct verdict {
    uint32_t glim, rounded, embree;
};

static void decide(const struct contest *c, const struct ray *r,
                   struct answer glim, struct answer embree, struct verdict *v)
{
    float exact = referee_distance(&c->shape.world, r, false);
    float rounded = referee_distance(&c->shape.world, r, true);

    v->glim += referee_is_same(distance_of(glim), exact);
    v->rounded += referee_is_same(distance_of(glim), rounded);
    v->embree += referee_is_same(distance_of(embree), exact);
}

/* Prints how many answers agree with glim's, and which of the others are right.
 */
static void compare_answers(const struct contest *c, const struct ray_set *set,
                            int racer)
{
    static const char *const names[RACERS] = {"", "robust", "fast"};
    uint32_t hits = 0, ties = 0, faults = 0, decided = 0;
    struct verdict verdict = {0, 0, 0};

    for (uint32_t i = 0; i < set->count; i++) {
        struct answer a = c->answers[GLIM][i], b = c->answers[racer][i];

        hits += a.tri != NO_INDEX;
        if (is_same(a, b)) {
            ties += a.tri != b.tri;
            continue;
        }
        faults++;
        if (set->is_any || decided == DECIDED_MAX)
            continue;
        decide(c, &set->rays[i], a, b, &verdict);
        decided++;
    }
    printf("    of %u rays %u hit; %s: %u at the same place name another "
           "triangle, %u differ\n",
           set->count, hits, names[racer], ties, faults);
    if (decided > 0)
        printf(
            "    exactly, of %u that differ: glim is right in %u, in %u with "
            "its rounded corners; Embree in %u\n",
            decided, verdict.glim, verdict.rounded, verdict.embree);
}

/* Times one query per racer and compares the results of one thread. Adds the
 * ratios to the mean, unless it is NULL. */
static void race(struct contest *c, struct pool *pool, const char *name,
                 const struct ray_set *set, racer_query *const *queries,
                 struct mean *mean)
{
    int threads = pool_thread_count(pool);
    struct times times[RACERS];
    double rate[RACERS], s[RACERS];

    for (int repeat = 0; repeat < REPEATS; repeat++)
        for (int i = 0; i < RACERS; i++) {
            struct heat h = {queries[i], c->racers[i].tree, set, c->answers[i]};

            time_heat(pool, &h, &times[i], repeat);
        }
    for (int i = 0; i < RACERS; i++) {
        s[i] = median(times[i].s, REPEATS);
        rate[i] = threads * set->count * 1e-6 / median(times[i].cpu_s, REPEATS);
    }
    printf("  %-8s %d %8.3f %8.3f %8.3f   %6.2f %6.2f   %6.2f %6.2f\n", name,
           threads, rate[GLIM], rate[ROBUST], rate[FAST],
           rate[GLIM] / rate[ROBUST], rate[GLIM] / rate[FAST],
           s[ROBUST] / s[GLIM], s[FAST] / s[GLIM]);
    if (threads == 1) {
        compare_answers(c, set, ROBUST);
        compare_answers(c, set, FAST);
    }
    fflush(stdout);
    if (mean == NULL)
        return;
    mean->robust += log(rate[GLIM] / rate[ROBUST]);
    mean->fast += log(rate[GLIM] / rate[FAST]);
    mean->count++;
}

/* `rays` names the rays and ends in a blank, or is empty for all. */
static void print_mean(const char *rays, const struct mean *m)
{
    if (m->count > 0)
        printf("%sgeometric mean: robust %.2f fast %.2f\n", rays,
               exp(m->robust / m->count), exp(m->fast / m->count));
}

/* Races with rays of which no racer knows the triangle that they leave. */
static void race_unknown(struct contest *c, struct pool *pool,
                         const struct ray_set *set, racer_query *const *queries)
{
    struct ray_set rays = {xcalloc(set->count, sizeof *set->rays), set->count,
                           set->is_any};

    for (uint32_t i = 0; i < set->count; i++) {
        rays.rays[i] = set->rays[i];
        rays.rays[i].from = 0;
    }
    race(c, pool, " unknown", &rays, queries, &unknown);
    free(rays.rays);
}

static void race_all(struct contest *c, struct pool *pool)
{
    for (int k = 0; k < SETS; k++) {
        const struct ray_set *set = &c->sets[k];
        racer_query *queries[RACERS];

        for (int i = 0; i < RACERS; i++)
            queries[i] = set->is_any ? c->racers[i].any : c->racers[i].closest;
        race(c, pool, set_names[k], set, queries,
             k != SET_PRIMARY ? &scattered : NULL);
        if (k != SET_PRIMARY)
            race_unknown(c, pool, set, queries);
    }
    racer_query *const coherent[RACERS] = {c->racers[GLIM].coherent,
                                           c->racers[ROBUST].coherent,
                                           c->racers[FAST].coherent};
    race(c, pool, "groups", &c->sets[SET_PRIMARY], coherent, &grouped);
}

static bool build_glim(struct contest *c, const struct cpu_kernel *paths,
                       struct pool *pool, struct error *err)
{
    struct spent begin;
    bool ok;

    bvh8_free(&c->tree);
    begin = spent_now();
    ok = bvh8_build(&c->tree, &c->shape.world, pool, err);
    c->world = c->shape.world;
    bvh8_lend(&c->tree, &c->world);
    c->racers[GLIM] = *racer_of(paths);
    c->racers[GLIM].tree = &c->world;
    c->racers[GLIM].build = spent_since(begin);
    c->racers[GLIM].bytes = (double)bvh8_bytes(&c->tree);
    return ok;
}

/* Times reinsertion alone; 0 in a world with instances, of many trees. */
static bool time_reinsertion(const struct contest *c, struct pool *pool,
                             struct spent *spent, struct error *err)
{
    struct bvh bvh = {.nodes = NULL};
    bool ok = has_instances(&c->shape.world) ||
              bvh_split(&bvh, &c->shape.world, &bvh8_leaves, pool, err);
    struct spent begin = spent_now();

    ok = ok && (bvh.nodes == NULL || bvh_reinsert(&bvh));
    *spent = spent_since(begin);
    bvh_free(&bvh);
    return ok;
}

static struct spent median_of(const struct spent times[BUILDS])
{
    double s[BUILDS], cpu_s[BUILDS];

    for (int k = 0; k < BUILDS; k++) {
        s[k] = times[k].s;
        cpu_s[k] = times[k].cpu_s;
    }
    return (struct spent){median(s, BUILDS), median(cpu_s, BUILDS)};
}

/* Prints the costs of the trees, and the ratio of Embree's time to glim's for
 * trees of the same kind. */
static void print_builds(const struct contest *c,
                         struct spent times[BUILD_LINES][BUILDS])
{
    static const struct {
        const char *name;
        int glims; /* glim's tree of the same kind */
    } lines[BUILD_LINES] = {[GLIM] = {"glim", GLIM},
                            [BINNED] = {"glim binned", BINNED},
                            [ROBUST] = {"Embree robust", BINNED},
                            [MEDIUM] = {"Embree medium", BINNED},
                            [FAST] = {"Embree fast", GLIM}};
    static const int order[BUILD_LINES] = {GLIM, FAST, BINNED, MEDIUM, ROBUST};

    for (int i = 0; i < BUILD_LINES; i++) {
        int k = order[i], glims = lines[k].glims;
        struct spent spent = median_of(times[k]);
        struct spent own = median_of(times[glims]);
        const struct racer *r =
            k == glims ? &c->racers[GLIM] : &c->embrees[k].racer;

        printf("  %-14s %8.4f s %8.4f of the processor  %6.2f %6.2f  %5.1f "
               "bytes a triangle\n",
               lines[k].name, spent.s, spent.cpu_s, spent.s / own.s,
               spent.cpu_s / own.cpu_s,
               r->bytes / c->shape.world.settings.tri_count);
    }
}

/* Embree's threads spin for a while after their work, which would disturb the
 * next measurement. */
static void settle(void)
{
    nanosleep(&(struct timespec){.tv_nsec = SETTLE_NS}, NULL);
}

/* Builds trees in turns, all with the same number of threads. */
static bool build_all(struct contest *c, const struct cpu_kernel *paths,
                      struct error *err)
{
    struct pool *pool = pool_create(usable_threads(), err);
    struct spent times[BUILD_LINES][BUILDS];
    bool ok = pool != NULL;

    for (int k = 0; ok && k < BUILDS; k++) {
        struct spent whole, part = {0.0, 0.0};

        settle();
        ok = build_glim(c, paths, pool, err) &&
             time_reinsertion(c, pool, &part, err);
        times[GLIM][k] = whole = c->racers[GLIM].build;
        times[BINNED][k] =
            (struct spent){whole.s - part.s, whole.cpu_s - part.cpu_s};
        for (int i = ROBUST; i < BUILDERS; i++) {
            embree_free(&c->embrees[i]);
            settle();
            embree_build(&c->embrees[i], &c->shape.world, embree_kinds[i],
                         usable_threads());
            times[i][k] = c->embrees[i].racer.build;
        }
    }
    pool_destroy(pool);
    if (!ok)
        return false;
    print_builds(c, times);
    embree_free(&c->embrees[MEDIUM]);
    for (int i = ROBUST; i < RACERS; i++)
        c->racers[i] = c->embrees[i].racer;
    return true;
}

static void contest_free(struct contest *c)
{
    for (int i = 0; i < RACERS; i++)
        free(c->answers[i]);
    for (int i = 0; i < BUILDERS; i++)
        embree_free(&c->embrees[i]);
    sets_free(c->sets);
    bvh8_free(&c->tree);
    shape_free(&c->shape);
}

static bool run_shape(int shape, const char *shared,
                      const struct cpu_kernel *paths, struct error *err)
{
    struct contest c = {.answers = {NULL}};
    bool ok = shape_load(&c.shape, shape, shared, err);

    if (!ok && err->text[0] == '\0') {
        printf("%s: skipped, found none in %s/scenes-real or scenes\n",
               shape_names[shape], shared);
        return true;
    }
    if (ok)
        printf("%s: %u triangles, %u with those of all instances\n",
               shape_names[shape], c.shape.world.settings.tri_count,
               all_tri_count(&c.shape.world));
    ok = ok && build_all(&c, paths, err);
    if (ok) {
        sets_make(c.sets, &c.shape.world, &c.racers[GLIM]);
        for (int i = 0; i < RACERS; i++)
            c.answers[i] =
                xcalloc(c.sets[SET_PRIMARY].count, sizeof *c.answers[i]);
    }
    for (int n = 1; ok && n <= THREADS_MAX; n++) {
        struct pool *pool = pool_create(n, err);

        ok = pool != NULL;
        if (ok)
            race_all(&c, pool);
        pool_destroy(pool);
    }
    contest_free(&c);
    return ok;
}

int main(int argc, char **argv)
{
    const char *part = argc > 2 ? argv[2] : "";
    const struct cpu_kernel *paths = cpu_kernel_best();
    struct error err;
    bool ok = true;

    if (argc < 2) {
        fprintf(stderr, "usage: rays SHARED [PART [ISA]]\n");
        return 2;
    }
    memory_init();
    if (argc > 3 && argv[3][0] != '\0')
        ok = (paths = cpu_kernel_named(argv[3], &err)) != NULL;
    if (ok)
        printf("glim (%s) beside Embree 3. Mrays/s: threads times rays over the"
               " threads'\nprocessor time; ratios of that, then of time by the"
               " clock.\n"
               "  rays     threads glim   robust     fast  /robust  /fast "
               " /robust  /fast\n"
               "Embree has no argument for the triangle that a ray leaves, "
               "which glim leaves out;\nin lines `unknown` glim is not told it "
               "either. Embree flushes denormal numbers.\n"
               "Trees take seconds by the clock, then of the processor; ratios"
               " of both: fast over\nglim, the others over `binned`, which is"
               " glim without the time of reinsertion, a\nstep that they do not"
               " have.\n",
               paths->name);
    for (int i = 0; ok && i < SHAPES; i++)
        if (strstr(shape_names[i], part) != NULL)
            ok = run_shape(i, argv[1], paths, &err);
    if (!ok) {
        fprintf(stderr, "rays: %s\n", err.text);
        return 1;
    }
    print_mean("groups of camera rays, ", &grouped);
    print_mean("unknown start, ", &unknown);
    print_mean("", &scattered);
    return 0;
}
