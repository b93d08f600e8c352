// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"
#include "tests/unit/chi_square.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kernels/rng.h"

/* Integrands over the unit square. */
static double plane(struct vec2 u)
{
    return (double)u.x + (double)u.y;
}

static double saddle(struct vec2 u)
{
    return (double)u.x * (double)u.x * (double)u.y;
}

static double wave(struct vec2 u)
{
    return sin(M_PI * (double)u.x) * exp((double)u.y);
}

static double disk(struct vec2 u)
{
    return hypot((double)u.x, (double)u.y) < 1 ? 1 : 0;
}

static const struct integrand {
    double (*f)(struct vec2 u);
    double integral;
    double deviation; /* square root of the variance of f */
} integrands[] = {
    {plane, 1, 0.408248290463863},        /* sqrt(1/6) */
    {saddle, 1.0 / 6, 0.197202659436654}, /* sqrt(1/15 - 1/36) */
    {wave, 2 / M_PI *(M_E - 1), 0.632980180616729},
    {disk, M_PI / 4, 0.410545841934081}, /* sqrt(p (1-p)) */
};

#define INTEGRAND_COUNT (sizeof integrands / sizeof *integrands)

static double mean_of(const struct integrand *g, uint32_t x, uint32_t y,
                      uint64_t first, int count, uint32_t dimension)
{
    double sum = 0;

    for (int i = 0; i < count; i++)
        sum += g->f(
            random_2d(sampler_start(x, y, first + (uint64_t)i, 0), dimension));
    return sum / count;
}

/* STRESS C9: no bits give 1. */
static void unit_floats_stay_below_one(void **state)
{
    (void)state;
    assert_true(unit_float(0) == 0.0f);
    for (uint32_t i = 0; i < 1u << 20; i++)
        assert_true(unit_float(0xffffffffu - i) < 1.0f);
}

/* Marks the one of 2^wide x 2^high boxes that contains u. Returns false if it
 * is marked already. */
static bool take_box(bool *is_taken, struct vec2 u, int wide, int high)
{
    int column = (int)ldexp((double)u.x, wide);
    int row = (int)ldexp((double)u.y, high);
    bool is_free = !is_taken[column << high | row];

    is_taken[column << high | row] = true;
    return is_free;
}

/* Each box of area 2^-m, of 2^-k by 2^-(m-k), contains one of the 2^m points
 * from `first` on. */
static bool is_net(uint32_t x, uint64_t first, int m, uint32_t dimension)
{
    for (int k = 0; k <= m; k++) {
        bool is_taken[1 << 12] = {false};

        for (uint64_t i = first; i < first + (UINT64_C(1) << m); i++) {
            struct vec2 u = random_2d(sampler_start(x, 5, i, 7), dimension);

            if (!take_box(is_taken, u, k, m - k))
                return false;
        }
    }
    return true;
}

/* Tests prefixes and aligned blocks of indices up to the last ones, so that a
 * sequence can be continued at any power of two. */
static void points_are_nets(void **state)
{
    (void)state;
    for (uint32_t x = 0; x < 100; x++)
        for (int m = 0; m <= 8; m++) {
            uint64_t step = UINT64_C(1) << m;

            for (uint64_t j = 0; j < 4; j++)
                assert_true(is_net(x, j * step, m, x % 40));
            assert_true(is_net(x, (UINT64_C(1) << 32) - step, m, 9));
            assert_true(is_net(x, (UINT64_C(1) << 32) + step, m, 9));
            assert_true(is_net(x, 0 - step, m, 9));
        }
    assert_true(is_net(3, 0, 12, 10));
}

/* Mean over 2^m samples of one half of a pixel. */
static double half_mean_of(const struct integrand *g, uint32_t x, uint32_t y,
                           uint64_t half, int count)
{
    double sum = 0;

    for (int i = 0; i < count; i++)
        sum += g->f(
            random_2d(sampler_start_half(x, y, 2 * (uint64_t)i + half, 0), 10));
    return sum / count;
}

/* The errors of the two halves of a pixel are uncorrelated, so that the square
 * of half their difference estimates the variance of their mean: chance exceeds
 * 5 standard errors once in 2e6. The same estimate from the two halves of one
 * sequence is several times too high. */
static void halves_are_independent(void **state)
{
    const int n = 40000, count = 16;

    (void)state;
    for (size_t g = 0; g < INTEGRAND_COUNT; g++) {
        const struct integrand *f = &integrands[g];
        double products = 0, squares = 0, adjacent = 0, whole = 0;

        for (int i = 0; i < n; i++) {
            uint32_t x = (uint32_t)i % 200, y = (uint32_t)i / 200;
            double a = half_mean_of(f, x, y, 0, count) - f->integral;
            double b = half_mean_of(f, x, y, 1, count) - f->integral;
            double c = mean_of(f, x, y, 0, count, 10) - f->integral;
            double d = mean_of(f, x, y, 16, count, 10) - f->integral;

            products += a * b;
            squares += a * a * b * b;
            adjacent += (c - d) * (c - d) / 4;
            whole += (c + d) * (c + d) / 4;
        }
        check_at_most(fabs(products) / sqrt(squares), 5);
        assert_true(adjacent > 1.5 * whole);
    }
}

/* Each half of a picture's pixel is a sequence of nets of its own. */
static void halves_are_nets(void **state)
{
    (void)state;
    for (uint64_t half = 0; half < 2; half++)
        for (int k = 0; k <= 6; k++) {
            bool is_taken[1 << 12] = {false};

            for (uint64_t i = 0; i < 64; i++)
                assert_true(take_box(
                    is_taken,
                    random_2d(sampler_start_half(3, 5, 2 * i + half, 7), 9), k,
                    6 - k));
        }
}

/* Single points are uniform: chi-square over 16 x 16 boxes, 255 degrees of
 * freedom, for each of 64 sample indices. Chance exceeds 5.5 standard errors
 * once in 5e7. */
static void each_index_is_uniform(void **state)
{
    (void)state;
    for (uint64_t index = 0; index < 64; index++) {
        const int n = 256 * 64;
        int counts[256] = {0};
        struct chi_square chi = chi_begin();

        for (int i = 0; i < n; i++) {
            struct vec2 u =
                random_2d(sampler_start((uint32_t)i % 128, (uint32_t)i / 128,
                                        index, 1),
                          10);

            counts[(int)(u.x * 16) * 16 + (int)(u.y * 16)]++;
        }
        for (int k = 0; k < 256; k++)
            chi_add(&chi, n / 256.0, counts[k]);
        check_at_most(fabs(chi_deviate(&chi)), 5.5);
    }
}

/* STRESS C7: neighbours of any kind are uncorrelated. One standard error is
 * 1/sqrt(n); chance exceeds 5 of them once in 2e6, and there are 6 values. */
static void numbers_are_uncorrelated(void **state)
{
    const int n = 200000;
    double sums[5] = {0};
    double mean = 0;

    (void)state;
    for (int i = 0; i < n; i++) {
        uint32_t x = (uint32_t)i % 640, y = (uint32_t)i / 640;
        struct sampler s = sampler_start(x, y, 7, 0);
        struct vec2 a = random_2d(s, 10);
        struct vec2 others[4] = {random_2d(sampler_start(x + 1, y, 7, 0), 10),
                                 random_2d(sampler_start(x, y + 1, 7, 0), 10),
                                 random_2d(s, 11),
                                 random_2d(sampler_start(x, y, 7, 1), 10)};

        mean += (double)a.x - 0.5;
        sums[4] += 12 * ((double)a.x - 0.5) * ((double)a.y - 0.5);
        for (int k = 0; k < 4; k++)
            sums[k] += 12 * ((double)a.x - 0.5) * ((double)others[k].x - 0.5);
    }
    check_close(mean / n, 0, 5 / sqrt(12.0 * n));
    for (int k = 0; k < 5; k++)
        check_close(sums[k] / n, 0, 5 / sqrt((double)n));
}

#define IMAGE_SIDE 256

/* Returns the correlation of an error image with another one, the first shifted
 * by dx, dy. */
static double correlation(const double *a, const double *b, int dx, int dy)
{
    double ab = 0, aa = 0;

    for (int y = 0; y < IMAGE_SIDE; y++)
        for (int x = 0; x < IMAGE_SIDE; x++) {
            int from =
                (y + dy) % IMAGE_SIDE * IMAGE_SIDE + (x + dx) % IMAGE_SIDE;

            ab += a[from] * b[y * IMAGE_SIDE + x];
            aa += a[y * IMAGE_SIDE + x] * a[y * IMAGE_SIDE + x];
        }
    return ab / aa;
}

/* Errors of pixels after 16 samples are uncorrelated too, of neighbours and of
 * two dimensions. One standard error is 1/256; chance exceeds 5 once in 2e6. */
static void errors_are_uncorrelated(void **state)
{
    static double first[IMAGE_SIDE * IMAGE_SIDE];
    static double second[IMAGE_SIDE * IMAGE_SIDE];
    const struct integrand *g = &integrands[3];

    (void)state;
    for (uint32_t i = 0; i < IMAGE_SIDE * IMAGE_SIDE; i++) {
        uint32_t x = i % IMAGE_SIDE, y = i / IMAGE_SIDE;

        first[i] = mean_of(g, x, y, 0, 16, 10) - g->integral;
        second[i] = mean_of(g, x, y, 0, 16, 11) - g->integral;
    }
    for (int k = 1; k < 4; k++)
        check_close(correlation(first, first, k & 1, k >> 1), 0,
                    5.0 / IMAGE_SIDE);
    check_close(correlation(first, second, 0, 0), 0, 5.0 / IMAGE_SIDE);
}

/* The mean of m samples over 4096 pixels is right within 5 standard errors,
 * estimated from the pixels. Chance exceeds them once in 2e6, and there are 16
 * values. */
static void means_are_unbiased(void **state)
{
    const int counts[] = {1, 3, 16, 37};
    const int pixel_count = 4096;

    (void)state;
    for (size_t g = 0; g < INTEGRAND_COUNT; g++)
        for (size_t c = 0; c < 4; c++) {
            double sum = 0, squares = 0;

            for (uint32_t p = 0; p < 4096; p++) {
                double e =
                    mean_of(&integrands[g], p % 64, p / 64, 0, counts[c], 12) -
                    integrands[g].integral;

                sum += e;
                squares += e * e;
            }
            check_close(sum / pixel_count, 0, 5 * sqrt(squares) / pixel_count);
        }
}

/* Returns the root mean square error of m samples over 256 pixels. */
static double rmse(const struct integrand *g, int m)
{
    double squares = 0;

    for (uint32_t p = 0; p < 256; p++)
        squares += pow(mean_of(g, p, 3, 0, m, 10) - g->integral, 2);
    return sqrt(squares / 256);
}

/* By Owen 1997 slopes are -3/2 for smooth integrands and -3/4 for edges.
 * Independent points have -1/2 and the deviation over the root of m. The square
 * root of a mean of 256 squares has an error of some 5 %: .02 in a slope over 8
 * doublings. */
static void errors_fall_fast(void **state)
{
    (void)state;
    for (size_t g = 0; g < INTEGRAND_COUNT; g++) {
        double few = rmse(&integrands[g], 16);
        double many = rmse(&integrands[g], 4096);
        double slope = log(many / few) / log(256);

        check_at_most(slope, g == 3 ? -0.7 : -1.4);
        check_at_most(few, 0.6 * integrands[g].deviation / 4);
    }
}

/* STRESS C8: the index has 64 bits, the seed 32. */
static void far_indices_and_seeds_differ(void **state)
{
    int equal = 0;

    (void)state;
    for (uint64_t i = 0; i < 1000; i++) {
        struct vec2 a = random_2d(sampler_start(3, 4, i, 0), 9);
        struct vec2 others[3] = {
            random_2d(sampler_start(3, 4, i + (UINT64_C(1) << 32), 0), 9),
            random_2d(sampler_start(3, 4, i + (UINT64_C(1) << 63), 0), 9),
            random_2d(sampler_start(3, 4, i, 0xffffffffu), 9)};

        for (int k = 0; k < 3; k++)
            equal += memcmp(&a, &others[k], sizeof a) == 0;
    }
    assert_int_equal(equal, 0);
    assert_true(random_2d(sampler_start(0, 0, 0, 0), 0).x != 0);
}

/* Returns the point of a draft's pixel (x, y). */
static struct vec2 draft_point(uint32_t x, uint32_t y, uint32_t index,
                               uint32_t seed, uint32_t dimension)
{
    return random_2d(sampler_start_draft(x, y, index, seed), dimension);
}

/* Tests 2^more samples from `first` on of the 2^wide x 2^high pixels with
 * corner (x, y), like is_net(). */
static bool is_draft_net(uint32_t x, uint32_t y, int wide, int high,
                         uint32_t first, int more, uint32_t dimension)
{
    int m = wide + high + more;

    for (int k = 0; k <= m; k++) {
        bool is_taken[1 << 12] = {false};

        for (uint32_t i = 0; i < 1u << m; i++) {
            uint32_t pixel = i >> more;
            struct vec2 u =
                draft_point(x + (pixel & ((1u << wide) - 1)),
                            y + (pixel >> wide),
                            first + (i & ((1u << more) - 1)), 7, dimension);

            if (!take_box(is_taken, u, k, m - k))
                return false;
        }
    }
    return true;
}

/* Aligned squares of pixels, and two of them side by side, hold nets: of their
 * first samples, of the next four, and of the four in one pixel. */
static void squares_of_a_draft_are_nets(void **state)
{
    (void)state;
    for (int high = 0; high <= 4; high++)
        for (int wide = high; wide <= high + 1; wide++)
            for (uint32_t i = 0; i < 60; i++) {
                uint32_t columns = 1u << wide, rows = 1u << high;
                uint32_t x = i % 6 * columns, y = i / 6 * rows;

                if (i == 59) { /* the last ones */
                    x = DRAFT_SIDE_MAX - columns;
                    y = DRAFT_SIDE_MAX - rows;
                }
                assert_true(is_draft_net(x, y, wide, high, 0, 0, i));
                assert_true(is_draft_net(x, y, wide, high, 1, 2, i));
            }
}

/* Like each_index_is_uniform(), over the seeds, for the samples of some
 * pixels. */
static void draft_points_are_uniform(void **state)
{
    const uint32_t pixels[4][2] = {{0, 0}, {1, 0}, {77, 40}, {0x7fff, 3}};

    (void)state;
    for (uint32_t k = 0; k < 4 * DRAFT_SPP; k++) {
        const uint32_t *p = pixels[k % 4];
        const int n = 256 * 64;
        int counts[256] = {0};
        struct chi_square chi = chi_begin();

        for (int i = 0; i < n; i++) {
            struct vec2 u = draft_point(p[0], p[1], k / 4, (uint32_t)i, 10);

            counts[(int)(u.x * 16) * 16 + (int)(u.y * 16)]++;
        }
        for (int j = 0; j < 256; j++)
            chi_add(&chi, n / 256.0, counts[j]);
        check_at_most(fabs(chi_deviate(&chi)), 5.5);
    }
}

static int compare_keys(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;

    return x < y ? -1 : x > y;
}

/* No two samples of a draft have the same keys at holes. Of 20480 keys with 32
 * bits some are equal by chance: .05 pairs are expected, 5 occur once in 4e8.
 */
static void draft_keys_differ(void **state)
{
    static uint32_t keys[64 * 64 * DRAFT_SPP];
    const int n = 64 * 64 * DRAFT_SPP;
    int equal = 0;

    (void)state;
    for (int i = 0; i < n; i++) {
        uint32_t pixel = (uint32_t)i / DRAFT_SPP;

        keys[i] = ray_key(sampler_start_draft(pixel % 64, pixel / 64,
                                              (uint32_t)i % DRAFT_SPP, 3),
                          1);
    }
    qsort(keys, (size_t)n, sizeof *keys, compare_keys);
    for (int i = 1; i < n; i++)
        equal += keys[i] == keys[i - 1];
    assert_in_range(equal, 0, 4);
}

/* Samples of a draft with halves have other keys than each other and than those
 * of the picture. */
static void draft_halves_have_keys_of_their_own(void **state)
{
    uint32_t keys[2 * DRAFT_HALVES_SPP];
    const int n = 2 * DRAFT_HALVES_SPP;

    (void)state;
    for (uint32_t pixel = 0; pixel < 100; pixel++) {
        for (uint32_t i = 0; i < DRAFT_HALVES_SPP; i++) {
            uint32_t x = 7 * pixel, y = 3 * pixel + 1;

            keys[2 * i] = ray_key(sampler_start_draft_half(x, y, i, 3), 1);
            keys[2 * i + 1] = ray_key(sampler_start_half(x, y, i, 3), 1);
        }
        qsort(keys, (size_t)n, sizeof *keys, compare_keys);
        for (int i = 1; i < n; i++)
            assert_int_not_equal(keys[i], keys[i - 1]);
    }
}

/* Radius of the blur by the eye, in pixels. */
#define BLUR_RADIUS 6
#define BLUR_SIGMA  1.5

/* Blurs along one axis: pixels are `step` apart, rows `across`. */
static void blur_along(double *to, const double *from, int step, int across)
{
    for (int row = 0; row < IMAGE_SIDE; row++)
        for (int i = 0; i < IMAGE_SIDE; i++) {
            double sum = 0, weights = 0;

            for (int k = -BLUR_RADIUS; k <= BLUR_RADIUS; k++) {
                double weight = exp(-k * k / (2 * BLUR_SIGMA * BLUR_SIGMA));
                int at = (i + k + IMAGE_SIDE) % IMAGE_SIDE;

                sum += weight * from[row * across + at * step];
                weights += weight;
            }
            to[row * across + i * step] = sum / weights;
        }
}

static double mean_square(const double *image)
{
    double squares = 0;

    for (int i = 0; i < IMAGE_SIDE * IMAGE_SIDE; i++)
        squares += image[i] * image[i];
    return squares / (IMAGE_SIDE * IMAGE_SIDE);
}

/* Returns the mean square error of a draft's first samples, and that after a
 * blur. */
static double draft_error(const struct integrand *g, uint32_t spp,
                          double *blurred)
{
    static double image[IMAGE_SIDE * IMAGE_SIDE];
    static double half[IMAGE_SIDE * IMAGE_SIDE];
    static double whole[IMAGE_SIDE * IMAGE_SIDE];

    for (uint32_t i = 0; i < IMAGE_SIDE * IMAGE_SIDE; i++) {
        double sum = 0;

        for (uint32_t s = 0; s < spp; s++)
            sum += g->f(draft_point(i % IMAGE_SIDE, i / IMAGE_SIDE, s, 0, 10));
        image[i] = sum / spp - g->integral;
    }
    blur_along(half, image, 1, IMAGE_SIDE);
    blur_along(whole, half, IMAGE_SIDE, 1);
    *blurred = mean_square(whole);
    return mean_square(image);
}

/* A draft's pixels have the error of independent ones, but its blurred error is
 * less. A blur leaves 1 / (4 pi sigma^2) of an error without a pattern. Of a
 * draft's error it leaves at most a third of that for smooth integrands and
 * half for an edge; with five samples, four of which are a net in each pixel, a
 * tenth and a fourth. The mean of 65536 squares is known to 1 %. */
static void errors_of_a_draft_are_blue(void **state)
{
    const double white = 1 / (4 * M_PI * BLUR_SIGMA * BLUR_SIGMA);

    (void)state;
    for (size_t g = 0; g < INTEGRAND_COUNT; g++) {
        double variance = pow(integrands[g].deviation, 2);
        double blurred;

        check_close(draft_error(&integrands[g], 1, &blurred), variance,
                    0.02 * variance);
        check_at_most(blurred, white * variance / (g == 3 ? 2 : 3));
        check_at_most(draft_error(&integrands[g], 5, &blurred), variance / 5);
        check_at_most(blurred, white * variance / 5 / (g == 3 ? 4 : 10));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unit_floats_stay_below_one),
        cmocka_unit_test(points_are_nets),
        cmocka_unit_test(halves_are_independent),
        cmocka_unit_test(halves_are_nets),
        cmocka_unit_test(each_index_is_uniform),
        cmocka_unit_test(numbers_are_uncorrelated),
        cmocka_unit_test(errors_are_uncorrelated),
        cmocka_unit_test(means_are_unbiased),
        cmocka_unit_test(errors_fall_fast),
        cmocka_unit_test(far_indices_and_seeds_differ),
        cmocka_unit_test(squares_of_a_draft_are_nets),
        cmocka_unit_test(draft_points_are_uniform),
        cmocka_unit_test(draft_keys_differ),
        cmocka_unit_test(draft_halves_have_keys_of_their_own),
        cmocka_unit_test(errors_of_a_draft_are_blue),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
