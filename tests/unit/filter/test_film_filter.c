// SPDX-License-Identifier: MIT
/*
 * test_film_filter.c - films with and without noise, few samples and no
 * surfaces; pictures of shipped scenes against long renders
 */
#include <math.h>
#include <stdlib.h>

#include "tests/unit/check.h"

#include "base/clock.h"
#include "film/filter/film_filter.h"
#include "session/session.h"

#define WIDTH  96
#define HEIGHT 64

/* Light of the sky that is seen, as a part of its direct light. */
static float seen_share;

/* Adds samples of a floor with albedo .5 and sky above it. The light of sample
 * `index` is given by a function of the pixel. */
static void add_samples(struct film *f, uint64_t first, int count,
                        float (*light)(int x, int y, uint64_t index))
{
    struct path_sample samples[16];
    struct first_surface surfaces[16];

    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++) {
            for (int i = 0; i < count; i++) {
                float l = light(x, y, first + (uint64_t)i);
                bool is_sky = y < f->height / 2;
                float seen = is_sky ? seen_share : 0;

                samples[i] = (struct path_sample){{l, l / 2, l / 4}, 1, 0};
                surfaces[i] = (struct first_surface){
                    .direct = {l / 2, l / 8, 0},
                    .seen = {seen * l / 2, seen * l / 8, 0},
                    .albedo = {0.5f, 0.5f, 0.5f},
                    .normal = {0, 1, 0},
                    .depth = 2,
                    .state = is_sky ? SURFACE_AHEAD : SURFACE_BEHIND,
                };
            }
            film_add_row(f, (struct film_pixels){x, y, 1, 1}, samples, surfaces,
                         &count);
        }
}

static void open_film(struct film *f)
{
    struct error err;

    assert_true(film_init(f, WIDTH, HEIGHT, &err));
    assert_true(film_init_surfaces(f, &err));
}

/* Returns the linear picture of the filtered film, for free(). */
static float *filtered(struct film *f, struct pool *pool)
{
    float *rgb = calloc(3 * WIDTH * HEIGHT, sizeof *rgb);
    struct film to;
    struct error err;

    assert_true(film_init(&to, WIDTH, HEIGHT, &err));
    check_or_say(film_filter(f, pool, &to, &err), err.text);
    film_linear(&to, rgb);
    film_free(&to);
    return rgb;
}

static float smooth_light(int x, int y, uint64_t index)
{
    (void)index;
    return 1 + 0.01f * (float)x + (y < 9 ? 3.0f : 0.0f);
}

/* A film without noise has its own picture, whatever its parts. */
static void clean_films_stay(void **state)
{
    struct film f;
    float *rgb, *raw = calloc(3 * WIDTH * HEIGHT, sizeof *raw);

    (void)state;
    open_film(&f);
    add_samples(&f, 0, 5, smooth_light); /* halves of 3 and 2 */
    assert_true(film_filter_applies(&f));
    rgb = filtered(&f, NULL);
    film_linear(&f, raw);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        check_close(rgb[i], raw[i], 2e-6 * raw[i]);
    free(rgb);
    free(raw);
    film_free(&f);
}

/* Even samples are 1, odd ones 3, in all pixels. */
static float striped_light(int x, int y, uint64_t index)
{
    (void)x;
    (void)y;
    return index % 2 == 0 ? 1 : 3;
}

/* Each half counts as its samples: the filtered picture has the film's mean. */
static void halves_count_as_their_samples(void **state)
{
    struct film f;

    (void)state;
    open_film(&f);
    for (int count = 2; count <= 7; count++) {
        double mean = (count + 2.0 * (count / 2)) / count;
        float *rgb;

        film_clear(&f);
        add_samples(&f, 0, count, striped_light);
        rgb = filtered(&f, NULL);
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            check_close(rgb[3 * i], mean, 1e-5);
        free(rgb);
    }
    film_free(&f);
}

static float noisy_light(int x, int y, uint64_t index)
{
    uint64_t seed = index * 1000003u + (uint64_t)(y * WIDTH + x);

    return 2 * (float)check_random(&seed);
}

/* ---- errors for adaptive sampling ---- */

static float level, deviation;

/* Pixels of one colour have `change` times the light. */
static uint32_t changed_colour = 2;
static float change;

static float spread_light(int x, int y, uint64_t index)
{
    float l = level + deviation * (noisy_light(x, y, index) - 1);

    return ((uint32_t)(x + y) & 1) == changed_colour ? change * l : l;
}

static void take_squares(struct film *f, float exposure, int colour,
                         float *squares)
{
    struct film_squares s = {f, exposure, colour, squares, false};
    struct error err;

    check_or_say(film_filter_squares(&s, NULL, NULL, &err), err.text);
    assert_true(s.is_known);
}

/* Errors of a colour do not depend on the light of the other one, in films of
 * any width; those of the other colour are 0. */
static void errors_are_those_of_a_colour(void **state)
{
    static float squares[3][WIDTH * HEIGHT];

    (void)state;
    for (int width = WIDTH - 3; width <= WIDTH; width += 3)
        for (uint32_t colour = 0; colour < 2; colour++) {
            struct film f;
            struct error err;
            bool differs = false;

            level = 10;
            deviation = 2;
            for (int k = 0; k < 3; k++) {
                changed_colour = k < 2 ? 1 - colour : colour;
                change = k == 0 ? 1 : 30;
                assert_true(film_init(&f, width, HEIGHT, &err));
                assert_true(film_init_surfaces(&f, &err));
                add_samples(&f, 0, 16, spread_light);
                take_squares(&f, 0, (int)colour, squares[k]);
                film_free(&f);
            }
            for (int i = 0; i < width * HEIGHT; i++) {
                bool is_other =
                    ((uint32_t)(i % width + i / width) & 1) != colour;

                assert_true(is_other == !(squares[0][i] > 0));
                differs |= squares[0][i] != squares[2][i];
            }
            assert_memory_equal(squares[0], squares[1],
                                (size_t)(width * HEIGHT) * sizeof(float));
            assert_true(differs);
        }
}

/* Noise that is the same part of the light leaves the same relative error,
 * twice the noise four times the squared error, nearly: it changes the light by
 * which the error is divided, too. */
static void errors_follow_the_noise(void **state)
{
    static const float levels[] = {10, 40, 10}, deviations[] = {2, 8, 4};
    static float squares[WIDTH * HEIGHT];
    double sums[3] = {0};
    struct film f;

    (void)state;
    open_film(&f);
    changed_colour = 2;
    for (int k = 0; k < 3; k++) {
        level = levels[k];
        deviation = deviations[k];
        film_clear(&f);
        add_samples(&f, 0, 16, spread_light);
        take_squares(&f, 0, 0, squares);
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            sums[k] += (double)squares[i];
    }
    check_close(sums[1] / sums[0], 1, 0.02);
    check_close(sums[2] / sums[0], 4, 0.3);
    film_free(&f);
}

/* The light of black pixels is divided by that of white, whose square would
 * underflow and overflow. */
static void extreme_exposures_have_numbers(void **state)
{
    static float squares[WIDTH * HEIGHT];
    struct film f;

    (void)state;
    open_film(&f);
    changed_colour = 2;
    level = deviation = 0;
    for (int k = 0; k < 3; k++) {
        add_samples(&f, (uint64_t)(16 * k), 16, spread_light);
        for (int exposure = -100; exposure <= 100; exposure += 50) {
            take_squares(&f, (float)exposure, 0, squares);
            for (int i = 0; i < WIDTH * HEIGHT; i++)
                assert_true(squares[i] >= 0 && isfinite(squares[i]));
        }
        level = k == 0 ? 1 : 1e15f;
        deviation = level;
    }
    film_free(&f);
}

/* Halves of 1 and 3 deviate by 1 from their mean. That is all the error of seen
 * light, which is half of red and a quarter of green. The rest is filtered: its
 * error is at most a 20th of what it was. */
static void seen_light_has_its_own_error(void **state)
{
    static float squares[WIDTH * HEIGHT];
    const double floor = 0.01, blue = 0.5;
    double red = 0.25 / (4 + floor), green = 0.0625 / 4 / (1 + floor);
    double rest = red + 9 * green + 0.25 / (blue * blue + floor);
    struct film f;

    (void)state;
    seen_share = 1;
    open_film(&f);
    add_samples(&f, 0, 16, striped_light);
    take_squares(&f, 0, 1, squares);
    for (int x = 1; x < WIDTH; x += 2) {
        check_at_most((red + green) / 3, (double)squares[x]);
        check_at_most((double)squares[x], (red + green + rest / 20) / 3);
    }
    seen_share = 0;
    film_free(&f);
}

/* Noise of mean 1 falls on the floor and in the sky, and the mean of each
 * stays. */
static void noise_falls_on_each_surface(void **state)
{
    struct film f;
    float *rgb;

    (void)state;
    open_film(&f);
    add_samples(&f, 0, 16, noisy_light);
    rgb = filtered(&f, NULL);
    for (int part = 0; part < 2; part++) {
        double mean = 0, squares = 0, n = WIDTH * HEIGHT / 2;

        for (int i = 0; i < WIDTH * HEIGHT / 2; i++) {
            double x = rgb[3 * (part * WIDTH * HEIGHT / 2 + i)];

            mean += x / n;
            squares += (x - 1) * (x - 1) / n;
        }
        /* samples have a variance of 1/3, pixels of 1/48; the mean has a
         * standard error of .0026 */
        check_close(mean, 1, 0.012);
        check_at_most(squares, 1 / 48.0 / 50);
    }
    free(rgb);
    film_free(&f);
}

static float lamp_light(int x, int y, uint64_t index)
{
    bool is_lamp = x == 40 && y == 9 && index % 3 == 0;

    return y < HEIGHT / 2 ? 100.0f * (float)is_lamp : noisy_light(x, y, index);
}

/* A lamp of one pixel that covers a third of its samples keeps its light, of
 * which a half is seen, and gives none of that to its neighbours. */
static void lamps_stay_sharp(void **state)
{
    float at[2], beside[2];
    struct film f;
    float *rgb;

    (void)state;
    open_film(&f);
    for (int share = 0; share < 2; share++) {
        film_clear(&f);
        seen_share = (float)share;
        add_samples(&f, 0, 12, lamp_light);
        rgb = filtered(&f, NULL);
        at[share] = rgb[3 * (9 * WIDTH + 40)];
        beside[share] = rgb[3 * (9 * WIDTH + 41)];
        free(rgb);
    }
    seen_share = 0;
    check_at_most(at[1], 100 / 3.0 + 1e-4);
    check_at_most(50 / 3.0, at[1]);
    check_at_most(at[0], at[1]);
    check_at_most(beside[1], beside[0] / 2 + 1e-6);
    film_free(&f);
}

/* The filter needs surfaces, and two samples in each pixel: not one, not those
 * of a coarse grid. */
static void few_samples_are_not_filtered(void **state)
{
    struct path_sample sample = {{1, 1, 1}, 1, 0};
    struct first_surface surface = {.state = SURFACE_AHEAD};
    struct film f, bare;
    struct error err;
    const int one = 1;

    (void)state;
    open_film(&f);
    assert_true(film_init(&bare, WIDTH, HEIGHT, &err));
    assert_false(film_filter_applies(&f));
    film_add_row(&f, (struct film_pixels){0, 0, 1, 1}, &sample, &surface, &one);
    assert_false(film_filter_applies(&f));
    film_clear(&f);
    add_samples(&f, 0, 1, smooth_light);
    assert_false(film_filter_applies(&f));
    add_samples(&f, 1, 1, smooth_light);
    assert_true(film_filter_applies(&f));
    add_samples(&bare, 0, 4, smooth_light);
    assert_false(film_filter_applies(&bare));
    /* a late share has no features */
    film_clear(&f);
    f.first_sample = SURFACE_SAMPLES_MAX - 1;
    add_samples(&f, 0, 4, smooth_light);
    assert_true(film_filter_applies(&f));
    film_clear(&f);
    f.first_sample = SURFACE_SAMPLES_MAX;
    add_samples(&f, 0, 4, smooth_light);
    assert_false(film_filter_applies(&f));
    film_free(&bare);
    film_free(&f);
}

/* ---- scenes ---- */

static void render(struct session *s, uint64_t spp, uint32_t seed,
                   bool is_for_filter)
{
    struct render_job job = {.host = &s->engine.world,
                             .crop = {0, 0, WIDTH, HEIGHT},
                             .limits.spp = spp};
    struct error err;

    check_or_say(world_lend(&s->engine.world, &s->engine.scene,
                            &s->edit.now.view, seed, &job.world, &err),
                 err.text);
    if (is_for_filter)
        job.world.settings.features |= FEATURE_FILTER;
    check_or_say(render_start(s->engine.render, &job, &err), err.text);
    assert_true(render_wait(s->engine.render, 300000));
}

static double rel_mse(const float *a, const float *truth)
{
    double sum = 0;

    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        sum += pow((double)a[i] - truth[i], 2) / (pow(truth[i], 2) + 0.01);
    return sum / (3 * WIDTH * HEIGHT);
}

static double mean_of(const float *rgb)
{
    double sum = 0;

    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        sum += rgb[i] / (3.0 * WIDTH * HEIGHT);
    return sum;
}

/* Seeds over which the fall of noise is a mean. */
#define SEEDS 4

/* The error of 8 samples, against a long render with another seed, falls at
 * least fourfold: a room, glass and a mirror; in an open scene whose caustics
 * come by light paths, so that there is half as much noise to begin with, at
 * least by 2.5. The mean stays within its noise, and threads do not change the
 * bits. The noise of the long render adds to both errors, so that a shorter one
 * makes the test stricter. */
static void scenes_lose_their_noise(void **state)
{
    static const char *const scenes[] = {"scenes/cornell.obj",
                                         "scenes/glass_mirror.obj",
                                         "scenes/skylit.obj"};
    static const double falls[] = {4, 4, 2.5};
    float *truth = calloc(3 * WIDTH * HEIGHT, sizeof *truth);
    float *raw = calloc(3 * WIDTH * HEIGHT, sizeof *raw);

    (void)state;
    for (int i = 0; i < 3; i++) {
        struct options o = {.scene_path = scenes[i],
                            .width_px = WIDTH,
                            .height_px = HEIGHT};
        struct session s;
        struct error err;
        struct pool *pool = pool_create(3, &err);
        double noise = 0, left = 0;

        check_or_say(session_open(&s, &o, clock_ns(), &err), err.text);
        render(&s, check_is_thorough() ? 400 : 200, 1, false);
        film_linear(render_film(s.engine.render), truth);
        for (uint32_t seed = 2; seed < 2 + SEEDS; seed++) {
            float *clean, *same;

            render(&s, 8, seed, true);
            film_linear(render_film(s.engine.render), raw);
            clean = filtered(render_film(s.engine.render), NULL);
            same = filtered(render_film(s.engine.render), pool);
            assert_memory_equal(clean, same,
                                3 * WIDTH * HEIGHT * sizeof *clean);
            noise += rel_mse(raw, truth) / SEEDS;
            left += rel_mse(clean, truth) / SEEDS;
            check_close(mean_of(clean), mean_of(raw), 0.01 * mean_of(raw));
            free(clean);
            free(same);
        }
        print_message("%s: relMSE %.3g, filtered %.3g\n", scenes[i], noise,
                      left);
        check_at_most(left, noise / falls[i]);
        pool_destroy(pool);
        session_close(&s);
    }
    free(truth);
    free(raw);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clean_films_stay),
        cmocka_unit_test(halves_count_as_their_samples),
        cmocka_unit_test(errors_are_those_of_a_colour),
        cmocka_unit_test(errors_follow_the_noise),
        cmocka_unit_test(extreme_exposures_have_numbers),
        cmocka_unit_test(seen_light_has_its_own_error),
        cmocka_unit_test(noise_falls_on_each_surface),
        cmocka_unit_test(lamps_stay_sharp),
        cmocka_unit_test(few_samples_are_not_filtered),
        cmocka_unit_test(scenes_lose_their_noise),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
