// SPDX-License-Identifier: MIT
/*
 * test_render_left.c - the time left to each limit, with simulated renders of
 * known speed and known course of the error
 */
#include "tests/unit/check.h"

#include <math.h>
#include <string.h>

#include "render/error_text.h"
#include "render/pass_plan.h"
#include "render/progress.h"

#define S_NS   UINT64_C(1000000000)
#define PIXELS 10000

/* Render of 1e6 samples per second, whose squared error falls as n^-p. */
struct simulation {
    double p;
    double first_error; /* at one sample */
    /* Each sample after the first 16 has the time of so many, and counts as
     * many for the error, as adaptive samples do where only a part of the
     * picture needs them. 0: as one */
    double slower;
    /* squared error that few pixels add at one sample, which falls as n^-2 and
     * widens the interval */
    double rare;
    double width; /* of the interval otherwise, as a part of the error */
    uint64_t build_ns;
};

/* Returns the samples before adaptive ones that are worth `spp`. */
static double worth(const struct simulation *s, double spp)
{
    return s->slower > 0 && spp > 16 ? 16 + s->slower * (spp - 16) : spp;
}

static double error_of(const struct simulation *s, double spp)
{
    double square =
        s->first_error * s->first_error * pow(spp, 1 - s->p) / worth(s, spp);

    return sqrt(square + s->rare / (spp * spp));
}

static struct film_error stated(const struct simulation *s, double spp)
{
    double error = error_of(s, spp);
    double width = s->width + 0.8 * s->rare / (spp * spp) / (error * error);

    return (struct film_error){true, true, error, error * (1 - width / 2),
                               error * exp(width)};
}

static double tracing_ns_of(const struct simulation *s, double spp)
{
    return worth(s, spp) * PIXELS * 1e3;
}

static struct render_progress at(const struct simulation *s, uint64_t spp,
                                 struct render_trend trend)
{
    struct film_error error = stated(s, (double)spp);

    render_trend_add(&trend, tracing_ns_of(s, (double)spp), (double)spp,
                     &error);
    return (struct render_progress){
        .state = RENDER_RUNNING,
        .spp_done = spp,
        .samples = spp * PIXELS,
        .pixels = PIXELS,
        .render_ns = s->build_ns + (uint64_t)tracing_ns_of(s, (double)spp),
        .build_ns = s->build_ns,
        .film_error = error,
        .trend = trend,
    };
}

/* Renders until the upper end is at the target, and compares the time left that
 * was shown from a tenth of the way on with the true one. Returns the worst
 * deviation beyond one pass, as a part of the true time left, but of a tenth of
 * the way at least. */
static double worst_deviation(const struct simulation *s, double target)
{
    const struct render_limits limits = {.error = target};
    bool is_adaptive = s->slower > 0;
    struct render_trend trend = {.count = 0};
    double shown_ns[4096], at_ns[4096], pass_ns, worst = 0;
    int count = 0;

    for (uint64_t spp = 2;; spp = pass_plan_next(spp, &limits, is_adaptive)) {
        struct render_progress p = at(s, spp, trend);
        struct render_left left;

        trend = p.trend;
        p.error_limit = target;
        p.is_adaptive = is_adaptive;
        left = render_left(&p);
        assert_int_equal(left.limit, RENDER_LIMIT_ERROR);
        assert_true(count < 4096);
        at_ns[count] = (double)p.render_ns;
        shown_ns[count++] = left.ns;
        if (p.film_error.high <= target)
            break;
    }
    assert_true(count > 1);
    pass_ns = at_ns[count - 1] - at_ns[count - 2];
    for (int i = 0; i < count; i++) {
        double end_ns = at_ns[count - 1];
        double left_ns = end_ns - at_ns[i];

        double off_ns = fmax(fabs(shown_ns[i] - left_ns) - pass_ns, 0);

        if (at_ns[i] >= end_ns / 10)
            worst = fmax(worst, off_ns / fmax(left_ns, end_ns / 10));
    }
    return worst;
}

static void time_to_an_error_is_right_from_a_tenth_on(void **state)
{
    (void)state;
    for (int i = 0; i <= 2; i++) {
        struct simulation s = {.p = 1 + 0.05 * i,
                               .first_error = 0.5,
                               .width = 0.03};

        for (double target = 0.04; target > 0.004; target /= 1.7)
            assert_true(worst_deviation(&s, target) < 0.2);
        s.build_ns = S_NS / 20;
        assert_true(worst_deviation(&s, 0.01) < 0.2);
    }
}

static void time_to_an_error_is_right_with_adaptive_samples(void **state)
{
    (void)state;
    for (int i = 0; i <= 3; i++) {
        const struct simulation s = {.p = 1.05,
                                     .first_error = 0.5,
                                     .slower = 1 + 0.1 * i,
                                     .width = 0.02};

        for (double target = 0.07; target > 0.004; target /= 1.7)
            assert_true(worst_deviation(&s, target) < 0.2);
    }
}

/* Four tenths of the way to 100 samples, the speed is that of adaptive samples.
 */
static void time_to_samples_is_at_late_speed(void **state)
{
    const struct simulation s = {.p = 1, .first_error = 0.5, .slower = 1.4};
    struct render_progress p = at(&s, 16, (struct render_trend){.count = 0});

    (void)state;
    p = at(&s, 40, p.trend);
    p.samples_limit = 100 * PIXELS;
    check_close(render_left(&p).ns, (100 - 40) * 1.4 * PIXELS * 1e3, 1);
}

/* A pixel that found much light counts less with every sample. */
static void time_to_an_error_is_right_after_rare_light(void **state)
{
    (void)state;
    for (double rare = 0.1; rare < 10; rare *= 3) {
        const struct simulation s = {.p = 1.05,
                                     .first_error = 0.5,
                                     .rare = rare,
                                     .width = 0.02};

        for (double target = 0.04; target > 0.004; target /= 1.7)
            assert_true(worst_deviation(&s, target) < 0.2);
    }
}

static struct film_error exactly(double error)
{
    return (struct film_error){true, true, error, error, error};
}

/* Returns the time at which the target is reached, of a course from time 1 to
 * time 16 whose error falls by the factor. */
static double time_of_course(double factor, double target)
{
    const struct film_error first = exactly(0.04 * factor);
    const struct film_error last = exactly(0.04);
    struct render_trend t = {.count = 0};

    render_trend_add(&t, 1, 2, &first);
    render_trend_add(&t, 16, 32, &last);
    return render_trend_target_ns(&t, target);
}

static void exponents_are_fitted(void **state)
{
    const struct film_error first = exactly(0.04), zero = exactly(0);
    struct render_trend t = {.count = 0};

    (void)state;
    render_trend_add(&t, 16, 32, &first);
    check_close(render_trend_target_ns(&t, 0.01), 256, 1e-6); /* p = 1 */
    check_close(time_of_course(pow(16, 0.54), 0.01), 16 * pow(16, 1 / 1.04),
                1e-6);
    /* out of bounds: an error that grows, or that vanishes */
    check_close(time_of_course(0.5, 0.01), 256, 1e-6);
    check_close(time_of_course(1e9, 0.01), 16 * pow(16, 1 / 1.1), 1e-6);
    /* reached already */
    assert_true(time_of_course(4, 0.04) == 16);
    assert_true(time_of_course(4, 0.05) == 16);
    render_trend_add(&t, 32, 64, &zero);
    assert_true(render_trend_target_ns(&t, 0.01) == 32);
    t.last.log_high = INFINITY;
    assert_true(render_trend_target_ns(&t, 0.01) == HUGE_VAL);
}

/* The interval's width counts 1.3 times and falls as 1 / t. */
static void wide_intervals_become_narrow(void **state)
{
    const struct film_error wide = {true, true, 0.02, 0.01, 0.04};
    struct render_trend t = {.count = 0};
    double width = 2 * log(2), ns;

    (void)state;
    render_trend_add(&t, 10, 32, &wide);
    ns = render_trend_target_ns(&t, 0.01);
    assert_true(ns < 160);
    check_close(2 * log(0.04) - 1.3 * width * (1 - 10 / ns) - log(ns / 10),
                2 * log(0.01), 1e-6);
}

static void speed_is_that_of_late(void **state)
{
    const struct film_error e = exactly(0.1);
    struct render_trend t = {.count = 0};

    (void)state;
    assert_true(render_trend_sample_ns(&t) == 0);
    render_trend_add(&t, 10, 10, &e);
    render_trend_add(&t, 19, 16, &e);
    assert_true(render_trend_sample_ns(&t) == 0);
    render_trend_add(&t, 20, 16, &e);
    check_close(render_trend_sample_ns(&t), 10 / 6.0, 1e-12);
    render_trend_add(&t, 30, 26, &e);
    check_close(render_trend_sample_ns(&t), 20 / 16.0, 1e-12);
    render_trend_add(&t, 40, 36, &e);
    check_close(render_trend_sample_ns(&t), 1, 1e-12);
}

static void the_nearest_limit_counts(void **state)
{
    const struct render_trend none = {.count = 0};
    const struct simulation s = {.p = 1, .first_error = 0.5};
    struct render_progress p = at(&s, 100, none); /* 1 s, 5 % */
    struct render_left left;

    (void)state;
    left = render_left(&p);
    assert_int_equal(left.limit, RENDER_LIMIT_NONE);
    assert_true(left.part == 0);
    p.samples_limit = 500 * PIXELS;
    left = render_left(&p);
    assert_int_equal(left.limit, RENDER_LIMIT_SPP);
    check_close(left.ns, 4e9, 1);
    check_close(left.part, 0.2, 1e-9);
    p.time_limit_ns = 4 * S_NS;
    left = render_left(&p);
    assert_int_equal(left.limit, RENDER_LIMIT_TIME);
    check_close(left.ns, 3e9, 1);
    check_close(left.part, 0.25, 1e-9);
    p.error_limit =
        p.film_error.high / 1.5; /* 225 samples: the pass ends at 228 */
    left = render_left(&p);
    assert_int_equal(left.limit, RENDER_LIMIT_ERROR);
    check_close(left.ns, 1.28e9, 1e3);
    p.error_limit = 0.04;
    p.time_limit_ns = 1; /* over */
    left = render_left(&p);
    assert_int_equal(left.limit, RENDER_LIMIT_TIME);
    assert_true(left.ns == 0 && left.part == 1);
}

/* 12 samples, of which 18.5 reach the target: passes end at 20 and 28, those of
 * an adaptive render at 16 and 24. */
static void errors_are_known_at_the_ends_of_passes(void **state)
{
    const struct render_trend none = {.count = 0};
    const struct simulation s = {.p = 1, .first_error = 0.5};
    struct render_progress p = at(&s, 12, none);

    (void)state;
    p.error_limit = p.film_error.high * sqrt(12 / 18.5);
    check_close(render_left(&p).ns, (20 - 12) * 1e7, 1e3);
    p.is_adaptive = true;
    check_close(render_left(&p).ns, (24 - 12) * 1e7, 1e3);
}

static void unknown_errors_have_no_time(void **state)
{
    const struct render_trend none = {.count = 0};
    const struct simulation s = {.p = 1, .first_error = 0.5};
    struct render_progress p = at(&s, 100, none);
    double ns;

    (void)state;
    p.error_limit = 0.01;
    p.film_error.is_resolved = false;
    assert_int_equal(render_left(&p).limit, RENDER_LIMIT_NONE);
    p.film_error = (struct film_error){0};
    assert_int_equal(render_left(&p).limit, RENDER_LIMIT_NONE);
    p.samples_limit = 200 * PIXELS;
    assert_int_equal(render_left(&p).limit, RENDER_LIMIT_SPP);
    p = (struct render_progress){.samples_limit = 7, .error_limit = 0.1};
    assert_int_equal(render_left(&p).limit, RENDER_LIMIT_NONE);
    assert_false(render_left_to_error(&p, 0.01, &ns));
    /* reached, though unresolved */
    p.stopped_by = RENDER_LIMIT_ERROR;
    p.film_error = (struct film_error){.is_known = true};
    assert_int_equal(render_left(&p).limit, RENDER_LIMIT_ERROR);
    assert_true(render_left(&p).part == 1 && render_left(&p).ns == 0);
    /* errors that no time reaches */
    p = at(&s, 100, none);
    assert_true(render_left_to_error(&p, 1e-300, &ns) && ns > 1e18);
    assert_true(render_left_to_error(&p, 1, &ns) && ns == 0);
}

/* ---- text ---- */

static const char *percent(double error)
{
    static char text[ERROR_TEXT_BYTES];

    error_text_percent(text, error);
    return text;
}

static void errors_have_two_digits(void **state)
{
    (void)state;
    assert_string_equal(percent(0), "0 %");
    assert_string_equal(percent(0.0098), "0.98 %");
    assert_string_equal(percent(0.00994), "0.99 %");
    assert_string_equal(percent(0.00996), "1.0 %");
    assert_string_equal(percent(0.023), "2.3 %");
    assert_string_equal(percent(0.0994), "9.9 %");
    assert_string_equal(percent(0.0996), "10 %");
    assert_string_equal(percent(1.2), "120 %");
    assert_string_equal(percent(0.0000123), "0.0012 %");
    assert_string_equal(percent(1e9), "over 9999 %");
    assert_string_equal(percent(INFINITY), "over 9999 %");
    assert_string_equal(percent(1e-30), "0.000000 %");
}

static void texts_say_what_is_known(void **state)
{
    struct film_error e = {true, true, 0.0098, 0.0097, 0.00994};
    char text[ERROR_TEXT_BYTES];

    (void)state;
    error_text_interval(text, &e);
    assert_string_equal(text, "0.98 % (0.97 to 0.99 %)");
    error_text_noise(text, &e);
    assert_string_equal(text, "noise 0.98 %");
    e.is_resolved = false;
    error_text_interval(text, &e);
    assert_string_equal(text, "0.98 % (0.97 to 0.99 %), mostly in few pixels");
    error_text_noise(text, &e);
    assert_string_equal(text, "noise 0.98 %, mostly in few pixels");
    e = (struct film_error){true, false, 1e30, 1e30, 1e30};
    error_text_interval(text, &e);
    assert_string_equal(
        text, "over 9999 % (over 9999 to over 9999 %), mostly in few pixels");
    e.is_known = false;
    error_text_interval(text, &e);
    assert_string_equal(text, "unknown");
    error_text_noise(text, &e);
    assert_string_equal(text, "noise unknown");
}

static void targets_are_round(void **state)
{
    (void)state;
    check_close(error_text_target(5), 0.1, 1e-12);
    check_close(error_text_target(0.2), 0.1, 1e-12);
    check_close(error_text_target(0.19), 0.05, 1e-12);
    check_close(error_text_target(0.099), 0.02, 1e-12);
    check_close(error_text_target(0.023), 0.01, 1e-12);
    check_close(error_text_target(0.019), 0.005, 1e-12);
    check_close(error_text_target(0.0099), 0.002, 1e-12);
    check_close(error_text_target(0.0021), 0.001, 1e-12);
    assert_true(error_text_target(0) > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(time_to_an_error_is_right_from_a_tenth_on),
        cmocka_unit_test(time_to_an_error_is_right_with_adaptive_samples),
        cmocka_unit_test(time_to_an_error_is_right_after_rare_light),
        cmocka_unit_test(time_to_samples_is_at_late_speed),
        cmocka_unit_test(exponents_are_fitted),
        cmocka_unit_test(wide_intervals_become_narrow),
        cmocka_unit_test(speed_is_that_of_late),
        cmocka_unit_test(the_nearest_limit_counts),
        cmocka_unit_test(errors_are_known_at_the_ends_of_passes),
        cmocka_unit_test(unknown_errors_have_no_time),
        cmocka_unit_test(errors_have_two_digits),
        cmocka_unit_test(texts_say_what_is_known),
        cmocka_unit_test(targets_are_round),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
