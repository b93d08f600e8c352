// SPDX-License-Identifier: MIT
#include "render/render_left.h"

#include <math.h>

#include "render/pass_plan.h"

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
