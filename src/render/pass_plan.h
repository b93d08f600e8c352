// SPDX-License-Identifier: MIT
/*
 * pass_plan.h - the plan of passes: how many samples each of them adds
 *
 * Passes double, from one sample per pixel to SAMPLE_BLOCK: short passes give
 * early pictures. Then, without a limit of the error, they grow with the
 * samples before them. At the end of a pass threads wait, a device's film is
 * read back and the error is estimated, which is a small share of long passes.
 * The plan depends on sample counts, never on the clock.
 *
 * Units:     samples per pixel; of adaptive renders in the mean
 */
#ifndef GLIM_PASS_PLAN_H
#define GLIM_PASS_PLAN_H

#include "film/adaptive.h"
#include "render/backend.h"
#include "render/render_limits.h"

/* Returns whether the passes after `done` samples have the shares of adaptive
 * sampling, in a render that is adaptive or not. */
bool pass_plan_has_shares(uint64_t done, bool is_adaptive);

/* Returns the number of samples at the end of the pass after `done` samples. */
uint64_t pass_plan_next(uint64_t done, const struct render_limits *limits,
                        bool is_adaptive);

/* Returns the number of samples at the end of the pass in which a render with
 * `done` samples and a limit of the error gets `spp` samples. */
uint64_t pass_plan_end(uint64_t done, uint64_t spp, bool is_adaptive);

/* Returns the pass from `done` to `target` samples over a grid. `adaptive` has
 * decided the shares if pass_plan_has_shares(); they are lent to the pass. */
struct pass pass_plan_pass(uint64_t done, uint64_t target, int stride,
                           const struct adaptive *adaptive);

#endif
