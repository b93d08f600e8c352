// SPDX-License-Identifier: MIT
/*
 * test_film_error.c - the stated error against films of known noise
 */
#include <math.h>
#include <stdlib.h>

#include "film/film_error.h"
#include "tests/unit/check.h"

#define SIDE   70 /* no multiple of the tiles' side */
#define PIXELS (SIDE * SIDE)

static uint64_t state_of_random = 1;

/* A sample of mean `mean`: with chance `chance` the light is mean / chance. Its
 * variance is mean^2 (1 / chance - 1). */
static float rare(double mean, double chance)
{
    return check_random(&state_of_random) < chance ? (float)(mean / chance)
                                                   : 0.0f;
}

struct noise {
    double mean, chance;
    int side; /* of the square with noise, which others lack; 0: the film */
};

static void fill(struct film *film, const struct noise *n, int spp)
{
    struct path_sample *samples = calloc((size_t)(SIDE * spp), sizeof *samples);
    int counts[SIDE];

    assert_non_null(samples);
    film_clear(film);
    for (int y = 0; y < SIDE; y++) {
        for (int i = 0; i < SIDE * spp; i++) {
            int place = i / spp > y ? i / spp : y;
            double chance = n->side > 0 && place >= n->side ? 1 : n->chance;

            samples[i].radiance =
                v3(rare(n->mean, chance), rare(n->mean, chance),
                   rare(n->mean, chance));
        }
        for (int x = 0; x < SIDE; x++)
            counts[x] = spp;
        film_add_row(film, (struct film_pixels){0, y, 1, SIDE}, samples, NULL,
                     counts);
    }
    free(samples);
}

static struct film_error error_by(struct film *film, float exposure,
                                  struct pool *pool,
                                  const struct cancel *cancel)
{
    struct film_error e;
    struct error err;

    assert_true(film_error(film, exposure, pool, cancel, &e, &err));
    return e;
}

static struct film_error error_of(struct film *film, float exposure)
{
    return error_by(film, exposure, NULL, NULL);
}

/* The error of the picture itself, whose truth is the same everywhere. */
static double true_error(struct film *film, double mean, double exposure)
{
    static float rgb[3 * PIXELS];
    double sum = 0;

    film_linear(film, rgb);
    for (int i = 0; i < 3 * PIXELS; i++)
        sum += pow((double)rgb[i] - mean, 2);
    return sqrt(sum / (3 * PIXELS) /
                (mean * mean + 0.01 * exp2(-2 * exposure)));
}

static void make(struct film *film)
{
    struct error err;

    assert_true(film_init(film, SIDE, SIDE, &err));
}

/* The error is the standard deviation of the mean, for even and odd numbers of
 * samples. 14,700 channels of chance 1/2 make it exact to 1 %. */
static void the_error_is_that_of_the_noise(void **state)
{
    const int spp[] = {2, 3, 4, 7, 16, 31};
    struct film film;

    (void)state;
    make(&film);
    for (int i = 0; i < 6; i++) {
        struct film_error e;

        fill(&film, &(struct noise){1, 0.5, 0}, spp[i]);
        e = error_of(&film, 0);
        assert_true(e.is_known && e.is_resolved);
        check_close(e.error, 1 / sqrt(spp[i] * 1.01), 0.03 * e.error);
        assert_true(e.low < e.error && e.error < e.high);
    }
    film_free(&film);
}

/* The interval contains the error of the very picture in 92 to 98 % of 1,000
 * pictures, by day of 500, also where most samples are black, and where few
 * pixels have noise. The standard error of the share is 0.7 %, by day 1 %. */
static void intervals_are_calibrated(void **state)
{
    const struct noise noises[] = {{1, 0.5, 0},
                                   {0.2, 0.1, 0},
                                   {5, 0.02, 0},
                                   {1, 0.03, 8}};
    const int spp[] = {4, 16, 64, 16};
    const int pictures = check_is_thorough() ? 1000 : 500;
    struct film film;

    (void)state;
    make(&film);
    for (int i = 0; i < 4; i++) {
        int inside = 0;

        if (!check_is_due(2))
            continue;
        for (int k = 0; k < pictures; k++) {
            struct film_error e;
            double truth;

            fill(&film, &noises[i], spp[i]);
            e = error_of(&film, 0);
            truth = true_error(&film, noises[i].mean, 0);
            inside += e.low <= truth && truth <= e.high;
        }
        print_message("%d of %d inside\n", inside, pictures);
        assert_true(inside >= 0.92 * pictures && inside <= 0.98 * pictures);
    }
    film_free(&film);
}

/* Light and exposure may be scaled together. Nearly black pictures have no
 * error to speak of. */
static void the_error_is_relative_to_white(void **state)
{
    struct film film;
    double error;

    (void)state;
    make(&film);
    state_of_random = 7;
    fill(&film, &(struct noise){0.25, 0.5, 0}, 8);
    error = error_of(&film, 0).error;
    state_of_random = 7;
    fill(&film, &(struct noise){256, 0.5, 0}, 8);
    check_close(error_of(&film, -10).error, error, 1e-6 * error);
    assert_true(error_of(&film, 0).error > error);
    fill(&film, &(struct noise){1e-6, 0.5, 0}, 8);
    check_at_most(error_of(&film, 0).error, 1e-5);
    film_free(&film);
}

/* Without a sample in each half of each pixel the error is unknown. */
static void one_sample_says_nothing(void **state)
{
    struct film film;
    struct film_error e;
    static float map[PIXELS];

    (void)state;
    make(&film);
    assert_false(error_of(&film, 0).is_known);
    fill(&film, &(struct noise){1, 0.5, 0}, 1);
    e = error_of(&film, 0);
    assert_false(e.is_known || film_error_map(&film, 0, NULL, map));
    fill(&film, &(struct noise){1, 0.5, 0}, 2);
    assert_true(error_of(&film, 0).is_known);
    film_clear(&film);
    assert_false(error_of(&film, 0).is_known);
    film_free(&film);
}

/* A few pixels with nearly all of the error make it unresolved. */
static void fireflies_are_unresolved(void **state)
{
    struct path_sample flash = {.radiance = {1e4f, 1e4f, 1e4f}};
    struct film film;

    (void)state;
    make(&film);
    fill(&film, &(struct noise){1, 0.5, 0}, 16);
    film_add_row(&film, (struct film_pixels){30, 31, 1, 1}, &flash, NULL,
                 (const int[]){1});
    assert_false(error_of(&film, 0).is_resolved);
    film_free(&film);
}

/* Of pixels with equal errors, the largest thousandth, five of 4,900, has half
 * of the error if there are ten. */
static void half_of_the_error_in_a_thousandth_is_unresolved(void **state)
{
    struct path_sample flash = {.radiance = {2, 2, 2}};
    struct film film;

    (void)state;
    make(&film);
    for (int count = 9; count <= 11; count += 2) {
        fill(&film, &(struct noise){1, 1, 0}, 16);
        for (int i = 0; i < count; i++)
            film_add_row(&film, (struct film_pixels){5 + 6 * i, 31, 1, 1},
                         &flash, NULL, (const int[]){1});
        assert_int_equal(error_of(&film, 0).is_resolved, count > 10);
    }
    film_free(&film);
}

/* Maps show where the noise is, and their root mean square is the error. */
static void maps_show_where_the_noise_is(void **state)
{
    struct path_sample samples[16 * SIDE];
    static float map[PIXELS];
    int counts[SIDE];
    struct film film;
    double sum = 0;

    (void)state;
    make(&film);
    for (int y = 0; y < SIDE; y++) {
        for (int i = 0; i < 16 * SIDE; i++) {
            float x = i / 16 < SIDE / 2 ? 1.0f : rare(1, 0.5);

            samples[i].radiance = v3(x, x, x);
        }
        for (int x = 0; x < SIDE; x++)
            counts[x] = 16;
        film_add_row(&film, (struct film_pixels){0, y, 1, SIDE}, samples, NULL,
                     counts);
    }
    assert_true(film_error_map(&film, 0, NULL, map));
    for (int i = 0; i < PIXELS; i++) {
        int x = i % SIDE;

        if (x < SIDE / 2 - 2)
            assert_true(map[i] == 0);
        if (x > SIDE / 2 + 2)
            sum += (double)map[i] * (double)map[i];
    }
    check_close(sqrt(sum / (SIDE * (SIDE / 2 - 3))), 0.25, 0.02);
    film_free(&film);
}

static void assert_has_numbers(struct film *film, float exposure)
{
    struct film_error e = error_of(film, exposure);
    float map[64];

    assert_true(e.is_known && isfinite(e.error) && isfinite(e.high));
    assert_true(e.low >= 0 && e.low <= e.error && e.error <= e.high);
    assert_true(film_error_map(film, exposure, NULL, map));
    for (int k = 0; k < film->width * film->height; k++)
        assert_true(isfinite(map[k]));
}

/* Small ones, black channels, light near the largest float in one half only,
 * and extreme exposures. */
static void odd_pictures_have_numbers(void **state)
{
    const int sides[][2] = {{1, 1}, {1, 5}, {33, 1}, {3, 2}};

    (void)state;
    for (int i = 0; i < 4; i++) {
        struct path_sample samples[4] = {{.radiance = {1, 0, 1e30f}},
                                         {.radiance = {0, 0, 0}},
                                         {.radiance = {1, 0, 1e30f}},
                                         {.radiance = {1, 0, 1}}};
        struct film film;
        struct error err;

        assert_true(film_init(&film, sides[i][0], sides[i][1], &err));
        for (int pass = 0; pass < 2; pass++) {
            for (int y = 0; y < sides[i][1]; y++)
                for (int x = 0; x < sides[i][0]; x++)
                    film_add_row(&film, (struct film_pixels){x, y, 1, 1},
                                 samples, NULL, (const int[]){4});
            for (int exposure = -100; exposure <= 100; exposure += 50)
                assert_has_numbers(&film, (float)exposure);
            samples[0].radiance = v3(3e38f, 3e38f, 3e38f);
            samples[2].radiance = v3(3e38f, 3e38f, 3e38f);
        }
        film_free(&film);
    }
}

/* Films from files can have halves that cancel each other. */
static void halves_of_unequal_signs_have_numbers(void **state)
{
    struct film film;
    struct error err;

    (void)state;
    assert_true(film_init(&film, 3, 2, &err));
    for (int i = 0; i < 6; i++) {
        film.counts[i] = 2;
        for (int c = 0; c < 3; c++)
            film.odd_sums[3 * i + c].hi = UINT64_C(1) << 62;
    }
    assert_has_numbers(&film, 0);
    film_free(&film);
}

static void assert_same_error(struct film_error a, struct film_error b)
{
    assert_true(a.is_known == b.is_known && a.is_resolved == b.is_resolved);
    assert_true(a.error == b.error && a.low == b.low && a.high == b.high);
}

/* Threads change nothing, and an error that was cancelled is unknown. */
static void threads_give_the_same_bits(void **state)
{
    struct cancel cancel = {0};
    static float alone[PIXELS], map[PIXELS];
    struct film_error error;
    struct film film;
    struct error err;

    (void)state;
    make(&film);
    fill(&film, &(struct noise){1, 0.5, 0}, 4);
    error = error_of(&film, 0);
    assert_true(film_error_map(&film, 0, NULL, alone));
    for (int threads = 1; threads <= 4; threads++) {
        struct pool *pool = pool_create(threads, &err);

        assert_non_null(pool);
        assert_same_error(error_by(&film, 0, pool, &cancel), error);
        assert_true(film_error_map(&film, 0, pool, map));
        assert_memory_equal(map, alone, sizeof map);
        cancel_request(&cancel);
        assert_false(error_by(&film, 0, pool, &cancel).is_known);
        cancel_reset(&cancel);
        pool_destroy(pool);
    }
    film_free(&film);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_error_is_that_of_the_noise),
        cmocka_unit_test(intervals_are_calibrated),
        cmocka_unit_test(the_error_is_relative_to_white),
        cmocka_unit_test(one_sample_says_nothing),
        cmocka_unit_test(fireflies_are_unresolved),
        cmocka_unit_test(half_of_the_error_in_a_thousandth_is_unresolved),
        cmocka_unit_test(maps_show_where_the_noise_is),
        cmocka_unit_test(odd_pictures_have_numbers),
        cmocka_unit_test(halves_of_unequal_signs_have_numbers),
        cmocka_unit_test(threads_give_the_same_bits),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
