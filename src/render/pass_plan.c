// SPDX-License-Identifier: MIT
#include "render/pass_plan.h"

#include "kernels/path_types.h"
#include "kernels/sample_share.h"

static uint64_t smaller(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

bool pass_plan_has_shares(uint64_t done, bool is_adaptive)
{
    return is_adaptive && done >= ADAPTIVE_FIRST;
}

uint64_t pass_plan_next(uint64_t done, uint64_t limit, bool is_adaptive)
{
    uint64_t more = done == 0 ? 1 : smaller(done, SAMPLE_BLOCK);
    uint64_t target = done + more;

    /* the decision has the same samples wherever a step or a limit stopped */
    if (is_adaptive && done < ADAPTIVE_FIRST)
        target = smaller(target, ADAPTIVE_FIRST);
    return limit != 0 ? smaller(target, limit) : target;
}

uint64_t pass_plan_end(uint64_t done, uint64_t spp, bool is_adaptive)
{
    uint64_t equal_from = is_adaptive ? ADAPTIVE_FIRST : SAMPLE_BLOCK;

    while (done < spp && done < equal_from)
        done = pass_plan_next(done, 0, is_adaptive);
    if (done >= spp)
        return done;
    return done + (spp - done + SAMPLE_BLOCK - 1) / SAMPLE_BLOCK * SAMPLE_BLOCK;
}

struct pass pass_plan_pass(uint64_t done, uint64_t target, int stride,
                           const struct adaptive *adaptive)
{
    struct pass pass = {.stride = stride,
                        .target = target,
                        .samples = (uint32_t)(target - done),
                        .order = (uint32_t)target};

    if (pass_plan_has_shares(done, adaptive->shares != NULL)) {
        pass.shares = adaptive->shares;
        pass.samples = (pass.samples * SHARE_MOST + SHARE_ONE - 1) / SHARE_ONE;
    }
    return pass;
}
