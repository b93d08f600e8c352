// SPDX-License-Identifier: MIT
/*
 * test_overlay.c - lines on frames, points of the scene on pixels, boxes of a
 * tree, colours for numbers
 */
#include "tests/unit/check.h"
#include "tests/unit/mesh.h"

#include <math.h>

#include "image/frame.h"
#include "inspect/false_color.h"
#include "inspect/overlay.h"
#include "render/projection.h"
#include "kernels/camera.h"

#define SIDE 40

static void open_frame(struct frame *f)
{
    struct error err;

    check_or_say(frame_init(f, SIDE, SIDE, &err), err.text);
}

static uint32_t pixel(const struct frame *f, int x, int y)
{
    const uint8_t *p = f->rgb + 3 * (y * f->width + x);

    return (uint32_t)p[0] << 16 | (uint32_t)p[1] << 8 | p[2];
}

static int count(const struct frame *f, uint32_t rgb)
{
    int n = 0;

    for (int i = 0; i < f->width * f->height; i++)
        n += pixel(f, i % f->width, i / f->width) == rgb;
    return n;
}

/* Draws random lines that also leave the frame. All pixels are within one of
 * the true line, and none is missing along its longer direction. */
static void lines_are_drawn_without_gaps(void **state)
{
    uint64_t seed = 4;

    (void)state;
    for (int n = 0; n < 300; n++) {
        double p[4];
        double dx, dy;
        struct frame f;
        int columns[2][SIDE] = {{0}};

        open_frame(&f);
        for (int i = 0; i < 4; i++)
            p[i] = SIDE * (3 * check_random(&seed) - 1);
        dx = p[2] - p[0];
        dy = p[3] - p[1];
        frame_line(&f, p[0], p[1], p[2], p[3], 0x123456);
        for (int y = 0; y < SIDE; y++) {
            for (int x = 0; x < SIDE; x++) {
                double ax = x + 0.5 - p[0], ay = y + 0.5 - p[1];

                if (pixel(&f, x, y) == 0)
                    continue;
                assert_int_equal(pixel(&f, x, y), 0x123456);
                check_at_most(fabs(ax * dy - ay * dx) / hypot(dx, dy), 1);
                columns[0][x] = columns[1][y] = 1;
            }
        }
        for (int i = 0; i < SIDE; i++) {
            /* This is where the line crosses the middle of column (or row)
             * i. */
            int steep = fabs(dy) > fabs(dx);
            double t = (i + 0.5 - p[steep]) / (steep ? dy : dx);
            double at = p[!steep] + t * (steep ? dx : dy);

            if (t >= 0 && t <= 1 && at >= 1 && at < SIDE - 1)
                assert_int_equal(columns[steep][i], 1);
        }
        frame_free(&f);
    }
}

static void far_lines_take_little_time(void **state)
{
    struct frame f;

    (void)state;
    open_frame(&f);
    frame_line(&f, -1e12, 5.5, 1e12, 5.5, 0xffffff);
    assert_int_equal(count(&f, 0xffffff), SIDE);
    for (int x = 0; x < SIDE; x++)
        assert_int_equal(pixel(&f, x, 5), 0xffffff);
    frame_line(&f, -5, -1, 60, -1, 0xff);
    frame_line(&f, (double)NAN, 1, 3, 4, 0xff);
    assert_int_equal(count(&f, 0xff), 0);
    frame_line(&f, 7.5, 8.5, 7.5, 8.5, 0xff00);
    assert_int_equal(count(&f, 0xff00), 1);
    assert_int_equal(pixel(&f, 7, 8), 0xff00);
    frame_free(&f);
    assert_int_equal(frame_dim(0x204080, 0.5), 0x102040);
    assert_int_equal(frame_dim(0x204080, 1), 0x204080);
}

static struct camera some_camera(uint64_t *seed)
{
    struct vec3 n = v3_unit(v3((float)check_random(seed) - 0.5f,
                               (float)check_random(seed) - 0.5f,
                               (float)check_random(seed) + 0.1f));
    struct camera c = {.eye = {0.3f, 0.2f, -1}, .width = 64, .height = 36};

    c.forward = n;
    frame_around(n, &c.right, &c.up);
    c.right = v3_scale(c.right, 0.8f);
    c.up = v3_scale(c.up, 0.45f);
    c.left = 3.25f;
    c.top = 1.5f;
    return c;
}

/* camera_ray() gives the rays. Points along a ray are projected into its
 * pixel. */
static void projection_inverts_the_camera_ray(void **state)
{
    uint64_t seed = 1;

    (void)state;
    for (int i = 0; i < 1000; i++) {
        struct camera c = some_camera(&seed);
        uint32_t x = (uint32_t)(64 * check_random(&seed));
        uint32_t y = (uint32_t)(36 * check_random(&seed));
        struct vec2 offset = {(float)check_random(&seed),
                              (float)check_random(&seed)};
        struct ray r = camera_ray(c, x, y, offset);
        float t = 0.1f + 3 * (float)check_random(&seed);
        struct projected at;

        assert_true(projection_point(&c, v3_add(r.o, v3_scale(r.d, t)), &at));
        check_close(at.x, x + (double)offset.x, 2e-3);
        check_close(at.y, y + (double)offset.y, 2e-3);
        check_close(at.depth, (double)(t * v3_dot(r.d, c.forward)), 1e-5);
        assert_false(projection_point(&c, v3_sub(r.o, v3_scale(r.d, t)), &at));
    }
}

/* A line crosses the plane of the eye. Its visible part is on the projected
 * line. */
static void lines_end_before_the_eye(void **state)
{
    struct camera c = {.width = 2,
                       .height = 2,
                       .forward = {0, 0, -1},
                       .right = {1, 0, 0},
                       .up = {0, 1, 0}};
    struct projected p[2];

    (void)state;
    assert_false(projection_line(&c, v3(0, 0, 1), v3(1, 0, 2), p));
    assert_true(projection_line(&c, v3(1, 1, -1), v3(1, 1, 3), p));
    check_close(p[0].x, 2, 1e-6);
    check_close(p[0].y, 0, 1e-6);
    assert_true(p[1].depth > 0);
    /* x = y all along, also for the pixels, which are far outside. */
    assert_true(p[1].x > 1000);
    check_close(p[1].x - 1, 1 - p[1].y, 1e-3 * p[1].x);
}

/* A crop with other pixels shows the same rays. */
static void crops_show_the_same(void **state)
{
    uint64_t seed = 8;
    struct camera c = some_camera(&seed);
    struct projection_part part = {10, 4, 40, 30, 20, 15};
    struct camera shown = projection_camera(&c, &part);

    (void)state;
    for (uint32_t i = 0; i < 20 * 15; i++) {
        uint32_t x = i % 20, y = i / 20;
        struct ray a = camera_ray(shown, x, y, v2(0.5f, 0.5f));
        struct ray b = camera_ray(c, 10 + 2 * x + 1, 4 + 2 * y + 1, v2(0, 0));

        check_at_most((double)v3_length(v3_sub(a.d, b.d)), 1e-6);
    }
}

/* Adds a wall of squares from (x, -1) to (x + 1, 1). */
static void add_wall(struct mesh *m, float x)
{
    const float width = 1.0f / 16, height = 2.0f / 16;

    for (int i = 0; i < 16 * 16; i++) {
        float left = x + (float)(i % 16) * width;
        float low = -1.0f + (float)(i / 16) * height;

        mesh_add_quad(m, v3(left, low, 0), v3(left + width, low, 0),
                      v3(left + width, low + height, 0),
                      v3(left, low + height, 0), 0);
    }
}

/* No box has triangles of two walls that are far apart. */
static void levels_of_a_tree_have_their_boxes(void **state)
{
    struct camera c = {.eye = {0, 0, 4},
                       .width = SIDE,
                       .forward = {0, 0, -1},
                       .height = SIDE,
                       .right = {1, 0, 0},
                       .up = {0, 1, 0}};
    struct mesh m = {0};
    struct frame f;

    (void)state;
    add_wall(&m, -2);
    add_wall(&m, 1);
    mesh_finish(&m);
    open_frame(&f);
    for (uint32_t level = 0; level < overlay_levels(&m.world); level++) {
        uint32_t boxes = overlay_boxes(&f, &c, &m.world, level);

        assert_in_range(boxes, 2, level == 0 ? 8 : 2 * 2 * 16 * 16);
        /* no box is between the grids, and x = -1 is pixel 15, x = 1 is 25 */
        for (int y = 0; y < SIDE; y++)
            assert_int_equal(pixel(&f, 20, y), 0);
        assert_true(pixel(&f, 14, 20) != 0 || pixel(&f, 15, 20) != 0);
        assert_true(pixel(&f, 25, 20) != 0 || pixel(&f, 24, 20) != 0);
        memset(f.rgb, 0, 3 * SIDE * SIDE);
    }
    assert_true(overlay_levels(&m.world) >= 2);
    assert_int_equal(overlay_boxes(&f, &c, &m.world, overlay_levels(&m.world)),
                     0);
    frame_free(&f);
    mesh_free(&m);
}

static double distance(uint32_t a, uint32_t b)
{
    double sum = 0;

    for (int shift = 0; shift <= 16; shift += 8) {
        double d = (int)(a >> shift & 255) - (int)(b >> shift & 255);

        sum += d * d;
    }
    return sqrt(sum);
}

static double brightness(uint32_t rgb)
{
    return 0.2126 * (rgb >> 16) + 0.7152 * (rgb >> 8 & 255) +
           0.0722 * (rgb & 255);
}

static void colours_distinguish_numbers(void **state)
{
    struct number_range r = number_range_of((float[]){0, 4, 9, 2, 0}, 5, 1);
    double before = -1;

    (void)state;
    assert_true(r.lo == 2 && r.hi == 9);
    r = number_range_of((float[]){5, 0, 7, 0}, 2, 2);
    assert_true(r.lo == 5 && r.hi == 7);
    assert_int_equal(false_color(SAMPLE_DEPTH, (float[3]){5}, r), 0xffffff);
    assert_int_equal(false_color(SAMPLE_DEPTH, (float[3]){7}, r), 0x262626);
    assert_int_equal(false_color(SAMPLE_DEPTH, (float[3]){0}, r), 0);
    assert_int_equal(false_color(SAMPLE_NORMAL, (float[3]){1, 0.5f, 0}, r),
                     0xff8000);
    assert_int_equal(false_color(SAMPLE_UV, (float[3]){1, 0, 1}, r), 0xff0000);
    assert_int_equal(false_color(SAMPLE_UV, (float[3]){0}, r), 0x404040);
    for (int i = 0; i <= 100; i++) {
        double now = brightness(false_color_heat((float)i * 0.01f));

        assert_true(now > before);
        before = now;
    }
    assert_int_equal(false_color_heat(0), 0);
    assert_int_equal(false_color_heat(1), 0xffffff);
    for (int i = 0; i < 24; i++) {
        uint32_t a = false_color(SAMPLE_MATERIAL, (float[3]){(float)i}, r);

        for (int k = 0; k < i; k++)
            check_at_most(20,
                          distance(a, false_color(SAMPLE_MATERIAL,
                                                  (float[3]){(float)k}, r)));
    }
}

/* Draws a path from left to right behind a wall in the right half, and counts
 * the pixels of each half. */
static void count_path(const struct world *w, const struct camera *camera,
                       int halves[2])
{
    struct path_record path = {.count = 1};
    struct frame frame;
    struct error err;

    path.steps[0] = (struct path_record_step){.from = {-0.9f, 0, 0},
                                              .to = {0.9f, 0, 0},
                                              .way = PATH_RECORD_SKY};
    assert_true(frame_init(&frame, 100, 100, &err));
    memset(frame.rgb, 0, 30000);
    overlay_path(&frame, camera, w, &path, 1);
    halves[0] = halves[1] = 0;
    for (int i = 0; i < 10000; i++)
        halves[i % 100 / 50] += frame.rgb[3 * i] > 0;
    frame_free(&frame);
}

static void hidden_paths_are_dashed(void **state)
{
    struct mesh m = {.tri_count = 0};
    struct camera camera = {.eye = {0, 0, 4},
                            .forward = {0, 0, -1},
                            .right = {0.25f, 0, 0},
                            .up = {0, 0.25f, 0},
                            .width = 100,
                            .height = 100,
                            .focus = 1};
    int open[2], hidden[2];

    (void)state;
    mesh_add_quad(&m, v3(0, -1, 1), v3(2, -1, 1), v3(2, 1, 1), v3(0, 1, 1), 0);
    mesh_finish(&m);
    count_path(NULL, &camera, open);
    count_path(&m.world, &camera, hidden);
    assert_in_range(open[0], 44, 46);
    assert_in_range(open[1], 44, 46);
    assert_int_equal(hidden[0], open[0]);
    /* pieces of three pixels and one, since ends are drawn */
    assert_in_range(hidden[1], open[1] / 2, 3 * open[1] / 4);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hidden_paths_are_dashed),
        cmocka_unit_test(lines_are_drawn_without_gaps),
        cmocka_unit_test(far_lines_take_little_time),
        cmocka_unit_test(projection_inverts_the_camera_ray),
        cmocka_unit_test(lines_end_before_the_eye),
        cmocka_unit_test(crops_show_the_same),
        cmocka_unit_test(levels_of_a_tree_have_their_boxes),
        cmocka_unit_test(colours_distinguish_numbers),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
