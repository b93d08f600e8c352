// SPDX-License-Identifier: MIT
#include "render/pass_plan.h"

#include <math.h>
#include <stdbool.h>

#include "base/min_max.h"
#include "kernels/path_types.h"
#include "kernels/sample_share.h"

/* ---- limits and the course of the error ---- */

/* ---- limits ---- */

enum render_limit render_limits_at(const struct render_limits *limits,
                                   uint64_t spp_done,
                                   const struct film_error *error)
{
    if (limits->error > 0 && spp_done >= RENDER_ERROR_SPP_MIN &&
        error->is_known && error->high <= limits->error)
        return RENDER_LIMIT_ERROR;
    return limits->spp != 0 && spp_done >= limits->spp ? RENDER_LIMIT_SPP
                                                       : RENDER_LIMIT_NONE;
}

/* ---- course of the error ---- */

/* The exponent p is 1 + FIT_SHARE * (fit - 1), with a fit of at most FIT_MAX:
 * stratification gains most at first. WIDTH_SHARE is a / t as a share of the
 * interval's width. Of 12,860 times left, from a tenth of the way on, in
 * adaptive renders of the 13 scenes of scenes/ that ended at 24 to 504 samples,
 * 10 % were wrong by more than 20 %, near the end by 20 % of a tenth of the
 * way: most of chess, where rare light goes on to be found, and 1 to 4 % in
 * half of the scenes. Without the exponential it was 17 %, over samples instead
 * of time 20 %. */
#define FIT_MAX     1.2
#define FIT_SHARE   0.5
#define WIDTH_SHARE 1.3

/* Steps of Newton's method. */
#define STEPS_MAX 100

void render_trend_add(struct render_trend *t, double ns, double spp,
                      const struct film_error *e)
{
    t->last =
        (struct trend_point){.ns = ns,
                             .spp = spp,
                             .log_high = 2 * log(e->high),
                             .width = e->error > 0 ? 2 * log(e->high / e->error)
                                                   : 0};
    if (t->count > 0 && ns < 2 * t->points[t->count - 1].ns)
        return;
    if (t->count == 2)
        t->points[0] = t->points[--t->count];
    t->points[t->count++] = t->last;
}

/* Returns whether the first point is from the first half of the time. */
static bool has_course(const struct render_trend *t)
{
    return t->count > 0 && t->points[0].ns > 0 &&
           t->last.ns >= 2 * t->points[0].ns;
}

double render_trend_sample_ns(const struct render_trend *t)
{
    const struct trend_point *first = &t->points[0];

    if (!has_course(t) || t->last.spp <= first->spp)
        return 0;
    return (t->last.ns - first->ns) / (t->last.spp - first->spp);
}

/* Returns the logarithm of C / t^p. */
static double log_power(const struct trend_point *p)
{
    return p->log_high - WIDTH_SHARE * p->width;
}

static double exponent(const struct render_trend *t)
{
    const struct trend_point *first = &t->points[0];
    double fit;

    if (!has_course(t))
        return 1;
    fit =
        (log_power(first) - log_power(&t->last)) / log(t->last.ns / first->ns);
    return fit > 1 ? 1 + FIT_SHARE * (fmin(fit, FIT_MAX) - 1) : 1;
}

double render_trend_target_ns(const struct render_trend *t, double target)
{
    double p = exponent(t);
    double a = WIDTH_SHARE * t->last.width; /* over the time of the last */
    double x = 0; /* logarithm of the time over that of the last */

    if (t->last.log_high <= 2 * log(target))
        return t->last.ns;
    if (!isfinite(t->last.log_high) || !isfinite(a))
        return HUGE_VAL;
    /* the function is convex and falls, so that steps from the left of its
     * root stay there */
    for (int i = 0; i < STEPS_MAX; i++) {
        double e = a * exp(-x);
        double above = log_power(&t->last) - p * x + e - 2 * log(target);

        if (!(above > 1e-9))
            break;
        x += above / (p + e);
    }
    return t->last.ns * exp(x);
}

/* ---- passes ---- */

/* Samples of a long pass: a share of those before, and at most PASS_MEAN_MAX.
 */
#define PASS_SHARE 16

bool pass_plan_has_shares(uint64_t done, bool is_adaptive)
{
    return is_adaptive && done >= ADAPTIVE_FIRST;
}

/* Returns the number of samples in the pass after `done` samples, if no limit
 * of samples and no decision comes before. */
static uint64_t pass_length(uint64_t done, bool has_error_limit)
{
    uint64_t share = done / PASS_SHARE / SAMPLE_BLOCK * SAMPLE_BLOCK;

    if (done <= SAMPLE_BLOCK)
        return done == 0 ? 1 : done;
    return has_error_limit || share < SAMPLE_BLOCK
               ? SAMPLE_BLOCK
               : u64_min(share, PASS_MEAN_MAX);
}

uint64_t pass_plan_next(uint64_t done, const struct render_limits *limits,
                        bool is_adaptive)
{
    uint64_t target = done + pass_length(done, limits->error > 0);

    /* the decision has the same samples wherever a step or a limit stopped */
    if (is_adaptive && done < ADAPTIVE_FIRST)
        target = u64_min(target, ADAPTIVE_FIRST);
    return limits->spp != 0 ? u64_min(target, limits->spp) : target;
}

uint64_t pass_plan_end(uint64_t done, uint64_t spp, bool is_adaptive)
{
    const struct render_limits limits = {.error = 1};
    uint64_t equal_from = is_adaptive ? ADAPTIVE_FIRST : SAMPLE_BLOCK;

    while (done < spp && done < equal_from)
        done = pass_plan_next(done, &limits, is_adaptive);
    if (done >= spp)
        return done;
    return done + (spp - done + SAMPLE_BLOCK - 1) / SAMPLE_BLOCK * SAMPLE_BLOCK;
}

struct pass pass_plan_pass(uint64_t done, uint64_t target, int stride,
                           const struct adaptive *adaptive)
{
    struct pass pass = {.stride = stride, .order = (uint32_t)target};

    if (pass_plan_has_shares(done, adaptive->shares != NULL))
        pass.shares = adaptive->shares;
    return pass_with(pass, target, target - done);
}
