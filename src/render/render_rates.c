// SPDX-License-Identifier: MIT
#include "render/render_rates.h"

#include <stdlib.h>

#include "base/memory.h"

/* Length of the first spans: the period at which the screen updates the
 * diagram. */
#define SPAN_FIRST_NS UINT64_C(250000000)

/* A rank is late after this time without an answer, and after this many times
 * its mean time for one. Parts of a pass differ in size and in the cost of
 * their pixels, up to some ten times. */
#define LATE_NS    UINT64_C(2000000000)
#define LATE_TIMES 20

/* ---- speeds ---- */

static void halve(struct speeds *s)
{
    s->count /= 2;
    for (int i = 0; i < s->count; i++)
        s->samples[i] = s->samples[2 * i] + s->samples[2 * i + 1];
    s->span_ns *= 2;
}

/* Returns the end of the span that contains the time. Merges spans if
 * necessary. */
static uint64_t span_end_ns(struct speeds *s, uint64_t time_ns)
{
    while (time_ns / s->span_ns >= SPEEDS_MAX)
        halve(s);
    while ((uint64_t)s->count <= time_ns / s->span_ns)
        s->samples[s->count++] = 0;
    return (time_ns / s->span_ns + 1) * s->span_ns;
}

void speeds_update(struct speeds *s, uint64_t time_ns, uint64_t sample_count)
{
    if (time_ns < s->time_ns || sample_count < s->sample_count)
        *s = (struct speeds){0};
    if (s->span_ns == 0)
        s->span_ns = SPAN_FIRST_NS;
    if (time_ns == s->time_ns)
        return; /* samples without time are added to the next measurement */
    double samples = (double)(sample_count - s->sample_count) /
                     (double)(time_ns - s->time_ns);
    while (s->time_ns < time_ns) {
        uint64_t end_ns = span_end_ns(s, s->time_ns);

        end_ns = end_ns < time_ns ? end_ns : time_ns;
        s->samples[s->count - 1] += samples * (double)(end_ns - s->time_ns);
        s->time_ns = end_ns;
    }
    s->sample_count = sample_count;
}

double speeds_at(const struct speeds *s, int i)
{
    uint64_t begin_ns = (uint64_t)i * s->span_ns;
    uint64_t seen_ns = s->time_ns - begin_ns;

    seen_ns = seen_ns < s->span_ns ? seen_ns : s->span_ns;
    return seen_ns > 0 ? s->samples[i] * 1e9 / (double)seen_ns : 0;
}

/* ---- threads ---- */

void thread_load_begin(struct thread_load *l, const struct backend *b)
{
    int count = b->cpu_ns ? b->thread_count : 0;

    if (count != l->count) {
        thread_load_free(l);
        l->cpu_ns = alloc_array((size_t)count, sizeof *l->cpu_ns);
        l->count = l->cpu_ns ? count : 0;
    }
    for (int i = 0; i < l->count; i++)
        l->cpu_ns[i] = b->cpu_ns(b, i);
}

double thread_load_share(const struct thread_load *l, const struct backend *b,
                         int thread, uint64_t time_ns)
{
    double share;

    if (thread >= l->count || !b->cpu_ns || time_ns == 0)
        return 0;
    share =
        (double)(b->cpu_ns(b, thread) - l->cpu_ns[thread]) / (double)time_ns;
    return share < 1 ? share
                     : 1; /* the two clocks are read one after the other */
}

void thread_load_free(struct thread_load *l)
{
    free(l->cpu_ns);
    *l = (struct thread_load){0};
}

/* ---- ranks ---- */

double rank_rate(const struct rank_progress *p)
{
    return p->busy_ns > 0 ? (double)p->samples * 1e9 / (double)p->busy_ns : 0;
}

bool rank_is_late(const struct rank_progress *p)
{
    uint64_t usual_ns = p->answers > 0 ? p->busy_ns / p->answers : 0;

    return p->silent_ns > LATE_NS && p->silent_ns / LATE_TIMES > usual_ns;
}
