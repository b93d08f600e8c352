// SPDX-License-Identifier: MIT
#include "cluster/cluster.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "cluster/cluster_pass.h"

/* Samples of a pass for each rank, at least: its end takes time. */
#define PASS_RANK 16

struct backend_cluster {
    struct backend base;
    struct cluster_ranks ranks;
    uint64_t sent[WORLD_LIST_COUNT]; /* versions that the workers have */
    bool is_announced;               /* the workers know the picture, */
    bool is_begun; /* and the local backend has the whole film */
};

/* ---- picture ---- */

static bool load(struct backend *base, struct host_world *host,
                 const struct world *world, struct error *err)
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
    c->is_begun =
        c->ranks.local->begin(c->ranks.local, c->ranks.host, &c->ranks.world,
                              c->ranks.film, c->ranks.x0, c->ranks.y0, err);
    c->base.upload_count = c->ranks.local->upload_count;
    return c->is_begun;
}

static bool begin(struct backend *base, const struct host_world *host,
                  const struct world *world, struct film *film, int x0, int y0,
                  struct error *err)
{
    struct backend_cluster *c = (struct backend_cluster *)base;

    c->ranks.host = host;
    c->ranks.world = *world;
    c->ranks.film = film;
    c->ranks.x0 = x0;
    c->ranks.y0 = y0;
    c->is_announced = false;
    for (int rank = 0; rank < wire_size(); rank++)
        rank_tally_begin(&c->ranks.tallies[rank]);
    return begin_local(c, err);
}

/* Tells the workers of the picture, and sends the arrays that they lack. */
static void announce(struct backend_cluster *c)
{
    struct world_array list[WORLD_LIST_COUNT];
    struct rank_order o = {.kind = ORDER_BEGIN,
                           .settings = c->ranks.world.settings,
                           .width = c->ranks.film->width,
                           .x0 = c->ranks.x0,
                           .y0 = c->ranks.y0,
                           .has_surfaces = c->ranks.film->surfaces != NULL,
                           .first_sample = c->ranks.film->first_sample};

    world_list(&c->ranks.world, list);
    memcpy(o.versions, c->ranks.host->versions, sizeof o.versions);
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
    uint64_t before = atomic_load(&c->ranks.film->samples);
    enum pass_result result;

    if (!c->is_begun && !begin_local(c, err))
        return PASS_FAILED;
    rank_tally_give(&c->ranks.tallies[0]);
    result = c->ranks.local->pass(c->ranks.local, pass, cancel, err);
    rank_tally_take(&c->ranks.tallies[0],
                    atomic_load(&c->ranks.film->samples) - before);
    return result;
}

static enum pass_result pass(struct backend *base, const struct pass *pass,
                             const struct cancel *cancel, struct error *err)
{
    struct backend_cluster *c = (struct backend_cluster *)base;

    if (is_local(c, pass))
        return pass_alone(c, pass, cancel, err);
    if (!c->is_announced) {
        enum pass_result result =
            cluster_pass_wait_for_late(&c->ranks, cancel, err);

        if (result != PASS_DONE)
            return result;
        announce(c);
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
                               .load = load,
                               .unload = unload,
                               .begin = begin,
                               .pass = pass,
                               .cpu_ns = local->cpu_ns != NULL ? cpu_ns : NULL,
                               .rank_progress = progress_of_rank,
                               .destroy = destroy};
    return &c->base;
}
