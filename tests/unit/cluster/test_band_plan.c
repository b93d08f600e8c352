// SPDX-License-Identifier: MIT
/*
 * test_band_plan.c - bands of a pass: each pixel gets each sample once, many
 * ranks have work, and bands become smaller
 */
#include "tests/unit/check.h"

#include <string.h>

#include "render/cluster/band.h"

#define WIDTH 5

static struct film make_film(int height, uint64_t count)
{
    struct film f;
    struct error err;

    assert_true(film_init(&f, WIDTH, height, &err));
    for (int i = 0; i < WIDTH * height; i++)
        f.counts[i] = count;
    return f;
}

static struct pass pass_from(uint64_t done, uint64_t target,
                             const uint16_t *shares)
{
    uint64_t most = target - done;

    if (shares != NULL)
        most = (most * SHARE_MAX + SHARE_ONE - 1) / SHARE_ONE;
    return (struct pass){.stride = 1,
                         .target = target,
                         .shares = shares,
                         .samples = (uint32_t)most};
}

/* Adds the samples of a band, which follow those that the pixels have. */
static void add_band(struct film *f, const struct band_range *r)
{
    size_t at = (size_t)r->y * WIDTH, end = at + (size_t)r->rows * WIDTH;

    assert_true(band_plan_is_next(f, r));
    for (; at < end; at++) {
        uint64_t before = band_plan_before(f, r, at);
        uint64_t target = pass_target(&r->pass, at);

        assert_int_equal(before, f->counts[at]);
        if (target > before) {
            assert_in_range(target - before, 1, r->pass.samples);
            f->counts[at] = target;
        }
    }
}

static void all_samples_are_in_bands(void **state)
{
    static uint16_t shares[WIDTH * 100];
    uint64_t seed = 3;

    (void)state;
    for (int i = 0; i < WIDTH * 100; i++)
        shares[i] = (uint16_t)(512 + check_random(&seed) * 9728);
    for (int i = 0; i < 400; i++) {
        int height = 1 + (int)(check_random(&seed) * 99);
        int ranks = 2 + (int)(check_random(&seed) * 60);
        int most = 1 + (int)(check_random(&seed) * 30);
        uint64_t done = 16 + (uint64_t)(check_random(&seed) * 50);
        uint64_t target = done + 1 + (uint64_t)(check_random(&seed) * 900);
        struct pass pass = pass_from(done, target, i % 2 ? shares : NULL);
        struct pass before = pass_from(0, done, i % 2 ? shares : NULL);
        struct film f = make_film(height, 0);
        struct band_plan plan;
        struct band_range range;

        for (size_t at = 0; at < (size_t)height * WIDTH; at++)
            f.counts[at] = pass_target(&before, at);
        plan = band_plan_begin(&f, &pass, ranks, most);
        while (band_plan_next(&plan, &range)) {
            assert_int_equal(range.y % BAND_ROWS, 0);
            assert_in_range(range.rows, 1, most + BAND_ROWS);
            add_band(&f, &range);
        }
        assert_true(band_plan_is_empty(&plan));
        for (size_t at = 0; at < (size_t)height * WIDTH; at++)
            assert_int_equal(f.counts[at], pass_target(&pass, at));
        film_free(&f);
    }
}

/* Rows that have their samples are in no band. */
static void rows_of_a_halted_pass_are_skipped(void **state)
{
    struct film f = make_film(64, 8);
    struct pass pass = pass_from(8, 16, NULL);
    struct band_plan plan;
    struct band_range range;

    (void)state;
    for (int at = 0; at < 24 * WIDTH; at++)
        f.counts[at] = 16;
    plan = band_plan_begin(&f, &pass, 2, 64);
    assert_true(band_plan_next(&plan, &range));
    assert_int_equal(range.y, 24);
    film_free(&f);
}

/* A halt between two slices leaves no pixel with a gap in its samples. */
static void later_slices_wait(void **state)
{
    struct film f = make_film(2, 8);
    struct pass pass = pass_from(8, 40, NULL);
    struct band_plan plan = band_plan_begin(&f, &pass, 4, 8);
    struct band_range first, second;

    (void)state;
    assert_true(band_plan_next(&plan, &first));
    assert_true(band_plan_next(&plan, &second));
    assert_int_equal(first.pass.target, 16);
    assert_int_equal(second.first, 16);
    assert_true(band_plan_is_next(&f, &first));
    assert_false(band_plan_is_next(&f, &second));
    add_band(&f, &first);
    assert_true(band_plan_is_next(&f, &second));
    film_free(&f);
}

static void bands_become_smaller_and_suffice(void **state)
{
    (void)state;
    for (int ranks = 2; ranks <= 128; ranks *= 2) {
        struct film f = make_film(1080, 64);
        struct pass pass = pass_from(64, 128, NULL);
        struct band_plan plan = band_plan_begin(&f, &pass, ranks, 1080);
        struct band_range range, first;
        int count = 1;

        assert_true(band_plan_next(&plan, &first));
        for (; band_plan_next(&plan, &range); count++)
            assert_true(range.rows <= first.rows);
        assert_true(count >= 4 * ranks);
        assert_true(range.rows <= BAND_ROWS);
        film_free(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_samples_are_in_bands),
        cmocka_unit_test(rows_of_a_halted_pass_are_skipped),
        cmocka_unit_test(later_slices_wait),
        cmocka_unit_test(bands_become_smaller_and_suffice),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
