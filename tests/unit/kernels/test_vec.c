// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"

#include <math.h>

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

static void nearly_unit_vectors_become_unit(void **state)
{
    uint64_t seed = 2;

    (void)state;
    for (int i = 0; i < 100000; i++) {
        struct vec3 a = v3((float)(check_random(&seed) - 0.5),
                           (float)(check_random(&seed) - 0.5),
                           (float)(check_random(&seed) - 0.5));
        float off = (float)(2e-4 * (check_random(&seed) - 0.5));
        struct vec3 b = v3_unit_again(v3_scale(v3_unit(a), 1.0f + off));
        double square = (double)b.x * (double)b.x + (double)b.y * (double)b.y +
                        (double)b.z * (double)b.z;

        check_close(sqrt(square), 1, 3e-7);
        check_close(v3_length(v3_cross(v3_unit(a), b)), 0, 1e-6);
    }
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
        cmocka_unit_test(nearly_unit_vectors_become_unit),
        cmocka_unit_test(hemisphere_has_cosine_moments),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
