// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include "render/pass_plan.h"

/* The upper end of the interval counts: the error is below the limit with the
 * stated confidence. */
static void an_error_is_reached_by_its_upper_end(void **state)
{
    struct render_limits limits = {.error = 0.01};
    struct film_error e = {true, true, 0.009, 0.008, 0.0101};

    (void)state;
    assert_int_equal(render_limits_at(&limits, 64, &e), RENDER_LIMIT_NONE);
    e.high = 0.01;
    assert_int_equal(render_limits_at(&limits, 64, &e), RENDER_LIMIT_ERROR);
    e.is_known = false;
    assert_int_equal(render_limits_at(&limits, 64, &e), RENDER_LIMIT_NONE);
    e = (struct film_error){.is_known = true}; /* a picture without noise */
    assert_int_equal(render_limits_at(&limits, 16, &e), RENDER_LIMIT_ERROR);
    assert_int_equal(render_limits_at(&limits, 15, &e), RENDER_LIMIT_NONE);
}

static void the_error_counts_more_than_samples(void **state)
{
    struct render_limits limits = {.spp = 64, .error = 0.01};
    struct film_error e = {true, true, 0.02, 0.019, 0.021};

    (void)state;
    assert_int_equal(render_limits_at(&limits, 63, &e), RENDER_LIMIT_NONE);
    assert_int_equal(render_limits_at(&limits, 64, &e), RENDER_LIMIT_SPP);
    assert_int_equal(render_limits_at(&limits, 65, &e), RENDER_LIMIT_SPP);
    e.high = 0.01;
    assert_int_equal(render_limits_at(&limits, 64, &e), RENDER_LIMIT_ERROR);
}

static void no_limit_never_holds(void **state)
{
    struct render_limits limits = {.time_ns = 1}; /* the clock's own */
    struct film_error e = {.is_known = true};

    (void)state;
    assert_int_equal(render_limits_at(&limits, 1000, &e), RENDER_LIMIT_NONE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_error_is_reached_by_its_upper_end),
        cmocka_unit_test(the_error_counts_more_than_samples),
        cmocka_unit_test(no_limit_never_holds),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
