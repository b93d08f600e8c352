// SPDX-License-Identifier: MIT
/*
 * test_dither.c - 256 colours compared with the nearest ones, found by search:
 * both are compared as blurred light, as the eye sees them
 */
#include "tests/unit/check.h"

#include "tests/unit/oklab.h"

#include <stdlib.h>

#include "terminal/dither.h"

#define WIDTH  128
#define HEIGHT 8

/* xterm's numbers are 16 + 36 r + 6 g + b for levels 0 95 135 175 215 255, and
 * 232 + i for greys of 8 + 10 i. */
static void value_256(int n, int rgb[3])
{
    static const int level[6] = {0, 95, 135, 175, 215, 255};

    if (n >= 232) {
        rgb[0] = rgb[1] = rgb[2] = 8 + 10 * (n - 232);
        return;
    }
    rgb[0] = level[(n - 16) / 36];
    rgb[1] = level[(n - 16) / 6 % 6];
    rgb[2] = level[(n - 16) % 6];
}

static void light_of_256(int n, double light[3])
{
    int rgb[3];

    value_256(n, rgb);
    for (int c = 0; c < 3; c++)
        light[c] = light_of_srgb(rgb[c]);
}

static int nearest_256(struct rgb c)
{
    double wanted[3] = {light_of_srgb(c.r), light_of_srgb(c.g),
                        light_of_srgb(c.b)};
    double least = 1e9;
    int best = 0;

    for (int n = 16; n < 256; n++) {
        double light[3];

        light_of_256(n, light);
        double distance = oklab_distance(wanted, light);
        if (distance < least) {
            least = distance;
            best = n;
        }
    }
    return best;
}

static struct dither make_dither(void)
{
    struct dither d;
    struct error err;

    assert_true(dither_init(&d, &err));
    return d;
}

static void numbers_are_those_of_xterm(void **state)
{
    (void)state;
    for (int n = 16; n < 256; n++) {
        struct rgb c = dither_value((uint32_t)n, PALETTE_256);
        int want[3];

        value_256(n, want);
        assert_true(c.r == want[0] && c.g == want[1] && c.b == want[2]);
    }
}

/* Returns the colour at x of a ramp from one colour to the other. */
static struct rgb ramp_color(const int ends[2][3], int x)
{
    int v[3];

    for (int c = 0; c < 3; c++)
        v[c] = ends[0][c] + (ends[1][c] - ends[0][c]) * x / (WIDTH - 1);
    return (struct rgb){v[0], v[1], v[2]};
}

/* Measures of a ramp after 4x4 pixels become one: its mean distance to the true
 * ramp, and the longest stretch of one colour. */
struct ramp_error {
    double miss;
    int plateau;
};

static struct ramp_error measure_ramp(const int ends[2][3], struct dither *d)
{
    static const double same = 1e-6;
    double before[3] = {-1, -1, -1};
    struct ramp_error error = {0, 0};
    int run = 0;

    for (int x = 0; x + 4 <= WIDTH; x++) {
        double seen[3] = {0}, wanted[3] = {0}, light[3];

        for (int i = 0; i < 16; i++) {
            int at = x + i % 4;
            struct rgb c = ramp_color(ends, at);
            int v[3] = {c.r, c.g, c.b};
            int n = d ? (int)dither_color(d, c, at, i / 4, PALETTE_256)
                      : nearest_256(c);

            light_of_256(n, light);
            for (int k = 0; k < 3; k++) {
                seen[k] += light[k] / 16;
                wanted[k] += light_of_srgb(v[k]) / 16;
            }
        }
        error.miss += oklab_distance(seen, wanted) / (WIDTH - 3);
        run = oklab_distance(seen, before) < same ? run + 1 : 1;
        error.plateau = run > error.plateau ? run : error.plateau;
        memcpy(before, seen, sizeof before);
    }
    return error;
}

/* Tests greys, a hue from dark to full, two hues, and colours between the
 * levels. */
static void ramps_have_no_bands(void **state)
{
    static const int ramps[][2][3] = {
        {{10, 10, 10}, {70, 70, 70}},    {{95, 95, 95}, {175, 175, 175}},
        {{60, 20, 20}, {250, 120, 100}}, {{20, 40, 90}, {120, 160, 240}},
        {{40, 90, 30}, {220, 230, 120}}, {{188, 124, 0}, {120, 80, 140}},
    };
    struct dither d = make_dither();

    (void)state;
    for (size_t i = 0; i < sizeof ramps / sizeof ramps[0]; i++) {
        struct ramp_error nearest = measure_ramp(ramps[i], NULL);
        struct ramp_error mixed = measure_ramp(ramps[i], &d);

        check_at_most(mixed.miss, 0.5 * nearest.miss);
        check_at_most(mixed.plateau, nearest.plateau / 2);
    }
    dither_free(&d);
}

/* Returns OKLab's a and b of an sRGB colour, after Ottosson 2020. */
static void chroma_of(const double light[3], double ab[2])
{
    double l = cbrt(0.4122214708 * light[0] + 0.5363325363 * light[1] +
                    0.0514459929 * light[2]);
    double m = cbrt(0.2119034982 * light[0] + 0.6806995451 * light[1] +
                    0.1073969566 * light[2]);
    double s = cbrt(0.0883024619 * light[0] + 0.2817188376 * light[1] +
                    0.6299787005 * light[2]);

    ab[0] = 1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s;
    ab[1] = 0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s;
}

/* Greys are mixed of greys, and no colour of specks of another hue. The limit
 * is that of the program less what its cache may round. */
static void hues_stay(void **state)
{
    struct dither d = make_dither();
    uint64_t seed = 3;

    (void)state;
    for (int n = 0; n < 4000; n++) {
        int grey = (int)(check_random(&seed) * 230);
        int spread = n % 2 == 0 ? 3 : 120;
        struct rgb c = {grey + (int)(check_random(&seed) * spread) % 26,
                        grey + (int)(check_random(&seed) * spread) % 26, grey};
        double want[3], got[3], a[2], b[2];

        want[0] = light_of_srgb(c.r);
        want[1] = light_of_srgb(c.g);
        want[2] = light_of_srgb(c.b);
        chroma_of(want, a);
        for (int i = 0; i < 16; i++) {
            uint32_t number = dither_color(&d, c, i % 4, i / 4, PALETTE_256);

            light_of_256((int)number, got);
            chroma_of(got, b);
            if (hypot(b[0], b[1]) < 1e-3)
                continue;
            assert_true(hypot(a[0], a[1]) > 0.005);
            assert_true(a[0] * b[0] + a[1] * b[1] >
                        0.3 * hypot(a[0], a[1]) * hypot(b[0], b[1]));
        }
    }
    dither_free(&d);
}

/* VGA's 16 colours: 0 or 170, then 85 or 255. */
static void light_of_16(int n, double light[3])
{
    for (int c = 0; c < 3; c++)
        light[c] = light_of_srgb((n < 8 ? 0 : 85) + (n >> c & 1 ? 170 : 0));
}

/* Finds the mean light of a flat area, and the distance of the nearest colour
 * of the palette. */
static double mean_light(struct dither *d, struct rgb c, enum palette palette,
                         double seen[3])
{
    double wanted[3] = {light_of_srgb(c.r), light_of_srgb(c.g),
                        light_of_srgb(c.b)};
    double light[3], least = 1e9;
    int first = palette == PALETTE_256 ? 16 : 0;
    int last = palette == PALETTE_256 ? 255 : 15;

    memset(seen, 0, 3 * sizeof seen[0]);
    for (int k = 0; k < 16; k++) {
        uint32_t n = dither_color(d, c, k % 4, k / 4, palette);

        assert_in_range(n, first, last);
        (palette == PALETTE_256 ? light_of_256 : light_of_16)((int)n, light);
        for (int j = 0; j < 3; j++)
            seen[j] += light[j] / 16;
    }
    for (int n = first; n <= last; n++) {
        (palette == PALETTE_256 ? light_of_256 : light_of_16)(n, light);
        least = fmin(least, oklab_distance(light, wanted));
    }
    return least;
}

/* A flat area of any colour is closer to it than the nearest palette colour. */
static void flat_areas_come_closer(void **state)
{
    static const enum palette palettes[] = {PALETTE_256, PALETTE_16};
    struct dither d = make_dither();

    (void)state;
    for (int p = 0; p < 2; p++) {
        uint64_t seed = 1;
        double nearest = 0, mixed = 0;

        for (int i = 0; i < 1000; i++) {
            struct rgb c = {(int)(256 * check_random(&seed)),
                            (int)(256 * check_random(&seed)),
                            (int)(256 * check_random(&seed))};
            double wanted[3] = {light_of_srgb(c.r), light_of_srgb(c.g),
                                light_of_srgb(c.b)};
            double seen[3];

            nearest += mean_light(&d, c, palettes[p], seen);
            mixed += oklab_distance(seen, wanted);
        }
        check_at_most(mixed, 0.4 * nearest);
    }
    dither_free(&d);
}

/* Walls keep their tint: the mean of a flat area has a channel that differs by
 * at most 4 of 255 from that of the wall, and one of the greys 2. */
static void tints_stay(void **state)
{
    static const struct rgb walls[] = {{135, 124, 115}, {188, 180, 170},
                                       {120, 128, 135}, {200, 205, 195},
                                       {150, 120, 100}, {126, 126, 126}};
    struct dither d = make_dither();

    (void)state;
    for (size_t i = 0; i < sizeof walls / sizeof walls[0]; i++) {
        const int wall[3] = {walls[i].r, walls[i].g, walls[i].b};
        int allowed = wall[0] == wall[2] ? 2 : 4;
        double seen[3];

        mean_light(&d, walls[i], PALETTE_256, seen);
        for (int c = 0; c < 3; c++) {
            check_at_most(seen[c], light_of_srgb(wall[c] + allowed));
            check_at_most(light_of_srgb(wall[c] - allowed), seen[c]);
        }
    }
    dither_free(&d);
}

/* A cell of 16 colours can mix two of them in quarters: the mean is much nearer
 * than the nearest colour. Greys are mixed of greys alone. */
static void shades_come_closer(void **state)
{
    struct dither d = make_dither();
    uint64_t seed = 5;
    double nearest = 0, shaded = 0;

    (void)state;
    for (int i = 0; i < 1000; i++) {
        bool is_grey = i % 2;
        int grey = (int)(256 * check_random(&seed));
        struct rgb c = {is_grey ? grey : (int)(256 * check_random(&seed)), grey,
                        is_grey ? grey : (int)(256 * check_random(&seed))};
        double wanted[3] = {light_of_srgb(c.r), light_of_srgb(c.g),
                            light_of_srgb(c.b)};
        double seen[3], fg[3], bg[3];
        struct shade s;

        nearest += mean_light(&d, c, PALETTE_16, seen);
        s = dither_shade(&d, c);
        assert_true(s.fg < 16 && s.bg < 16);
        assert_in_range(s.quarters, 0, 3);
        light_of_16((int)s.fg, fg);
        light_of_16((int)s.bg, bg);
        for (int k = 0; k < 3; k++)
            seen[k] = bg[k] + (fg[k] - bg[k]) * s.quarters / 4;
        shaded += oklab_distance(seen, wanted);
        if (is_grey)
            check_close(seen[0], seen[2], 1e-9);
    }
    check_at_most(shaded, 0.5 * nearest);
    dither_free(&d);
}

/* The corners of the colour cube are exact, so black has no speckles. */
static void corners_stay_pure(void **state)
{
    struct dither d = make_dither();

    (void)state;
    for (int corner = 0; corner < 8; corner++) {
        int r = corner & 1, g = corner >> 1 & 1, b = corner >> 2;
        struct rgb c = {255 * r, 255 * g, 255 * b};

        for (int k = 0; k < 16; k++)
            assert_int_equal(dither_color(&d, c, k % 4, k / 4, PALETTE_256),
                             16 + 5 * (36 * r + 6 * g + b));
    }
    dither_free(&d);
}

/* The same picture gives the same cells, whatever was converted before. Noise
 * of one step in each channel changes few of them: less than twice as many as
 * with nearest colours, which have fewer borders. */
static void small_changes_change_little(void **state)
{
    struct dither d = make_dither();
    struct dither other = make_dither();
    uint64_t seed = 2;
    int moved = 0, moved_nearest = 0;

    (void)state;
    for (int i = 0; i < 4000; i++) {
        int x = i % 64, y = i / 64;
        int v[3], w[3];

        for (int c = 0; c < 3; c++) {
            v[c] = 1 + (int)(254 * check_random(&seed));
            w[c] = v[c] + (int)(3 * check_random(&seed)) - 1;
        }
        struct rgb a = {v[0], v[1], v[2]};
        struct rgb b = {w[0], w[1], w[2]};
        uint32_t before = dither_color(&d, a, x, y, PALETTE_256);

        moved += dither_color(&d, b, x, y, PALETTE_256) != before;
        moved_nearest += nearest_256(a) != nearest_256(b);
        assert_int_equal(dither_color(&d, a, x, y, PALETTE_256), before);
        assert_int_equal(dither_color(&other, a, x, y, PALETTE_256), before);
    }
    check_at_most(moved, 2 * moved_nearest);
    check_at_most(moved, 0.1 * 4000);
    dither_free(&other);
    dither_free(&d);
}

static void thresholds_are_spread(void **state)
{
    (void)state;
    for (int i = 0; i < 64; i++) {
        unsigned seen = 0;

        for (int k = 0; k < 16; k++)
            seen |= 1u << dither_threshold(i % 8 + k % 4, i / 8 + k / 4);
        assert_int_equal(seen, 0xffff);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_those_of_xterm),
        cmocka_unit_test(ramps_have_no_bands),
        cmocka_unit_test(hues_stay),
        cmocka_unit_test(flat_areas_come_closer),
        cmocka_unit_test(tints_stay),
        cmocka_unit_test(shades_come_closer),
        cmocka_unit_test(corners_stay_pure),
        cmocka_unit_test(small_changes_change_little),
        cmocka_unit_test(thresholds_are_spread),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
