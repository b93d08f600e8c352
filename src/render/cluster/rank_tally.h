// SPDX-License-Identifier: MIT
/*
 * rank_tally.h - counters of a rank: bands given to it, answers, samples, time
 *
 * Units:     nanoseconds of clock_ns(), samples of all pixels together
 * Threads:   one gives and takes; any reads
 */
#ifndef GLIM_RANK_TALLY_H
#define GLIM_RANK_TALLY_H

#include <stdatomic.h>

#include "render/backend.h"

struct rank_tally {
    int owed;           /* bands without an answer */
    atomic_ullong busy; /* time with a band, without the one in progress */
    atomic_ullong samples, answers;
    /* time of the last answer, or when it got work after that; 0: it owes
     * nothing */
    atomic_ullong since;
};

/* Begins a new picture: everything but the owed bands is 0. */
void rank_tally_begin(struct rank_tally *t);

/* Counts a band that the rank was given. */
void rank_tally_give(struct rank_tally *t);

/* Counts an answer, with the samples that were added to the film. */
void rank_tally_take(struct rank_tally *t, uint64_t samples);

struct rank_progress rank_tally_read(const struct rank_tally *t);

#endif
