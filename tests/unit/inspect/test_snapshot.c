// SPDX-License-Identifier: MIT
/*
 * test_snapshot.c - a kept render is painted as the film was; differences of
 * noise are not marked, differences of light are
 */
#include <math.h>

#include "studio/comparison.h"
#include "tests/unit/check.h"

#define WIDTH  128
#define HEIGHT 64
#define SPP    16

/* The part of the picture that becomes brighter. */
#define IS_CHANGED(x, y) ((x) >= 32 && (x) < 64 && (y) >= 16 && (y) < 48)

static double light_of(int x, int y)
{
    return 0.2 + 0.5 * x / WIDTH + 0.2 * y / HEIGHT;
}

/* Fills a film with samples of exponential noise around the light. */
static void fill(struct film *film, uint64_t seed, double change)
{
    struct error err;

    assert_true(film_init(film, WIDTH, HEIGHT, &err));
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            struct path_sample samples[SPP];
            double mean = light_of(x, y);
            int count = SPP;

            if (IS_CHANGED(x, y))
                mean *= 1 + change;
            for (int i = 0; i < SPP; i++) {
                float v = (float)(-mean * log(1 - check_random(&seed)));

                samples[i] = (struct path_sample){.radiance = {v, v, v}};
            }
            film_add_row(film, (struct film_pixels){x, y, 1, 1}, samples, NULL,
                         &count);
        }
    }
}

static int count_marked(const struct snapshot_blocks *b, bool is_changed)
{
    int count = 0;

    for (int i = 0; i < b->cols * b->rows; i++) {
        int x = (2 * (i % b->cols) + 1) * WIDTH / (2 * b->cols);
        int y = (2 * (i / b->cols) + 1) * HEIGHT / (2 * b->rows);

        count += b->blocks[i].is_significant && IS_CHANGED(x, y) == is_changed;
    }
    return count;
}

static void noise_is_not_marked(void **state)
{
    int marked = 0;

    (void)state;
    for (uint64_t seed = 0; seed < 40; seed++) {
        struct snapshot_blocks blocks = {.blocks = NULL};
        struct snapshot kept;
        struct film before, now;
        struct error err;

        fill(&before, 2 * seed + 1, 0);
        fill(&now, 2 * seed + 2, 0);
        assert_true(snapshot_take(&kept, &before, &err));
        assert_true(
            snapshot_differences(&kept, &now, 1000, 1000, &blocks, &err));
        assert_int_equal(blocks.cols, WIDTH / 8);
        assert_int_equal(blocks.rows, HEIGHT / 8);
        marked += blocks.significant_count > 0;
        snapshot_blocks_free(&blocks);
        snapshot_free(&kept);
        film_free(&before);
        film_free(&now);
    }
    /* .05 of 40 are expected; 8 would be 4 standard deviations more */
    assert_in_range(marked, 0, 7);
}

static void light_is_marked(void **state)
{
    struct snapshot_blocks blocks = {.blocks = NULL};
    struct snapshot kept;
    struct film before, now;
    struct error err;

    (void)state;
    fill(&before, 71, 0);
    fill(&now, 72, 0.4);
    assert_true(snapshot_take(&kept, &before, &err));
    assert_true(snapshot_differences(&kept, &now, 1000, 1000, &blocks, &err));
    /* a block's mean has a relative error of 1/32, times the root of 2 */
    assert_in_range(count_marked(&blocks, true), 15, 16);
    assert_int_equal(count_marked(&blocks, false), 0);
    assert_false(blocks.is_unknown);
    for (int i = 0; i < blocks.cols * blocks.rows; i++)
        if (blocks.blocks[i].is_significant)
            check_close((double)blocks.blocks[i].difference, 0.4 / 1.2, 0.2);
    snapshot_blocks_free(&blocks);
    snapshot_free(&kept);
    film_free(&before);
    film_free(&now);
}

static void paintings_are_previews(void **state)
{
    static const struct develop ways[] = {{0, TONE_LINEAR},
                                          {1.5f, TONE_LINEAR},
                                          {0, TONE_ACES},
                                          {-1, TONE_REINHARD}};
    static const int sizes[][2] = {{128, 64}, {37, 20}, {1, 1}, {64, 64}};
    struct snapshot kept;
    struct film film;
    struct error err;

    (void)state;
    fill(&film, 5, 0);
    assert_true(snapshot_take(&kept, &film, &err));
    for (size_t i = 0; i < 4; i++) {
        for (size_t k = 0; k < 4; k++) {
            struct frame want, got;

            assert_true(frame_init(&want, sizes[k][0], sizes[k][1], &err));
            assert_true(frame_init(&got, sizes[k][0], sizes[k][1], &err));
            film_preview(&film, NULL, ways[i], &want);
            snapshot_paint(&kept, ways[i], &got);
            for (int at = 0; at < 3 * want.width * want.height; at++)
                assert_in_range(got.rgb[at] - want.rgb[at] + 1, 0, 2);
            frame_free(&want);
            frame_free(&got);
        }
    }
    snapshot_free(&kept);
    film_free(&film);
}

/* Without a sample in each half nothing is marked. */
static void young_films_are_not_marked(void **state)
{
    struct snapshot_blocks blocks = {.blocks = NULL};
    struct snapshot kept;
    struct film before, now;
    struct error err;

    (void)state;
    fill(&before, 1, 0);
    assert_true(film_init(&now, WIDTH, HEIGHT, &err));
    assert_true(snapshot_take(&kept, &before, &err));
    assert_true(snapshot_differences(&kept, &now, 3, 2, &blocks, &err));
    assert_int_equal(blocks.cols * blocks.rows, 6);
    assert_int_equal(blocks.significant_count, 0);
    assert_true(blocks.is_unknown);
    snapshot_blocks_free(&blocks);
    snapshot_free(&kept);
    film_free(&before);
    film_free(&now);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_is_not_marked),
        cmocka_unit_test(light_is_marked),
        cmocka_unit_test(paintings_are_previews),
        cmocka_unit_test(young_films_are_not_marked),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
