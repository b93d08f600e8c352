// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <math.h>

#include "kernels/camera.h"
#include "kernels/rng.h"

#define FOCUS  2.5
#define RADIUS 0.125

/* The camera looks along -x with y up, 90 degrees over 100 pixels. */
static struct camera camera(void)
{
    struct camera c = {.eye = {0.3f, -0.2f, 0.1f},
                       .width = 150,
                       .height = 100,
                       .forward = {-1, 0, 0},
                       .right = {0, 0, -1.5f},
                       .up = {0, 1, 0},
                       .lens_radius = (float)RADIUS,
                       .focus = (float)FOCUS};

    return c;
}

/* Returns the point where the ray meets the plane at this distance from the
 * eye. */
static struct vec3 meet(struct camera c, struct ray r, double distance)
{
    double t = distance / (double)v3_dot(r.d, c.forward);

    return v3_add(r.o, v3_scale(r.d, (float)t));
}

static const uint32_t pixels[][2] = {{75, 50}, {0, 0}, {149, 70}, {10, 99}};

#define PIXEL_COUNT (sizeof pixels / sizeof *pixels)

/* By similar triangles, rays of a point of the film fill a disk of radius r |f
 * - D| / f at distance D around the pinhole's ray. They are uniform, so the
 * mean square of the radius is half the square of the greatest. */
static void blur_is_a_disk(void **state)
{
    const double distances[] = {0.5, 1.7, FOCUS, 4, 40};
    const int n = 20000;
    struct camera c = camera();

    (void)state;
    for (size_t p = 0; p < PIXEL_COUNT; p++)
        for (size_t k = 0; k < 5; k++) {
            double d = distances[k];
            double radius = RADIUS * fabs(FOCUS - d) / FOCUS;
            struct ray middle =
                camera_ray(c, pixels[p][0], pixels[p][1], v2(0.3f, 0.8f));
            struct vec3 center = meet(c, middle, d);
            double most = 0, squares = 0;
            struct vec3 sum = {0, 0, 0};

            for (int i = 0; i < n; i++) {
                struct vec2 u = random_2d(sampler_start(1, 2, (uint64_t)i, 3),
                                          DIMENSION_LENS);
                struct ray r = camera_through_lens(c, middle, u);
                struct vec3 off = v3_sub(meet(c, r, d), center);

                check_close(v3_length(r.d), 1, 1e-6);
                most = fmax(most, (double)v3_length(off));
                squares += (double)v3_dot(off, off) / n;
                sum = v3_add(sum, v3_scale(off, 1 / (float)n));
            }
            /* At 40 coordinates of 1e2 have the precision of floats. */
            check_close(most, radius, 2e-3 * radius + 1e-5);
            check_close(squares, radius * radius / 2,
                        5e-3 * radius * radius + 1e-9);
            check_at_most(v3_length(sum), 5e-3 * radius + 1e-5);
        }
}

/* Circle of confusion: a point at distance D appears at film points of tangent
 * s with |s - s0| <= r |1/f - 1/D|. The point is on the axis. A search finds
 * the pixel whose ray from a lens point l meets it. */
static void points_blur_into_circles(void **state)
{
    const double distances[] = {0.7, 1.5, 5, 100};
    struct camera c = camera();

    (void)state;
    for (size_t k = 0; k < 4; k++) {
        double truth = RADIUS * fabs(1 / FOCUS - 1 / distances[k]);
        double low = -1, high = 1;

        for (int i = 0; i < 40; i++) {
            double s = (low + high) / 2;
            /* The vertical tangent of a pixel's row is 1 - 2 y / height. */
            double y = (1 - s) / 2 * (double)c.height;
            struct ray r =
                camera_ray(c, 75, (uint32_t)y, v2(0, (float)(y - floor(y))));
            struct vec3 p;

            /* The top of the lens is u = (1/2, 1). */
            r = camera_through_lens(c, r, v2(0.5f, 1));
            p = meet(c, r, distances[k]);
            if (p.y > c.eye.y)
                high = s;
            else
                low = s;
        }
        check_close(fabs(low), truth, 1e-5);
    }
}

/* A ray through the middle of the lens is the pinhole's ray. */
static void middle_of_the_lens_is_a_pinhole(void **state)
{
    struct camera c = camera();

    (void)state;
    for (size_t p = 0; p < PIXEL_COUNT; p++) {
        struct ray a = camera_ray(c, pixels[p][0], pixels[p][1], v2(0, 0.5f));
        struct ray b = camera_through_lens(c, a, v2(0.5f, 0.5f));

        check_close(v3_length(v3_sub(a.o, b.o)), 0, 0);
        check_close(v3_length(v3_sub(a.d, b.d)), 0, 2e-7);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blur_is_a_disk),
        cmocka_unit_test(points_blur_into_circles),
        cmocka_unit_test(middle_of_the_lens_is_a_pinhole),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
