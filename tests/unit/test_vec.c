// SPDX-License-Identifier: MIT
#include "check.h"

#include <math.h>

#include "kernels/rng.h"
#include "kernels/sample.h"
#include "kernels/vec.h"

static void angles_agree_with_libm(void **state)
{
    double worst_sin = 0, worst_atan = 0;

    (void)state;
    for (int i = 0; i <= 1000000; i++) {
        float u = (float)i * 1e-6f;
        struct vec2 cs = cos_sin_turns(u);
        double a = 2 * M_PI * (double)u;

        worst_sin = fmax(worst_sin, fabs((double)cs.x - cos(a)));
        worst_sin = fmax(worst_sin, fabs((double)cs.y - sin(a)));
        double radius = pow(10.0, 4.0 * (double)u - 2.0);
        float x = (float)(radius * cos(37 * a));
        float y = (float)(radius * sin(37 * a));
        worst_atan = fmax(worst_atan, fabs((double)atan2_rad(y, x) -
                                           atan2((double)y, (double)x)));
    }
    check_at_most(worst_sin, 3e-7);
    check_at_most(worst_atan, 6e-7);
    check_close(atan2_rad(0.0f, 0.0f), 0, 0);
    check_close(atan2_rad(0.0f, -1.0f), M_PI, 2e-7);
    check_close(atan2_rad(-1.0f, 0.0f), -M_PI / 2, 2e-7);
}

static void frames_are_orthonormal(void **state)
{
    uint64_t seed = 1;

    (void)state;
    for (int i = 0; i < 100000; i++) {
        struct vec3 n = v3((float)(check_random(&seed) - 0.5),
                           (float)(check_random(&seed) - 0.5),
                           (float)(check_random(&seed) - 0.5));
        struct vec3 t, b, c;

        n = i == 0 ? v3(0, 0, -1) : i == 1 ? v3(0, 0, 1) : v3_unit(n);
        frame_around(n, &t, &b);
        c = v3_cross(t, b);
        check_close(v3_dot(t, t), 1, 2e-6);
        check_close(v3_dot(b, b), 1, 2e-6);
        check_close(v3_dot(t, n), 0, 1e-6);
        check_close(v3_dot(c, n), 1, 2e-6);
    }
}

static void steps_are_nextafter(void **state)
{
    const float values[] = {0.0f, 1.0f, -1.0f, 1e-45f, -1e-45f, 3e38f, -2.5f};

    (void)state;
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        assert_true(float_step(values[i], true) ==
                    nextafterf(values[i], INFINITY));
        assert_true(float_step(values[i], false) ==
                    nextafterf(values[i], -INFINITY));
    }
}

/* STRESS C9: no bits give 1. */
static void unit_floats_stay_below_one(void **state)
{
    (void)state;
    assert_true(unit_float(0) == 0.0f);
    for (uint32_t i = 0; i < 1u << 20; i++)
        assert_true(unit_float(0xffffffffu - i) < 1.0f);
}

/* STRESS C7: neighbours of any kind are uncorrelated. 1/sqrt(n) is one
 * standard error; 5 of them happen once in 2e6 by chance, 12 are tried. */
static void numbers_are_uncorrelated(void **state)
{
    const int n = 200000;
    double sums[6] = {0};
    double mean = 0;

    (void)state;
    for (int i = 0; i < n; i++) {
        uint32_t x = (uint32_t)i % 640, y = (uint32_t)i / 640;
        struct sampler s = sampler_start(x, y, 7, 0);
        struct vec2 a = random_2d(s, 10);
        struct vec2 others[5] = {random_2d(sampler_start(x + 1, y, 7, 0), 10),
                                 random_2d(sampler_start(x, y + 1, 7, 0), 10),
                                 random_2d(sampler_start(x, y, 8, 0), 10),
                                 random_2d(s, 11),
                                 random_2d(sampler_start(x, y, 7, 1), 10)};

        mean += (double)a.x - 0.5;
        sums[5] += 12 * ((double)a.x - 0.5) * ((double)a.y - 0.5);
        for (int k = 0; k < 5; k++)
            sums[k] += 12 * ((double)a.x - 0.5) * ((double)others[k].x - 0.5);
    }
    check_close(mean / n, 0, 5 / sqrt(12.0 * n));
    for (int k = 0; k < 6; k++)
        check_close(sums[k] / n, 0, 5 / sqrt((double)n));
}

/* STRESS C8: the index is 64 bits wide, the seed 32. */
static void far_indices_and_seeds_differ(void **state)
{
    struct sampler s = sampler_start(3, 4, 5, 0);

    (void)state;
    assert_true(random_bits(s, 9) !=
                random_bits(sampler_start(3, 4, 5 + (1ull << 32), 0), 9));
    assert_true(random_bits(s, 9) !=
                random_bits(sampler_start(3, 4, 5, 0xffffffffu), 9));
    assert_true(random_bits(sampler_start(0, 0, 0, 0), 0) != 0);
}

/* Moments of the cosine distribution: E z = 2/3, E z^2 = 1/2, E x^2 = 1/4. */
static void hemisphere_has_cosine_moments(void **state)
{
    double z = 0, zz = 0, xx = 0, yy = 0;
    const int side = 1000;

    (void)state;
    for (int i = 0; i < side * side; i++) {
        struct vec2 u = v2((float)((i % side + 0.5) / side),
                           (float)((i / side + 0.5) / side));
        struct vec3 d = cosine_hemisphere(u);

        check_close(v3_dot(d, d), 1, 1e-6);
        z += (double)d.z;
        zz += (double)d.z * (double)d.z;
        xx += (double)d.x * (double)d.x;
        yy += (double)d.y * (double)d.y;
    }
    check_close(z / (side * side), 2.0 / 3, 1e-4);
    check_close(zz / (side * side), 0.5, 1e-4);
    check_close(xx / (side * side), 0.25, 1e-4);
    check_close(yy / (side * side), 0.25, 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(angles_agree_with_libm),
        cmocka_unit_test(frames_are_orthonormal),
        cmocka_unit_test(steps_are_nextafter),
        cmocka_unit_test(unit_floats_stay_below_one),
        cmocka_unit_test(numbers_are_uncorrelated),
        cmocka_unit_test(far_indices_and_seeds_differ),
        cmocka_unit_test(hemisphere_has_cosine_moments),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
