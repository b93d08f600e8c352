// SPDX-License-Identifier: MIT
/* test_maps.c - image files and MTL options give the surface at a point */
#include <math.h>
#include <stdlib.h>

#include "kernels/subsurface.h"
#include "tests/unit/mapped.h"

/* Returns the share of 10,000 rays that a point stops. */
static double stopped(const struct loaded *l, float u, float v)
{
    struct hit h = {.b0 = 1 - u - v, .b1 = u, .b2 = v, .tri = 0};
    int count = 0;

    for (uint32_t i = 0; i < 10000; i++) {
        struct ray r = {.t_max = FLOAT_MAX, .key = hash_u32(i)};

        count += hit_is_solid(&l->world, r, h);
    }
    return count / 10000.0;
}

static double coverage(const struct loaded *l)
{
    struct hit h = {.b0 = 0.4f, .b1 = 0.3f, .b2 = 0.3f, .tri = 0};

    return (double)coverage_at(&l->world, h);
}

/* IEC 61966-2-1. */
static double linear(uint8_t byte)
{
    double c = byte / 255.0;

    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

static const uint8_t six[18] = {255, 0,  0,  0,   200, 10, 7,   8,  90,
                                40,  50, 60, 100, 110, 3,  250, 99, 1};

/* v is 0 at the bottom; the file begins with the top row. */
static void texels_are_met_in_their_centres(void **state)
{
    struct loaded l;

    (void)state;
    write_image("six.tga", 3, 2, 3, six);
    load(&l, "Kd 1\nmap_Kd six.tga");
    for (int turn = -2; turn <= 2; turn++)
        for (int i = 0; i < 6; i++) {
            struct bsdf b = surface(&l, (float)((i % 3 + 0.5) / 3 + turn),
                                    (float)(1 - (i / 3 + 0.5) / 2 - turn));

            check_close((double)b.color.x, linear(six[3 * i]), 2e-6);
            check_close((double)b.color.y, linear(six[3 * i + 1]), 2e-6);
            check_close((double)b.color.z, linear(six[3 * i + 2]), 2e-6);
        }
    unload(&l);
}

/* The texel of column i of a row of three that is mirrored: 0 1 2 2 1 0. */
static int mirrored_column(int i)
{
    int k = ((i % 6) + 6) % 6;

    return k < 3 ? k : 5 - k;
}

/* In the centres of texels -6 to 5 of the row below the image's middle. */
static void rows_are_mirrored_and_clamped_on_one_axis(void **state)
{
    struct loaded mirror, clamp, nearest;

    (void)state;
    write_image("six.tga", 3, 2, 3, six);
    load(&mirror, "Kd 1\nmap_Kd -mirror u six.tga");
    load(&clamp, "Kd 1\nmap_Kd -clamp u six.tga");
    load(&nearest, "Kd 1\nmap_Kd -nearest on -mirror on six.tga");
    for (int i = -6; i < 6; i++) {
        float u = (float)((i + 0.5) / 3);
        int column = i < 0 ? 0 : i > 2 ? 2 : i;
        double red = linear(six[3 * (3 + mirrored_column(i))]);

        for (int turn = -1; turn <= 1; turn++) {
            float v = 0.25f + (float)turn; /* v repeats */

            check_close((double)surface(&mirror, u, v).color.x, red, 2e-6);
            check_close((double)surface(&clamp, u, v).color.x,
                        linear(six[3 * (3 + column)]), 2e-6);
        }
        /* anywhere in the texel; v 1.8 is 0.2 in the mirror */
        check_close((double)surface(&nearest, u + 0.14f, 1.8f).color.x, red,
                    1e-6);
        check_close((double)surface(&nearest, u - 0.14f, -0.2f).color.x, red,
                    1e-6);
    }
    unload(&mirror);
    unload(&clamp);
    unload(&nearest);
}

/* The coordinates are scaled, turned to the left about (0, 0), and moved. */
static void options_rotate(void **state)
{
    struct loaded plain, turned;

    (void)state;
    write_image("six.tga", 3, 2, 3, six);
    load(&plain, "Kd 1\nmap_Kd six.tga");
    load(&turned, "Kd 1\nmap_Kd -s 2 3 -rotate 30 -o .1 .2 six.tga");
    for (int i = 0; i < 100; i++) {
        double u = i % 10 / 8. - 0.3, v = i / 10 / 8. - 0.2;
        double c = sqrt(0.75), s = 0.5;
        struct vec3 a = surface(&plain, (float)(2 * u * c - 3 * v * s + 0.1),
                                (float)(2 * u * s + 3 * v * c + 0.2))
                            .color;
        struct vec3 b = surface(&turned, (float)u, (float)v).color;

        check_close((double)a.x, (double)b.x, 1e-5);
        check_close((double)a.y, (double)b.y, 1e-5);
        check_close((double)a.z, (double)b.z, 1e-5);
    }
    unload(&plain);
    unload(&turned);
}

/* One image gives several numbers, and its texels are in memory once. */
static void numbers_come_from_their_channels(void **state)
{
    const uint8_t pixel[4] = {51, 102, 153, 204};
    struct loaded l;
    struct bsdf b;

    (void)state;
    write_image("two.tga", 1, 1, 4, pixel);
    load(&l, "Kd 1\nmap_Kd -alpha off two.tga\nPr 1\nPm 1\n"
             "map_Pr -imfchan g two.tga\nmap_Pm -imfchan b two.tga\nPc 1\n"
             "map_Pc -imfchan r two.tga\nPcr 1\nmap_Pcr -imfchan m two.tga");
    assert_int_equal(l.world.settings.texel_count, 1);
    b = surface(&l, 0.3f, 0.3f);
    check_close((double)b.alpha, 0.4 * 0.4, 1e-6);
    check_close((double)b.metalness, 0.6, 1e-6);
    check_close((double)b.coat, 0.2, 1e-6);
    check_close((double)b.coat_alpha, 0.8 * 0.8, 1e-6);
    assert_int_equal(l.world.settings.features & FEATURE_COVERAGE, 0);
    check_close(stopped(&l, 0.3f, 0.3f), 1, 0);
    unload(&l);
    load(&l, "Kd 1\nmap_d -imfchan r two.tga");
    check_close(stopped(&l, 0.3f, 0.3f), 0.2, 0.02);
    unload(&l);
}

/* Rare maps multiply what they name. */
static void rare_maps_multiply(void **state)
{
    const uint8_t pixel[4] = {51, 102, 153, 204};
    struct loaded l;
    struct bsdf b;

    (void)state;
    write_image("two.tga", 1, 1, 4, pixel);
    load(&l, "Ks 1\nKs_full 0.04\nmap_Ks_weight -imfchan m two.tga\nPs 1\n"
             "Ps_color 1 .5 .25\nmap_Ps_color two.tga\nPs_roughness .9\n"
             "map_Ps_roughness -imfchan m two.tga\nPf 1\nPf_thickness 400\n"
             "Pf_thinnest 100\nmap_Pf -imfchan r two.tga\n"
             "map_Pf_thickness -imfchan g two.tga");
    b = surface(&l, 0.3f, 0.3f);
    check_close((double)b.specular.x, 0.04 * 0.8, 1e-7);
    check_close((double)b.sheen.y, 0.5 * linear(102), 1e-6);
    check_close((double)b.sheen_alpha, 0.72 * 0.72, 1e-6);
    check_close((double)b.film, 0.2, 1e-6);
    check_close((double)b.film_thickness, 100 + 0.4 * 300, 1e-3);
    unload(&l);
    load(&l, "Kd .5\nTd 1 .5 .25\nmap_Td two.tga\nTd_weight .5\n"
             "map_Td_weight -imfchan r two.tga");
    b = surface(&l, 0.3f, 0.3f);
    check_close((double)b.back_color.y, 0.5 * linear(102), 1e-6);
    check_close((double)b.translucency, 0.5 * 0.2, 1e-6);
    check_close((double)b.color.y, 0.5, 0);
    assert_int_equal(l.world.settings.features & FEATURE_COVERAGE, 0);
    unload(&l);
}

/* map_Sf multiplies the weight of what enters, which is 1 beside it. */
static void maps_of_bodies_multiply(void **state)
{
    const uint8_t pixel[4] = {51, 102, 153, 204};
    const struct surface_point v = {.uv = {{0.3f, 0.3f}, {0, 0}},
                                    .has_uv = true,
                                    .is_outside = true};
    struct loaded l;
    struct bsdf b;

    (void)state;
    write_image("two.tga", 1, 1, 4, pixel);
    for (int i = 0; i < 2; i++) {
        load(&l, i == 0 ? "Kd .5\nSr 1 1 1\nmap_Sf -imfchan g two.tga"
                        : "Kd .5\nSf .5\nSr 1 1 1\nPc 1\n"
                          "map_Sf -imfchan g two.tga");
        b = surface(&l, 0.3f, 0.3f);
        check_close((double)subsurface_share(&l.world, &l.material, &v, &b),
                    i == 0 ? 0.4 : 0.2, 1e-6);
        assert_true(material_features(&l.material, l.world.textures) &
                    FEATURE_TEXTURE_OPTIONS);
        unload(&l);
    }
}

/* Light leaves where it has entered if its mean free path is next to nothing,
 * and there is no medium then. */
static void short_paths_are_none(void **state)
{
    struct loaded l;

    (void)state;
    load(&l, "Kd .5\nTf .5\nPr .2\nSf 1\nSr 1e-5 1e-6 1e-6");
    check_close((double)l.material.subsurface, 0, 0);
    assert_true(v3_is_zero(l.material.medium.extinction));
    unload(&l);
    load(&l, "Kd .5\nTf .5\nPr .2\nSf 1\nSr 1e-2 1e-6 1e-6");
    check_close((double)l.material.subsurface, 1, 0);
    unload(&l);
}

/* A map of the grain gives the direction x + i y times that of anisor, and
 * highlights of glTF's widths: a + (1 - a) (s f)^2 and a, of which s = 1 is Pr
 * and aniso here. */
static void maps_turn_and_scale_the_grain(void **state)
{
    const uint8_t pixel[3] = {204, 51, 153};
    struct ray r = {.o = {0.3f, 0.3f, 1}, .d = {0, 0, -1}};
    struct hit h = {.t = 1, .b0 = 0.4f, .b1 = 0.3f, .b2 = 0.3f, .tri = 0};
    double x = 2 * 204 / 255. - 1, y = 2 * 51 / 255. - 1, f = 153 / 255.;
    double along, across, turn = 2 * M_PI * 0.1;
    struct surface_point v;
    struct loaded l;
    struct bsdf b;
    struct ggx g;

    (void)state;
    write_image("two.tga", 1, 1, 3, pixel);
    load(&l, "Kd 1\nPm 1\nPr .7\naniso .8\nanisor .1\nmap_grain two.tga");
    assert_true(surface_at(&l.world, &l.material, r, h, &v));
    check_close((double)v.t.x,
                (x * cos(turn) - y * sin(turn)) / sqrt(x * x + y * y), 1e-5);
    check_close((double)v.t.y,
                (x * sin(turn) + y * cos(turn)) / sqrt(x * x + y * y), 1e-5);
    b = bsdf_at(&l.world, &l.material, &v);
    g = bsdf_facets(&b);
    along = 0.49 / sqrt(1 - 0.9 * 0.8);
    across = 0.49 * sqrt(1 - 0.9 * 0.8);
    check_close((double)(g.alpha * g.stretch),
                across + (along - across) * f * f, 1e-5);
    check_close((double)(g.alpha / g.stretch), across, 1e-5);
    unload(&l);
}

/* Each texture is looked up by the texture coordinates that it names. */
static void second_coordinates_are_used(void **state)
{
    struct loaded l;
    struct vec2 uvs[3] = {{0.5f, 0.25f}, {0.5f, 0.25f}, {0.5f, 0.25f}};
    struct hit h = {.t = 1, .b0 = 0.4f, .b1 = 0.3f, .b2 = 0.3f, .tri = 0};
    struct ray r = {.o = {0.3f, 0.3f, 1}, .d = {0, 0, -1}};
    struct surface_point v;

    (void)state;
    write_image("six.tga", 3, 2, 3, six);
    load(&l, "Kd 1\nmap_Kd -uv 1 six.tga\nKs 1\nmap_Ks six.tga");
    l.world.uvs2 = uvs;
    l.world.settings.uv2_count = 3;
    assert_true(surface_at(&l.world, &l.material, r, h, &v));
    check_close((double)bsdf_at(&l.world, &l.material, &v).color.x,
                linear(six[12]), 2e-6);
    l.world.settings.uv2_count = 0;
    assert_true(surface_at(&l.world, &l.material, r, h, &v));
    check_close((double)bsdf_at(&l.world, &l.material, &v).color.x,
                (double)surface(&l, 0.3f, 0.3f).color.x, 2e-6);
    unload(&l);
}

static void options_move_and_scale(void **state)
{
    struct loaded plain, moved;

    (void)state;
    write_image("six.tga", 3, 2, 3, six);
    load(&plain, "Kd 1\nmap_Kd six.tga");
    load(&moved, "Kd 1\nmap_Kd -s 2 -3 -o .25 .5 six.tga");
    for (int i = 0; i < 100; i++) {
        float u = (float)(i % 10) / 8 - 0.3f;
        float v = (float)(i / 10) / 8 - 0.2f;
        struct vec3 a = surface(&plain, 2 * u + 0.25f, -3 * v + 0.5f).color;
        struct vec3 b = surface(&moved, u, v).color;

        check_close((double)b.x, (double)a.x, 1e-5);
        check_close((double)b.y, (double)a.y, 1e-5);
    }
    unload(&plain);
    unload(&moved);
}

/* Coordinates and options whose product exceeds floats still give a texel's
 * colour. */
static void extreme_coordinates_have_colors(void **state)
{
    const float places[] = {0.5f, 3e38f, -3e38f, INFINITY, NAN};
    struct loaded l;

    (void)state;
    write_image("six.tga", 3, 2, 3, six);
    load(&l, "Kd 1\nmap_Kd -s 3e38 -3e38 -o 1e38 1e38 six.tga");
    for (int i = 0; i < 25; i++) {
        struct vec3 c = surface(&l, places[i % 5], places[i / 5]).color;

        assert_true(c.x >= 0 && c.x <= 1 && c.y >= 0 && c.y <= 1 && c.z >= 0 &&
                    c.z <= 1);
    }
    unload(&l);
}

static void clamped_borders_go_on(void **state)
{
    struct loaded l;

    (void)state;
    write_image("six.tga", 3, 2, 3, six);
    load(&l, "Kd 1\nmap_Kd -clamp on six.tga");
    check_close((double)surface(&l, -3, 9).color.x, linear(255), 1e-6);
    check_close((double)surface(&l, 0, 1).color.x, linear(255), 1e-6);
    check_close((double)surface(&l, 5, -2).color.x, linear(250), 1e-5);
    check_close((double)surface(&l, 1, 0).color.y, linear(99), 1e-5);
    unload(&l);
}

static void an_image_is_read_once(void **state)
{
    struct loaded l;

    (void)state;
    write_image("six.tga", 3, 2, 3, six);
    load(&l, "Kd 1\nmap_Kd six.tga\nKe 1\nmap_Ke -s 2 2 six.tga");
    assert_int_equal(l.scene.texture_count, 2);
    assert_int_equal(l.host.texel_count, 6);
    unload(&l);
}

#define MANY 40

/* Images are read in parallel and numbered in the order of their materials.
 * Every fifth is the same as the one before, and number 7 is missing. */
static void many_images_are_read(void **state)
{
    uint32_t expected = 0;
    struct scene scene = {0};
    struct host_world host;
    struct warnings report = {0};
    struct error err;
    char path[32];
    FILE *obj = fopen("many.obj", "w"), *mtl = fopen("many.mtl", "w");

    (void)state;
    assert_non_null(obj);
    assert_non_null(mtl);
    fputs("mtllib many.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n", obj);
    for (int i = 0; i < MANY; i++) {
        const uint8_t pixels[6] = {(uint8_t)i, 1, 2, 3, (uint8_t)i, 5};

        snprintf(path, sizeof path, "m%d.tga", i);
        if (i != 7)
            write_image(path, 1 + i % 2, 1, 3, pixels);
        fprintf(mtl, "newmtl m%d\nmap_Kd m%d.tga\n", i, i % 5 == 4 ? i - 1 : i);
        fprintf(obj, "usemtl m%d\nf 1/1 2/1 3/1\n", i);
    }
    assert_int_equal(fclose(obj), 0);
    assert_int_equal(fclose(mtl), 0);
    assert_true(
        scene_load(&scene, "many.obj", SCENE_UP_OF_FILE, &report, &err));
    assert_true(world_init(&host, &scene, 2, &report, &err));
    assert_int_equal(report.entry_count, 1);
    for (int i = 0; i < MANY; i++) {
        uint32_t map = host.materials[1 + i].color_texture;
        int image = i % 5 == 4 ? i - 1 : i;

        if (i == 7) {
            assert_int_equal(map, NO_INDEX);
            continue;
        }
        assert_int_equal(host.textures[map].width, 1 + image % 2);
        assert_int_equal(host.texels[host.textures[map].first] & 0xff, image);
        if (image == i) {
            assert_int_equal(host.textures[map].first, expected);
            expected += host.textures[map].width;
        }
    }
    assert_int_equal(host.texel_count, expected);
    world_free(&host);
    scene_free(&scene);
    warnings_free(&report);
    for (int i = 0; i < MANY; i++) {
        snprintf(path, sizeof path, "m%d.tga", i);
        unlink(path);
    }
    unlink("many.obj");
    unlink("many.mtl");
}

/* Numbers are not decoded: grey 51 is 0.2 and 204 is 0.8. */
static const uint8_t two[6] = {51, 51, 51, 204, 204, 204};

static void roughness_is_multiplied(void **state)
{
    struct loaded l;

    (void)state;
    write_image("two.tga", 2, 1, 3, two);
    load(&l, "Ks .9\nillum 3\nmap_Pr two.tga");
    check_close((double)surface(&l, 0.25f, 0.5f).alpha, 0.04, 1e-6);
    check_close((double)surface(&l, 0.75f, 0.5f).alpha, 0.64, 1e-6);
    unload(&l);
    load(&l, "Tf 1\nillum 7\nPr .5\nmap_Pr two.tga");
    check_close((double)surface(&l, 0.75f, 0.5f).alpha, 0.16, 1e-6);
    unload(&l);
}

static void metal_is_mixed_by_its_map(void **state)
{
    struct loaded l;

    (void)state;
    write_image("two.tga", 2, 1, 3, two);
    load(&l, "Kd .3\nKs .5\nPr .5\nmap_Pm two.tga");
    check_close((double)surface(&l, 0.25f, 0.5f).metalness, 0.2, 1e-6);
    check_close((double)surface(&l, 0.75f, 0.5f).metalness, 0.8, 1e-6);
    check_close((double)surface(&l, 0.75f, 0.5f).color.x, 0.3, 1e-7);
    check_close((double)surface(&l, 0.75f, 0.5f).alpha, 0.25, 1e-7);
    unload(&l);
    load(&l, "Kd .3\nPm .6\nmap_Pm two.tga");
    check_close((double)surface(&l, 0.75f, 0.5f).metalness, 0.48, 1e-6);
    unload(&l);
}

/* The texels of the map are 0.2 and 0.8. */
static void layers_are_weighed_by_their_maps(void **state)
{
    struct loaded l;
    struct bsdf b;

    (void)state;
    write_image("two.tga", 2, 1, 3, two);
    load(&l, "Kd .3\nKs .5\nPr .5\nTf .5\nPc .6\nPcr .5\nPs .4\n"
             "map_Pc two.tga\nmap_Pcr two.tga\nmap_Ps two.tga\n"
             "map_Tf two.tga");
    b = surface(&l, 0.75f, 0.5f);
    check_close((double)b.coat, 0.48, 1e-6);
    check_close((double)b.coat_alpha, 0.25 * 0.64, 1e-6);
    check_close((double)b.sheen.y, 0.32, 1e-6);
    check_close((double)b.transmission, 0.4, 1e-6);
    b = surface(&l, 0.25f, 0.5f);
    check_close((double)b.coat, 0.12, 1e-6);
    check_close((double)b.coat_alpha, 0.25 * 0.04, 1e-6);
    unload(&l);
    /* without the statements their numbers are 1 */
    load(&l, "Kd .3\nPr .5\nmap_Pc two.tga\nmap_Pcr two.tga\n"
             "map_Ps two.tga\nmap_Tf two.tga");
    b = surface(&l, 0.75f, 0.5f);
    assert_int_equal(b.kind, MATERIAL_PRINCIPLED);
    check_close((double)b.coat, 0.8, 1e-6);
    check_close((double)b.coat_alpha, 0.64, 1e-6);
    check_close((double)b.sheen.x, 0.8, 1e-6);
    check_close((double)b.transmission, 0.8, 1e-6);
    unload(&l);
}

static void maps_are_the_share_of_stopped_rays(void **state)
{
    const uint8_t leaf[8] = {9, 9, 9, 0, 9, 9, 9, 255};
    struct loaded l;

    (void)state;
    write_image("two.tga", 2, 1, 3, two);
    write_image("leaf.tga", 2, 1, 4, leaf);
    load(&l, "Kd .3\nmap_d two.tga");
    assert_int_equal(l.world.settings.features & FEATURE_COVERAGE,
                     FEATURE_COVERAGE);
    check_close(stopped(&l, 0.25f, 0.25f), 0.2, 0.02);
    check_close(stopped(&l, 0.75f, 0.125f), 0.8, 0.02);
    check_close(stopped(&l, 0.5f, 0.125f), 0.5, 0.02);
    unload(&l);
    load(&l, "Kd .3\nd .5\nmap_d two.tga");
    check_close(stopped(&l, 0.75f, 0.125f), 0.4, 0.02);
    unload(&l);
    load(&l, "Kd .3\nd .5\nmap_d two.tga\nd_cutoff .39");
    check_close(stopped(&l, 0.75f, 0.125f), 1, 0);
    check_close(stopped(&l, 0.25f, 0.125f), 0, 0);
    unload(&l);
    load(&l, "Kd .3\nd .5\nmap_d two.tga\nd_cutoff .41");
    check_close(stopped(&l, 0.75f, 0.125f), 0, 0);
    unload(&l);
    load(&l, "Kd .3\nmap_d leaf.tga"); /* uses its alpha channel */
    check_close(stopped(&l, 0.25f, 0.25f), 0, 0);
    check_close(stopped(&l, 0.75f, 0.125f), 1, 0);
    unload(&l);
    load(&l, "Kd .3\nmap_Kd two.tga"); /* opaque and no cost */
    assert_int_equal(l.world.settings.features & FEATURE_COVERAGE, 0);
    unload(&l);
}

/* Blender names one image as map_Kd and map_d. Its alpha is opacity, once: by
 * whatever path, with whatever options, and as the colour of metal too. Another
 * image multiplies. */
static void one_image_counts_once(void **state)
{
    static const char *const statements[] = {
        "map_Kd leaf.tga\nmap_d leaf.tga",
        "map_d leaf.tga\nmap_Kd leaf.tga",
        "map_Kd leaf.tga\nmap_d -imfchan m leaf.tga",
        "map_Kd -clamp on leaf.tga\nmap_d -s 2 2 2 leaf.tga",
        "map_Kd ./leaf.tga\nmap_d .\\LEAF.TGA",
        "map_Kd leaf.tga\nmap_d six.tga", /* a second name of the file */
        "illum 3\nmap_Ks leaf.tga\nmap_d leaf.tga",
        "map_Kd -alpha off leaf.tga\nmap_d leaf.tga",
        "map_Kd leaf.tga",
        "map_d leaf.tga",
        "map_Ke leaf.tga\nmap_d leaf.tga",
    };
    const uint8_t half[4] = {255, 0, 0, 128};
    struct loaded l;

    (void)state;
    write_image("leaf.tga", 1, 1, 4, half);
    write_image("two.tga", 1, 1, 4, half);
    unlink("six.tga");
    assert_int_equal(symlink("leaf.tga", "six.tga"), 0);
    for (size_t i = 0; i < sizeof statements / sizeof statements[0]; i++) {
        load(&l, statements[i]);
        check_close(coverage(&l), 128 / 255., 1e-6);
        unload(&l);
    }
    load(&l, "map_Kd two.tga\nmap_d leaf.tga");
    check_close(coverage(&l), pow(128 / 255., 2), 1e-6);
    unload(&l);
    /* opacity is in red; the alpha of the same image is none */
    load(&l, "map_Kd leaf.tga\nmap_d -imfchan r leaf.tga");
    check_close(coverage(&l), 1, 0);
    unload(&l);
    /* or in the mean of the colours */
    load(&l, "map_Kd leaf.tga\nmap_d -imfchan l leaf.tga");
    check_close(coverage(&l), 1 / 3., 1e-6);
    unload(&l);
    /* the texels of all spellings are in memory once */
    load(&l, "Ks 1\nmap_Kd leaf.tga\nmap_Ks .//leaf.tga\nmap_Ke six.tga");
    assert_int_equal(l.world.settings.texel_count, 1);
    unload(&l);
    /* roughness and metal are grey, as Blender reads them; alpha is opacity */
    load(&l, "map_Kd leaf.tga\nPr 1\nmap_Pr leaf.tga\nmap_Pm leaf.tga");
    check_close(coverage(&l), 128 / 255., 1e-6);
    check_close((double)surface(&l, 0.3f, 0.3f).metalness, 1 / 3., 1e-6);
    check_close((double)surface(&l, 0.3f, 0.3f).alpha, 1 / 9., 1e-6);
    unload(&l);
    unlink("six.tga");
}

/* Colours of vertices are mixed linearly over a triangle, and multiply the
 * colour of the material. */
static void vertices_have_colors(void **state)
{
    static const struct vec3 colors[3] = {{0.9f, 0.1f, 0.2f},
                                          {0.1f, 0.8f, 0.3f},
                                          {0.2f, 0.3f, 0.7f}};
    struct loaded l;

    (void)state;
    load(&l, "Kd .5 1 .25");
    l.world.colors = colors;
    l.world.settings.color_count = 3;
    for (int i = 0; i < 16; i++) {
        struct hit h = {.b1 = 0.06f * (float)i, .b2 = 0.002f * (float)(i * i)};
        struct ray r = {.o = {0, 0, 1}, .d = {0, 0, -1}};
        struct surface_point at = {.has_uv = false};
        struct bsdf b;
        double c[3];

        h.b0 = 1 - h.b1 - h.b2;
        assert_true(surface_at(&l.world, &l.material, r, h, &at));
        b = bsdf_at(&l.world, &l.material, &at);
        c[0] = 0.5 *
               (0.9 * (double)h.b0 + 0.1 * (double)h.b1 + 0.2 * (double)h.b2);
        c[1] = 1.0 *
               (0.1 * (double)h.b0 + 0.8 * (double)h.b1 + 0.3 * (double)h.b2);
        c[2] = 0.25 *
               (0.2 * (double)h.b0 + 0.3 * (double)h.b1 + 0.7 * (double)h.b2);
        check_close((double)b.color.x, c[0], 1e-6);
        check_close((double)b.color.y, c[1], 1e-6);
        check_close((double)b.color.z, c[2], 1e-6);
    }
    unload(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_are_met_in_their_centres),
        cmocka_unit_test(rows_are_mirrored_and_clamped_on_one_axis),
        cmocka_unit_test(options_rotate),
        cmocka_unit_test(numbers_come_from_their_channels),
        cmocka_unit_test(rare_maps_multiply),
        cmocka_unit_test(maps_of_bodies_multiply),
        cmocka_unit_test(short_paths_are_none),
        cmocka_unit_test(maps_turn_and_scale_the_grain),
        cmocka_unit_test(second_coordinates_are_used),
        cmocka_unit_test(options_move_and_scale),
        cmocka_unit_test(extreme_coordinates_have_colors),
        cmocka_unit_test(clamped_borders_go_on),
        cmocka_unit_test(an_image_is_read_once),
        cmocka_unit_test(many_images_are_read),
        cmocka_unit_test(roughness_is_multiplied),
        cmocka_unit_test(metal_is_mixed_by_its_map),
        cmocka_unit_test(layers_are_weighed_by_their_maps),
        cmocka_unit_test(maps_are_the_share_of_stopped_rays),
        cmocka_unit_test(one_image_counts_once),
        cmocka_unit_test(vertices_have_colors),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_files);
}
