// SPDX-License-Identifier: MIT
/* test_bump_maps.c - maps of heights and normals turn the surface and its coat
 */
#include <math.h>

#include "tests/unit/mapped.h"

static const struct vec3 up = {0, 0, 1};

static struct vec3 bumped(const struct loaded *l, float u, float v,
                          struct vec3 wo)
{
    struct uv_pair uv = {{u, v}, {u, v}};

    return bumped_normal(&l->world, &l->material,
                         &(struct bump_place){l->scene.tris[0], NO_INDEX,
                                              (struct hit){.b0 = 1}, uv, up,
                                              wo},
                         up);
}

static void check_direction(struct vec3 n, double x, double y, double z)
{
    double length = sqrt(x * x + y * y + z * z);

    check_close((double)n.x, x / length, 1e-5);
    check_close((double)n.y, y / length, 1e-5);
    check_close((double)n.z, z / length, 1e-5);
}

/* Decoding is linear: 0 is -1 and 255 is 1. */
static void normal_maps_turn_the_normal(void **state)
{
    const uint8_t tilted[3] = {170, 102, 221};
    struct loaded l;

    (void)state;
    write_image("two.tga", 1, 1, 3, tilted);
    load(&l, "Kd 1\nnorm two.tga");
    check_direction(bumped(&l, 0.5f, 0.5f, up), 85. / 255, -51. / 255,
                    187. / 255);
    /* Half of its strength is half way to the normal of the face. */
    l.material.normal_strength = l.material.normal_depth = 0.5f;
    check_direction(bumped(&l, 0.5f, 0.5f, up), 85. / 255, -51. / 255,
                    187. / 255 + 1);
    l.material.normal_strength = l.material.normal_depth = 1;
    /* If u increases to the left, x is reversed. */
    l.scene.uvs[1].x = -1;
    check_direction(bumped(&l, 0.5f, 0.5f, up), -85. / 255, -51. / 255,
                    187. / 255);
    unload(&l);
}

/* A map of normals bends the surface below a coat, and that of the coat the
 * coat alone. */
static void coats_have_normals_of_their_own(void **state)
{
    static const char *const statements[] = {
        "Kd 1\nPc 1\nnorm two.tga", "Kd 1\nPc 1\nmap_Pc_norm -bm 1.5 two.tga",
        "Kd 1\nPc 1\nnorm two.tga\nmap_Pc_norm two.tga"};
    const double x[3][2] = {{1, 0}, {0, 1.5}, {1, 1}};
    const uint8_t tilted[3] = {170, 102, 221};
    struct loaded plain;

    (void)state;
    write_image("two.tga", 1, 1, 3, tilted);
    for (int i = 0; i < 3; i++) {
        struct ray r = {.o = {0.2f, 0.2f, 1}, .d = {0, 0, -1}};
        struct surface_point v;
        struct loaded l;
        struct bsdf b;

        load(&l, statements[i]);
        assert_int_not_equal(l.world.settings.features & FEATURE_COAT_NORMALS,
                             0);
        assert_true(surface_at(&l.world, &l.material, r,
                               (struct hit){.t = 1, .b0 = 1}, &v));
        b = bsdf_at(&l.world, &l.material, &v);
        check_direction(v.n, x[i][0] * 85, x[i][0] * -51,
                        x[i][0] > 0 ? 187 : 1);
        check_direction(v.coat_n, x[i][1] * 85, x[i][1] * -51,
                        x[i][1] > 0 ? 187 : 1);
        check_close((double)v3_length(
                        v3_sub(surface_to_world(&v, b.coat_normal), v.coat_n)),
                    0, 1e-6);
        unload(&l);
    }
    load(&plain, "Kd 1\nPc 1");
    assert_int_equal(plain.world.settings.features & FEATURE_COAT_NORMALS, 0);
    unload(&plain);
}

/* With tangents of vertices, x of the map is along them, and y along the normal
 * times the tangent, times its sign. From behind only z is reversed. */
static void normal_maps_use_tangents(void **state)
{
    static const struct vec3 normals[3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    static const struct tangent tangents[3] = {{{0, 1, 0}, -1},
                                               {{0, 1, 0}, -1},
                                               {{0, 1, 0}, -1}};
    static const struct vec3 down = {0, 0, -1};
    const uint8_t tilted[3] = {170, 102, 221};
    struct uv_pair uv = {{0.5f, 0.5f}, {0.5f, 0.5f}};
    struct hit h = {.b0 = 1};
    struct loaded l;
    struct tri t;

    (void)state;
    write_image("two.tga", 1, 1, 3, tilted);
    load(&l, "Kd 1\nnorm two.tga");
    l.world.normals = normals;
    l.world.tangents = tangents;
    l.world.settings.tangent_count = 3;
    t = l.scene.tris[0];
    for (uint32_t k = 0; k < 3; k++)
        t.vn[k] = k;
    check_direction(
        bumped_normal(&l.world, &l.material,
                      &(struct bump_place){t, NO_INDEX, h, uv, up, up}, up),
        -51. / 255, 85. / 255, 187. / 255);
    check_direction(bumped_normal(&l.world, &l.material,
                                  &(struct bump_place){t, NO_INDEX, h, uv, down,
                                                       down},
                                  down),
                    -51. / 255, 85. / 255, -187. / 255);
    unload(&l);
}

/* A ramp of 0.2 per texel rises to the right, so the normal leans left. */
static void bump_maps_tilt_by_their_slope(void **state)
{
    const uint8_t ramp[12] = {0,   0,   0,   51,  51,  51,
                              102, 102, 102, 153, 153, 153};
    struct loaded l;

    (void)state;
    write_image("two.tga", 4, 1, 3, ramp);
    load(&l, "Kd 1\nbump -clamp on two.tga");
    check_direction(bumped(&l, 0.5f, 0.5f, up), -0.2, 0, 1);
    unload(&l);
    load(&l, "Kd 1\nbump -clamp on -bm -2 -s .5 1 two.tga");
    check_direction(bumped(&l, 1, 0.5f, up), 0.4, 0, 1);
    unload(&l);
}

/* No reflected direction is below the face, whatever the map is. */
static void bent_normals_reflect_upwards(void **state)
{
    uint64_t seed = 5;

    (void)state;
    for (int i = 0; i < 100000; i++) {
        struct vec3 v[2];
        struct vec3 n, r;

        for (int k = 0; k < 2; k++) {
            double z = check_random(&seed);
            double phi = 2 * M_PI * check_random(&seed);
            double s = sqrt(1 - z * z);

            v[k] = v3((float)(s * cos(phi)), (float)(s * sin(phi)), (float)z);
        }
        if (v3_dot(v[0], v[1]) <= 0)
            continue;
        n = bent_normal(v[0], up, v[1]);
        r = v3_sub(v3_scale(n, 2 * v3_dot(n, v[1])), v[1]);
        assert_true(v3_dot(n, v[1]) > 0);
        assert_true(r.z > 0);
        check_close((double)v3_length(n), 1, 1e-5);
    }
}
int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normal_maps_turn_the_normal),
        cmocka_unit_test(normal_maps_use_tangents),
        cmocka_unit_test(coats_have_normals_of_their_own),
        cmocka_unit_test(bump_maps_tilt_by_their_slope),
        cmocka_unit_test(bent_normals_reflect_upwards),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_files);
}
