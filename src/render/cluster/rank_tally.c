// SPDX-License-Identifier: MIT
#include "render/cluster/rank_tally.h"

#include "base/clock.h"

void rank_tally_begin(struct rank_tally *t)
{
    atomic_store(&t->busy, 0);
    atomic_store(&t->samples, 0);
    atomic_store(&t->answers, 0);
    atomic_store(&t->since, t->owed > 0 ? clock_ns() : 0);
}

void rank_tally_give(struct rank_tally *t)
{
    if (t->owed++ == 0)
        atomic_store(&t->since, clock_ns());
}

void rank_tally_take(struct rank_tally *t, uint64_t samples)
{
    uint64_t now = clock_ns();

    t->owed--;
    atomic_fetch_add(&t->busy, now - atomic_load(&t->since));
    atomic_fetch_add(&t->samples, samples);
    atomic_fetch_add(&t->answers, 1);
    atomic_store(&t->since, t->owed > 0 ? now : 0);
}

struct rank_progress rank_tally_read(const struct rank_tally *t)
{
    uint64_t since = atomic_load(&t->since), now = clock_ns();
    struct rank_progress p = {.samples = atomic_load(&t->samples),
                              .answers = atomic_load(&t->answers),
                              .busy_ns = atomic_load(&t->busy)};

    /* an answer may have come between the two readings */
    if (since != 0 && now > since)
        p.silent_ns = now - since;
    return p;
}
