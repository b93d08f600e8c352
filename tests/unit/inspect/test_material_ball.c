// SPDX-License-Identifier: MIT
/*
 * test_material_ball.c - a ball that only glows has its radiance in every pixel
 * of its disc; white and lamps are exposed so that neither is a white disc;
 * smoke is lit; a change begins the picture anew; samples end
 */
#include <math.h>

#include "inspect/material_ball.h"
#include "scene/material.h"
#include "tests/unit/check.h"

static const struct world no_textures;

static struct material glowing(float radiance)
{
    struct material m = material_default();

    m.color = v3(0.0f, 0.0f, 0.0f);
    m.emission = v3(radiance, radiance, radiance);
    return m;
}

static void finish(struct material_ball *ball, const struct material *m)
{
    struct error err;
    bool is_new;
    int calls = 0;

    do {
        assert_true(material_ball_add(ball, &no_textures, 1, m, &is_new, &err));
        calls++;
    } while (!material_ball_is_done(ball));
    assert_in_range(calls, 2, BALL_SPP);
    assert_true(material_ball_add(ball, &no_textures, 1, m, &is_new, &err));
    assert_false(is_new);
    assert_int_equal(ball->spp, BALL_SPP);
}

static struct vec3 mean_at(const struct material_ball *ball, int x, int y)
{
    return v3_scale(ball->sums[y * BALL_PIXELS + x], 1.0f / (float)ball->spp);
}

static void glow_is_the_radiance(void **state)
{
    struct material_ball ball = {.kernel = NULL};
    struct material dim = glowing(0.25f), bright = glowing(2.0f);
    int inside = 0;

    (void)state;
    finish(&ball, &dim);
    for (int y = 0; y < BALL_PIXELS; y++) {
        for (int x = 0; x < BALL_PIXELS; x++) {
            double dx = x + .5 - BALL_PIXELS / 2.,
                   dy = y + .5 - BALL_PIXELS / 2.;

            if (hypot(dx, dy) > BALL_PIXELS / 3.)
                continue;
            inside++;
            check_close((double)mean_at(&ball, x, y).y, 0.25, 1e-5);
        }
    }
    assert_in_range(inside, 100, 576);
    finish(&ball, &bright);
    check_close((double)mean_at(&ball, 12, 12).x, 2, 1e-5);
    material_ball_free(&ball);
}

/* White and without loss, the ball is about as bright as the sky above it. */
static void white_is_brighter_than_black(void **state)
{
    struct material_ball ball = {.kernel = NULL};
    struct material white = material_default(), black = white;
    double light;

    (void)state;
    white.color = v3(1.0f, 1.0f, 1.0f);
    black.color = v3(0.0f, 0.0f, 0.0f);
    finish(&ball, &white);
    light = (double)mean_at(&ball, 12, 8).y;
    assert_true(light > 0.4 && light < 4);
    finish(&ball, &black);
    check_close((double)mean_at(&ball, 12, 8).y, 0, 1e-6);
    material_ball_free(&ball);
}

/* Returns the mean of green over the lower half of the picture. */
static double floor_light(const struct material *m)
{
    struct material_ball ball = {.kernel = NULL};
    double sum = 0;

    finish(&ball, m);
    for (int y = BALL_PIXELS / 2; y < BALL_PIXELS; y++)
        for (int x = 0; x < BALL_PIXELS; x++)
            sum += (double)mean_at(&ball, x, y).y;
    material_ball_free(&ball);
    return sum / (BALL_PIXELS * BALL_PIXELS / 2.);
}

/* A ball of hardly any smoke lets the light of the sky through, as none does,
 * and one of much smoke does not. */
static void smoke_is_lit(void **state)
{
    struct material none = material_default(), smoke = none;
    double light;

    (void)state;
    none.opacity = 0.0f;
    smoke.kind = MATERIAL_GLASS;
    smoke.color = v3(1.0f, 1.0f, 1.0f);
    smoke.ior = 1.0f;
    smoke.is_boundary = 1;
    smoke.medium.extinction = v3(1e-6f, 1e-6f, 1e-6f);
    light = floor_light(&none);
    check_close(floor_light(&smoke), light, 0.03 * light);
    smoke.medium.extinction = v3(1e3f, 1e3f, 1e3f);
    assert_true(floor_light(&smoke) < 0.7 * light);
}

/* Least and largest green of the painted disc. */
struct range {
    int least, most;
};

static struct range painted(struct material_ball *ball,
                            const struct material *m, struct frame *frame)
{
    struct range r = {255, 0};

    finish(ball, m);
    material_ball_paint(ball, frame);
    for (int y = 0; y < BALL_PIXELS; y++)
        for (int x = 0; x < BALL_PIXELS; x++) {
            int green = frame->rgb[3 * (y * BALL_PIXELS + x) + 1];

            if (hypot(x + .5 - BALL_PIXELS / 2., y + .5 - BALL_PIXELS / 2.) >
                BALL_PIXELS / 3.)
                continue;
            r.least = green < r.least ? green : r.least;
            r.most = green > r.most ? green : r.most;
        }
    return r;
}

static double linear_of(uint8_t srgb)
{
    return pow((srgb / 255. + 0.055) / 1.055, 2.4);
}

/* A white ball is light grey to white and nowhere as white as can be; half the
 * albedo is darker. The painted disc of a lamp has the ratios of its emission.
 */
static void white_and_lamps_are_exposed(void **state)
{
    struct material_ball ball = {.kernel = NULL};
    struct material white = material_default(), grey = white, lamp = white;
    struct frame frame;
    struct range of_white, of_grey;
    struct error err;
    const uint8_t *middle;

    (void)state;
    assert_true(frame_init(&frame, BALL_PIXELS, BALL_PIXELS, &err));
    white.color = v3(1.0f, 1.0f, 1.0f);
    grey.color = v3(0.5f, 0.5f, 0.5f);
    of_white = painted(&ball, &white, &frame);
    assert_in_range(of_white.most, 220, 254);
    assert_true(of_white.most - of_white.least > 60);
    of_grey = painted(&ball, &grey, &frame);
    assert_true(of_grey.most < of_white.most - 40);
    lamp.color = v3(0.0f, 0.0f, 0.0f);
    lamp.emission = v3(1700.0f, 1200.0f, 400.0f);
    assert_in_range(painted(&ball, &lamp, &frame).most, 200, 254);
    middle = frame.rgb + 3 * (12 * BALL_PIXELS + 12);
    check_close(linear_of(middle[1]) / linear_of(middle[0]), 12 / 17., 0.02);
    check_close(linear_of(middle[2]) / linear_of(middle[0]), 4 / 17., 0.02);
    frame_free(&frame);
    material_ball_free(&ball);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(glow_is_the_radiance),
        cmocka_unit_test(white_is_brighter_than_black),
        cmocka_unit_test(white_and_lamps_are_exposed),
        cmocka_unit_test(smoke_is_lit),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
