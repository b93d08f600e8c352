// SPDX-License-Identifier: MIT
#include "render/pass_plan.h"

#include "kernels/path_types.h"
#include "kernels/sample_share.h"

/* Samples of a long pass: a share of those before, and at most PASS_MEAN_MAX.
 */
#define PASS_SHARE 16

static uint64_t smaller(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

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
               : smaller(share, PASS_MEAN_MAX);
}

uint64_t pass_plan_next(uint64_t done, const struct render_limits *limits,
                        bool is_adaptive)
{
    uint64_t target = done + pass_length(done, limits->error > 0);

    /* the decision has the same samples wherever a step or a limit stopped */
    if (is_adaptive && done < ADAPTIVE_FIRST)
        target = smaller(target, ADAPTIVE_FIRST);
    return limits->spp != 0 ? smaller(target, limits->spp) : target;
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
