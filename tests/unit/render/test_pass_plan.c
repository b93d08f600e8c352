// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include "render/pass_plan.h"

/* Compares the ends of the passes after `done` samples. */
static void check_passes(uint64_t done, bool is_adaptive, const uint64_t *ends,
                         int count)
{
    for (int i = 0; i < count; i++) {
        done = pass_plan_next(done, 0, is_adaptive);
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

/* Rounds begin at 16, 32, 64, ..., wherever a step or a limit stopped. */
static void adaptive_passes_end_with_their_round(void **state)
{
    (void)state;
    check_passes(3, true, (const uint64_t[]){6, 12, 20, 28, 32, 40}, 6);
    check_passes(17, true, (const uint64_t[]){25, 32, 40}, 3);
    check_passes(63, true, (const uint64_t[]){64, 72}, 2);
    check_passes(65, true, (const uint64_t[]){73, 81}, 2);
}

static void a_limit_ends_the_last_pass(void **state)
{
    (void)state;
    for (int adaptive = 0; adaptive <= 1; adaptive++) {
        assert_int_equal(pass_plan_next(0, 1, adaptive), 1);
        assert_int_equal(pass_plan_next(2, 3, adaptive), 3);
        assert_int_equal(pass_plan_next(16, 20, adaptive), 20);
        assert_int_equal(pass_plan_next(16, 24, adaptive), 24);
        assert_int_equal(pass_plan_next(16, 1000, adaptive), 24);
    }
}

/* The end that is found at once is that of the pass after pass. */
static void the_pass_of_a_sample_is_found(void **state)
{
    (void)state;
    for (int adaptive = 0; adaptive <= 1; adaptive++)
        for (uint64_t done = 0; done < 150; done++)
            for (uint64_t spp = 0; spp < 300; spp++) {
                uint64_t end = done;

                while (end < spp)
                    end = pass_plan_next(end, 0, adaptive);
                assert_int_equal(pass_plan_end(done, spp, adaptive), end);
            }
    assert_int_equal(pass_plan_end(3, UINT64_C(1000000000000001), false),
                     UINT64_C(1000000000000004));
    assert_int_equal(pass_plan_end(3, UINT64_C(1000000000000001), true),
                     UINT64_C(1000000000000008));
}

static void targets_begin_after_the_first_samples(void **state)
{
    uint32_t targets[8] = {0};
    struct adaptive none = {0};
    struct adaptive adaptive = {.targets = targets, .cells = 4, .version = 7};
    struct pass p;

    (void)state;
    p = pass_plan_pass(8, 16, 2, &adaptive);
    assert_int_equal(p.stride, 2);
    assert_int_equal(p.target, 16);
    assert_int_equal(p.samples, 8);
    assert_null(p.targets);
    p = pass_plan_pass(16, 24, 1, &none);
    assert_int_equal(p.samples, 8);
    assert_null(p.targets);
    p = pass_plan_pass(16, 24, 1, &adaptive);
    assert_int_equal(p.target, 24);
    assert_int_equal(p.samples, ADAPTIVE_MOST);
    assert_ptr_equal(p.targets, targets);
    assert_int_equal(p.target_count, 8);
    assert_int_equal(p.target_version, 7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(passes_double_up_to_a_block),
        cmocka_unit_test(adaptive_passes_end_with_their_round),
        cmocka_unit_test(a_limit_ends_the_last_pass),
        cmocka_unit_test(the_pass_of_a_sample_is_found),
        cmocka_unit_test(targets_begin_after_the_first_samples),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
