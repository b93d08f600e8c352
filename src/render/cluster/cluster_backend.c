// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "film/film.h"
#include "film/film_pack.h"
#include "render/cluster/band.h"
#include "render/cluster/cluster.h"
#include "render/cluster/rank_tally.h"
#include "render/cluster/wire.h"

/* The ranks, seen from rank 0, and the picture that they render. */
struct cluster_ranks {
    struct backend *local; /* the backend of rank 0 */
    struct band_thread *thread;
    struct rank_tally *tallies; /* of each rank */
    int waiting_count;          /* bands of this pass without an answer */
    uint32_t epoch;             /* passes so far */
    struct world world;
    struct backend_picture picture; /* of that world */
};

/* Samples of a pass for each rank, at least: its end takes time. */
#define PASS_RANK 16

struct backend_cluster {
    struct backend base;
    struct cluster_ranks ranks;
    uint64_t sent[WORLD_LIST_COUNT]; /* versions that the workers have */
    bool is_announced;               /* the workers know the picture, */
    uint64_t light; /* version of the light that they have; 0: none */
    bool is_begun;  /* and the local backend has the whole film */
};

/* ---- one pass ---- */

/*
 * Rank 0 hands out bands (band_plan.h), of which it renders some itself. The
 * answers to them are added to the film when it has all samples before them: a
 * band of a later slice may be done first, and waits in memory.
 *
 * Each worker has a second band waiting, so that it does not wait for messages.
 */

/* Bands of a worker at a time, one of which waits so that the worker does not;
 * only one at the end of a pass, where others would wait for the worker that
 * has two. */
#define BANDS_WAITING 2

/* Time for answers after a halt, beyond which they are late: their samples are
 * lost, and the next pass does without that worker until it has answered. */
#define LATE_NS 250000000

/* Time after which a late worker is lost. */
#define LOST_NS 10000000000

/* An answer that waits for the samples before it. */
struct held {
    struct held *next;
    struct band_answer *answer;
    size_t size;
};

/* A pass in progress. */
struct progress {
    struct cluster_ranks *c;
    struct band_plan plan;
    const struct cancel *cancel;
    struct band local;
    struct held *held;
    uint64_t stopped_ns; /* when the workers were told to stop; 0: not yet */
    bool has_failed;
    struct error *err;
};

/* ---- answers ---- */

/* Adds the answers to the film whose samples are the next ones. */
static void add_held(struct progress *p)
{
    struct held **link = &p->held;

    while (*link != NULL) {
        struct held *h = *link;
        const struct band_range range = {.y = h->answer->y,
                                         .rows = h->answer->rows,
                                         .first = h->answer->first,
                                         .pass = p->plan.pass};

        if (!band_plan_is_next(p->c->picture.film, &range)) {
            link = &h->next;
            continue;
        }
        if (!band_answer_add(h->answer, h->size, p->c->picture.film, p->err))
            p->has_failed = true;
        *link = h->next;
        free(h->answer);
        free(h);
        link = &p->held; /* others may have waited for this one */
    }
}

/* Adds an answer, which is taken over, to the film when it is the next. */
static void hold(struct progress *p, struct band_answer *a, size_t size)
{
    struct held *h = alloc_array(1, sizeof *h);

    if (h == NULL || a == NULL) {
        p->has_failed = !fail(p->err, "out of memory for a band");
        free(a);
        free(h);
        return;
    }
    *h = (struct held){p->held, a, size};
    p->held = h;
    add_held(p);
}

static void free_held(struct progress *p)
{
    while (p->held != NULL) {
        struct held *h = p->held;

        p->held = h->next;
        free(h->answer);
        free(h);
    }
}

/* Takes an answer if there is one, of this pass or of an earlier one. `p` is
 * NULL between passes. Returns false if there is none; *failed is set if the
 * worker failed. */
static bool take_answer(struct cluster_ranks *c, struct progress *p,
                        bool *failed, struct error *err)
{
    int rank;
    size_t size;
    struct band_answer *a = wire_take(&rank, WIRE_ANSWER, &size);
    bool is_of_pass;

    if (a == NULL)
        return false;
    is_of_pass = p != NULL && a->epoch == c->epoch;
    if (is_of_pass)
        c->waiting_count--;
    if (a->has_failed)
        *failed = !fail(err, "rank %d: %.240s", rank, a->error);
    rank_tally_take(&c->tallies[rank], is_of_pass ? a->samples : 0);
    if (is_of_pass && a->samples > 0)
        hold(p, a, size);
    else
        free(a);
    return true;
}

/* Returns true if a worker owes an answer. */
static bool has_late(const struct cluster_ranks *c)
{
    for (int rank = 1; rank < wire_size(); rank++)
        if (c->tallies[rank].owed > 0)
            return true;
    return false;
}

/* Sleeps between two looks for messages. */
static void rest(struct cluster_ranks *c)
{
    band_thread_wait(c->thread, wire_rest_ns(band_thread_is_busy(c->thread)));
}

/* Waits for answers to earlier passes, whose samples are lost: a worker that
 * has something to say does not listen to a broadcast. */
static enum pass_result cluster_pass_wait_for_late(struct cluster_ranks *c,
                                                   const struct cancel *cancel,
                                                   struct error *err)
{
    uint64_t begin_ns = clock_ns();
    bool failed = false;

    while (has_late(c) && !failed && !cancel_requested(cancel)) {
        if (!take_answer(c, NULL, &failed, err))
            rest(c);
        if (clock_ns() > begin_ns + LOST_NS)
            failed = !fail(err, "a rank of the cluster does not answer");
    }
    if (failed)
        return PASS_FAILED;
    return cancel_requested(cancel) ? PASS_CANCELLED : PASS_DONE;
}

/* ---- bands ---- */

static void start_local(struct progress *p)
{
    struct cluster_ranks *c = p->c;
    struct band_range range;

    if (!band_plan_next(&p->plan, &range))
        return;
    if (!band_init(&p->local, c->picture.film->width, &range,
                   c->picture.film->surfaces != NULL, p->err)) {
        p->has_failed = true;
        band_free(&p->local);
        return;
    }
    band_take(&p->local, c->picture.film, &range);
    rank_tally_give(&c->tallies[0]);
    band_thread_begin(c->thread,
                      &(struct band_work){.band = &p->local,
                                          .backend = c->local,
                                          .whole = c->picture,
                                          .first_sample =
                                              c->picture.film->first_sample,
                                          .cancel = p->cancel});
}

/* Adds the band of this rank to the film. If it has to wait, it is packed as
 * the others are. */
static void add_local(struct progress *p)
{
    struct band *b = &p->local;

    if (band_plan_is_next(p->c->picture.film, &b->range)) {
        film_merge(p->c->picture.film, b->range.y, &b->film);
        add_held(p);
    } else {
        size_t size;
        struct band_answer *a = band_answer_make(b, p->c->epoch, "", &size);

        hold(p, a, size);
    }
}

/* Returns true if the band of this rank was done. */
static bool end_local(struct progress *p)
{
    enum pass_result result;

    if (!band_thread_is_busy(p->c->thread) ||
        band_thread_end(p->c->thread, &result, p->err) == NULL)
        return false;
    rank_tally_take(&p->c->tallies[0], atomic_load(&p->local.film.samples));
    if (result == PASS_FAILED)
        p->has_failed = true;
    else
        add_local(p);
    band_free(&p->local);
    return true;
}

/* Returns an order with the numbers of samples and the shares of its pixels. */
static struct rank_order *make_order(const struct cluster_ranks *c,
                                     const struct band_range *range,
                                     size_t *size)
{
    const uint16_t *shares = range->pass.shares;
    size_t width = (size_t)c->picture.film->width;
    size_t at = (size_t)range->y * width, pixels = (size_t)range->rows * width;
    struct rank_order *o =
        alloc_array(sizeof *o + pixels * (sizeof(uint64_t) + sizeof *shares),
                    1);
    uint64_t *counts;
    size_t used;

    if (o == NULL)
        return NULL;
    counts = (uint64_t *)(o + 1);
    *o = (struct rank_order){.kind = ORDER_BAND,
                             .epoch = c->epoch,
                             .range = *range,
                             .has_shares = shares != NULL,
                             .before =
                                 band_plan_before(c->picture.film, range, at)};
    for (size_t i = 0; i < pixels; i++) {
        counts[i] = band_plan_before(c->picture.film, range, at + i);
        o->has_counts = o->has_counts || counts[i] != o->before;
    }
    used = o->has_counts ? pixels * sizeof *counts : 0;
    if (shares != NULL)
        memcpy((char *)counts + used, shares + at, pixels * sizeof *shares);
    used += shares != NULL ? pixels * sizeof *shares : 0;
    *size = sizeof *o + used;
    return o;
}

static void send_band(struct progress *p, int rank)
{
    struct cluster_ranks *c = p->c;
    struct rank_order *o;
    struct band_range range;
    size_t size;

    if (!band_plan_next(&p->plan, &range))
        return;
    o = make_order(c, &range, &size);
    if (o == NULL) {
        p->has_failed = !fail(p->err, "out of memory for a band");
        return;
    }
    wire_give(rank, WIRE_ORDER, o, size);
    rank_tally_give(&c->tallies[rank]);
    c->waiting_count++;
}

/* Gives bands to the ranks that have too few. */
static void give_bands(struct progress *p)
{
    struct cluster_ranks *c = p->c;
    int most = band_plan_is_ending(&p->plan) ? 1 : BANDS_WAITING;

    if (!band_thread_is_busy(c->thread))
        start_local(p);
    for (int i = 0; i < most; i++)
        for (int rank = 1; rank < wire_size(); rank++)
            if (c->tallies[rank].owed <= i)
                send_band(p, rank);
}

/* Tells the workers to send what they have. */
static void stop_workers(struct progress *p)
{
    struct cluster_ranks *c = p->c;

    for (int rank = 1; rank < wire_size(); rank++)
        if (c->tallies[rank].owed > 0)
            wire_post(rank, WIRE_CANCEL, &c->epoch, sizeof c->epoch);
    p->stopped_ns = clock_ns();
}

/* Returns true if all bands are done, or if those that are not are late. */
static bool is_complete(const struct progress *p, bool is_stopping)
{
    const struct cluster_ranks *c = p->c;

    if (band_thread_is_busy(c->thread))
        return false;
    if (is_stopping)
        return c->waiting_count == 0 || clock_ns() > p->stopped_ns + LATE_NS;
    return c->waiting_count == 0 && band_plan_is_empty(&p->plan);
}

static enum pass_result run_bands(struct progress *p)
{
    for (;;) {
        bool is_stopping = p->has_failed || cancel_requested(p->cancel);
        bool did_something;

        if (!is_stopping)
            give_bands(p);
        else if (p->stopped_ns == 0)
            stop_workers(p);
        did_something = end_local(p);
        did_something =
            take_answer(p->c, p, &p->has_failed, p->err) || did_something;
        if (is_complete(p, is_stopping))
            break;
        if (!did_something)
            rest(p->c);
    }
    if (p->has_failed)
        return PASS_FAILED;
    return cancel_requested(p->cancel) ? PASS_CANCELLED : PASS_DONE;
}

/* ---- ranks ---- */

/* Returns the most rows of a band: the sums of a pixel take this at most. */
static int most_rows(const struct film *f)
{
    size_t bytes = 2 + 8 * film_words_count(f->surfaces != NULL);
    size_t rows = WIRE_BYTES_MAX / 2 / (bytes * (size_t)f->width);

    return rows > 1 ? (int)rows : 1;
}

/* Renders a pass. The local backend loses its film. */
static enum pass_result cluster_pass(struct cluster_ranks *c,
                                     const struct pass *pass,
                                     const struct cancel *cancel,
                                     struct error *err)
{
    struct progress p = {.c = c, .cancel = cancel, .err = err};
    enum pass_result result;

    c->epoch++;
    c->waiting_count = 0;
    p.plan = band_plan_begin(c->picture.film, pass, wire_size(),
                             most_rows(c->picture.film));
    result = run_bands(&p);
    free_held(&p); /* of a pass that has stopped */
    return result;
}

/* The caller frees after a failure, too. */
static bool cluster_ranks_init(struct cluster_ranks *c, struct backend *local,
                               struct error *err)
{
    *c = (struct cluster_ranks){.local = local};
    c->tallies = alloc_array((size_t)wire_size(), sizeof *c->tallies);
    if (c->tallies == NULL)
        return fail(err, "out of memory for ranks");
    c->thread = band_thread_create(err);
    return c->thread != NULL;
}

static void cluster_ranks_free(struct cluster_ranks *c)
{
    band_thread_destroy(c->thread);
    free(c->tallies);
}

/* ---- picture ---- */

static bool load(struct backend *base, struct host_world *host,
                 struct world *world, struct error *err)
{
    struct backend_cluster *c = (struct backend_cluster *)base;
    bool ok = c->ranks.local->load(c->ranks.local, host, world, err);

    base->tree_bytes = c->ranks.local->tree_bytes;
    base->pool = c->ranks.local->pool;
    return ok;
}

static void unload(struct backend *base)
{
    struct backend_cluster *c = (struct backend_cluster *)base;

    c->ranks.local->unload(c->ranks.local);
    base->tree_bytes = 0;
}

static bool begin_local(struct backend_cluster *c, struct error *err)
{
    c->is_begun = c->ranks.local->begin(c->ranks.local, &c->ranks.picture, err);
    c->base.upload_count = c->ranks.local->upload_count;
    return c->is_begun;
}

static bool begin(struct backend *base, const struct backend_picture *picture,
                  struct error *err)
{
    struct backend_cluster *c = (struct backend_cluster *)base;

    c->ranks.world = *picture->world;
    c->ranks.picture = *picture;
    c->ranks.picture.world = &c->ranks.world;
    c->is_announced = false;
    for (int rank = 0; rank < wire_size() && !picture->goes_on; rank++)
        rank_tally_begin(&c->ranks.tallies[rank]);
    return begin_local(c, err);
}

/* Tells the workers of the picture, and sends the arrays that they lack. */
static void announce(struct backend_cluster *c)
{
    struct world_array list[WORLD_LIST_COUNT];
    struct rank_order o = {.kind = ORDER_BEGIN,
                           .settings = c->ranks.world.settings,
                           .width = c->ranks.picture.film->width,
                           .x0 = c->ranks.picture.x0,
                           .y0 = c->ranks.picture.y0,
                           .has_surfaces =
                               c->ranks.picture.film->surfaces != NULL,
                           .first_sample = c->ranks.picture.film->first_sample};

    world_list(&c->ranks.world, list);
    memcpy(o.versions, c->ranks.picture.host->versions, sizeof o.versions);
    for (int i = 0; i < WORLD_LIST_COUNT; i++)
        o.sizes[i] = list[i].size_bytes;
    for (int rank = 1; rank < wire_size(); rank++)
        wire_post(rank, WIRE_ORDER, &o, sizeof o);
    for (int i = 0; i < WORLD_LIST_COUNT; i++) {
        uint64_t version = o.versions[list[i].part];

        if (c->sent[i] == version)
            continue;
        wire_broadcast((void *)(uintptr_t)list[i].data, list[i].size_bytes);
        c->sent[i] = version;
    }
    c->is_announced = true;
    c->light = 0;
}

/* Tells the workers of the light of light paths. */
static void announce_light(struct backend_cluster *c,
                           const struct pass_light *light)
{
    const struct rank_order o = {.kind = ORDER_LIGHT, .light = *light};

    for (int rank = 1; rank < wire_size(); rank++)
        wire_post(rank, WIRE_ORDER, &o, sizeof o);
    for (int i = 0; i < LIGHT_ARRAYS; i++) {
        const void *bytes;
        size_t size = light_array(light, i, &bytes);

        wire_broadcast((void *)(uintptr_t)bytes, size);
    }
    c->light = light->version;
}

/* ---- passes ---- */

/* Returns true for the passes that rank 0 renders alone: coarse grids, and the
 * first sample of the screen's draft, which have no time for messages. */
static bool is_local(const struct backend_cluster *c, const struct pass *pass)
{
    const struct settings *s = &c->ranks.world.settings;

    return pass->stride > 1 || s->sample != SAMPLE_LIGHT ||
           (s->order != ORDER_PROGRESSIVE && pass->target == 1);
}

static enum pass_result pass_alone(struct backend_cluster *c,
                                   const struct pass *pass,
                                   const struct cancel *cancel,
                                   struct error *err)
{
    uint64_t before = atomic_load(&c->ranks.picture.film->samples);
    enum pass_result result;

    if (!c->is_begun && !begin_local(c, err))
        return PASS_FAILED;
    rank_tally_give(&c->ranks.tallies[0]);
    result = c->ranks.local->pass(c->ranks.local, pass, cancel, err);
    rank_tally_take(&c->ranks.tallies[0],
                    atomic_load(&c->ranks.picture.film->samples) - before);
    return result;
}

static bool has_new_light(const struct backend_cluster *c,
                          const struct pass *pass)
{
    return pass->light != NULL && pass->light->version != c->light;
}

static enum pass_result pass(struct backend *base, const struct pass *pass,
                             const struct cancel *cancel, struct error *err)
{
    struct backend_cluster *c = (struct backend_cluster *)base;

    if (is_local(c, pass))
        return pass_alone(c, pass, cancel, err);
    if (!c->is_announced || has_new_light(c, pass)) {
        enum pass_result result =
            cluster_pass_wait_for_late(&c->ranks, cancel, err);

        if (result != PASS_DONE)
            return result;
        if (!c->is_announced)
            announce(c);
        if (has_new_light(c, pass))
            announce_light(c, pass->light);
    }
    c->is_begun = false;
    return cluster_pass(&c->ranks, pass, cancel, err);
}

static uint64_t cpu_ns(const struct backend *base, int thread)
{
    const struct backend_cluster *c = (const struct backend_cluster *)base;

    return c->ranks.local->cpu_ns(c->ranks.local, thread);
}

static struct rank_progress progress_of_rank(const struct backend *base,
                                             int rank)
{
    const struct backend_cluster *c = (const struct backend_cluster *)base;

    return rank_tally_read(&c->ranks.tallies[rank]);
}

static void destroy(struct backend *base)
{
    struct backend_cluster *c = (struct backend_cluster *)base;

    c->ranks.local->destroy(c->ranks.local);
    cluster_ranks_free(&c->ranks);
    free(c);
}

struct backend *cluster_backend_create(struct backend *local, struct error *err)
{
    struct backend_cluster *c = alloc_array(1, sizeof *c);

    if (c == NULL) {
        fail(err, "out of memory");
        return NULL;
    }
    if (!cluster_ranks_init(&c->ranks, local, err)) {
        cluster_ranks_free(&c->ranks);
        free(c);
        return NULL;
    }
    c->base = (struct backend){.name = local->name,
                               .device = local->device,
                               .driver = local->driver,
                               .thread_count = local->thread_count,
                               .rank_count = wire_size(),
                               .pass_least = PASS_RANK * (uint32_t)wire_size(),
                               .pool = local->pool,
                               .takes_light = local->takes_light,
                               .load = load,
                               .unload = unload,
                               .begin = begin,
                               .pass = pass,
                               .cpu_ns = local->cpu_ns != NULL ? cpu_ns : NULL,
                               .rank_progress = progress_of_rank,
                               .destroy = destroy};
    return &c->base;
}
