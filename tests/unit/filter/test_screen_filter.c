// SPDX-License-Identifier: MIT
/*
 * test_screen_filter.c - the filter of the screen on films and drafts of known
 * light: without noise, with noise of known size, with one sample, with the
 * first samples of a film, with lamps
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/unit/check.h"

#include "film/film_error.h"
#include "film/filter/screen_filter.h"

#define WIDTH  64
#define HEIGHT 48
#define BYTES  (3 * WIDTH * HEIGHT)

/* Light of sample `index` of the pixel at (x, y) of the screen. */
typedef float light_function(float x, float y, uint64_t index);

static struct film film, draft;
static struct screen_filter filter;
static struct frame raw, clean;

/* Share of the light that is seen. */
static float seen_share;

/* Adds a sample to every `stride`-th pixel of a film of any size. */
static void add_samples(struct film *f, int stride, uint64_t index,
                        light_function *light)
{
    static const int one = 1;

    for (int y = 0; y < f->height; y += stride)
        for (int x = 0; x < f->width; x += stride) {
            float l =
                light(((float)x + 0.5f) * WIDTH / (float)f->width,
                      ((float)y + 0.5f) * HEIGHT / (float)f->height, index);
            struct path_sample sample = {{l, l / 2, l / 4}, 1, 0};
            struct first_surface surface = {
                .direct = {l, l / 2, l / 4},
                .seen = {seen_share * l, seen_share * l / 2,
                         seen_share * l / 4},
                .albedo = {0.5f, 0.5f, 0.5f},
                .normal = {0, 1, 0},
                .depth = 2,
                .state = SURFACE_BEHIND,
            };

            film_add_row(f, (struct film_pixels){x, y, 1, 1}, &sample, &surface,
                         &one);
        }
}

/* Opens a film that is `scale` times as large as the screen each way. */
static void open_films(int scale)
{
    struct error err;

    seen_share = 0;
    assert_true(film_init(&film, scale * WIDTH, scale * HEIGHT, &err));
    assert_true(film_init(&draft, WIDTH, HEIGHT, &err));
    assert_true(film_init_surfaces(&draft, &err));
    assert_true(frame_init(&raw, WIDTH, HEIGHT, &err));
    assert_true(frame_init(&clean, WIDTH, HEIGHT, &err));
}

static void close_films(void)
{
    film_free(&film);
    film_free(&draft);
    frame_free(&raw);
    frame_free(&clean);
    screen_filter_free(&filter);
}

/* Makes both frames, without and with the filter. */
static void show(struct film *young)
{
    film_preview(&film, young, develop_linear(0), &raw);
    film_preview(&film, young, develop_linear(0), &clean);
    assert_true(screen_filter_show(&filter,
                                   &(struct screen_films){&film, &draft, young},
                                   develop_linear(0), FILTER_FULL, &clean));
}

static float constant_light(float x, float y, uint64_t index)
{
    (void)x, (void)y, (void)index;
    return 0.4f;
}

static float pattern(float x, float y, uint64_t index)
{
    (void)index;
    return 0.1f + 0.01f * x + (x > y ? 0.3f : 0.0f) +
           ((int)x / 5 % 2 == 1 ? 0.2f : 0.0f);
}

/* Uniform noise of mean .4 and variance .4^2 / 3. */
static float noisy_light(float x, float y, uint64_t index)
{
    uint64_t seed =
        index * 1000003u + (uint64_t)(y * 10007) * 503u + (uint64_t)(x * 1009);

    return 0.8f * (float)check_random(&seed);
}

/* Constant light stays to the byte: in a draft of one sample, with a film that
 * has begun its first grid, and with a film of many. */
static void constant_light_stays(void **state)
{
    (void)state;
    open_films(4);
    add_samples(&draft, 1, 0, constant_light);
    show(&draft);
    assert_memory_equal(clean.rgb, raw.rgb, BYTES);
    add_samples(&film, FILM_STRIDE_MAX, 0, constant_light);
    show(&draft);
    assert_memory_equal(clean.rgb, raw.rgb, BYTES);
    add_samples(&draft, 1, 1, constant_light);
    add_samples(&film, 1, 1, constant_light);
    show(&draft);
    assert_memory_equal(clean.rgb, raw.rgb, BYTES);
    for (uint64_t i = 2; i < 20; i++)
        add_samples(&film, 1, i, constant_light);
    show(NULL);
    assert_memory_equal(clean.rgb, raw.rgb, BYTES);
    close_films();
}

/* Any picture without noise stays to the byte once each pixel has two samples,
 * also if the film's pixels are not those of the screen. */
static void pictures_without_noise_stay(void **state)
{
    (void)state;
    open_films(1);
    for (uint64_t i = 0; i < 5; i++)
        add_samples(&draft, 1, i, pattern);
    show(&draft);
    assert_memory_equal(clean.rgb, raw.rgb, BYTES);
    for (uint64_t i = 0; i < 20; i++)
        add_samples(&film, 1, i, pattern);
    show(NULL);
    assert_memory_equal(clean.rgb, raw.rgb, BYTES);
    close_films();
    open_films(5);
    add_samples(&draft, 1, 0, pattern);
    for (uint64_t i = 0; i < 20; i++)
        add_samples(&film, 1, i, pattern);
    show(NULL);
    assert_memory_equal(clean.rgb, raw.rgb, BYTES);
    close_films();
}

/* Returns the linear light of a byte. */
static double light_of(uint8_t byte)
{
    double v = byte / 255.0;

    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

/* Returns the variance of the frame's red light, and checks its mean. Bytes
 * round light by up to .003. */
static double clean_variance(double sigma)
{
    const double n = WIDTH * HEIGHT;
    double mean = 0, squares = 0;

    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        double x = light_of(clean.rgb[3 * i]);

        mean += x / n;
        squares += (x - 0.4) * (x - 0.4) / n;
    }
    check_close(mean, 0.4, 4.5 * sigma / sqrt(n) + 1e-3);
    return squares;
}

/* Noise falls with one sample in each pixel, with five, and beside the first
 * grid of the film; the mean stays. */
static void noise_falls(void **state)
{
    const double variance = 0.16 / 3;

    (void)state;
    open_films(3);
    add_samples(&draft, 1, 0, noisy_light);
    show(&draft);
    check_at_most(clean_variance(sqrt(variance)), variance / 40);
    add_samples(&film, FILM_STRIDE_MAX, 0, noisy_light);
    show(&draft);
    check_at_most(clean_variance(sqrt(variance)), variance / 40);
    for (uint64_t i = 1; i < 5; i++)
        add_samples(&draft, 1, i, noisy_light);
    show(&draft);
    check_at_most(clean_variance(sqrt(variance / 5)), variance / 5 / 60);
    for (uint64_t i = 0; i < 2; i++)
        add_samples(&film, 1, i, noisy_light);
    show(&draft);
    check_at_most(clean_variance(sqrt(variance / 23)), variance / 23 / 60);
    close_films();
}

/* Without edges nothing is blurred, and the error is the noise that is left. */
static void the_noise_left_is_known(void **state)
{
    double truth = 0, told = 0;

    (void)state;
    for (uint64_t run = 0; run < 40; run++) {
        open_films(1);
        for (uint64_t i = 0; i < 2; i++)
            add_samples(&draft, 1, 2 * run + i, noisy_light);
        show(&draft);
        for (int i = 0; i < BYTES; i++) {
            double light = 0.4 / (1 << i % 3);

            truth += pow(filter.rgb[i] - light, 2) /
                     (light * light + FILM_ERROR_BLACK) / BYTES;
        }
        told += pow(filter.error / SCREEN_FILTER_ERROR, 2);
        close_films();
    }
    check_close(told, truth, 0.15 * told);
}

static bool is_lamp(float x, float y)
{
    return x >= 20 && x < 24 && y >= 20 && y < 23;
}

static float lamp_light(float x, float y, uint64_t index)
{
    return is_lamp(x, y) ? 40.0f : noisy_light(x, y, index);
}

/* A lamp of a few pixels is as without the filter, and the noise beside it gets
 * none of its light. */
static void check_lamp(uint64_t samples)
{
    double mean = 0;

    open_films(2);
    for (uint64_t i = 0; i < samples; i++)
        add_samples(&draft, 1, i, lamp_light);
    for (int y = 20; y < 23; y++) /* the lamp is seen */
        for (int x = 20; x < 24; x++) {
            struct surface_sums *s = &draft.surfaces[y * WIDTH + x];

            memcpy(s->seen, s->direct, sizeof s->seen);
            s->seen_count = s->count;
        }
    show(&draft);
    for (int y = 18; y < 25; y++)
        for (int x = 18; x < 26; x++) {
            size_t at = 3 * (size_t)(y * WIDTH + x);

            if (is_lamp((float)x, (float)y))
                assert_memory_equal(clean.rgb + at, raw.rgb + at, 3);
            else
                mean += light_of(clean.rgb[at]) / (7 * 8 - 12);
        }
    check_close(mean, 0.4, 0.1);
    close_films();
}

static void lamps_stay_sharp(void **state)
{
    (void)state;
    check_lamp(1);
    check_lamp(5);
}

/* Light of a lamp's edge, which the draft does not see under a black sky. */
static float edge_light(float x, float y, uint64_t index)
{
    return (int)x == 20 ? noisy_light(x, y, index) : 0;
}

/* Light in the film where the draft sees a black sky stays in its pixel. */
static void edges_under_a_black_sky_stay(void **state)
{
    static const int one = 1;
    const struct path_sample dark = {{0, 0, 0}, 1, 0};
    const struct first_surface none = {.state = SURFACE_AHEAD};

    (void)state;
    open_films(1);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            film_add_row(&draft, (struct film_pixels){x, y, 1, 1}, &dark, &none,
                         &one);
    for (uint64_t i = 0; i < 20; i++)
        add_samples(&film, 1, i, edge_light);
    show(NULL);
    assert_memory_equal(clean.rgb, raw.rgb, BYTES);
    close_films();
}

/* A draft is not used for a frame with fewer pixels. */
static void smaller_frames_stay(void **state)
{
    struct frame other;
    struct error err;

    (void)state;
    open_films(1);
    add_samples(&draft, 1, 0, noisy_light);
    assert_true(frame_init(&other, WIDTH - 1, HEIGHT, &err));
    memset(other.rgb, 77, BYTES - 3 * HEIGHT);
    assert_false(
        screen_filter_show(&filter,
                           &(struct screen_films){&film, &draft, &draft},
                           develop_linear(0), FILTER_FULL, &other));
    for (int i = 0; i < BYTES - 3 * HEIGHT; i++)
        assert_int_equal(other.rgb[i], 77);
    frame_free(&other);
    close_films();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constant_light_stays),
        cmocka_unit_test(pictures_without_noise_stay),
        cmocka_unit_test(noise_falls),
        cmocka_unit_test(the_noise_left_is_known),
        cmocka_unit_test(lamps_stay_sharp),
        cmocka_unit_test(edges_under_a_black_sky_stay),
        cmocka_unit_test(smaller_frames_stay),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
