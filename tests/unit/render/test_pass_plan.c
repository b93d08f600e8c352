// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include "render/pass_plan.h"

#include "kernels/sample_share.h"

static const struct render_limits none = {0};
static const struct render_limits some_error = {.error = 0.1};

/* Compares the ends of the passes after `done` samples. */
static void check_passes(uint64_t done, bool is_adaptive, const uint64_t *ends,
                         int count)
{
    for (int i = 0; i < count; i++) {
        done = pass_plan_next(done, &none, is_adaptive);
        assert_int_equal(done, ends[i]);
    }
}

static void passes_double_up_to_a_block(void **state)
{
    (void)state;
    for (int adaptive = 0; adaptive <= 1; adaptive++)
        check_passes(0, adaptive,
                     (const uint64_t[]){1, 2, 4, 8, 16, 24, 32, 40, 48}, 9);
    check_passes(3, false, (const uint64_t[]){6, 12, 20, 28, 36}, 5);
}

/* A later pass is at most a 16th of the samples before it, or a block, as are
 * all passes of a render that ends at an error. */
static void long_passes_are_a_share(void **state)
{
    uint64_t done = 8, before;
    int count = 0;

    (void)state;
    check_passes(240, false, (const uint64_t[]){248, 256, 272, 288}, 4);
    assert_int_equal(pass_plan_next(1016, &some_error, false), 1024);
    check_passes(1016, false, (const uint64_t[]){1072, 1136, 1200, 1264}, 4);
    while (done < 4096) {
        before = done;
        done = pass_plan_next(before, &none, false);
        assert_true(done - before <= 64);
        assert_true(done - before == 8 || 16 * (done - before) <= before);
        count++;
    }
    assert_true(count < 110);
}

/* Shares are decided after as many samples wherever a step or a limit stopped.
 */
static void adaptive_passes_stop_at_the_decision(void **state)
{
    (void)state;
    check_passes(3, true, (const uint64_t[]){6, 12, 16, 24, 32}, 5);
    check_passes(15, true, (const uint64_t[]){16, 24}, 2);
    check_passes(17, true, (const uint64_t[]){25, 33}, 2);
}

static uint64_t next_within(uint64_t done, uint64_t limit, bool is_adaptive)
{
    const struct render_limits limits = {.spp = limit};

    return pass_plan_next(done, &limits, is_adaptive);
}

static void a_limit_ends_the_last_pass(void **state)
{
    (void)state;
    for (int adaptive = 0; adaptive <= 1; adaptive++) {
        assert_int_equal(next_within(0, 1, adaptive), 1);
        assert_int_equal(next_within(2, 3, adaptive), 3);
        assert_int_equal(next_within(16, 20, adaptive), 20);
        assert_int_equal(next_within(16, 24, adaptive), 24);
        assert_int_equal(next_within(16, 1000, adaptive), 24);
    }
}

/* The end that is found at once is that of the pass after pass. */
static void the_pass_of_a_sample_is_found(void **state)
{
    (void)state;
    for (int adaptive = 0; adaptive <= 1; adaptive++)
        for (uint64_t done = 0; done < 1500; done += 1 + done / 10)
            for (uint64_t spp = 0; spp < 3000; spp += 1 + spp / 50) {
                uint64_t end = done;

                while (end < spp)
                    end = pass_plan_next(end, &some_error, adaptive);
                assert_int_equal(pass_plan_end(done, spp, adaptive), end);
            }
    assert_int_equal(pass_plan_end(3, UINT64_C(1000000000000001), false),
                     UINT64_C(1000000000000004));
    assert_int_equal(pass_plan_end(3, UINT64_C(1000000000000001), true),
                     UINT64_C(1000000000000008));
}

static void shares_count_after_the_first_samples(void **state)
{
    uint16_t shares[16] = {0};
    struct adaptive off = {0};
    struct adaptive adaptive = {.shares = shares};
    struct pass p;

    (void)state;
    p = pass_plan_pass(8, 16, 2, &adaptive);
    assert_int_equal(p.stride, 2);
    assert_int_equal(p.target, 16);
    assert_int_equal(p.samples, 8);
    assert_null(p.shares);
    p = pass_plan_pass(16, 24, 1, &off);
    assert_int_equal(p.samples, 8);
    assert_null(p.shares);
    p = pass_plan_pass(16, 24, 1, &adaptive);
    assert_int_equal(p.target, 24);
    assert_int_equal(p.samples, 32);
    assert_ptr_equal(p.shares, shares);
}

/* No pixel needs more samples in a pass than its plan says, and together they
 * get what was asked for. */
static void samples_follow_shares(void **state)
{
    uint64_t seed = 3;

    (void)state;
    assert_int_equal(share_samples(SHARE_MAX, ADAPTIVE_FIRST), ADAPTIVE_FIRST);
    assert_int_equal(share_samples(SHARE_ONE, 1000), 1000);
    assert_int_equal(share_samples(2 * SHARE_ONE, 116), 216);
    assert_int_equal(share_samples(SHARE_MAX, UINT64_C(1) << 40),
                     (UINT64_C(1) << 42) - 48);
    for (int i = 0; i < 100000; i++) {
        uint32_t share = (uint32_t)(check_random(&seed) * SHARE_MAX);
        uint64_t done = 16 + (uint64_t)(check_random(&seed) * 1000);
        uint64_t more = 1 + (uint64_t)(check_random(&seed) * 8);
        uint64_t first = share_samples(share, done);
        uint64_t last = share_samples(share, done + more);

        assert_true(last >= first && last - first <= 4 * more);
        check_close((double)last,
                    16 + (double)(done + more - 16) * share / SHARE_ONE, 0.5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(passes_double_up_to_a_block),
        cmocka_unit_test(long_passes_are_a_share),
        cmocka_unit_test(adaptive_passes_stop_at_the_decision),
        cmocka_unit_test(a_limit_ends_the_last_pass),
        cmocka_unit_test(the_pass_of_a_sample_is_found),
        cmocka_unit_test(shares_count_after_the_first_samples),
        cmocka_unit_test(samples_follow_shares),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
