// SPDX-License-Identifier: MIT
#include "render/cluster/cluster.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "render/cluster/band.h"
#include "render/cluster/wire.h"

/* A worker, its copy of rank 0's world, and the band in progress. */
struct worker {
    struct backend *local;
    struct band_thread *thread;
    struct host_world host; /* versions and the tree; arrays are below */
    struct world world;
    void *arrays[WORLD_LIST_COUNT];
    uint64_t versions[WORLD_LIST_COUNT];
    struct rank_order picture; /* the last ORDER_BEGIN */
    struct pass_light light;   /* of the last ORDER_LIGHT */
    void *light_arrays[LIGHT_ARRAYS];
    /* the band in progress, and the one before, whose answer is being sent */
    uint32_t epochs[2];
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
    if (b->shape == shape) {
        bvh8_lend(world_tree(&w->host), &w->world);
        return true;
    }
    world_drop_tree(&w->host);
    b->shape = b->load(b, &w->host, &w->world, &w->error) ? shape : 0;
    return true;
}

static bool receive_light(struct worker *w, const struct rank_order *o,
                          struct error *err)
{
    void **arrays = w->light_arrays;

    for (int i = 0; i < LIGHT_ARRAYS; i++) {
        const void *none;
        size_t size = light_array(&o->light, i, &none);

        free(arrays[i]);
        arrays[i] = size > 0 ? alloc_aligned(size, 1) : NULL;
        if (size > 0 && arrays[i] == NULL)
            return lacks_memory("light paths", err);
        wire_broadcast(arrays[i], size);
    }
    w->light = o->light;
    w->light.pixels = arrays[LIGHT_PIXELS];
    w->light.grids = arrays[LIGHT_GRIDS];
    w->light.cells = arrays[LIGHT_CELLS];
    return true;
}

/* ---- bands ---- */

/* Sends the answer for one of the bands. `error` is "" or why it failed. */
static bool send_answer(struct worker *w, int index, const char *error,
                        struct error *err)
{
    size_t size;
    struct band_answer *a =
        band_answer_make(&w->bands[index], w->epochs[index], error, &size);

    if (a == NULL)
        return lacks_memory("an answer", err);
    wire_give(0, WIRE_ANSWER, a, size);
    return true;
}

/* Fills a band from the arrays behind its order. */
static void fill_band(struct band *band, const struct rank_order *o)
{
    const uint64_t *counts = (const uint64_t *)(o + 1);
    size_t pixels = (size_t)band->film.width * (size_t)band->film.height;

    for (size_t i = 0; i < pixels; i++)
        band->before[i] = o->has_counts ? counts[i] : o->before;
    if (o->has_shares)
        memcpy(band->shares, o->has_counts ? counts + pixels : counts,
               pixels * sizeof *band->shares);
}

static bool begin_band(struct worker *w, const struct rank_order *o,
                       struct error *err)
{
    const struct rank_order *p = &w->picture;
    static const uint16_t some_shares;
    struct band_range range = o->range;
    struct error why;
    struct band *band;

    w->current = 1 - w->current;
    band = &w->bands[w->current];
    w->epochs[w->current] = o->epoch;
    range.pass.shares = o->has_shares ? &some_shares : NULL;
    range.pass.light = range.pass.light != NULL ? &w->light : NULL;
    if (!band_init(band, p->width, &range, p->has_surfaces, &why))
        return fail(err, "rank %d: %.900s", wire_rank(), why.text);
    fill_band(band, o);
    if (w->error.text[0] != '\0' || o->epoch <= w->cancelled_epoch) {
        bool ok = send_answer(w, w->current, w->error.text, err);

        band_free(band);
        return ok;
    }
    cancel_reset(&w->cancel);
    band_thread_begin(w->thread,
                      &(struct band_work){.band = band,
                                          .backend = w->local,
                                          .whole = {.host = &w->host,
                                                    .world = &w->world,
                                                    .x0 = p->x0,
                                                    .y0 = p->y0},
                                          .first_sample = p->first_sample,
                                          .cancel = &w->cancel});
    return true;
}

/* ---- loop ---- */

static bool take_cancel(struct worker *w)
{
    int from;
    size_t size;
    uint32_t *epoch = wire_take(&from, WIRE_CANCEL, &size);

    if (epoch == NULL)
        return false;
    w->cancelled_epoch = *epoch;
    free(epoch);
    if (band_thread_is_busy(w->thread) &&
        w->epochs[w->current] <= w->cancelled_epoch)
        cancel_request(&w->cancel);
    return true;
}

static bool do_order(struct worker *w, const struct rank_order *o,
                     bool *is_ended, struct error *err)
{
    if (o->kind == ORDER_BEGIN)
        return begin_picture(w, o, err);
    if (o->kind == ORDER_LIGHT)
        return receive_light(w, o, err);
    if (o->kind == ORDER_BAND)
        return begin_band(w, o, err);
    *is_ended = true;
    return true;
}

/* Does the next order, if there is one and nothing is rendered. Arrays that
 * were not received stay with MPI after a failure, so the job cannot go on. */
static bool take_order(struct worker *w, bool *is_ended, bool *did_something,
                       struct error *err)
{
    struct rank_order *o;
    size_t size;
    int from;
    bool ok;

    if (band_thread_is_busy(w->thread))
        return true;
    o = wire_take(&from, WIRE_ORDER, &size);
    if (o == NULL)
        return true;
    *did_something = true;
    ok = do_order(w, o, is_ended, err);
    free(o);
    return ok;
}

/* Answers for a band that is done. The next one begins before, if it is there,
 * so that it is rendered while the sums are packed and sent. */
static bool end_band(struct worker *w, const char *error, bool *is_ended,
                     struct error *err)
{
    int done = w->current;
    bool did_something;
    bool ok = take_order(w, is_ended, &did_something, err);

    if (ok && !*is_ended)
        ok = send_answer(w, done, error, err);
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
            band_thread_end(w->thread, &result, &why) != NULL) {
            ok = end_band(w, result == PASS_FAILED ? why.text : "", &is_ended,
                          err);
            did_something = true;
        } else {
            ok = take_order(w, &is_ended, &did_something, err);
        }
        if (!did_something)
            band_thread_wait(w->thread,
                             wire_rest_ns(band_thread_is_busy(w->thread)));
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
    for (int i = 0; i < LIGHT_ARRAYS; i++)
        free(w->light_arrays[i]);
    free(w);
    return ok;
}
