// SPDX-License-Identifier: MIT
/*
 * A pass is divided into bands of rows, which ranks get in turn: a share of the
 * rows that are left, so that they are large at first and small at the end, and
 * a slow rank gets fewer of them. Each worker has a second band waiting, so
 * that it does not wait for messages. Grids with a stride, which are fast, and
 * the draft of the screen are rendered by rank 0 alone.
 */
#include "cluster/cluster.h"

#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "cluster/band_thread.h"
#include "cluster/wire.h"
#include "picture/film_merge.h"

/* Bands of a worker at a time, one of which waits so that the worker does not;
 * only one in the last part of the rows, where others would wait for the worker
 * that has two. */
#define BANDS_WAITING 2
#define LAST_PART     4

/* Time for answers after a halt, beyond which they are late: their samples are
 * lost, and the next pass does without that worker until it has answered. */
#define LATE_NS 250000000

/* Time after which a late worker is lost. */
#define LOST_NS 10000000000

/* A band has this part of a rank's share of the rows that are left. */
#define ROWS_PART 4

struct backend_cluster {
    struct backend base;
    struct backend *local;
    struct band_thread *thread;
    int *waiting;                    /* bands of each rank without an answer */
    int waiting_count;               /* bands of this pass without an answer */
    uint64_t sent[WORLD_LIST_COUNT]; /* versions that the workers have */
    uint32_t epoch;                  /* passes so far */
    /* of begin() */
    const struct host_world *host;
    struct world world;
    struct film *film;
    int x0, y0;
    bool is_announced; /* the workers know the picture, */
    bool is_begun;     /* and the local backend has the whole film */
};

/* A pass in progress. */
struct progress {
    struct backend_cluster *c;
    const struct pass *pass;
    const struct cancel *cancel;
    int y; /* first row that is in no band */
    struct band local;
    uint64_t stopped_ns; /* when the workers were told to stop; 0: not yet */
    bool has_failed;
    struct error *err;
};

/* ---- picture ---- */

static bool load(struct backend *base, struct host_world *host,
                 const struct world *world, struct error *err)
{
    struct backend_cluster *c = (struct backend_cluster *)base;
    bool ok = c->local->load(c->local, host, world, err);

    base->tree_bytes = c->local->tree_bytes;
    base->pool = c->local->pool;
    return ok;
}

static void unload(struct backend *base)
{
    struct backend_cluster *c = (struct backend_cluster *)base;

    c->local->unload(c->local);
    base->tree_bytes = 0;
}

static bool begin_local(struct backend_cluster *c, struct error *err)
{
    c->is_begun = c->local->begin(c->local, c->host, &c->world, c->film, c->x0,
                                  c->y0, err);
    c->base.upload_count = c->local->upload_count;
    return c->is_begun;
}

static bool begin(struct backend *base, const struct host_world *host,
                  const struct world *world, struct film *film, int x0, int y0,
                  struct error *err)
{
    struct backend_cluster *c = (struct backend_cluster *)base;

    c->host = host;
    c->world = *world;
    c->film = film;
    c->x0 = x0;
    c->y0 = y0;
    c->is_announced = false;
    return begin_local(c, err);
}

/* Tells the workers of the picture, and sends the arrays that they lack. */
static void announce(struct backend_cluster *c)
{
    struct world_array list[WORLD_LIST_COUNT];
    struct rank_order o = {.kind = ORDER_BEGIN,
                           .settings = c->world.settings,
                           .width = c->film->width,
                           .x0 = c->x0,
                           .y0 = c->y0,
                           .has_surfaces = c->film->surfaces != NULL,
                           .first_sample = c->film->first_sample};

    world_list(&c->world, list);
    memcpy(o.versions, c->host->versions, sizeof o.versions);
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
}

/* ---- bands ---- */

static bool row_is_done(const struct film *f, const struct pass *pass, int y)
{
    size_t at = (size_t)y * (size_t)f->width;

    for (int x = 0; x < f->width; x++, at++)
        if (f->counts[at] < pass_target(pass, at))
            return false;
    return true;
}

/* Takes the next rows that lack samples: those from *y on. Returns their
 * number, 0 at the end. */
static int next_rows(struct progress *p, int *y)
{
    const struct film *f = p->c->film;
    int rows;

    while (p->y < f->height && row_is_done(f, p->pass, p->y))
        p->y++;
    *y = p->y - p->y % BAND_ROWS;
    rows = (f->height - *y) / (ROWS_PART * wire_size());
    rows = (rows / BAND_ROWS + 1) * BAND_ROWS;
    if (rows > f->height - *y)
        rows = f->height - *y;
    if (p->y >= f->height)
        return 0;
    p->y = *y + rows;
    return rows;
}

static void start_local(struct progress *p)
{
    struct backend_cluster *c = p->c;
    int y, rows = next_rows(p, &y);

    if (rows == 0)
        return;
    if (!band_init(&p->local, c->film->width, y, rows,
                   c->film->surfaces != NULL, p->pass, p->err)) {
        p->has_failed = true;
        band_free(&p->local);
        return;
    }
    band_take(&p->local, c->film, p->pass);
    c->is_begun = false;
    band_thread_begin(c->thread,
                      &(struct band_work){.band = &p->local,
                                          .backend = c->local,
                                          .host = c->host,
                                          .world = &c->world,
                                          .x0 = c->x0,
                                          .y0 = c->y0,
                                          .first_sample = c->film->first_sample,
                                          .cancel = p->cancel});
}

/* Returns true if the band of this rank was done. */
static bool end_local(struct progress *p)
{
    enum pass_result result;

    if (!band_thread_is_busy(p->c->thread) ||
        band_thread_end(p->c->thread, &result, p->err) == NULL)
        return false;
    if (result == PASS_FAILED)
        p->has_failed = true;
    else
        film_merge(p->c->film, p->local.y, &p->local.film);
    band_free(&p->local);
    return true;
}

static void send_band(struct progress *p, int rank)
{
    struct backend_cluster *c = p->c;
    struct rank_order o = {.kind = ORDER_BAND,
                           .epoch = c->epoch,
                           .has_shares = p->pass->shares != NULL,
                           .pass = *p->pass};
    size_t width = (size_t)c->film->width, at, pixels;

    o.rows = next_rows(p, &o.y);
    if (o.rows == 0)
        return;
    at = (size_t)o.y * width;
    pixels = (size_t)o.rows * width;
    wire_post(rank, WIRE_ORDER, &o, sizeof o);
    wire_post(rank, WIRE_DATA, c->film->counts + at,
              pixels * sizeof *c->film->counts);
    if (o.has_shares)
        wire_post(rank, WIRE_DATA, p->pass->shares + at,
                  pixels * sizeof *p->pass->shares);
    c->waiting[rank]++;
    c->waiting_count++;
}

static void receive_film(struct film *f, int rank, const struct rank_answer *a)
{
    size_t pixels = (size_t)f->width * (size_t)f->height;

    wire_receive(rank, WIRE_DATA, f->counts, pixels * sizeof *f->counts);
    wire_receive(rank, WIRE_DATA, f->sums, 3 * pixels * sizeof *f->sums);
    wire_receive(rank, WIRE_DATA, f->odd_sums,
                 3 * pixels * sizeof *f->odd_sums);
    if (f->surfaces != NULL)
        wire_receive(rank, WIRE_DATA, f->surfaces,
                     pixels * sizeof *f->surfaces);
    atomic_store(&f->samples, a->samples);
    atomic_store(&f->rays, a->rays);
    atomic_store(&f->non_finite, a->non_finite);
    atomic_store(&f->saturated, a->saturated);
    atomic_store(&f->cut_paths, a->cut_paths);
}

/* Receives the samples of an answer, and adds them to the film unless they come
 * too late. */
static bool take_samples(struct backend_cluster *c, int rank,
                         const struct rank_answer *a, struct error *err)
{
    struct film part = {0};
    bool ok = film_init(&part, a->width, a->rows, err) &&
              (!a->has_surfaces || film_init_surfaces(&part, err));

    if (ok) /* otherwise the samples stay with MPI, and the render fails */
        receive_film(&part, rank, a);
    if (ok && a->epoch == c->epoch)
        film_merge(c->film, a->y, &part);
    film_free(&part);
    return ok;
}

/* Takes an answer if there is one. Returns false if there is none; *failed is
 * set if the worker or the memory failed. */
static bool take_answer(struct backend_cluster *c, bool *failed,
                        struct error *err)
{
    struct rank_answer a;
    int rank = -1;

    if (!wire_has(&rank, WIRE_ANSWER))
        return false;
    wire_receive(rank, WIRE_ANSWER, &a, sizeof a);
    c->waiting[rank]--;
    if (a.epoch == c->epoch)
        c->waiting_count--;
    if (a.has_failed) {
        *failed = true;
        fail(err, "rank %d: %.240s", rank, a.error);
    }
    if (a.samples > 0 && !take_samples(c, rank, &a, err))
        *failed = true;
    return true;
}

/* Returns true if a worker owes an answer. */
static bool has_late(const struct backend_cluster *c)
{
    for (int rank = 1; rank < wire_size(); rank++)
        if (c->waiting[rank] > 0)
            return true;
    return false;
}

/* Waits for answers to earlier passes: a worker that has something to say does
 * not listen to a broadcast. */
static enum pass_result wait_for_late(struct backend_cluster *c,
                                      const struct cancel *cancel,
                                      struct error *err)
{
    uint64_t begin_ns = clock_ns();
    bool failed = false;

    while (has_late(c) && !failed && !cancel_requested(cancel)) {
        if (!take_answer(c, &failed, err))
            wire_rest();
        if (clock_ns() > begin_ns + LOST_NS)
            failed = !fail(err, "a rank of the cluster does not answer");
    }
    if (failed)
        return PASS_FAILED;
    return cancel_requested(cancel) ? PASS_CANCELLED : PASS_DONE;
}

/* Tells the workers to send what they have. */
static void stop_workers(struct progress *p)
{
    struct backend_cluster *c = p->c;

    for (int rank = 1; rank < wire_size(); rank++)
        if (c->waiting[rank] > 0)
            wire_post(rank, WIRE_CANCEL, &c->epoch, sizeof c->epoch);
    p->stopped_ns = clock_ns();
}

/* Gives bands to the ranks that have too few. */
static void give_bands(struct progress *p)
{
    struct backend_cluster *c = p->c;
    int height = c->film->height;
    int most = p->y < height - height / LAST_PART ? BANDS_WAITING : 1;

    if (!band_thread_is_busy(c->thread))
        start_local(p);
    for (int i = 0; i < most; i++)
        for (int rank = 1; rank < wire_size(); rank++)
            if (c->waiting[rank] <= i)
                send_band(p, rank);
}

/* Returns true if all bands are done, or if those that are not are late. */
static bool is_complete(const struct progress *p, bool is_stopping)
{
    const struct backend_cluster *c = p->c;

    if (band_thread_is_busy(c->thread))
        return false;
    if (is_stopping)
        return c->waiting_count == 0 || clock_ns() > p->stopped_ns + LATE_NS;
    return c->waiting_count == 0 && p->y >= c->film->height;
}

static enum pass_result run_bands(struct progress *p)
{
    struct backend_cluster *c = p->c;

    for (;;) {
        bool is_stopping = p->has_failed || cancel_requested(p->cancel);
        bool did_something;

        if (!is_stopping)
            give_bands(p);
        else if (p->stopped_ns == 0)
            stop_workers(p);
        wire_is_sent();
        did_something = end_local(p);
        did_something = take_answer(c, &p->has_failed, p->err) || did_something;
        if (is_complete(p, is_stopping))
            break;
        if (!did_something)
            wire_rest();
    }
    if (p->has_failed)
        return PASS_FAILED;
    return cancel_requested(p->cancel) ? PASS_CANCELLED : PASS_DONE;
}

/* ---- passes ---- */

/* Returns true for the passes that rank 0 renders alone. */
static bool is_local(const struct backend_cluster *c, const struct pass *pass)
{
    return pass->stride > 1 || c->world.settings.order != ORDER_PROGRESSIVE ||
           c->world.settings.sample != SAMPLE_LIGHT;
}

static enum pass_result pass(struct backend *base, const struct pass *pass,
                             const struct cancel *cancel, struct error *err)
{
    struct backend_cluster *c = (struct backend_cluster *)base;
    struct progress p = {.c = c, .pass = pass, .cancel = cancel, .err = err};

    if (is_local(c, pass)) {
        if (!c->is_begun && !begin_local(c, err))
            return PASS_FAILED;
        return c->local->pass(c->local, pass, cancel, err);
    }
    c->epoch++;
    c->waiting_count = 0;
    if (!c->is_announced) {
        enum pass_result result = wait_for_late(c, cancel, err);

        if (result != PASS_DONE)
            return result;
        announce(c);
    }
    return run_bands(&p);
}

static uint64_t cpu_ns(const struct backend *base, int thread)
{
    const struct backend_cluster *c = (const struct backend_cluster *)base;

    return c->local->cpu_ns(c->local, thread);
}

static void destroy(struct backend *base)
{
    struct backend_cluster *c = (struct backend_cluster *)base;

    band_thread_destroy(c->thread);
    c->local->destroy(c->local);
    free(c->waiting);
    free(c);
}

/* The exchange at the end of a pass takes the longer, beside the samples, the
 * more ranks there are. */
static uint32_t pass_least(void)
{
    int least = SAMPLE_BLOCK * wire_size();

    return least < PASS_JOINED_MAX ? (uint32_t)least : PASS_JOINED_MAX;
}

struct backend *cluster_backend_create(struct backend *local, struct error *err)
{
    struct backend_cluster *c = alloc_array(1, sizeof *c);

    if (c != NULL)
        c->waiting = alloc_array((size_t)wire_size(), sizeof *c->waiting);
    if (c == NULL || c->waiting == NULL) {
        free(c);
        fail(err, "out of memory");
        return NULL;
    }
    c->thread = band_thread_create(err);
    if (c->thread == NULL) {
        free(c->waiting);
        free(c);
        return NULL;
    }
    c->local = local;
    c->base = (struct backend){.name = local->name,
                               .device = local->device,
                               .driver = local->driver,
                               .thread_count = local->thread_count,
                               .pass_least = pass_least(),
                               .pool = local->pool,
                               .load = load,
                               .unload = unload,
                               .begin = begin,
                               .pass = pass,
                               .cpu_ns = local->cpu_ns != NULL ? cpu_ns : NULL,
                               .destroy = destroy};
    return &c->base;
}
