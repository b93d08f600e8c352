// SPDX-License-Identifier: MIT
/*
 * test_screen_detail.c - detail of films of known light and noise: enlarged
 * ramps, detail without noise, noise without detail, both with the error of
 * Wiener's filter, and lamps
 */
#include <math.h>
#include <stdlib.h>

#include "tests/unit/check.h"

#include "film/filter/filter.h"
#include "film/filter/screen_halves.h"

#define WIDTH  96
#define HEIGHT 60
#define LOW    3 /* pixels of the result along a side of a filtered one */

#define LOW_WIDTH  (WIDTH / LOW)
#define LOW_HEIGHT (HEIGHT / LOW)
#define LOW_PIXELS (LOW_WIDTH * LOW_HEIGHT)

/* Light of sample `index` of pixel (x, y). */
typedef float light_function(int x, int y, uint64_t index);

static struct screen_detail detail;
static struct film film;
static float filtered[3 * LOW_PIXELS], seen[LOW_PIXELS];

static void begin(void)
{
    struct error err;

    assert_true(film_init(&film, WIDTH, HEIGHT, &err));
    assert_true(screen_detail_init(&detail, WIDTH, HEIGHT, LOW_WIDTH,
                                   LOW_HEIGHT, filter_loops_at(0)));
    for (int i = 0; i < LOW_PIXELS; i++)
        seen[i] = 0;
}

static void end(void)
{
    film_free(&film);
    screen_detail_free(&detail);
}

static void add_samples(light_function *light, int count)
{
    static const int one = 1;

    for (int i = 0; i < count; i++)
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++) {
                float l = light(x, y, (uint64_t)i);
                struct path_sample sample = {{l, l / 2, l / 4}, 1, 0};

                film_add_row(&film, (struct film_pixels){x, y, 1, 1}, &sample,
                             NULL, &one);
            }
}

static void filter_to(int x, int y, float light)
{
    float *to = filtered + 3 * (y * LOW_WIDTH + x);

    for (int c = 0; c < 3; c++)
        to[c] = light / (float)(1 << c);
}

static void filter_all_to(float light)
{
    for (int i = 0; i < LOW_PIXELS; i++)
        filter_to(i % LOW_WIDTH, i / LOW_WIDTH, light);
}

/* Returns the mean of the squared differences between red light and `truth`, at
 * pixels that are at least `edge` away from the border. */
static double mean_square(light_function *truth, int edge)
{
    double sum = 0, count = 0;

    for (int y = 0; y < HEIGHT; y++) {
        const float *row = screen_detail_row(&detail, y);

        if (y < edge || y >= HEIGHT - edge)
            continue;
        for (int x = edge; x < WIDTH - edge; x++) {
            double off = (double)row[3 * x] - (double)truth(x, y, 0);

            sum += off * off;
            count++;
        }
    }
    return sum / count;
}

static float ramp(int x, int y, uint64_t index)
{
    (void)index;
    return 0.5f + 0.01f * ((float)x + 0.5f) + 0.02f * ((float)y + 0.5f);
}

/* Without a film the picture is enlarged linearly. */
static void ramps_stay_ramps(void **state)
{
    (void)state;
    begin();
    for (int y = 0; y < LOW_HEIGHT; y++)
        for (int x = 0; x < LOW_WIDTH; x++)
            filter_to(x, y, ramp(LOW * x + 1, LOW * y + 1, 0));
    screen_detail_find(&detail, &film, filtered, seen);
    check_at_most(mean_square(ramp, LOW), 1e-12);
    end();
}

/* A chess board of pixels, which a filtered picture cannot hold. */
static float chess(int x, int y, uint64_t index)
{
    (void)index;
    return (x + y) % 2 == 1 ? 0.6f : 0.2f;
}

/* Detail without noise appears as it is, up to what the means of pixels of the
 * filtered picture hold of it, which are .4 + - .2 / 9. */
static void detail_without_noise_appears(void **state)
{
    (void)state;
    begin();
    filter_all_to(0.4f);
    add_samples(chess, 1);
    screen_detail_find(&detail, &film, filtered, seen);
    check_close(mean_square(chess, 0), 0.04, 1e-6); /* a sample has no halves */
    add_samples(chess, 1);
    screen_detail_find(&detail, &film, filtered, seen);
    check_at_most(mean_square(chess, 0), (0.2 / 9) * (0.2 / 9));
    end();
}

static float noise(int x, int y, uint64_t index)
{
    uint64_t seed = index * 1000003u + (uint64_t)y * 50331653u +
                    (uint64_t)x * 12582917u + 1;

    return 0.8f * (float)check_random(&seed);
}

static float grey(int x, int y, uint64_t index)
{
    (void)x, (void)y, (void)index;
    return 0.4f;
}

/* Noise without detail stays away. */
static void noise_stays_away(void **state)
{
    const double variance = 0.8 * 0.8 / 12 / 8;

    (void)state;
    begin();
    filter_all_to(0.4f);
    add_samples(noise, 8);
    screen_detail_find(&detail, &film, filtered, seen);
    check_at_most(mean_square(grey, 0), variance / 20);
    end();
}

static float noisy_chess(int x, int y, uint64_t index)
{
    return chess(x, y, 0) + noise(x, y, index) - 0.2f;
}

static float shifted_chess(int x, int y, uint64_t index)
{
    return chess(x, y, index) + 0.2f;
}

/* The error is near that of Wiener's filter: energy * noise / (energy + noise),
 * which is less than that of the film and of the filtered picture. */
static void error_is_that_of_wieners_filter(void **state)
{
    (void)state;
    for (int spp = 2; spp <= 32; spp *= 4) {
        double energy = 0.04, variance = 0.8 * 0.8 / 12 / spp;

        begin();
        filter_all_to(0.6f);
        add_samples(noisy_chess, spp);
        screen_detail_find(&detail, &film, filtered, seen);
        check_close(mean_square(shifted_chess, 0),
                    energy * variance / (energy + variance),
                    0.25 * energy * variance / (energy + variance));
        end();
    }
}

static bool is_lamp(int x, int y)
{
    return x >= 30 && x < 45 && y >= 30 && y < 36;
}

static float lamp(int x, int y, uint64_t index)
{
    return is_lamp(x, y) ? 40.0f : noise(x, y, index);
}

static void check_beside_lamp(double most, double mean)
{
    double sum = 0, count = 0;

    screen_detail_find(&detail, &film, filtered, seen);
    for (int y = 27; y < 39; y++) {
        const float *row = screen_detail_row(&detail, y);

        for (int x = 27; x < 48; x++)
            if (!is_lamp(x, y)) {
                sum += (double)row[3 * x];
                count++;
                check_at_most((double)row[3 * x], most);
            }
    }
    check_close(sum / count, 0.4, mean);
}

/* Pixels beside a lamp get none of its light, with a film and without. */
static void lamps_do_not_spread(void **state)
{
    (void)state;
    begin();
    for (int y = 0; y < LOW_HEIGHT; y++)
        for (int x = 0; x < LOW_WIDTH; x++) {
            bool is_seen = is_lamp(LOW * x, LOW * y);

            filter_to(x, y, is_seen ? 40.0f : 0.4f);
            seen[y * LOW_WIDTH + x] = is_seen;
        }
    check_beside_lamp(0.401, 1e-4);
    add_samples(lamp, 8);
    check_beside_lamp(0.8, 0.02);
    end();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ramps_stay_ramps),
        cmocka_unit_test(detail_without_noise_appears),
        cmocka_unit_test(noise_stays_away),
        cmocka_unit_test(error_is_that_of_wieners_filter),
        cmocka_unit_test(lamps_do_not_spread),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
