// SPDX-License-Identifier: MIT
#include "world/light/sky_table.h"

#include <math.h>
#include <stdlib.h>

#include "kernels/light.h"
#include "kernels/rng.h"

#include "tests/unit/check.h"
#include "tests/unit/chi_square.h"
#include "tests/unit/sky_pdf.h"

/* Means are compared with the truth within 4.9 standard errors, which chance
 * exceeds once in a million. Seeds are fixed. */
#define Z_LIMIT 4.9

struct dome {
    struct vec3 *texels;
    struct sky_table table;
    struct world world;
};

static struct vec2 any_point(uint64_t *seed)
{
    float x = unit_float((uint32_t)(check_random(seed) * 4294967296.0));

    return v2(x, unit_float((uint32_t)(check_random(seed) * 4294967296.0)));
}

/* Returns the radiance of a texel whose middle is in direction d. */
typedef double radiance_function(struct vec3 d, void *context);

/* Returns the direction of a point of the image: +y is up, the top row is +y,
 * the middle column looks along -z, and columns grow towards +x. */
static struct vec3 direction_of(double column, double row)
{
    double theta = M_PI * row;
    double phi = 2 * M_PI * (column - 0.5);

    return v3((float)(sin(theta) * sin(phi)), (float)cos(theta),
              (float)(-sin(theta) * cos(phi)));
}

static void dome_init(struct dome *d, uint32_t width, uint32_t height,
                      enum sky_use use, radiance_function *f, void *context)
{
    struct error err;

    *d = (struct dome){.texels = NULL};
    d->texels = malloc((size_t)width * height * sizeof *d->texels);
    assert_non_null(d->texels);
    for (uint32_t i = 0; i < width * height; i++) {
        float l = (float)f(direction_of((i % width + 0.5) / width,
                                        (i / width + 0.5) / height),
                           context);

        d->texels[i] = v3(l, l, l);
    }
    d->world.settings.sky = (struct sky){.color = {1, 1, 1},
                                         .width = width,
                                         .height = height,
                                         .rotation_cos = 1};
    d->world.sky_texels = d->texels;
    assert_true(
        sky_table_build(&d->table, d->texels, width, height, use, &err));
    sky_table_lend(&d->table, &d->world);
}

static void dome_free(struct dome *d)
{
    sky_table_free(&d->table);
    free(d->texels);
}

static void rotate(struct dome *d, double angle_rad)
{
    d->world.settings.sky.rotation_cos = (float)cos(angle_rad);
    d->world.settings.sky.rotation_sin = (float)sin(angle_rad);
}

static double spots(struct vec3 d, void *context)
{
    (void)context;
    return 0.3 + 2 * pow(fmax((double)d.x, 0), 8) +
           5 * pow(fmax((double)(-d.y + d.z) * 0.7, 0), 20);
}

static double constant(struct vec3 d, void *context)
{
    (void)d;
    return *(double *)context;
}

/* The radiance is linear in the direction, positive, and greatest along
 * `slope`. */
static const double slope[3] = {0.3, 0.5, -0.2};

static double linear(struct vec3 d, void *context)
{
    (void)context;
    return 1 + slope[0] * (double)d.x + slope[1] * (double)d.y +
           slope[2] * (double)d.z;
}

static float table_pdf(const struct world *w, struct vec3 d)
{
    return sky_table_pdf(w, sky_uv(w->settings.sky, d));
}

/* Integrates by midpoints that are independent of the texels. */
static void density_integrates_to_one(void **state)
{
    const uint32_t sizes[][2] = {{32, 16}, {7, 5}, {3, 200}, {512, 1}, {2, 2}};
    const struct receiver r = {{0, 0, 0}, {0.6f, 0, 0.8f}, false, false};
    const int rows = 1400;

    (void)state;
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
        for (int use = SKY_WITH_MIS; use <= SKY_ALONE; use++) {
            struct dome d;
            double sum = 0;

            dome_init(&d, sizes[k][0], sizes[k][1], (enum sky_use)use, spots,
                      NULL);
            rotate(&d, 1);
            for (int i = 0; i < rows; i++)
                for (int j = 0; j < rows; j++) {
                    double z = 2 * (i + 0.5) / rows - 1;
                    double phi = 2 * M_PI * (j + 0.5) / rows;
                    double s = sqrt(1 - z * z);

                    sum += (double)sky_light_pdf(&d.world, &r,
                                                 v3((float)(s * cos(phi)),
                                                    (float)z,
                                                    (float)(s * sin(phi))));
                }
            check_close(sum * 4 * M_PI / rows / rows, 1, 3e-3);
            dome_free(&d);
        }
}

#define CELLS_Z 16
#define CELLS   (CELLS_Z * CELLS_Z)
#define FINE    64 /* midpoints of a cell along each axis */

/* Chi-square test over boxes of equal solid angle that are not the texels.
 * Boxes with fewer than 5 expected samples are merged. Expected counts come
 * from midpoints, whose relative error at the edges of texels is below 1/64;
 * the number of samples is small enough for the noise to exceed that. */
static void samples_follow_the_density(void **state)
{
    const int n = 20000;

    (void)state;
    for (int use = SKY_WITH_MIS; use <= SKY_ALONE; use++) {
        struct dome d;
        double expected[CELLS] = {0};
        int counts[CELLS] = {0};
        struct chi_square chi = chi_begin();
        uint64_t seed = 6;

        dome_init(&d, 37, 19, (enum sky_use)use, spots, NULL);
        rotate(&d, 2.5);
        for (int i = 0; i < CELLS * FINE * FINE; i++) {
            int row = i / (CELLS_Z * FINE), column = i % (CELLS_Z * FINE);
            double z = 2 * (row + 0.5) / (CELLS_Z * FINE) - 1;
            double phi = 2 * M_PI * (column + 0.5) / (CELLS_Z * FINE);
            double s = sqrt(1 - z * z);

            expected[row / FINE * CELLS_Z + column / FINE] +=
                (double)table_pdf(&d.world, v3((float)(s * cos(phi)), (float)z,
                                               (float)(s * sin(phi)))) *
                4 * M_PI / (CELLS * FINE * FINE) * n;
        }
        for (int i = 0; i < n; i++) {
            struct vec3 w = sky_sample(&d.world, any_point(&seed));
            double turns = atan2((double)w.z, (double)w.x) / (2 * M_PI);
            int row = (int)(((double)w.y + 1) / 2 * CELLS_Z);
            int column = (int)((turns - floor(turns)) * CELLS_Z);

            check_close(v3_length(w), 1, 1e-6);
            counts[row * CELLS_Z + column]++;
        }
        for (int i = 0; i < CELLS; i++)
            chi_add(&chi, expected[i], counts[i]);
        chi_end(&chi);
        check_at_most(fabs(chi_deviate(&chi)), Z_LIMIT);
        dome_free(&d);
    }
}

/* Returns the irradiance on a plane with normal n, by samples of the table and
 * of the cosine with the balance heuristic. `most` becomes the largest single
 * estimate. */
static double irradiance(const struct world *w, struct vec3 n, int count,
                         double *error, double *most)
{
    struct receiver r = {{0, 0, 0}, n, false, false};
    double sum = 0, squares = 0;
    uint64_t seed = 99;
    struct vec3 t, b;

    *most = 0;
    frame_around(n, &t, &b);
    for (int i = 0; i < count; i++) {
        struct vec3 c = cosine_hemisphere(any_point(&seed));
        struct vec3 wi = v3_add(v3_add(v3_scale(t, c.x), v3_scale(b, c.y)),
                                v3_scale(n, c.z));
        struct light_sample s;
        double e = 0;

        if (c.z > 0) {
            float p = c.z / PI;

            e = (double)(sky_radiance(w, wi).x * c.z /
                         (p + sky_light_pdf(w, &r, wi)));
        }
        if (light_sample(w, &r, NO_INDEX, any_point(&seed), any_point(&seed),
                         &s)) {
            float cosine = f_max(v3_dot(s.wi, n), 0);

            assert_true(s.pdf > 0 && s.pdf <= FLOAT_MAX);
            assert_int_equal(s.tri, NO_INDEX);
            assert_true(s.pdf == sky_light_pdf(w, &r, s.wi));
            e += (double)(s.radiance.x * cosine / (s.pdf + cosine / PI));
        }
        *most = fmax(*most, e);
        sum += e;
        squares += e * e;
    }
    *error = sqrt(fmax(squares / count - pow(sum / count, 2), 0) / (count - 1));
    return sum / count;
}

/* E = pi a + 2 pi / 3 b.n for L = a + b.d. A bilinear image of 512 x 256
 * differs by at most 1e-4: (pi / 256)^2 / 8 of the amplitude in the middle of
 * four texels, twice. */
static void linear_sky_has_its_irradiance(void **state)
{
    (void)state;
    for (int use = SKY_WITH_MIS; use <= SKY_ALONE; use++) {
        struct dome d;
        uint64_t seed = 12;

        dome_init(&d, 512, 256, (enum sky_use)use, linear, NULL);
        for (int k = 0; k < 10; k++) {
            double angle = 0.7 * k;
            double c = cos(angle), s = sin(angle);
            struct vec3 n = v3_unit(v3((float)check_random(&seed) - 0.5f,
                                       (float)check_random(&seed) - 0.5f,
                                       (float)check_random(&seed) - 0.5f));
            /* The dome is rotated about +y, counter-clockwise seen from
             * above. */
            double along = (c * slope[0] + s * slope[2]) * (double)n.x +
                           slope[1] * (double)n.y +
                           (c * slope[2] - s * slope[0]) * (double)n.z;
            double error, most, e;

            rotate(&d, angle);
            e = irradiance(&d.world, n, 100000, &error, &most);
            check_close(e, M_PI + 2 * M_PI / 3 * along, Z_LIMIT * error + 1e-4);
        }
        dome_free(&d);
    }
}

struct spot {
    uint32_t width, height, column, row;
    double hot, rest;
};

static double spot_radiance(struct vec3 d, void *context)
{
    const struct spot *s = context;
    struct vec3 middle =
        direction_of((s->column + 0.5) / s->width, (s->row + 0.5) / s->height);

    return v3_length(v3_sub(d, middle)) < 1e-6f ? s->hot : s->rest;
}

/* One texel among a million has most of the light. No single estimate is far
 * above the whole. The mean is the integral of the bilinear tent in closed
 * form, which at the equator is one texel's solid angle, to 1e-4. */
static void hot_texels_make_no_fireflies(void **state)
{
    struct spot s = {2048, 512, 300, 200, 1e6, 0.1};
    double theta = M_PI * (s.row + 0.5) / s.height;
    double angle = 2 * M_PI / s.width * M_PI / s.height * sin(theta);
    struct vec3 middle =
        direction_of((s.column + 0.5) / s.width, (s.row + 0.5) / s.height);
    struct vec3 n = v3_unit(v3_add(middle, v3(0.2f, 0.4f, 0.1f)));
    double truth =
        M_PI * s.rest + (s.hot - s.rest) * angle * (double)v3_dot(middle, n);
    struct dome d;
    double error, most, e;

    (void)state;
    dome_init(&d, s.width, s.height, SKY_WITH_MIS, spot_radiance, &s);
    e = irradiance(&d.world, n, 200000, &error, &most);
    check_close(e, truth, Z_LIMIT * error + 1e-4 * truth);
    /* At its peak the tent is 16/9 times its mean over the texel, and at the
     * corners of the neighbours 16 times the mean over those. */
    check_at_most(most, 20 * truth);
    /* Over three texels the mean of the squared tent over its means is 13/9
     * along each axis. */
    check_at_most(error * sqrt(200000) / truth, sqrt(169.0 / 81 - 1) + 0.02);
    dome_free(&d);
}

/* Samples are directed at hot texels anywhere, including the poles and the
 * seam: the mean of their directions is the texel's direction. */
static void samples_go_where_the_image_says(void **state)
{
    const uint32_t places[][2] = {{32, 16}, {48, 16}, {0, 16}, {63, 10},
                                  {10, 0},  {40, 31}, {20, 7}, {5, 25}};
    (void)state;
    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        struct spot s = {64, 32, places[k][0], places[k][1], 1000, 0};
        struct vec3 middle =
            direction_of((s.column + 0.5) / s.width, (s.row + 0.5) / s.height);
        struct vec3 mean = {0, 0, 0};
        uint64_t seed = 4;
        struct dome d;

        dome_init(&d, s.width, s.height, SKY_ALONE, spot_radiance, &s);
        for (int i = 0; i < 10000; i++)
            mean = v3_add(mean, sky_sample(&d.world, any_point(&seed)));
        /* at most two texels away */
        check_at_most(v3_length(v3_sub(v3_unit(mean), middle)), 2 * M_PI / 32);
        assert_true(table_pdf(&d.world, middle) > 10);
        dome_free(&d);
    }
}

/* Texels at the poles of a large image have a solid angle of 1e-8, where 1 -
 * cos has no digits in float. */
static void poles_keep_their_digits(void **state)
{
    (void)state;
    for (uint32_t row = 0; row < 2048; row += 2047) {
        struct spot s = {8, 2048, 3, row, 1e6, 0};
        /* Solid angle of a cap of one row. */
        double top = 2 * pow(sin(M_PI / 4096), 2);
        uint64_t seed = 4;
        double first = 0;
        struct dome d;

        dome_init(&d, s.width, s.height, SKY_ALONE, spot_radiance, &s);
        check_close(sky_texel_angle(d.world.settings.sky, row) * 8 /
                        (2 * M_PI * top),
                    1, 1e-5);
        for (int i = 0; i < 20000; i++) {
            struct vec3 w = sky_sample(&d.world, any_point(&seed));
            double radius = hypot((double)w.x, (double)w.z);

            assert_true(table_pdf(&d.world, w) > 0);
            assert_true((w.y > 0) == (row == 0));
            first += radius < sin(M_PI / 2048) ? 1 : 0;
        }
        /* Row 0: 7/8 of the radiance (its own 3/4 and the clamped 1/8) times
         * the solid angle of a cap. Row 1: 1/8 times three caps. */
        check_close(first / 20000, 7.0 / (7 + 3), Z_LIMIT * 0.5 / sqrt(20000));
        dome_free(&d);
    }
}

/* Returns the last of n intervals of a cdf that begins at or below u. */
static uint32_t last_at_or_below(const float *cdf, uint32_t n, float u)
{
    uint32_t found = 0;

    for (uint32_t i = 1; i < n; i++)
        if (cdf[i] <= u)
            found = i;
    return found;
}

/* Checks the search at an end of an interval or of a part, and beside it. */
static void check_search_at(const struct world *w, uint32_t cdf, float u)
{
    struct sky s = w->settings.sky;
    uint32_t first = cdf == 0 ? 0 : sky_row_cdf(s, cdf - 1);
    uint32_t n = cdf == 0 ? s.height : s.width;
    const float places[] = {nextafterf(u, 0), u, nextafterf(u, 1)};

    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        float at = fminf(places[i], UNIT_FLOAT_MAX), rest;

        assert_int_equal(sky_cdf_find(w, first, sky_starts(s, cdf), at, &rest),
                         last_at_or_below(w->sky_cdf + first, n, at));
        assert_true(rest >= 0 && rest <= 1);
    }
}

/* A search that begins near its end finds what one from the first to the last
 * interval finds, at every end of an interval and of a part. */
static void searches_find_the_interval(void **state)
{
    const uint32_t sizes[][2] = {{600, 9}, {3, 700}, {1, 1}, {37, 19}};

    (void)state;
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
        for (int use = SKY_WITH_MIS; use <= SKY_ALONE; use++) {
            struct dome d;
            struct sky s;

            dome_init(&d, sizes[k][0], sizes[k][1], (enum sky_use)use, spots,
                      NULL);
            s = d.world.settings.sky;
            for (uint32_t cdf = 0; d.world.sky_cdf != NULL && cdf <= s.height;
                 cdf++) {
                uint32_t n = cdf == 0 ? s.height : s.width;
                const float *ends =
                    d.world.sky_cdf + (cdf == 0 ? 0 : sky_row_cdf(s, cdf - 1));

                for (uint32_t i = 0; i <= n && ends[n] > 0; i++)
                    check_search_at(&d.world, cdf, ends[i]);
                for (int i = 0; i <= 256; i++)
                    check_search_at(&d.world, cdf, (float)i / 256);
            }
            dome_free(&d);
        }
}

/* Without a table, samples follow the cosine, and a single one is exact. */
static void flat_skies_have_no_table(void **state)
{
    const double levels[] = {0, 1, 1e30, 1e-30};
    const struct receiver r = {{0, 0, 0}, {0.6f, 0, -0.8f}, false, false};
    uint64_t seed = 3;

    (void)state;
    for (size_t k = 0; k < 4; k++) {
        double level = levels[k];
        struct light_sample s;
        struct dome d;

        dome_init(&d, 20, 10, SKY_WITH_MIS, constant, &level);
        assert_null(d.table.sums);
        assert_true(d.world.settings.sky_share == (level > 0 ? 1 : 0));
        assert_true(sky_light_pdf(&d.world, &r, v3(-0.6f, 0, 0.8f)) == 0);
        for (int i = 0; i < 1000; i++) {
            double cosine;

            if (!light_sample(&d.world, &r, NO_INDEX, any_point(&seed),
                              any_point(&seed), &s)) {
                assert_true(level == 0);
                continue;
            }
            cosine = (double)v3_dot(s.wi, r.n);
            check_close((double)v3_length(s.wi), 1, 1e-6);
            assert_true(s.pdf == sky_light_pdf(&d.world, &r, s.wi));
            check_close((double)s.radiance.x / level * cosine / (double)s.pdf,
                        M_PI, 1e-4);
        }
        dome_free(&d);
        dome_init(&d, 20, 10, SKY_ALONE, constant, &level);
        assert_true((d.table.sums != NULL) == (level > 0));
        /* uniform over the sphere */
        if (level > 0)
            check_close(table_pdf(&d.world, v3(0.6f, 0, 0.8f)), 1 / (4 * M_PI),
                        1e-6);
        dome_free(&d);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(density_integrates_to_one),
        cmocka_unit_test(samples_follow_the_density),
        cmocka_unit_test(linear_sky_has_its_irradiance),
        cmocka_unit_test(hot_texels_make_no_fireflies),
        cmocka_unit_test(samples_go_where_the_image_says),
        cmocka_unit_test(poles_keep_their_digits),
        cmocka_unit_test(searches_find_the_interval),
        cmocka_unit_test(flat_skies_have_no_table),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
