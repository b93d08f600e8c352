// SPDX-License-Identifier: MIT
/*
 * cluster_pass.h - a pass of all ranks, on rank 0
 *
 * Rank 0 hands out bands (band_plan.h), of which it renders some itself. The
 * answers to them are added to the film when it has all samples before them: a
 * band of a later slice may be done first, and waits in memory.
 *
 * Each worker has a second band waiting, so that it does not wait for messages.
 *
 * Ownership: cluster_ranks_free() frees; what a picture has is lent
 * Threads:   one at a time; tallies are read from any
 * Errors:    out of memory, failures and silence of workers
 */
#ifndef GLIM_CLUSTER_PASS_H
#define GLIM_CLUSTER_PASS_H

#include "cluster/band_answer.h"
#include "cluster/band_thread.h"
#include "cluster/rank_tally.h"
#include "cluster/wire.h"

/* The ranks, seen from rank 0, and the picture that they render. */
struct cluster_ranks {
    struct backend *local; /* the backend of rank 0 */
    struct band_thread *thread;
    struct rank_tally *tallies; /* of each rank */
    int waiting_count;          /* bands of this pass without an answer */
    uint32_t epoch;             /* passes so far */
    const struct host_world *host;
    struct world world;
    struct film *film;
    int x0, y0; /* corner of the film in the picture */
};

/* The caller frees after a failure, too. */
bool cluster_ranks_init(struct cluster_ranks *c, struct backend *local,
                        struct error *err);
void cluster_ranks_free(struct cluster_ranks *c);

/* Waits for answers to earlier passes, whose samples are lost: a worker that
 * has something to say does not listen to a broadcast. */
enum pass_result cluster_pass_wait_for_late(struct cluster_ranks *c,
                                            const struct cancel *cancel,
                                            struct error *err);

/* Renders a pass. The local backend loses its film. */
enum pass_result cluster_pass(struct cluster_ranks *c, const struct pass *pass,
                              const struct cancel *cancel, struct error *err);

#endif
