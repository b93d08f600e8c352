// SPDX-License-Identifier: MIT
/* test_light_pictures.c - lamps with emission maps, and the part of a map that
 * a triangle covers */
#include <math.h>
#include <string.h>

#include "world/light/lights.h"
#include "kernels/light.h"

#include "tests/unit/check.h"
#include "tests/unit/lamps.h"
#include "tests/unit/mesh.h"

#define TEXTURE_SIDE 128

/* Adds a square lamp with a map; `uvs` are those of its corners. */
static void add_picture(struct mesh *m, struct vec2 uvs[4], uint32_t *texels,
                        struct texture *texture, float linear[256],
                        float repeat)
{
    const uint32_t corners[2][3] = {{0, 1, 2}, {0, 2, 3}};

    for (int i = 0; i < 256; i++)
        linear[i] = (float)i / 255;
    *texture = (struct texture){.width = TEXTURE_SIDE,
                                .height = TEXTURE_SIDE,
                                .scale = {1, 1}};
    mesh_add_quad(m, v3(-0.5f, 0.5f, -0.5f), v3(0.5f, 0.5f, -0.5f),
                  v3(0.5f, 0.5f, 0.5f), v3(-0.5f, 0.5f, 0.5f), LAMP);
    for (int k = 0; k < 4; k++)
        uvs[k] = v2(k == 1 || k == 2 ? repeat : 0, k > 1 ? repeat : 0);
    for (int t = 0; t < 2; t++)
        memcpy(m->tris[t].vt, corners[t], sizeof corners[t]);
    m->materials[LAMP] = mesh_material(MATERIAL_DIFFUSE, 0);
    m->materials[LAMP].emission = v3(1, 1, 1);
    m->materials[LAMP].emission_texture = 0;
    m->world.uvs = uvs;
    m->world.textures = texture;
    m->world.texels = texels;
    m->world.linear_of_srgb = linear;
}

/* Returns the irradiance under a square with a map, by midpoints on the
 * square. */
static double picture_irradiance(const struct world *w,
                                 const struct receiver *r, float repeat)
{
    const int side = 1000;
    double sum = 0;

    for (int i = 0; i < side * side; i++) {
        struct vec2 u = v2(((float)(i % side) + 0.5f) / (float)side,
                           ((float)(i / side) + 0.5f) / (float)side);
        struct vec3 p = v3(u.x - 0.5f, 0.5f, u.y - 0.5f);
        struct vec3 d = v3_sub(p, r->p);
        double square = (double)v3_dot(d, d);
        double cosines = (double)(f_max(v3_dot(d, r->n), 0) * fabsf(d.y));

        sum +=
            (double)texture_at(w, 0, v2(u.x * repeat, u.y * repeat)).color.x *
            cosines / (square * square);
    }
    return sum / (side * side);
}

static void emission_maps_light_the_floor(void **state)
{
    const float repeats[] = {1, 3.5f, 0.2f};

    (void)state;
    for (size_t k = 0; k < 3; k++) {
        uint32_t texels[TEXTURE_SIDE * TEXTURE_SIDE];
        uint64_t seed = 2;
        float linear[256];
        struct texture texture;
        struct vec2 uvs[4];
        struct mesh m = {0};
        struct lights lights;

        for (int i = 0; i < TEXTURE_SIDE * TEXTURE_SIDE; i++)
            texels[i] = check_random(&seed) < 0.1
                            ? 0xff000000u | (uint32_t)(i % 256)
                            : 0xff000000u;
        add_picture(&m, uvs, texels, &texture, linear, repeats[k]);
        finish(&m, &lights);
        assert_int_equal(lights.light_count, 1);
        for (int i = 0; i < 5; i++) {
            struct receiver r = {v3(between(&seed, -1, 1), 0,
                                    between(&seed, -1, 1)),
                                 v3_unit(v3(between(&seed, -1, 1), 1, 0)),
                                 false, false};
            double error, e;

            e = irradiance(&m.world, &r, 200000, &seed, &error);
            check_close(e, picture_irradiance(&m.world, &r, repeats[k]),
                        Z_LIMIT * error + 1e-4);
        }
        discard(&m, &lights);
    }
}

/* A lamp lets rays pass like other surfaces: it emits in proportion to its
 * opacity, and nothing from holes. */
static void holes_do_not_shine(void **state)
{
    static uint32_t texels[TEXTURE_SIDE * TEXTURE_SIDE];
    struct receiver r = {{0, 0, 0}, {0, 1, 0}, false, false};
    uint64_t seed = 23;
    float linear[256];
    struct texture texture;
    struct vec2 uvs[4];
    struct mesh m = {0};
    struct lights lights;
    int solid = 0;

    (void)state;
    /* The left half is a hole. */
    for (int i = 0; i < TEXTURE_SIDE * TEXTURE_SIDE; i++)
        texels[i] = i % TEXTURE_SIDE < TEXTURE_SIDE / 2 ? 0 : 0xff000000u;
    add_picture(&m, uvs, texels, &texture, linear, 1);
    texture.has_alpha = 1;
    m.materials[LAMP].emission_texture = NO_INDEX;
    m.materials[LAMP].color_texture = 0;
    m.materials[LAMP].opacity = 0.25f;
    m.world.settings.features = FEATURE_COVERAGE;
    finish(&m, &lights);
    for (int i = 0; i < 1000; i++) {
        struct light_sample s = {.pdf = 0};
        struct vec2 point = any_choice(&seed);

        assert_true(
            light_sample(&m.world, &r, NO_INDEX, point, any_choice(&seed), &s));
        if (fabsf(s.p.x) > 1e-2f && fabsf(s.p.x) < 0.49f) /* away from edges */
            assert_true(s.radiance.x == (s.p.x < 0 ? 0 : 0.25f));
        solid += s.radiance.x > 0;
    }
    check_close(solid / 1000.0, 0.5, Z_LIMIT * 0.5 / sqrt(1000) + 0.01);
    discard(&m, &lights);
}

/* A square of area 1 and radiance 1 has a grey map that covers half of it. */
static void power_counts_picture_and_opacity(void **state)
{
    static uint32_t texels[TEXTURE_SIDE * TEXTURE_SIDE];
    float linear[256];
    struct texture texture;
    struct vec2 uvs[4];
    struct mesh m = {0};
    struct lights lights;

    (void)state;
    for (int i = 0; i < TEXTURE_SIDE * TEXTURE_SIDE; i++)
        texels[i] = 0xff333333u;
    add_picture(&m, uvs, texels, &texture, linear, 1);
    m.materials[LAMP].opacity = 0.5f;
    finish(&m, &lights);
    check_close(lights_power(&lights), 0.5 * 0x33 / 255, 1e-6);
    check_close(lights.powers[0][0], lights.powers[0][1], 1e-6);
    discard(&m, &lights);
}

/* Of the two halves of a square, only the one with light in its map is a light:
 * the one below the diagonal from the lower left to the upper right. */
static void dark_pictures_are_no_lights(void **state)
{
    static uint32_t texels[TEXTURE_SIDE * TEXTURE_SIDE];
    float linear[256];
    struct texture texture;
    struct vec2 uvs[4];
    struct mesh m = {0};
    struct lights lights;

    (void)state;
    memset(texels, 0, sizeof texels);
    add_picture(&m, uvs, texels, &texture, linear, 1);
    finish(&m, &lights);
    assert_int_equal(lights.light_count, 0);
    lights_free(&lights);
    /* Row 0 is the top: u = 3/4, v = 1/4. */
    texels[TEXTURE_SIDE * TEXTURE_SIDE * 3 / 4 + TEXTURE_SIDE * 3 / 4] = 1;
    finish(&m, &lights);
    assert_int_equal(lights.light_count, 1);
    assert_int_equal(lights.lights[0].tris[0], 0);
    discard(&m, &lights);
}

/* Compares the mean over the footprint with random points of the bilinear
 * look-up. On a smooth map the rim of 2 texels counts by its share of the area
 * times the map's contrast; .006 is 4.9 standard errors of 2000 points. The
 * mean is never 0 where a single texel is visible. */
static void footprints_miss_nothing(void **state)
{
    static uint32_t texels[TEXTURE_SIDE * TEXTURE_SIDE];
    uint64_t seed = 44;
    float linear[256];
    struct texture texture;
    struct vec2 uvs[4];
    struct mesh m = {0};
    struct error err;
    int checked = 0;

    (void)state;
    add_picture(&m, uvs, texels, &texture, linear, 1);
    m.world.materials = m.materials;
    for (int k = 0; k < 600; k++) {
        bool is_smooth = k % 4 == 0;
        double size = is_smooth ? 1 : 2.0 / TEXTURE_SIDE;
        int spot = k * 3761 % (TEXTURE_SIDE * TEXTURE_SIDE);
        struct texture_power_sums f = {NULL, 0, 0};
        struct vec2 uv[3];
        double truth = 0, rim = 0, area;

        for (int i = 0; i < TEXTURE_SIDE * TEXTURE_SIDE; i++) {
            double x = 2 * M_PI * (i % TEXTURE_SIDE) / TEXTURE_SIDE;
            double y = 2 * M_PI * (i / TEXTURE_SIDE) / TEXTURE_SIDE;

            texels[i] =
                is_smooth ? (uint32_t)(128 + 60 * sin(x) + 60 * sin(y)) : 0;
        }
        if (!is_smooth)
            texels[spot] = 255;
        for (int i = 0; i < 3; i++) {
            /* Anywhere, or within 2 texels of the single one. */
            float u = is_smooth ? 0.2f * (float)(k % 5)
                                : (0.5f + (float)(spot % TEXTURE_SIDE)) /
                                      TEXTURE_SIDE;
            float v = is_smooth ? 0.15f * (float)(k % 7)
                                : 1 - (0.5f + (float)(spot / TEXTURE_SIDE)) /
                                          TEXTURE_SIDE;

            uv[i] = v2(u + between(&seed, -size, size),
                       v + between(&seed, -size, size));
        }
        for (int i = 0; i < 2000; i++) {
            struct vec2 u = any_choice(&seed);
            struct hit h = triangle_point(u);
            struct vec2 at =
                v2(h.b0 * uv[0].x + h.b1 * uv[1].x + h.b2 * uv[2].x,
                   h.b0 * uv[0].y + h.b1 * uv[1].y + h.b2 * uv[2].y);

            truth += (double)texture_at(&m.world, 0, at).color.x / 2000 / 3;
        }
        assert_true(texture_power_init(&f, &m.world, &m.materials[LAMP], &err));
        if (truth > 0)
            assert_true(texture_power_mean(&f, uv) > 0);
        for (int i = 0; i < 3; i++)
            rim += hypot((double)(uv[(i + 1) % 3].x - uv[i].x),
                         (double)(uv[(i + 1) % 3].y - uv[i].y));
        area = fabs((double)((uv[1].x - uv[0].x) * (uv[2].y - uv[0].y) -
                             (uv[2].x - uv[0].x) * (uv[1].y - uv[0].y)));
        if (is_smooth && area > 0.3) {
            double share = 2 * rim / TEXTURE_SIDE / (area / 2);

            check_close(texture_power_mean(&f, uv), truth,
                        share / (1 + share) * 240 / 255 / 3 + 0.006);
            checked++;
        }
        texture_power_free(&f);
    }
    assert_true(checked > 20);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(emission_maps_light_the_floor),
        cmocka_unit_test(holes_do_not_shine),
        cmocka_unit_test(power_counts_picture_and_opacity),
        cmocka_unit_test(dark_pictures_are_no_lights),
        cmocka_unit_test(footprints_miss_nothing),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
