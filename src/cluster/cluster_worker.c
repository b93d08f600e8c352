// SPDX-License-Identifier: MIT
#include "cluster/cluster.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "cluster/band_thread.h"
#include "cluster/wire.h"

/* A worker, its copy of rank 0's world, and the band in progress. */
struct worker {
    struct backend *local;
    struct band_thread *thread;
    struct host_world host; /* versions and the tree; arrays are below */
    struct world world;
    void *arrays[WORLD_LIST_COUNT];
    uint64_t versions[WORLD_LIST_COUNT];
    struct rank_order picture; /* the last ORDER_BEGIN */
    /* the band in progress, and the one before, whose answer is being sent */
    struct rank_order orders[2];
    struct band bands[2];
    int current;
    struct cancel cancel;
    uint32_t cancelled_epoch;
    struct error error; /* of the picture; "" */
};

/* ---- world ---- */

static bool lacks_memory(const char *what, struct error *err)
{
    return fail(err, "rank %d: out of memory for %s", wire_rank(), what);
}

/* Receives the arrays that have changed. */
static bool receive_arrays(struct worker *w, struct error *err)
{
    struct world_array list[WORLD_LIST_COUNT];

    world_list(&w->world, list);
    for (int i = 0; i < WORLD_LIST_COUNT; i++) {
        uint64_t version = w->picture.versions[list[i].part];
        size_t size = w->picture.sizes[i];

        if (version == w->versions[i])
            continue;
        free(w->arrays[i]);
        w->arrays[i] = size > 0 ? alloc_aligned(size, 1) : NULL;
        if (size > 0 && w->arrays[i] == NULL)
            return lacks_memory("the scene", err);
        wire_broadcast(w->arrays[i], size);
        w->versions[i] = version;
    }
    for (int i = 0; i < WORLD_LIST_COUNT; i++)
        world_list_set(&w->world, (enum world_list_index)i, w->arrays[i]);
    return true;
}

static bool begin_picture(struct worker *w, const struct rank_order *o,
                          struct error *err)
{
    struct backend *b = w->local;
    uint64_t shape = o->versions[WORLD_SHAPE];

    w->picture = *o;
    w->world.settings = o->settings;
    if (!receive_arrays(w, err))
        return false;
    memcpy(w->host.versions, o->versions, sizeof w->host.versions);
    w->error.text[0] = '\0';
    if (b->shape == shape)
        return true;
    world_drop_tree(&w->host);
    b->shape = b->load(b, &w->host, &w->world, &w->error) ? shape : 0;
    return true;
}

/* ---- bands ---- */

/* Sends the answer for one of the bands. */
static void send_answer(struct worker *w, int index, bool has_failed,
                        const char *reason)
{
    const struct film *f = &w->bands[index].film;
    const struct rank_order *o = &w->orders[index];
    size_t pixels = (size_t)f->width * (size_t)f->height;
    struct rank_answer a = {.epoch = o->epoch,
                            .has_failed = has_failed,
                            .width = f->width,
                            .has_surfaces = f->surfaces != NULL,
                            .y = o->y,
                            .rows = o->rows,
                            .samples = atomic_load(&f->samples),
                            .rays = atomic_load(&f->rays),
                            .non_finite = atomic_load(&f->non_finite),
                            .saturated = atomic_load(&f->saturated),
                            .cut_paths = atomic_load(&f->cut_paths)};

    snprintf(a.error, sizeof a.error, "%.255s", reason);
    wire_send(0, WIRE_ANSWER, &a, sizeof a);
    if (a.samples == 0)
        return;
    wire_send(0, WIRE_DATA, f->counts, pixels * sizeof *f->counts);
    wire_send(0, WIRE_DATA, f->sums, 3 * pixels * sizeof *f->sums);
    wire_send(0, WIRE_DATA, f->odd_sums, 3 * pixels * sizeof *f->odd_sums);
    if (f->surfaces != NULL)
        wire_send(0, WIRE_DATA, f->surfaces, pixels * sizeof *f->surfaces);
}

static bool begin_band(struct worker *w, const struct rank_order *o,
                       struct error *err)
{
    const struct rank_order *p = &w->picture;
    size_t pixels = (size_t)p->width * (size_t)o->rows;
    static const uint16_t some_shares;
    struct pass pass = o->pass;
    struct error why;
    struct band *band;

    w->current = 1 - w->current;
    band = &w->bands[w->current];
    w->orders[w->current] = *o;
    pass.shares = o->has_shares ? &some_shares : NULL;
    if (!band_init(band, p->width, o->y, o->rows, p->has_surfaces, &pass, &why))
        return fail(err, "rank %d: %.900s", wire_rank(), why.text);
    wire_receive(0, WIRE_DATA, band->before, pixels * sizeof *band->before);
    if (o->has_shares)
        wire_receive(0, WIRE_DATA, band->shares, pixels * sizeof *band->shares);
    if (w->error.text[0] != '\0' || o->epoch <= w->cancelled_epoch) {
        send_answer(w, w->current, w->error.text[0] != '\0', w->error.text);
        band_free(band);
        return true;
    }
    cancel_reset(&w->cancel);
    band_thread_begin(w->thread,
                      &(struct band_work){.band = band,
                                          .backend = w->local,
                                          .host = &w->host,
                                          .world = &w->world,
                                          .x0 = p->x0,
                                          .y0 = p->y0,
                                          .first_sample = p->first_sample,
                                          .cancel = &w->cancel});
    return true;
}

/* ---- loop ---- */

static bool take_cancel(struct worker *w)
{
    int from = 0;

    if (!wire_has(&from, WIRE_CANCEL))
        return false;
    wire_receive(0, WIRE_CANCEL, &w->cancelled_epoch,
                 sizeof w->cancelled_epoch);
    if (band_thread_is_busy(w->thread) &&
        w->orders[w->current].epoch <= w->cancelled_epoch)
        cancel_request(&w->cancel);
    return true;
}

/* Does the next order. *is_ended is set at the last. Messages that were not
 * received stay with MPI after a failure, so the job cannot go on. */
static bool do_order(struct worker *w, bool *is_ended, struct error *err)
{
    struct rank_order o;

    wire_receive(0, WIRE_ORDER, &o, sizeof o);
    if (o.kind == ORDER_BEGIN)
        return begin_picture(w, &o, err);
    if (o.kind == ORDER_BAND)
        return begin_band(w, &o, err);
    *is_ended = true;
    return true;
}

static bool has_order(const struct worker *w)
{
    int from = 0;

    return !band_thread_is_busy(w->thread) && wire_has(&from, WIRE_ORDER);
}

/* Answers for a band that is done. The next one begins before, if it is there,
 * so that it is rendered while the sums are sent. */
static bool end_band(struct worker *w, enum pass_result result,
                     const char *reason, bool *is_ended, struct error *err)
{
    int done = w->current;
    bool ok = !has_order(w) || do_order(w, is_ended, err);

    if (ok && !*is_ended)
        send_answer(w, done, result == PASS_FAILED, reason);
    band_free(&w->bands[done]);
    return ok;
}

/* Serves rank 0 until it ends. */
static bool serve(struct worker *w, struct error *err)
{
    bool is_ended = false, ok = true;

    while (ok && !is_ended) {
        struct error why = {""};
        enum pass_result result;
        bool did_something = take_cancel(w);

        if (band_thread_is_busy(w->thread) &&
            band_thread_end(w->thread, &result, &why) != NULL)
            ok = end_band(w, result, why.text, &is_ended, err);
        else if (has_order(w))
            ok = do_order(w, &is_ended, err);
        else if (!did_something)
            wire_rest();
    }
    return ok;
}

bool cluster_work(struct backend *local, struct error *err)
{
    struct worker *w = alloc_array(1, sizeof *w);
    bool ok;

    if (w == NULL)
        return lacks_memory("a worker", err);
    w->local = local;
    w->host.thread_count = local->thread_count;
    w->thread = band_thread_create(err);
    ok = w->thread != NULL && serve(w, err);
    band_thread_destroy(w->thread);
    local->unload(local);
    world_drop_tree(&w->host);
    for (int i = 0; i < WORLD_LIST_COUNT; i++)
        free(w->arrays[i]);
    free(w);
    return ok;
}
