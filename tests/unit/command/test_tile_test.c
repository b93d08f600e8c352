// SPDX-License-Identifier: MIT
/*
 * test_tile_test.c - false alarms at the stated rate for several kinds of
 * noise, and differences that must be found
 */
#include <math.h>

#include "tests/unit/check.h"

#include "command/difference.h"

enum { SIDE = 64, TILES = 4, VALUES = 3 * SIDE * SIDE };

/* Noise with mean 0 and a standard deviation of about 1. */
enum noise { NOISE_NORMAL, NOISE_EXPONENTIAL, NOISE_LOGNORMAL, NOISE_SPIKES };

static double normal(uint64_t *random)
{
    double r = sqrt(-2 * log(1 - check_random(random)));

    return r * cos(6.28318530717958648 * check_random(random));
}

static double noise_of(enum noise kind, uint64_t *random)
{
    switch (kind) {
    case NOISE_EXPONENTIAL: return -log(1 - check_random(random)) - 1;
    case NOISE_LOGNORMAL: return exp(normal(random)) - exp(0.5);
    case NOISE_SPIKES: return check_random(random) < 0.02 ? 6.86 : -0.14;
    case NOISE_NORMAL: break;
    }
    return normal(random);
}

static float pictures[2][VALUES];

/* Fills a picture of radiance 1 with noise that grows from left to right. */
static void fill(float *rgb, enum noise kind, double size, uint64_t *random)
{
    for (int i = 0; i < VALUES; i++)
        rgb[i] = (float)(1 + size * (1 + i / 3 % SIDE / (double)SIDE) *
                                 noise_of(kind, random));
}

static int differing(double false_alarms)
{
    struct picture_pair pair = {SIDE, SIDE, pictures[0], pictures[1]};
    struct tile_test test;
    struct error err;
    int count;

    assert_true(tile_test_init(&test, &pair, 16, false_alarms, &err));
    assert_int_equal(test.cols * test.rows, TILES * TILES);
    count = test.differing + test.whole.differs;
    tile_test_free(&test);
    return count;
}

/* Returns how many of `tries` comparisons of noise alone mark a tile. */
static int alarms_of(enum noise a, enum noise b, double size_b, int tries,
                     double rate)
{
    uint64_t random = 7;
    int alarms = 0;

    for (int i = 0; i < tries; i++) {
        fill(pictures[0], a, 0.1, &random);
        fill(pictures[1], b, size_b, &random);
        alarms += differing(rate) > 0;
    }
    return alarms;
}

/* 50 of 1,000 may be marked; more than 75 have a probability of 3e-4. */
static void two_noisy_pictures_do_not_differ(void **state)
{
    (void)state;
    check_at_most(alarms_of(NOISE_NORMAL, NOISE_NORMAL, 0.1, 1000, 0.05), 75);
}

/* A noisy picture against a clean reference: skewed noise, as that of light,
 * has the most false alarms. */
static void skewed_noise_makes_no_more_alarms(void **state)
{
    (void)state;
    check_at_most(alarms_of(NOISE_EXPONENTIAL, NOISE_NORMAL, 0, 300, 0.05), 27);
    check_at_most(alarms_of(NOISE_LOGNORMAL, NOISE_NORMAL, 0, 300, 0.05), 27);
    check_at_most(alarms_of(NOISE_SPIKES, NOISE_NORMAL, 0, 300, 0.05), 27);
    check_at_most(alarms_of(NOISE_LOGNORMAL, NOISE_SPIKES, 0.1, 300, 0.05), 27);
}

/* One tile of 16 is 1 % brighter in green. The noise of 2.3 % in each picture
 * gives its mean of 256 pixels a standard error of 0.2 %, so t is about 5 where
 * the bound for 48 tests at 1 % is 3.8. */
static void one_per_cent_in_one_tile_is_found(void **state)
{
    struct picture_pair pair = {SIDE, SIDE, pictures[0], pictures[1]};
    const struct tile *t;
    struct tile_test test;
    struct error err;
    uint64_t random = 3;
    int found = 0;

    (void)state;
    for (int i = 0; i < 100; i++) {
        fill(pictures[0], NOISE_NORMAL, 0.02, &random);
        fill(pictures[1], NOISE_NORMAL, 0.02, &random);
        for (int y = 32; y < 48; y++)
            for (int x = 0; x < 16; x++)
                pictures[0][3 * (y * SIDE + x) + 1] += 0.01f;
        assert_true(tile_test_init(&test, &pair, 16, 0.01, &err));
        t = &test.tiles[2 * TILES];
        if (t->differs && t->channel == 1 && t->y == 32 && t->x == 0) {
            found++;
            check_close(t->difference, 0.01, 0.01);
            check_close(t->reference, 1, 0.01);
        }
        tile_test_free(&test);
    }
    /* t has to fall short of its mean by 1.2 or more: about one in nine */
    check_at_most(100 - found, 25);
}

/* A shift of 0.4 % everywhere is 1.5 standard errors of a tile's mean and 6 of
 * the picture's. */
static void a_small_shift_of_the_mean_is_found(void **state)
{
    struct picture_pair pair = {SIDE, SIDE, pictures[0], pictures[1]};
    struct tile_test test;
    struct error err;
    uint64_t random = 4;

    (void)state;
    fill(pictures[0], NOISE_NORMAL, 0.02, &random);
    fill(pictures[1], NOISE_NORMAL, 0.02, &random);
    for (int i = 2; i < VALUES; i += 3)
        pictures[0][i] -= 0.004f;
    assert_true(tile_test_init(&test, &pair, 16, 0.01, &err));
    assert_true(test.whole.differs && test.whole.channel == 2);
    check_close(test.whole.difference, -0.004, 0.0015);
    tile_test_free(&test);
}

/* Without noise any difference counts, and none is none. */
static void a_constant_shift_is_found(void **state)
{
    (void)state;
    for (int i = 0; i < VALUES; i++)
        pictures[0][i] = pictures[1][i] = 1;
    assert_int_equal(differing(0.01), 0);
    for (int i = 0; i < VALUES; i++)
        pictures[0][i] = 1.001f;
    assert_int_equal(differing(0.01), TILES * TILES + 1);
}

/* Tiles cover every pixel once, whatever the size. */
static void tiles_cover_the_picture(void **state)
{
    static const int sides[][2] = {{1, 1},  {1, 64},  {7, 9},
                                   {17, 8}, {64, 50}, {100, 33}};
    static float a[3 * 100 * 64], b[3 * 100 * 64];
    struct tile_test test;
    struct error err;

    (void)state;
    for (int i = 0; i < 6; i++) {
        struct picture_pair pair = {sides[i][0], sides[i][1], a, b};
        int pixels = 0;

        assert_true(tile_test_init(&test, &pair, 5, 0.01, &err));
        assert_true(test.cols <= 5 && test.rows <= 5);
        for (int k = 0; k < test.cols * test.rows; k++) {
            const struct tile *t = &test.tiles[k];

            assert_true(t->x + t->width <= sides[i][0]);
            assert_true(t->y + t->height <= sides[i][1]);
            pixels += t->width * t->height;
        }
        assert_int_equal(pixels, sides[i][0] * sides[i][1]);
        tile_test_free(&test);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_noisy_pictures_do_not_differ),
        cmocka_unit_test(skewed_noise_makes_no_more_alarms),
        cmocka_unit_test(one_per_cent_in_one_tile_is_found),
        cmocka_unit_test(a_small_shift_of_the_mean_is_found),
        cmocka_unit_test(a_constant_shift_is_found),
        cmocka_unit_test(tiles_cover_the_picture),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
