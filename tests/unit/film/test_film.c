// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <math.h>
#include <string.h>

#include "film/film.h"
#include "kernels/tone.h"

/* STRESS C6: the mean still changes at counts where sums of floats would
 * stall. */
static void sums_do_not_stall(void **state)
{
    struct sum s = {0, 0};

    (void)state;
    for (uint32_t i = 0; i < 1u << 25; i++)
        sum_add(&s, 1.0f);
    assert_true(s.hi == 1u << 25 && s.lo == 0);
    assert_true(sum_float(s) == 0x1p25f);
}

static void sums_are_exact_in_any_order(void **state)
{
    struct sum forward = {0, 0}, backward = {0, 0};
    float values[1000];
    long double truth = 0; /* 64 bits of mantissa: 1e-17 of the largest value */
    uint64_t seed = 3;

    (void)state;
    for (int i = 0; i < 1000; i++) {
        double exponent = check_random(&seed) * 60 - 30;

        values[i] = (float)(check_random(&seed) * pow(10, exponent / 2));
        truth += (long double)values[i];
    }
    for (int i = 0; i < 1000; i++) {
        sum_add(&forward, values[i]);
        sum_add(&backward, values[999 - i]);
    }
    assert_true(forward.lo == backward.lo && forward.hi == backward.hi);
    long double sum =
        (long double)forward.hi + ldexpl((long double)forward.lo, -64);
    check_at_most((double)(fabsl(sum - truth) / truth), 1e-15);
}

/* Tests every power of two alone, compared with ldexp(). */
static void single_values_come_back(void **state)
{
    (void)state;
    for (int e = -60; e <= 61; e++) {
        struct sum s = {0, 0};
        float x = ldexpf(1.2345678f, e);

        sum_add(&s, x);
        check_close(sum_float(s) / x, 1, e < -40 ? 0x1p-3 : 0x1p-23);
    }
}

static void odd_values_are_refused_or_saturate(void **state)
{
    struct sum s = {0, 0};

    (void)state;
    assert_false(sum_accepts(NAN));
    assert_false(sum_accepts(INFINITY));
    assert_false(sum_accepts(-INFINITY));
    assert_false(sum_accepts(-1e-30f));
    assert_true(sum_accepts(-0.0f));
    assert_true(sum_accepts(3.4e38f));
    sum_add(&s, -0.0f);
    assert_true(s.lo == 0 && s.hi == 0);
    sum_add(&s, 3.4e38f);
    assert_true(s.hi == (uint64_t)1 << 62);
    for (int i = 0; i < 5; i++)
        sum_add(&s, 3.4e38f);
    assert_true(s.hi == (uint64_t)1 << 63);
}

/* Light that a sum has no room for is counted: of 10 samples of 2^61 the first
 * three fit below 2^63; two sums of three do not fit together. */
static void lost_light_is_counted(void **state)
{
    struct film film, half;
    struct error err;
    struct path_sample samples[10];
    float rgb[3];

    (void)state;
    assert_true(film_init(&film, 1, 1, &err) && film_init(&half, 1, 1, &err));
    for (int i = 0; i < 10; i++)
        samples[i] = (struct path_sample){.radiance = {0x1p61f, 1, 0}};
    film_add_row(&half, (struct film_pixels){0, 0, 1, 1}, samples, NULL,
                 (int[]){3});
    assert_int_equal(atomic_load(&half.saturated), 0);
    film_add_row(&film, (struct film_pixels){0, 0, 1, 1}, samples, NULL,
                 (int[]){3});
    film_merge(&film, 0, &half);
    assert_int_equal(atomic_load(&film.saturated), 1);
    film_add_row(&half, (struct film_pixels){0, 0, 1, 1}, samples + 3, NULL,
                 (int[]){7});
    assert_int_equal(atomic_load(&half.saturated), 7);
    film_linear(&half, rgb);
    check_close(rgb[0], 0x1p63 / 10, 1e12);
    check_close(rgb[1], 1, 0);
    film_free(&half);
    film_free(&film);
}

/* Compares bytes with the formula of IEC 61966-2-1 in double. */
static void bytes_follow_the_srgb_curve(void **state)
{
    (void)state;
    for (int i = -100; i < 1200000; i++) {
        float x = (float)i * 1e-6f;
        double v = (double)x <= 0.0031308
                       ? 12.92 * (double)x
                       : 1.055 * pow((double)x, 1 / 2.4) - 0.055;
        double exact = fmin(fmax(v * 255, 0), 255);

        /* The bound is half a step, and the rounding of a threshold to
         * float. */
        check_close(srgb_byte(x), exact, 0.5 + 2e-5);
    }
    assert_int_equal(srgb_byte(NAN), 0);
    assert_int_equal(srgb_byte(INFINITY), 255);
    assert_int_equal(srgb_byte(-1.0f), 0);
}

static struct path_sample grey(float x)
{
    struct path_sample s = {{x, x / 2, x / 4}, 1, 0};

    return s;
}

/* Pixels with samples show their means. Others show the neighbour on the
 * coarser grid. */
static void film_shows_means_and_fills_gaps(void **state)
{
    struct film film;
    struct frame frame;
    struct error err;
    float rgb[3 * 64 * 48];
    float numbers[64 * 48];
    struct path_sample samples[8];
    int counts[8] = {2, 1, 0, 0, 0, 0, 0, 0};

    (void)state;
    assert_true(film_init(&film, 64, 48, &err));
    film_linear(&film, rgb);
    for (int i = 0; i < 3 * 64 * 48; i++)
        assert_true(rgb[i] == 0.0f);
    samples[0] = grey(1.0f);
    samples[1] = grey(3.0f);
    samples[2] = grey(8.0f);
    film_add_row(&film, (struct film_pixels){0, 0, 32, 2}, samples, NULL,
                 counts); /* (0,0) and (32,0) */
    film_counts(&film, numbers);
    for (int i = 0; i < 64 * 48; i++)
        assert_true(numbers[i] == (i == 0 ? 2 : i == 32 ? 1 : 0));
    film_linear(&film, rgb);
    check_close(rgb[0], 2, 0);
    check_close(rgb[1], 1, 0);
    check_close(rgb[3 * (31 * 64 + 31)], 2, 0);
    check_close(rgb[3 * 32], 8, 0);
    check_close(rgb[3 * (47 * 64 + 5)], 0, 0);
    counts[0] = 1;
    samples[0] = grey(5.0f);
    film_add_row(&film, (struct film_pixels){16, 16, 1, 1}, samples, NULL,
                 counts);
    film_linear(&film, rgb);
    check_close(rgb[3 * (16 * 64 + 16)], 5, 0);
    check_close(rgb[3 * (17 * 64 + 17)], 5, 0);
    check_close(rgb[3 * (15 * 64 + 16)], 2, 0);
    assert_int_equal(atomic_load(&film.samples), 4);
    assert_int_equal(atomic_load(&film.rays), 4);

    assert_true(frame_init(&frame, 64, 48, &err));
    film_resolve(&film, develop_linear(-1.0f), &frame);
    assert_int_equal(frame.rgb[0], 255);
    assert_int_equal(frame.rgb[1], 188); /* sRGB of 0.5 */
    assert_int_equal(frame.rgb[2], 137); /* sRGB of 0.25 */
    frame_free(&frame);

    film_clear(&film);
    film_linear(&film, rgb);
    check_close(rgb[0], 0, 0);
    film_add_row(&film, (struct film_pixels){0, 0, 1, 1}, samples, NULL,
                 counts);
    film_linear(&film, rgb);
    check_close(rgb[0], 5, 0); /* no sample from before the clear is left */
    film_free(&film);
}

static void bad_samples_count_as_zero(void **state)
{
    struct film film;
    struct error err;
    float rgb[3];
    struct path_sample samples[4];
    const int counts[1] = {4};

    (void)state;
    assert_true(film_init(&film, 1, 1, &err));
    samples[0] = grey(NAN);
    samples[1] = grey(-1.0f);
    samples[2] = grey(INFINITY);
    samples[3] = grey(8.0f);
    film_add_row(&film, (struct film_pixels){0, 0, 1, 1}, samples, NULL,
                 counts);
    film_linear(&film, rgb);
    check_close(rgb[0], 2, 0);
    assert_int_equal(atomic_load(&film.non_finite), 3);
    film_free(&film);
}

/* Samples with odd indices are also summed by themselves, however many are
 * added at a time. */
static void odd_samples_have_sums_of_their_own(void **state)
{
    struct film film, copy;
    struct error err;
    struct path_sample samples[7];
    int counts[1];

    (void)state;
    assert_true(film_init(&film, 3, 2, &err));
    for (int i = 0; i < 7; i++)
        samples[i] = grey(ldexpf(1.0f, i));
    samples[3] = grey(NAN); /* counts as 0 in both sums */
    for (int i = 0; i < 7; i += counts[0]) {
        counts[0] = i == 1 ? 3 : i == 4 ? 2 : 1;
        film_add_row(&film, (struct film_pixels){1, 1, 1, 1}, samples + i, NULL,
                     counts);
    }
    assert_true(film_copy(&copy, &film, &err));
    for (int c = 0; c < 3; c++) {
        check_close(sum_float(copy.sums[3 * 4 + c]), ldexp(127 - 8, -c), 0);
        check_close(sum_float(copy.odd_sums[3 * 4 + c]), ldexp(2 + 32, -c), 0);
    }
    assert_int_equal(copy.counts[4], 7);
    assert_int_equal(atomic_load(&film.non_finite), 1);
    film_free(&copy);
    film_free(&film);
}

/* The preview averages with a box filter, so its mean is the picture's mean. */
static void preview_averages(void **state)
{
    struct film film;
    struct frame frame;
    struct error err;
    struct path_sample samples[8];
    int counts[8];

    (void)state;
    assert_true(film_init(&film, 64, 48, &err));
    for (int i = 0; i < 8; i++) {
        counts[i] = 1;
        samples[i] = grey(i % 2 == 0 ? 0.4f : 0.6f);
    }
    for (int y = 0; y < 48; y++)
        for (int x = 0; x < 64; x += 8)
            film_add_row(&film, (struct film_pixels){x, y, 1, 8}, samples, NULL,
                         counts);
    assert_true(frame_init(&frame, 10, 7, &err));
    film_preview(&film, NULL, develop_linear(0.0f), &frame);
    for (int i = 0; i < 70; i++)
        /* Odd widths shift the boxes a little. */
        check_close(frame.rgb[3 * i], 188, 4);
    frame_free(&frame);
    assert_true(frame_init(&frame, 128, 96, &err));
    film_preview(&film, NULL, develop_linear(0.0f), &frame);
    assert_int_equal(frame.rgb[0], frame.rgb[3]);
    assert_int_not_equal(frame.rgb[3], frame.rgb[6]);
    frame_free(&frame);
    film_free(&film);
}

static int looks_left;

static bool has_key(void)
{
    return looks_left-- <= 0;
}

/* A cancel ends a preview between two rows; the others stay as they are. */
static void preview_ends_when_cancelled(void **state)
{
    struct cancel cancel = {.deadline_ns = 1, .is_due = has_key};
    struct film film;
    struct frame frame;
    struct error err;

    (void)state;
    assert_true(film_init(&film, 4, 4, &err));
    assert_true(frame_init(&frame, 5, 9, &err));
    frame.cancel = &cancel;
    for (looks_left = 9; looks_left >= 0; looks_left -= 3) {
        int rows = looks_left;

        memset(frame.rgb, 77, 3 * 5 * 9);
        film_preview(&film, NULL, develop_linear(0.0f), &frame);
        for (int i = 0; i < 3 * 5 * 9; i++)
            assert_int_equal(frame.rgb[i], i < 3 * 5 * rows ? 0 : 77);
        looks_left = rows;
    }
    frame_free(&frame);
    film_free(&film);
}

static void fill(struct film *film, float value)
{
    struct path_sample samples[8];
    int counts[8];

    for (int i = 0; i < 8; i++) {
        counts[i] = 1;
        samples[i] = grey(value);
    }
    for (int y = 0; y < film->height; y++)
        for (int x = 0; x < film->width; x += 8)
            film_add_row(film, (struct film_pixels){x, y, 1, 8}, samples, NULL,
                         counts);
}

/* All samples have equal weight: 12 of the film's 0.2 and 3 of the draft's 0.7
 * in a pixel of the frame have the mean 0.3. A frame of another size than the
 * draft's shows the same mean. */
static void previews_add_the_draft(void **state)
{
    struct film film, draft;
    struct frame frame;
    struct error err;

    (void)state;
    assert_true(film_init(&film, 64, 48, &err));
    assert_true(film_init(&draft, 16, 16, &err));
    for (int i = 0; i < 3; i++)
        fill(&draft, 0.7f);
    assert_true(frame_init(&frame, 16, 16, &err));
    film_preview(&film, &draft, develop_linear(0.0f),
                 &frame); /* the draft alone */
    for (int i = 0; i < 16 * 16; i++)
        assert_int_equal(frame.rgb[3 * i], srgb_byte(0.7f));
    fill(&film, 0.2f);
    film_preview(&film, &draft, develop_linear(0.0f), &frame);
    for (int i = 0; i < 16 * 16; i++)
        check_close(frame.rgb[3 * i], srgb_byte(0.3f), 1);
    film_preview(&film, NULL, develop_linear(0.0f), &frame);
    assert_int_equal(frame.rgb[0], srgb_byte(0.2f));
    frame_free(&frame);
    assert_true(frame_init(&frame, 32, 16, &err));
    film_clear(&film);
    film_preview(&film, &draft, develop_linear(0.0f), &frame);
    for (int i = 0; i < 32 * 16; i++)
        assert_int_equal(frame.rgb[3 * i], srgb_byte(0.7f));
    film_clear(&draft);
    draft.counts[0] = 3; /* all samples of its coarsest grid */
    film_preview(&film, &draft, develop_linear(0.0f), &frame);
    assert_int_equal(frame.rgb[3 * (15 * 32 + 31)], srgb_byte(0.7f));
    frame_free(&frame);
    film_free(&film);
    film_free(&draft);
}

/* Pixels of light 8 and 0 alternate. In a file they are white and black, which
 * has half the light of white. With one sample per pixel the preview shows
 * their mean instead, and with FILM_YOUNG_SPP the file, with and without the
 * draft. The transition is continuous. */
static void young_films_turn_into_files(void **state)
{
    struct path_sample samples[8];
    int counts[8], before = 255;
    struct film film, draft;
    struct frame frame;
    struct error err;

    (void)state;
    for (int i = 0; i < 8; i++) {
        counts[i] = 1;
        samples[i] = grey(i % 2 == 0 ? 8.0f : 0.0f);
    }
    assert_true(film_init(&film, 8, 8, &err));
    assert_true(film_init(&draft, 8, 2, &err));
    assert_true(frame_init(&frame, 4, 2, &err));
    fill(&draft, 4.0f);
    for (int spp = 1; spp <= FILM_YOUNG_SPP; spp++) {
        for (int y = 0; y < 8; y++)
            film_add_row(&film, (struct film_pixels){0, y, 1, 8}, samples, NULL,
                         counts);
        film_preview(&film, &draft, develop_linear(0), &frame);
        for (int i = 1; i < 4 * 2; i++)
            assert_int_equal(frame.rgb[3 * i], frame.rgb[0]);
        if (spp == 1)
            assert_int_equal(frame.rgb[0], 255);
        assert_in_range(frame.rgb[0], before - 6, before);
        before = frame.rgb[0];
    }
    assert_int_equal(before, srgb_byte(0.5f));
    film_preview(&film, NULL, develop_linear(0), &frame);
    assert_int_equal(frame.rgb[0], before);
    frame_free(&frame);
    film_free(&film);
    film_free(&draft);
}

/* Sums that saturate, in some pixels of the film or in all of them, show as
 * white. */
static void previews_of_too_much_light_are_white(void **state)
{
    struct film film;
    struct frame frame;
    struct error err;

    (void)state;
    assert_true(film_init(&film, 64, 48, &err));
    assert_true(frame_init(&frame, 32, 24, &err));
    for (int i = 0; i < 3; i++) { /* a sum saturates with the third */
        fill(&film, 3e38f);
        film_preview(&film, NULL, develop_linear(0.0f), &frame);
        for (int k = 0; k < 3 * 32 * 24; k++)
            assert_int_equal(frame.rgb[k], 255);
    }
    frame_free(&frame);
    film_free(&film);
}

static void films_too_large_are_refused(void **state)
{
    struct film film;
    struct error err;

    (void)state;
    assert_false(film_init(&film, 2000000, 2000000, &err));
    assert_non_null(strstr(err.text, "2000000x2000000"));
}

/* Tests the curves by independent properties. Reinhard's keeps the ratios of
 * channels and turns luminance L into L / (1 + L). Narkowicz's meets values of
 * his formula, computed exactly. Both are monotonic, and infinite light is not
 * dark. */
static void tone_curves_follow_their_formulas(void **state)
{
    static const struct {
        float x;
        double y;
    } aces[] = {{0, 0}, {.18f, 0.26689}, {1, 0.80380}, {4, 0.97342}};
    uint64_t seed = 11;

    (void)state;
    for (int i = 0; i < 1000; i++) {
        float in[3], out[3];
        double luminance = 0, shown = 0;
        static const double weights[3] = {0.2126, 0.7152, 0.0722};

        for (int c = 0; c < 3; c++)
            in[c] = out[c] = (float)(10 * check_random(&seed));
        tone_curve(TONE_REINHARD, out);
        for (int c = 0; c < 3; c++) {
            luminance += weights[c] * (double)in[c];
            shown += weights[c] * (double)out[c];
            check_close((double)out[c] * (double)in[0],
                        (double)out[0] * (double)in[c], 1e-4);
        }
        check_close(shown, luminance / (1 + luminance), 1e-5);
        memcpy(out, in, sizeof in);
        tone_curve(TONE_LINEAR, out);
        assert_memory_equal(out, in, sizeof in);
    }
    for (size_t i = 0; i < sizeof aces / sizeof aces[0]; i++) {
        float rgb[3] = {aces[i].x, 0, 0};

        tone_curve(TONE_ACES, rgb);
        check_close((double)rgb[0], aces[i].y, 1e-4);
    }
    for (uint32_t tone = TONE_REINHARD; tone < TONES; tone++) {
        float bright[3] = {INFINITY, INFINITY, INFINITY};
        float last = -1;

        for (float x = 0; x < 1e5f; x = x * 1.1f + 0.001f) {
            float rgb[3] = {x, x, x};

            tone_curve(tone, rgb);
            assert_true(rgb[0] >= last);
            last = rgb[0];
        }
        tone_curve(tone, bright);
        assert_true(bright[0] >= 0.99f && bright[0] < 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tone_curves_follow_their_formulas),
        cmocka_unit_test(sums_do_not_stall),
        cmocka_unit_test(sums_are_exact_in_any_order),
        cmocka_unit_test(single_values_come_back),
        cmocka_unit_test(odd_values_are_refused_or_saturate),
        cmocka_unit_test(lost_light_is_counted),
        cmocka_unit_test(bytes_follow_the_srgb_curve),
        cmocka_unit_test(film_shows_means_and_fills_gaps),
        cmocka_unit_test(bad_samples_count_as_zero),
        cmocka_unit_test(odd_samples_have_sums_of_their_own),
        cmocka_unit_test(preview_averages),
        cmocka_unit_test(preview_ends_when_cancelled),
        cmocka_unit_test(previews_add_the_draft),
        cmocka_unit_test(young_films_turn_into_files),
        cmocka_unit_test(previews_of_too_much_light_are_white),
        cmocka_unit_test(films_too_large_are_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
