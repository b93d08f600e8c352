// SPDX-License-Identifier: MIT
#include "render/pass_plan.h"

#include "kernels/path_types.h"

static uint64_t smaller(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

bool pass_plan_has_targets(uint64_t done, bool is_adaptive)
{
    return is_adaptive && done >= ADAPTIVE_FIRST;
}

uint64_t pass_plan_next(uint64_t done, uint64_t limit, bool is_adaptive)
{
    uint64_t more = done == 0 ? 1 : smaller(done, SAMPLE_BLOCK);
    uint64_t target = done + more;

    if (pass_plan_has_targets(done, is_adaptive))
        target = smaller(done + ADAPTIVE_PASS, adaptive_round_end(done));
    return limit != 0 ? smaller(target, limit) : target;
}

/* Returns the end of the pass with sample `spp`, where all passes after `done`
 * samples have the same size. */
static uint64_t equal_passes_end(uint64_t done, uint64_t spp, uint64_t size)
{
    return done + (spp - done + size - 1) / size * size;
}

uint64_t pass_plan_end(uint64_t done, uint64_t spp, bool is_adaptive)
{
    uint64_t equal_from = is_adaptive ? ADAPTIVE_FIRST : SAMPLE_BLOCK;
    uint64_t round_end;

    while (done < spp && done < equal_from)
        done = pass_plan_next(done, 0, is_adaptive);
    if (done >= spp)
        return done;
    if (!is_adaptive)
        return equal_passes_end(done, spp, SAMPLE_BLOCK);
    /* rounds end at multiples of their passes */
    round_end = adaptive_round_end(done);
    return spp > round_end
               ? equal_passes_end(round_end, spp, ADAPTIVE_PASS)
               : smaller(equal_passes_end(done, spp, ADAPTIVE_PASS), round_end);
}

struct pass pass_plan_pass(uint64_t done, uint64_t target, int stride,
                           const struct adaptive *adaptive)
{
    struct pass pass = {.stride = stride,
                        .target = target,
                        .samples = (uint32_t)(target - done),
                        .order = (uint32_t)target};

    if (pass_plan_has_targets(done, adaptive->targets != NULL)) {
        pass.targets = adaptive->targets;
        pass.target_count = 2 * (uint32_t)adaptive->cells;
        pass.target_version = adaptive->version;
        pass.samples = ADAPTIVE_MOST;
    }
    return pass;
}
