// SPDX-License-Identifier: MIT
/*
 * test_replicates.c - the mean of pictures, and how often the interval of its
 * error contains its true error
 */
#include <math.h>

#include "tests/unit/check.h"
#include "tests/unit/noise.h"

#include "command/difference.h"
#include "command/replicates.h"

enum { SIDE = 30, VALUES = 3 * SIDE * SIDE, TRIES = 300 };

static float truth[VALUES];

static void four_pixels_by_hand(void **state)
{
    struct replicates r;
    struct mean_error e;
    struct error err;
    double relmse = 0;

    (void)state;
    assert_true(replicates_init(&r, 1, 1, 4, &err));
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 3; c++)
            r.rgb[i][c] = (float)(i * (c + 1)); /* 0 1 2 3, 0 2 4 6, 0 3 6 9 */
    r.count = 4;
    check_close(replicates_mean(&r, &e)[1], 3, 1e-6);
    check_close(e.mean, 3, 1e-6);
    /* squares of distances from the mean: 5, 20, 45, over 4 x 3; those of both
     * halves: 0.5, 2, 4.5, over 4 */
    check_close(e.mse, (5 + 20 + 45) / 12.0 / 3, 1e-6);
    for (int c = 1; c <= 3; c++) {
        double v = c * c * 5.0 / 12, half = c * c * 0.5 / 4;
        double mean = 1.5 * c, w = mean * mean + 0.01;
        /* the second derivative of 1 / (x^2 + 0.01) by differences */
        double h = 1e-4;
        double above = 1 / ((mean + h) * (mean + h) + 0.01);
        double below = 1 / ((mean - h) * (mean - h) + 0.01);
        double second = (above - 2 / w + below) / (h * h);

        relmse += (v / w + half * half * second) / 3;
    }
    check_close(e.relmse, relmse, 1e-6);
    assert_true(e.relmse_low < e.relmse && e.relmse < e.relmse_high);
    replicates_free(&r);
}

/* Noise that is far above the radiance leaves an error and an interval. */
static void dark_pictures_have_an_error(void **state)
{
    struct replicates r;
    struct mean_error e;
    struct error err;

    (void)state;
    assert_true(replicates_init(&r, 1, 1, 4, &err));
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 3; c++)
            r.rgb[i][c] = i % 2 == 0 ? 0.5f : -0.5f;
    r.count = 4;
    replicates_mean(&r, &e);
    assert_true(e.relmse > 0 && e.relmse_low > 0);
    assert_true(e.relmse_low < e.relmse && e.relmse < e.relmse_high);
    replicates_free(&r);
}

static void equal_pictures_have_no_error(void **state)
{
    struct replicates r;
    struct mean_error e;
    struct error err;

    (void)state;
    assert_true(replicates_init(&r, 5, 4, 5, &err));
    for (int i = 0; i < 5; i++)
        for (int k = 0; k < 60; k++)
            r.rgb[i][k] = 0.5f;
    r.count = 5;
    replicates_mean(&r, &e);
    check_close(e.mse, 0, 0);
    check_close(e.relmse, 0, 0);
    check_close(e.relmse_high, 0, 0);
    replicates_free(&r);
}

/* Adds noise that is the same in all channels of a pixel, as that of light. The
 * true error is relative to the mean, as it is where the mean is the reference.
 * Returns in how many tries the true error of the mean is in the interval. */
static int inside(int count, double spread)
{
    uint64_t random = 21;
    int found = 0;

    for (int t = 0; t < TRIES; t++) {
        struct picture_pair pair = {SIDE, SIDE, truth, NULL};
        struct replicates r;
        struct mean_error e;
        struct error err;
        double relmse;

        assert_true(replicates_init(&r, SIDE, SIDE, count, &err));
        for (int i = 0; i < count; i++)
            for (int k = 0; k < VALUES; k += 3) {
                double factor = 1 + 0.05 * noise(spread, &random);

                for (int c = k; c < k + 3; c++)
                    r.rgb[i][c] = (float)((double)truth[c] * factor);
            }
        r.count = count;
        pair.reference = replicates_mean(&r, &e);
        relmse = picture_error_of(&pair).relmse;
        found += e.relmse_low <= relmse && relmse <= e.relmse_high;
        replicates_free(&r);
    }
    return found;
}

/* 92 to 98 % of 300. */
static void interval_contains_the_true_error(void **state)
{
    static const double spreads[] = {0, 0.5, 1};

    (void)state;
    for (int k = 0; k < VALUES; k++)
        truth[k] = (float)(0.1 + (double)(k % 97) / 50);
    for (int i = 0; i < 3; i++)
        for (int count = 4; count <= 8; count += 4) {
            int found = inside(count, spreads[i]);

            printf("%d pictures, spread %g: %d of %d\n", count, spreads[i],
                   found, TRIES);
            check_at_most(found, 0.98 * TRIES);
            check_at_most(0.92 * TRIES, found);
        }
}

static void pictures_beyond_the_memory_are_refused(void **state)
{
    struct replicates r;
    struct error err;

    (void)state;
    assert_false(replicates_init(&r, 65536, 65536, 64, &err));
    check_has(err.text, "64 pictures of 65536x65536 pixels need");
    replicates_free(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(four_pixels_by_hand),
        cmocka_unit_test(dark_pictures_have_an_error),
        cmocka_unit_test(equal_pictures_have_no_error),
        cmocka_unit_test(interval_contains_the_true_error),
        cmocka_unit_test(pictures_beyond_the_memory_are_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
