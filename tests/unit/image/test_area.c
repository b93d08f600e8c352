// SPDX-License-Identifier: MIT
/*
 * test_area.c - the screen shows box averages, in linear light, of the pixels
 * that a file has
 */
#include <math.h>
#include <stdlib.h>

#include "tests/unit/check.h"

#include "base/clock.h"
#include "image/color.h"
#include "image/frame.h"
#include "session/session.h"
#include "terminal/cells.h"

#define WIDTH  150
#define HEIGHT 86

/* Returns the overlap of [i, i + 1) / n with [k, k + 1) / m. */
static double shared(int i, int n, int k, int m)
{
    double begin = fmax((double)i / n, (double)k / m);
    double end = fmin((double)(i + 1) / n, (double)(k + 1) / m);

    return fmax(end - begin, 0);
}

/* For any two grids the walk meets each pair of overlapping cells once and in
 * order, with the length that they share, and no other pair. */
static void walks_cover_the_axis(void **state)
{
    uint64_t seed = 5;

    (void)state;
    for (int round = 0; round < 3000; round++) {
        int from = 1 + (int)(60 * check_random(&seed));
        int to = 1 + (int)(60 * check_random(&seed));
        int first = (int)(to * check_random(&seed));
        int count = 1 + (int)((to - first) * check_random(&seed));
        struct area_walk w = area_walk(from, to, first, count);

        for (int k = first; k < first + count; k++)
            for (int i = 0; i < from; i++) {
                double length = shared(i, from, k, to);

                if (length < 1e-9)
                    continue;
                assert_true(area_walks(&w));
                assert_int_equal(w.from, i);
                assert_int_equal(w.to, k);
                check_close((double)area_step(&w), length * from * to, 1e-3);
            }
        assert_false(area_walks(&w));
    }
}

/* Returns the byte for a channel's mean, in linear light, over the pixels of
 * the picture under pixel (x, y) of a frame, weighted by area. */
static double box_average(const struct frame *picture,
                          const struct frame *frame, int x, int y, int c)
{
    int x0 = x * picture->width / frame->width;
    int y0 = y * picture->height / frame->height;
    double sum = 0, area = 1.0 / frame->width / frame->height, height, width;

    for (int j = y0; j < picture->height; j++) {
        height = shared(j, picture->height, y, frame->height);
        if (j > y0 && height <= 0)
            break;
        for (int i = x0; i < picture->width; i++) {
            int at = 3 * (j * picture->width + i) + c;

            width = shared(i, picture->width, x, frame->width);
            if (i > x0 && width <= 0)
                break;
            sum += height * width * color_decoded(picture->rgb[at] / 255.0);
        }
    }
    return round(255 * color_encoded(sum / area));
}

static void check_frame(struct film *film, const struct frame *picture,
                        struct develop how, int width, int height)
{
    struct frame frame;
    struct error err;

    assert_true(frame_init(&frame, width, height, &err));
    film_preview(film, NULL, how, &frame);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++)
                check_close(frame.rgb[3 * (y * width + x) + c],
                            box_average(picture, &frame, x, y, c), 1);
    frame_free(&frame);
}

/* Tests cells of each kind, in terminals smaller and larger than the
 * picture. */
static void check_terminals(struct film *film, struct develop how)
{
    static const enum glyphs kinds[] = {GLYPHS_HALF, GLYPHS_BLOCK,
                                        GLYPHS_SPACE};
    static const struct {
        int cols, rows;
    } sizes[] = {{1, 1}, {41, 13}, {80, 23}, {119, 39}, {203, 61}};
    struct frame picture;
    struct error err;

    assert_true(frame_init(&picture, film->width, film->height, &err));
    film_resolve(film, how, &picture);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
            struct glyph_grid grid = glyphs_grid(kinds[k]);
            struct cells_rect fit = cells_fit(film->width, film->height,
                                              sizes[i].cols, sizes[i].rows, 2);

            check_frame(film, &picture, how, fit.cols * grid.across,
                        fit.rows * grid.down);
        }
    frame_free(&picture);
}

static void screens_are_the_average_of_files(void **state)
{
    static const char *const names[] = {"cornell",   "glass_mirror", "interior",
                                        "lights200", "materials",    "skylit"};

    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        static struct session s;
        char path[64];
        struct options options;
        struct error err;

        if (!check_is_due(2))
            continue;
        snprintf(path, sizeof path, "scenes/%s.obj", names[i]);
        options_init(&options);
        options.scene_path = path;
        options.width_px = WIDTH;
        options.height_px = HEIGHT;
        options.thread_count = 2;
        check_or_say(session_open(&s, &options, clock_ns(), &err), err.text);
        check_or_say(session_restart(&s, (struct render_limits){.spp = 2},
                                     &err),
                     err.text);
        assert_true(render_wait(s.engine.render, 60000));
        for (uint32_t tone = 0; tone < TONES; tone++)
            check_terminals(render_film(s.engine.render),
                            (struct develop){0.5f, tone});
        session_close(&s);
    }
}

/* Black and white pixels alternate; a few are far brighter than white. */
static void sums_of_noise(void **state)
{
    struct film film;
    struct error err;
    uint64_t seed = 1;

    (void)state;
    assert_true(film_init(&film, 37, 23, &err));
    for (int i = 0; i < 37 * 23; i++) {
        float light = (float)exp(20 * check_random(&seed) - 10);
        struct path_sample sample = {.radiance = {light, 1 / light, 0.01f}};

        film_add_row(&film, (struct film_pixels){i % 37, i / 37, 1, 1}, &sample,
                     NULL, &(int){1});
    }
    for (uint32_t tone = 0; tone < TONES; tone++)
        check_terminals(&film, (struct develop){-1, tone});
    film_free(&film);
}

/* Each byte of a scaled frame is the mean over its area. */
static void scaled_frames_are_means(void **state)
{
    static const struct {
        int width, height;
    } sizes[] = {{1, 1}, {12, 9}, {37, 23}, {80, 11}};
    struct frame from, to;
    struct error err;
    uint64_t seed = 3;

    (void)state;
    assert_true(frame_init(&from, 37, 23, &err));
    for (int i = 0; i < 3 * 37 * 23; i++)
        from.rgb[i] = (uint8_t)(256 * check_random(&seed));
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
        assert_true(frame_init(&to, sizes[k].width, sizes[k].height, &err));
        frame_scale(&from, &to);
        for (int i = 0; i < 3 * to.width * to.height; i++) {
            int x = i / 3 % to.width, y = i / 3 / to.width;
            double sum = 0;

            for (int j = 0; j < 37 * 23; j++)
                sum += shared(j % 37, 37, x, to.width) *
                       shared(j / 37, 23, y, to.height) *
                       from.rgb[3 * j + i % 3];
            check_close(to.rgb[i], sum * to.width * to.height, 0.51);
        }
        frame_free(&to);
    }
    frame_free(&from);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(walks_cover_the_axis),
        cmocka_unit_test(sums_of_noise),
        cmocka_unit_test(scaled_frames_are_means),
        cmocka_unit_test(screens_are_the_average_of_files),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
