// SPDX-License-Identifier: MIT
/*
 * test_filter.c - the denoising filter against closed forms, against its
 * definition in double precision, and at the ends of its ranges
 */
#include <math.h>
#include <stdlib.h>

#include "tests/unit/check.h"

#include "film/filter/filter.h"

/* A picture in memory. */
struct picture {
    int width, height;
    int component_count;
    float (*light[2][2])[3]; /* of a component and half, for each pixel */
    float (*features)[FILTER_FEATURES];
    float feature_noise; /* variance of albedo, normal and depth alike */
    float count[2];
    float uneven; /* times as many samples in pixels of odd x + y, if not 0 */
};

/* Returns the samples of half h of a pixel. */
static float samples_at(const struct picture *p, int h, int x, int y)
{
    return p->count[h] * ((x + y) % 2 != 0 && p->uneven > 0 ? p->uneven : 1);
}

static void picture_init(struct picture *p, int width, int height)
{
    size_t pixels = (size_t)width * (size_t)height;

    *p = (struct picture){width, height, .component_count = 1, .count = {2, 2}};
    for (int k = 0; k < 2; k++)
        for (int h = 0; h < 2; h++)
            p->light[k][h] = calloc(pixels, sizeof *p->light[k][h]);
    p->features = calloc(pixels, sizeof *p->features);
    for (size_t i = 0; i < pixels; i++)
        for (int f = 0; f < FILTER_FEATURES; f++)
            p->features[i][f] = f < 3 ? 0.5f : 1.0f;
}

static void picture_free(struct picture *p)
{
    for (int k = 0; k < 2; k++)
        for (int h = 0; h < 2; h++)
            free(p->light[k][h]);
    free(p->features);
}

static void give_features(void *context, int y, const struct filter_row *to)
{
    const struct picture *p = context;

    for (int x = 0; x < p->width; x++) {
        const float *from = p->features[y * p->width + x];

        for (int c = 0; c < 3; c++) {
            to->albedo[c][x] = from[c];
            to->normal[c][x] = from[3 + c];
        }
        to->depth[x] = from[6];
        to->albedo_noise[x] = p->feature_noise;
        to->normal_noise[x] = p->feature_noise;
        to->depth_noise[x] = p->feature_noise;
        to->count[0][x] = samples_at(p, 0, x, y);
        to->count[1][x] = samples_at(p, 1, x, y);
    }
}

static void give_light(void *context, int component, int y, float *to[2][3])
{
    const struct picture *p = context;

    for (int h = 0; h < 2; h++)
        for (int x = 0; x < p->width; x++)
            for (int c = 0; c < 3; c++)
                to[h][c][x] = p->light[component][h][y * p->width + x][c];
}

/* Returns the filtered picture, for free(), and its variance. */
static float *filtered_with(struct picture *p, enum filter_form form,
                            struct pool *pool, const struct filter_loops *loops,
                            float *variance)
{
    struct filter_source source = {p, p->component_count, give_features,
                                   give_light, NULL};
    struct filter f;
    struct error err;
    float *rgb = calloc((size_t)p->width * (size_t)p->height, 3 * sizeof *rgb);

    assert_true(filter_init(&f, p->width, p->height, &err));
    f.loops = loops;
    filter_run(&f, &source, form, pool,
               &(struct filter_result){rgb, variance, NULL});
    filter_free(&f);
    return rgb;
}

static float *filtered(struct picture *p, enum filter_form form,
                       struct pool *pool, const struct filter_loops *loops)
{
    return filtered_with(p, form, pool, loops, NULL);
}

static float *filtered_well(struct picture *p)
{
    return filtered(p, FILTER_FULL, NULL, filter_loops_at(0));
}

/* A number with mean 0 and variance 1, nearly normal. */
static double noise(uint64_t *seed)
{
    double sum = -6;

    for (int i = 0; i < 12; i++)
        sum += check_random(seed);
    return sum;
}

/* Sets light of the given mean with independent noise in each half. */
static void set_noisy(struct picture *p, int x, int y, float mean, double sigma,
                      uint64_t *seed)
{
    for (int h = 0; h < 2; h++)
        for (int c = 0; c < 3; c++)
            p->light[0][h][y * p->width + x][c] =
                (float)(mean + sigma * noise(seed));
}

/* Fills light and features with random numbers: patches, gradients, noise. */
static void fill_any(struct picture *p, uint64_t seed)
{
    for (int i = 0; i < p->width * p->height; i++) {
        int x = i % p->width, y = i / p->width;

        for (int f = 0; f < FILTER_FEATURES; f++)
            p->features[i][f] =
                (float)(0.3 + 0.2 * (x / 9 % 2) + 0.1 * (y / 7 % 3) +
                        0.02 * check_random(&seed));
        for (int k = 0; k < 2; k++)
            for (int h = 0; h < 2; h++)
                for (int c = 0; c < 3; c++)
                    p->light[k][h][i][c] =
                        (float)(0.5 + 0.01 * x + 0.7 * (y > x) +
                                0.3 * check_random(&seed));
    }
}

/* A picture of constant light stays, under any albedo. */
static void constant_light_stays(void **state)
{
    struct picture p;
    float *rgb;

    (void)state;
    picture_init(&p, 50, 41);
    fill_any(&p, 1);
    for (int i = 0; i < 50 * 41; i++)
        for (int h = 0; h < 2; h++)
            for (int c = 0; c < 3; c++)
                p.light[0][h][i][c] =
                    (float)(c + 1) * (p.features[i][c] + FILTER_ALBEDO_MIN);
    rgb = filtered_well(&p);
    for (int i = 0; i < 3 * 50 * 41; i++) {
        double want = p.light[0][0][i / 3][i % 3];

        check_close(rgb[i], want, 4e-6 * want);
    }
    free(rgb);
    picture_free(&p);
}

/* Filters equal halves, all but one pixel of which are dimmed by a factor, and
 * compares every pixel. */
static void check_equal_halves(float dimmed)
{
    struct picture p;
    double most = 0;
    float *rgb;

    picture_init(&p, 70, 45);
    p.component_count = 2;
    fill_any(&p, 2);
    for (int i = 0; i < 70 * 45; i++)
        for (int k = 0; k < 2; k++)
            for (int c = 0; c < 3; c++) {
                p.light[k][0][i][c] *= i == 1000 ? 1 : dimmed;
                p.light[k][1][i][c] = p.light[k][0][i][c];
            }
    rgb = filtered_well(&p);
    for (int i = 0; i < 3 * 70 * 45; i++) {
        double want =
            (double)p.light[0][0][i / 3][i % 3] + p.light[1][0][i / 3][i % 3];

        most = fmax(most, fabs(rgb[i] - want) / want);
    }
    check_at_most(most, 12 * 0x1p-24); /* units in the last place */
    free(rgb);
    picture_free(&p);
}

/* Halves without noise are not changed: each level rounds the sums of equal
 * numbers, and everything that differs has weight 0. That is true of dark parts
 * beside bright light as well. */
static void equal_halves_stay(void **state)
{
    (void)state;
    check_equal_halves(1);
    check_equal_halves(0x1p-20f);
    check_equal_halves(0x1p-40f);
}

/* Noise of known variance on a plane falls, and the mean stays. Six levels of
 * the taps (1/4, 1/2, 1/4)^2 have the weights of a triangle of half width 64,
 * which would reduce the variance by (3 * 64 / 2)^2. At least the reduction of
 * four levels is required, (3 * 16 / 2)^2, as some differences look like edges.
 */
static void noise_falls(void **state)
{
    double before = 0, after = 0, mean = 0, mean_before = 0;
    uint64_t seed = 3;
    struct picture p;
    float *rgb;

    (void)state;
    picture_init(&p, 256, 256);
    for (int i = 0; i < 256 * 256; i++)
        set_noisy(&p, i % 256, i / 256, 5, 1, &seed);
    rgb = filtered_well(&p);
    for (int i = 0; i < 3 * 256 * 256; i++) {
        double raw = ((double)p.light[0][0][i / 3][i % 3] +
                      p.light[0][1][i / 3][i % 3]) /
                     2;

        mean_before += raw / (3 * 256 * 256);
        mean += rgb[i] / (3.0 * 256 * 256);
        before += (raw - 5) * (raw - 5);
        after += (rgb[i] - 5) * (rgb[i] - 5);
    }
    check_at_most(576, before / after);
    /* standard error of the mean: sqrt(1 / 2 / 196608) = .0016 */
    check_close(mean, mean_before, 0.003);
    free(rgb);
    picture_free(&p);
}

/* Sets light that changes evenly, with noise, and features that change evenly,
 * too: a plane seen at a low angle, with a shaded normal. */
static void set_even(struct picture *p, double sigma)
{
    uint64_t seed = 11;

    for (int i = 0; i < p->width * p->height; i++) {
        int x = i % p->width, y = i / p->width;

        set_noisy(p, x, y, (float)(1 + 0.05 * x + 0.03 * y), sigma, &seed);
        p->features[i][3] = (float)(0.02 * x);
        p->features[i][6] = (float)(1 + 0.05 * y);
    }
}

/* Noise falls as much where light and features change evenly, and they stay:
 * pixels on opposite sides have the light between them. Without their weights,
 * the variance is reduced 53 times. The lines at a distance of 64 from the edge
 * of the picture are those whose opposite pixels are in it. */
static void even_light_is_averaged(void **state)
{
    double before = 0, after = 0, bias = 0;
    struct picture p;
    float *rgb;

    (void)state;
    picture_init(&p, 256, 256);
    set_even(&p, 0.5);
    rgb = filtered_well(&p);
    for (int y = 64; y < 192; y++)
        for (int k = 3 * 64; k < 3 * 192; k++) {
            int i = 256 * y + k / 3, c = k % 3;
            double want = 1 + 0.05 * (k / 3) + 0.03 * y;
            double raw =
                ((double)p.light[0][0][i][c] + p.light[0][1][i][c]) / 2;

            bias += ((double)rgb[3 * i + c] - want) / (3 * 128 * 128);
            before += pow(raw - want, 2);
            after += pow((double)rgb[3 * i + c] - want, 2);
        }
    check_at_most(576, before / after);
    /* five standard errors of the mean of the raw pixels */
    check_close(bias, 0, 5 * 0.5 / sqrt(2.0 * 3 * 128 * 128));
    free(rgb);
    picture_free(&p);
}

/* Light that only a feature's edge separates stays on its side, although the
 * noise is larger than the step. */
static void edges_of_features_survive(void **state)
{
    (void)state;
    for (int f = 0; f < FILTER_FEATURES; f += 3) {
        uint64_t seed = 4;
        struct picture p;
        double sum[2] = {0};
        float *rgb;

        picture_init(&p, 64, 64);
        for (int i = 0; i < 64 * 64; i++) {
            bool is_right = i % 64 >= 32;

            set_noisy(&p, i % 64, i / 64, is_right ? 3.2f : 3.0f, 0.7, &seed);
            p.features[i][f] = is_right ? 0.1f : 0.9f;
        }
        rgb = filtered_well(&p);
        for (int y = 0; y < 64; y++)
            for (int c = 0; c < 3; c++) {
                sum[0] += rgb[3 * (64 * y + 31) + c] / (64 * 3.0);
                sum[1] += rgb[3 * (64 * y + 32) + c] / (64 * 3.0);
            }
        /* columns of raw pixels have a standard error of .7 / sqrt(2 * 192) */
        check_close(sum[0], 3.0, 0.06);
        check_close(sum[1], 3.2, 0.06);
        free(rgb);
        picture_free(&p);
    }
}

/* An edge of light that no feature shows survives if it is larger than the
 * noise. */
static void edges_of_light_survive(void **state)
{
    uint64_t seed = 5;
    struct picture p;
    float *rgb;

    (void)state;
    picture_init(&p, 64, 64);
    for (int i = 0; i < 64 * 64; i++)
        set_noisy(&p, i % 64, i / 64, i % 64 < 32 ? 1.0f : 3.0f, 0.1, &seed);
    rgb = filtered_well(&p);
    for (int i = 0; i < 3 * 64 * 64; i++)
        check_close(rgb[i], i / 3 % 64 < 32 ? 1.0 : 3.0, 0.1);
    free(rgb);
    picture_free(&p);
}

static void set_grey(struct picture *p, int h, int i, float light)
{
    for (int c = 0; c < 3; c++)
        p->light[0][h][i][c] = light;
}

/* A picture of 16x16 pixels with light 1, but for one half of a pixel. */
static float *lone_picture(float light, float samples, struct picture *p)
{
    picture_init(p, 16, 16);
    p->count[0] = p->count[1] = samples;
    for (int i = 0; i < 16 * 16; i++)
        for (int h = 0; h < 2; h++)
            set_grey(p, h, i, h == 1 && i == 16 * 7 + 9 ? light : 1.0f);
    return filtered_well(p);
}

/* Returns true if a half with this light gives another picture than one with
 * the limit. */
static bool goes_beyond(float light, float limit, float samples)
{
    struct picture p, q;
    float *a = lone_picture(light, samples, &p);
    float *b = lone_picture(limit, samples, &q);
    bool differs = false;

    for (int i = 0; i < 3 * 16 * 16; i++)
        differs = differs || fabsf(a[i] - b[i]) > 1e-5f * b[i];
    free(a);
    free(b);
    picture_free(&p);
    picture_free(&q);
    return differs;
}

/* The other half of a pixel and both halves of 24 around it have a light of 49
 * in all. A half of eight samples or more has no more than that, one of two not
 * four times as much. */
static void lone_light_is_limited(void **state)
{
    (void)state;
    assert_false(goes_beyond(1e20f, 49.0f, 8));
    assert_false(goes_beyond(60.0f, 49.0f, 512));
    assert_true(goes_beyond(48.0f, 49.0f, 512));
    assert_false(goes_beyond(1e20f, 196.0f, 2));
    assert_true(goes_beyond(190.0f, 196.0f, 2));
}

/* What both halves of a pixel have is light, however much. */
static void light_of_both_halves_stays(void **state)
{
    struct picture p;
    float *rgb;

    (void)state;
    picture_init(&p, 16, 16);
    p.count[0] = p.count[1] = 64;
    set_grey(&p, 0, 16 * 7 + 9, 1e9f);
    set_grey(&p, 1, 16 * 7 + 9, 1e9f);
    rgb = filtered_well(&p);
    check_close(rgb[3 * (16 * 7 + 9)], 1e9, 1e5);
    free(rgb);
    picture_free(&p);
}

/* Noise in features, if they say how much it is, does not stop the filter. */
static void noise_of_features_is_no_edge(void **state)
{
    double before = 0, after = 0;
    uint64_t seed = 6;
    struct picture p;
    float *rgb;

    (void)state;
    picture_init(&p, 128, 128);
    p.feature_noise = 3 * 0.01f;
    for (int i = 0; i < 128 * 128; i++) {
        set_noisy(&p, i % 128, i / 128, 2, 0.3, &seed);
        for (int f = 3; f < 6; f++)
            p.features[i][f] += (float)(0.1 * noise(&seed));
    }
    rgb = filtered_well(&p);
    for (int i = 0; i < 3 * 128 * 128; i++) {
        double raw = ((double)p.light[0][0][i / 3][i % 3] +
                      p.light[0][1][i / 3][i % 3]) /
                     2;

        before += (raw - 2) * (raw - 2);
        after += (rgb[i] - 2) * (rgb[i] - 2);
    }
    check_at_most(200, before / after);
    free(rgb);
    picture_free(&p);
}

/* Sets samples of a pixel that each meet one of two surfaces, the first with a
 * probability of `cover`, under light that is 1 on average. Features have the
 * mean of all samples. */
static void set_divided(struct picture *p, int i, double cover,
                        const double albedos[2], uint64_t *seed)
{
    int samples = 2 * (int)p->count[0], met = 0;

    for (int k = 0; k < samples; k++) {
        bool is_first = check_random(seed) < cover;
        double albedo = albedos[is_first ? 0 : 1];
        double light = albedo * (1 + 0.3 * noise(seed)) / p->count[0];

        met += is_first;
        for (int c = 0; c < 3; c++)
            p->light[0][k % 2][i][c] += (float)light;
    }
    for (int f = 0; f < 3; f++)
        p->features[i][f] =
            (float)(albedos[1] + (albedos[0] - albedos[1]) * met / samples);
}

/* Surfaces that samples meet by chance, as at partial coverage, have albedos
 * with as much noise as light. It falls in the picture as that of
 * light does, and the mean is that of the surfaces by coverage. */
static void chance_between_surfaces_falls(void **state)
{
    static const double albedos[][2] = {{0.02, 0.8}, {0.9, 0.1}};
    static const double covers[] = {0.3, 0.6};
    uint64_t seed = 11;

    (void)state;
    for (int n = 0; n < 4; n++) {
        const double *a = albedos[n % 2];
        double cover = covers[n / 2], sample = cover * (1 - cover);
        double want = cover * a[0] + (1 - cover) * a[1];
        double before = 0, after = 0, mean = 0, pixels = 96 * 96;
        struct picture p;
        float *rgb;

        picture_init(&p, 96, 96);
        p.count[0] = p.count[1] = 8;
        for (int i = 0; i < 96 * 96; i++)
            set_divided(&p, i, cover, a, &seed);
        p.feature_noise = (float)(sample * (a[0] - a[1]) * (a[0] - a[1]) / 16);
        rgb = filtered_well(&p);
        for (int i = 0; i < 96 * 96; i++) {
            double raw =
                ((double)p.light[0][0][i][0] + p.light[0][1][i][0]) / 2;

            before += (raw - want) * (raw - want);
            after += (rgb[3 * i] - want) * (rgb[3 * i] - want);
            mean += rgb[3 * i] / pixels;
        }
        check_at_most(20, before / after);
        check_close(mean, want, 5 * sqrt(before) / pixels);
        free(rgb);
        picture_free(&p);
    }
}

/* Pixels of a column at an edge, half black and half white, have the mean light
 * of both surfaces. The mean of light without albedo, which is 50 times as much
 * on the black one, would make 12 times of it. */
static void black_does_not_shine_on_white(void **state)
{
    static const double albedos[] = {0.8, 0.41, 0.02};
    static const double lights[] = {0.08, 0.09, 0.1};
    uint64_t seed = 12;
    struct picture p;
    double mean = 0;
    float *rgb;

    (void)state;
    picture_init(&p, 33, 256);
    for (int i = 0; i < 33 * 256; i++) {
        int side = i % 33 < 16 ? 0 : i % 33 == 16 ? 1 : 2;

        for (int f = 0; f < 3; f++)
            p.features[i][f] = (float)albedos[side];
        for (int h = 0; h < 2; h++)
            set_grey(&p, h, i,
                     (float)(-lights[side] * log(1 - check_random(&seed))));
    }
    rgb = filtered_well(&p);
    for (int y = 0; y < 256; y++)
        mean += rgb[3 * (33 * y + 16)] / 256.0;
    /* five standard errors of the mean of the raw column */
    check_close(mean, 0.09, 5 * 0.09 / sqrt(2 * 256));
    free(rgb);
    picture_free(&p);
}

/* ---- the definition, in double precision ---- */

struct truth {
    const struct picture *p;
    double light[2][3][64 * 64];
    double variance[2][64 * 64];               /* summed over channels */
    double features[FILTER_FEATURES][64 * 64]; /* scaled */
    double noise[64 * 64];                     /* summed over features */
};

static int clamped(int i, int count)
{
    return i < 0 ? 0 : i >= count ? count - 1 : i;
}

static int at(const struct truth *t, int x, int y)
{
    return clamped(y, t->p->height) * t->p->width + clamped(x, t->p->width);
}

/* The distance of half h between the pixels around (x, y) and those a step
 * away. Pixels beside the picture are copies of those at its edge. */
static double light_distance(const struct truth *t, int h, int x, int y, int dx,
                             int dy)
{
    double sum = 0;

    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++) {
            double vp = t->variance[h][at(t, i, j)];
            double vq = t->variance[h][at(t, i + dx, j + dy)];
            double square = 0;

            for (int c = 0; c < 3; c++)
                square += pow(t->light[h][c][at(t, i, j)] -
                                  t->light[h][c][at(t, i + dx, j + dy)],
                              2);
            sum += (square - 2 * fmin(vp, vq)) / (1e-40 + 2.56 * (vp + vq));
        }
    return fmax(sum / 9, 0);
}

static double feature_square(const struct truth *t, int p, int q)
{
    double sum = 0;

    for (int i = 0; i < FILTER_FEATURES; i++)
        sum += pow(t->features[i][p] - t->features[i][q], 2);
    return sum;
}

static double feature_distance(const struct truth *t, int p, int q)
{
    double np = t->noise[p], nq = t->noise[q];

    return fmax((feature_square(t, p, q) - 2 * fmin(np, nq)) / (1 + np + nq),
                0);
}

/* The distance of features around (x, y) and those a step away, in units of
 * their noise. */
static double noise_distance(const struct truth *t, int x, int y, int dx,
                             int dy)
{
    double sum = 0;

    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++) {
            int p = at(t, i, j), q = at(t, i + dx, j + dy);
            double np = t->noise[p], nq = t->noise[q];

            sum += (feature_square(t, p, q) - 2 * fmin(np, nq)) /
                   (1e-40 + 2.56 * (np + nq));
        }
    return fmax(sum / 9, 0);
}

/* The distance of half h between the pixels around (x, y) and the means of
 * those a step away on both sides. */
static double opposite_light(const struct truth *t, int h, int x, int y, int dx,
                             int dy)
{
    double sum = 0;

    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++) {
            int p = at(t, i, j), q = at(t, i + dx, j + dy);
            int r = at(t, i - dx, j - dy);
            const double *v = t->variance[h];
            double square = 0;

            for (int c = 0; c < 3; c++)
                square += pow(t->light[h][c][q] + t->light[h][c][r] -
                                  2 * t->light[h][c][p],
                              2);
            sum += (square - 6 * fmin(fmin(v[p], v[q]), v[r])) /
                   (1e-40 + 1.25 * (v[q] + v[r] + 4 * v[p]));
        }
    return fmax(sum / 9, 0);
}

static double opposite_features(const struct truth *t, int p, int q, int r)
{
    const double *n = t->noise;
    double sum = 0;

    for (int i = 0; i < FILTER_FEATURES; i++) {
        const double *f = t->features[i];

        sum += pow(f[q] + f[r] - 2 * f[p], 2);
    }
    return 4 * fmax((sum - 6 * fmin(fmin(n[p], n[q]), n[r])) /
                        (1 + n[q] + n[r] + 4 * n[p]),
                    0);
}

static bool is_inside(const struct picture *p, int x, int y)
{
    return x >= 0 && x < p->width && y >= 0 && y < p->height;
}

/* The weight of a distance. */
static double weight_of(double d)
{
    return pow(fmax(1 - d / 16, 0), 16);
}

/* The sum of the channels by which light is divided. */
static double albedo_sum(const struct truth *t, int p)
{
    return (t->features[0][p] + t->features[1][p] + t->features[2][p]) /
               7.0710678 +
           3e-3;
}

/* The weight of the pixel a step away from (x, y) over its tap, from half h. */
static double truth_weight(const struct truth *t, int h, int x, int y, int dx,
                           int dy, bool has_opposite)
{
    int p = at(t, x, y), q = at(t, x + dx, y + dy), r = at(t, x - dx, y - dy);
    double own = 0, opposite = 0, share = 0;

    if (is_inside(t->p, x + dx, y + dy)) {
        own = weight_of(light_distance(t, h, x, y, dx, dy) +
                        feature_distance(t, p, q));
        if (has_opposite && is_inside(t->p, x - dx, y - dy))
            opposite = weight_of(opposite_light(t, h, x, y, dx, dy) +
                                 opposite_features(t, p, q, r));
        share = albedo_sum(t, q) / (albedo_sum(t, q) + albedo_sum(t, r));
    }
    return 2 * opposite * share + (1 - opposite) * own;
}

/* The weight of the pixel of index k in 0 to 8 around (x, y) for features, and
 * its place. */
static double feature_weight(const struct truth *t, int x, int y, int k,
                             int step, int *q)
{
    static const double tap[] = {0.25, 0.5, 0.25};
    int dx = (k % 3 - 1) * step, dy = (k / 3 - 1) * step;
    double w = tap[k % 3] * tap[k / 3];

    *q = at(t, x + dx, y + dy);
    if (k == 4)
        return w;
    return is_inside(t->p, x + dx, y + dy)
               ? w * weight_of(noise_distance(t, x, y, dx, dy))
               : 0;
}

static void truth_features(const struct truth *from, struct truth *to, int step)
{
    const struct picture *p = from->p;

    *to = *from;
    for (int i = 0; i < p->width * p->height; i++) {
        double sums[FILTER_FEATURES] = {0}, noise = 0, all = 0;

        for (int k = 0; k < 9; k++) {
            int q;
            double w =
                feature_weight(from, i % p->width, i / p->width, k, step, &q);

            all += w;
            for (int f = 0; f < FILTER_FEATURES; f++)
                sums[f] += w * from->features[f][q];
            noise += w * w * from->noise[q];
        }
        for (int f = 0; f < FILTER_FEATURES; f++)
            to->features[f][i] = sums[f] / all;
        to->noise[i] = noise / (all * all);
    }
}

static void truth_level(const struct truth *from, struct truth *to, int step,
                        bool has_opposite)
{
    static const double tap[] = {0.25, 0.5, 0.25};
    const struct picture *p = from->p;

    *to = *from;
    for (int h = 0; h < 2; h++)
        for (int i = 0; i < p->width * p->height; i++) {
            int x = i % p->width, y = i / p->width;
            double light[3] = {0}, variance = 0, all = 0;

            for (int k = 0; k < 9; k++) {
                int dx = (k % 3 - 1) * step, dy = (k / 3 - 1) * step;
                int q = at(from, x + dx, y + dy);
                double w = tap[k % 3] * tap[k / 3];

                if (k != 4)
                    w *= truth_weight(from, 1 - h, x, y, dx, dy, has_opposite);
                all += w;
                for (int c = 0; c < 3; c++)
                    light[c] += w * from->light[h][c][q];
                variance += w * w * from->variance[h][q];
            }
            for (int c = 0; c < 3; c++)
                to->light[h][c][i] = light[c] / all;
            to->variance[h][i] = variance / (all * all);
        }
}

static double albedo(const struct truth *t, int c, int i)
{
    return t->features[c][i] * sqrt(0.02) + 1e-3;
}

/* Features, before they are averaged. */
static void truth_begin(struct truth *t, const struct picture *p)
{
    double depths = 0, scale;

    t->p = p;
    for (int i = 0; i < p->width * p->height; i++)
        depths += p->features[i][6];
    scale = p->width * p->height / (0.2 * depths);
    for (int i = 0; i < p->width * p->height; i++) {
        for (int f = 0; f < FILTER_FEATURES; f++)
            t->features[f][i] = p->features[i][f] * (f < 3   ? sqrt(1 / 0.02)
                                                     : f < 6 ? sqrt(1 / 0.32)
                                                             : scale);
        t->noise[i] = p->feature_noise * (1 / 0.02 + 1 / 0.32 + scale * scale);
    }
}

/* Light, after features were averaged. */
static void truth_light(struct truth *t)
{
    const struct picture *p = t->p;

    for (int i = 0; i < p->width * p->height; i++)
        for (int h = 0; h < 2; h++)
            for (int c = 0; c < 3; c++)
                t->light[h][c][i] = p->light[0][h][i][c] / albedo(t, c, i);
    for (int i = 0; i < p->width * p->height; i++) {
        double sum = 0;

        /* the mean variance of one sample, over the samples of the half */
        for (int k = 0; k < 3 * 25; k++) {
            int q =
                at(t, i % p->width + k / 3 % 5 - 2, i / p->width + k / 15 - 2);

            sum += pow(t->light[0][k % 3][q] - t->light[1][k % 3][q], 2) / 2 *
                   samples_at(p, 0, q % p->width, q / p->width);
        }
        t->variance[0][i] = t->variance[1][i] =
            sum / 25 / samples_at(p, 0, i % p->width, i / p->width);
    }
}

/* Both forms compute their definition, at sizes below and above the steps, with
 * the variance that is left. */
static void result_is_the_definition(void **state)
{
    static struct truth t[2];
    static const int sizes[][2] = {{64, 37}, {64, 37}, {5, 64},
                                   {1, 1},   {3, 2},   {64, 37}};
    static float variance[3 * 64 * 64];

    (void)state;
    for (int n = 0; n < 6; n++) {
        bool is_full = n < 5;
        struct picture p;
        float *rgb;

        picture_init(&p, sizes[n][0], sizes[n][1]);
        p.feature_noise = 0.001f;
        p.count[0] = 3;
        p.uneven = n > 0 ? 5 : 0;
        fill_any(&p, 7);
        truth_begin(&t[1], &p);
        for (int l = 0; l < 3; l++)
            truth_features(&t[1 - l % 2], &t[l % 2], 1 << l);
        truth_light(&t[0]);
        for (int l = 0; l < (is_full ? 6 : 4); l++)
            truth_level(&t[l % 2], &t[1 - l % 2], 1 << l, is_full);
        rgb = filtered_with(&p, is_full ? FILTER_FULL : FILTER_FAST, NULL,
                            filter_loops_at(0), variance);
        for (int i = 0; i < 3 * p.width * p.height; i++) {
            int c = i % 3;
            double factor = albedo(&t[0], c, i / 3);
            double want =
                (3 * t[0].light[0][c][i / 3] + 2 * t[0].light[1][c][i / 3]) /
                5 * factor;
            double rest =
                (9 * t[0].variance[0][i / 3] + 4 * t[0].variance[1][i / 3]) /
                25 / 3 * factor * factor;

            check_close(rgb[i], want, 1e-4 * want);
            check_close(variance[i], rest, 1e-3 * rest);
        }
        free(rgb);
        picture_free(&p);
    }
}

/* ---- bits ---- */

static void assert_same(const float *a, const float *b, const struct picture *p)
{
    assert_memory_equal(a, b,
                        (size_t)p->width * (size_t)p->height * 3 * sizeof *a);
}

/* Threads and instruction sets give the same bits. */
static void bits_depend_on_the_picture_only(void **state)
{
    struct picture p;
    struct error err;
    float *one;

    (void)state;
    picture_init(&p, 300, 70);
    p.component_count = 2;
    p.feature_noise = 0.002f;
    fill_any(&p, 8);
    one = filtered_well(&p);
    for (int threads = 1; threads < 5; threads++) {
        struct pool *pool = pool_create(threads, &err);
        float *some = filtered(&p, FILTER_FULL, pool, filter_loops_at(0));

        assert_same(one, some, &p);
        free(some);
        pool_destroy(pool);
    }
    for (int i = 1; filter_loops_at(i) != NULL; i++) {
        float *other = filtered(&p, FILTER_FULL, NULL, filter_loops_at(i));

        assert_same(one, other, &p);
        free(other);
    }
    free(one);
    picture_free(&p);
}

/* Exchanging the halves does not change the picture. */
static void halves_are_alike(void **state)
{
    struct picture p;
    float *one, *other;

    (void)state;
    picture_init(&p, 90, 33);
    fill_any(&p, 9);
    one = filtered_well(&p);
    for (int i = 0; i < 90 * 33; i++)
        for (int c = 0; c < 3; c++) {
            float a = p.light[0][0][i][c];

            p.light[0][0][i][c] = p.light[0][1][i][c];
            p.light[0][1][i][c] = a;
        }
    other = filtered_well(&p);
    assert_same(one, other, &p);
    free(one);
    free(other);
    picture_free(&p);
}

/* The result is finite and not negative for black pictures, single bright
 * pixels and mixtures of the greatest and least numbers. */
static void ends_of_the_range_are_finite(void **state)
{
    static const float values[] = {0, 0x1p-149f, 1e-30f, 1, 0x1p62f};
    static const int sizes[][2] = {{1, 1}, {3, 2}, {1, 70}, {40, 40}};
    uint64_t seed = 10;

    (void)state;
    for (int round = 0; round < 200; round++) {
        const int *size = sizes[round % 4];
        int kinds = 1 + (int)(5 * check_random(&seed));
        struct picture p;
        float *rgb;

        picture_init(&p, size[0], size[1]);
        for (int i = 0; i < size[0] * size[1]; i++) {
            for (int f = 0; f < FILTER_FEATURES; f++)
                p.features[i][f] =
                    round % 3 == 0 ? 0 : (float)check_random(&seed);
            for (int h = 0; h < 2; h++)
                for (int c = 0; c < 3; c++)
                    p.light[0][h][i][c] =
                        values[(int)(kinds * check_random(&seed))];
        }
        p.feature_noise = round % 5 == 0 ? 0x1p60f : 0;
        rgb = filtered_well(&p);
        for (int i = 0; i < 3 * size[0] * size[1]; i++)
            assert_true(rgb[i] >= 0 && rgb[i] <= 0x1p73f);
        free(rgb);
        picture_free(&p);
    }
}

/* Sums of any size become the nearest floats, or those beside them. */
static void sums_are_converted(void **state)
{
    enum { COUNT = 67 };
    struct sum sums[COUNT] = {{0, 0}, {1, 0}, {0, (uint64_t)1 << 63}};
    uint64_t seed = 5;

    (void)state;
    for (int i = 3; i < COUNT; i++) {
        double size = check_random(&seed) * 126 - 63;

        sums[i].lo = (uint64_t)(check_random(&seed) * 0x1p64);
        if (size < 0)
            sums[i].lo >>= (int)-size;
        else
            sums[i].hi = (uint64_t)exp2(size);
    }
    for (int k = 0; filter_loops_at(k) != NULL; k++) {
        float to[COUNT];

        filter_loops_at(k)->convert(sums, COUNT, to);
        for (int i = 0; i < COUNT; i++) {
            double exact = (double)sums[i].hi + ldexp((double)sums[i].lo, -64);

            check_close(to[i], exact, 1.3e-7 * exact);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constant_light_stays),
        cmocka_unit_test(equal_halves_stay),
        cmocka_unit_test(noise_falls),
        cmocka_unit_test(even_light_is_averaged),
        cmocka_unit_test(edges_of_features_survive),
        cmocka_unit_test(edges_of_light_survive),
        cmocka_unit_test(lone_light_is_limited),
        cmocka_unit_test(light_of_both_halves_stays),
        cmocka_unit_test(noise_of_features_is_no_edge),
        cmocka_unit_test(chance_between_surfaces_falls),
        cmocka_unit_test(black_does_not_shine_on_white),
        cmocka_unit_test(result_is_the_definition),
        cmocka_unit_test(bits_depend_on_the_picture_only),
        cmocka_unit_test(halves_are_alike),
        cmocka_unit_test(ends_of_the_range_are_finite),
        cmocka_unit_test(sums_are_converted),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
