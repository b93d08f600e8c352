// SPDX-License-Identifier: MIT
#include "render/progress.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "render/pass_plan.h"

/* ---- what is left ---- */

/* Samples per pixel beyond which a time is of no interest, and which integers
 * hold. */
#define SPP_MAX 1e15

static double tracing_ns(const struct render_progress *p)
{
    return p->render_ns > p->build_ns ? (double)(p->render_ns - p->build_ns)
                                      : 0;
}

/* Returns the time of a sample, of the latter part of the render if that is
 * known, else the mean one. It is 0 before the first sample. */
static double sample_ns(const struct render_progress *p)
{
    double late_ns = render_trend_sample_ns(&p->trend);

    if (p->samples == 0)
        return 0;
    return late_ns > 0 ? late_ns / (double)p->pixels
                       : tracing_ns(p) / (double)p->samples;
}

/* Finds the time until the film has so many samples. Returns false before the
 * first sample. */
static bool ns_to_samples(const struct render_progress *p, double samples,
                          double *ns)
{
    double missing = samples - (double)p->samples;
    double each_ns = sample_ns(p);

    *ns = missing > 0 ? missing * each_ns : 0;
    return each_ns > 0;
}

bool render_left_to_error(const struct render_progress *p, double target,
                          double *ns)
{
    const struct film_error *e = &p->film_error;
    double left_ns, spp;

    if (!e->is_known || !e->is_resolved || p->spp_done == 0 ||
        sample_ns(p) <= 0)
        return false;
    left_ns = render_trend_target_ns(&p->trend, target) - tracing_ns(p);
    spp = ((double)p->samples + left_ns / sample_ns(p)) / (double)p->pixels;
    spp = fmax(spp, fmax((double)p->spp_done, RENDER_ERROR_SPP_MIN));
    if (e->high > target && spp < SPP_MAX) /* the error is known after passes */
        spp = (double)pass_plan_end(p->spp_done, (uint64_t)spp + 1,
                                    p->is_adaptive);
    return ns_to_samples(p, spp * (double)p->pixels, ns);
}

/* Takes the limit if it is nearer. */
static void take(struct render_left *left, enum render_limit limit, double ns)
{
    if (left->limit != RENDER_LIMIT_NONE && ns >= left->ns)
        return;
    left->limit = limit;
    left->ns = ns;
}

struct render_left render_left(const struct render_progress *p)
{
    struct render_left left = {.limit = RENDER_LIMIT_NONE};
    double elapsed_ns = (double)p->render_ns;
    double ns;

    if (p->stopped_by != RENDER_LIMIT_NONE)
        return (struct render_left){p->stopped_by, 0, 1};
    if (p->samples_limit != 0 &&
        ns_to_samples(p, (double)p->samples_limit, &ns))
        take(&left, RENDER_LIMIT_SPP, ns);
    if (p->error_limit > 0 && render_left_to_error(p, p->error_limit, &ns))
        take(&left, RENDER_LIMIT_ERROR, ns);
    if (p->time_limit_ns != 0)
        take(&left, RENDER_LIMIT_TIME,
             p->time_limit_ns > p->render_ns
                 ? (double)(p->time_limit_ns - p->render_ns)
                 : 0);
    if (left.limit == RENDER_LIMIT_SPP)
        left.part = (double)p->samples / (double)p->samples_limit;
    else if (left.limit != RENDER_LIMIT_NONE && elapsed_ns > 0)
        left.part = elapsed_ns / (elapsed_ns + left.ns);
    if (left.part > 1)
        left.part = 1;
    return left;
}

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

/* ---- errors so far ---- */

#define GROWTH 1.1

void error_history_update(struct error_history *h,
                          const struct render_progress *p)
{
    double time_s = (double)p->render_ns * 1e-9;
    double error = p->film_error.error;

    if (h->count > 0 && time_s < h->points[h->count - 1].time_s)
        h->count = 0;
    if (!p->film_error.is_known || !(error > 0) ||
        h->count == ERROR_HISTORY_MAX)
        return;
    /* an error belongs to the end of its pass */
    if (h->count > 0 && (time_s < GROWTH * h->points[h->count - 1].time_s ||
                         !(error < h->points[h->count - 1].error ||
                           error > h->points[h->count - 1].error)))
        return;
    h->points[h->count++] = (struct error_then){time_s, error};
}
