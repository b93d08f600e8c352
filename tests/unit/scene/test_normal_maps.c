// SPDX-License-Identifier: MIT
/*
 * test_normal_maps.c - images named by map_Bump: heights, or normals by their
 * contents
 *
 * ../shared/suites/blender has a normal map as Blender writes it. The folder is
 * looked for in ../shared or $GLIM_SHARED.
 */
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "engine/scene_load.h"
#include "terminal/xmalloc.h"
#include "tests/unit/files.h"
#include "tests/unit/shared.h"
#include "world/world.h"

#define SIDE 32

enum image {
    FLAT,      /* normals that all point away */
    BALLS,     /* normals of half balls on a plane */
    PADDED,    /* the same beside black */
    NOISY,     /* the same after a lossy compression */
    RAMP,      /* heights from black to white */
    LONE_GREY, /* heights whose vector has unit length */
    BRICK,     /* a photograph used as heights */
    IMAGES
};

static const bool is_normals[IMAGES] = {true, true, true, true};

/* Returns the normal at x, y in -1 to 1 over a half ball of radius 0.9. */
static void ball_normal(double x, double y, double n[3])
{
    double r2 = (x * x + y * y) / .81;

    n[0] = r2 < 1 ? x / .9 : 0;
    n[1] = r2 < 1 ? y / .9 : 0;
    n[2] = r2 < 1 ? sqrt(1 - r2) : 1;
}

static void color_at(enum image image, int x, int y, uint8_t rgb[3])
{
    double n[3], grey = image == RAMP ? 255.0 * x / (SIDE - 1) : 201;
    uint64_t seed = (uint64_t)(y * SIDE + x + 1);

    ball_normal((x % 16 - 7.5) / 8, (y % 16 - 7.5) / 8, n);
    for (int k = 0; k < 3; k++) {
        double c = 127.5 * (1 + n[k]);

        if (image == FLAT)
            c = k == 2 ? 255 : 128;
        if (image == NOISY)
            c += 10 * check_random(&seed) - 5;
        if (image == PADDED && x < SIDE / 3)
            c = 0;
        if (image == RAMP || image == LONE_GREY)
            c = grey;
        if (image == BRICK)
            c = (k == 0 ? 170 : 80) + 60 * check_random(&seed);
        rgb[k] = (uint8_t)(c < 0 ? 0 : c > 255 ? 255 : c);
    }
}

/* Writes an uncompressed TGA, whose colours are blue, green, red. */
static void put_image(enum image image)
{
    uint8_t bytes[18 + 3 * SIDE * SIDE] = {
        [2] = 2, [12] = SIDE, [14] = SIDE, [16] = 24};

    for (int i = 0; i < SIDE * SIDE; i++) {
        uint8_t rgb[3];

        color_at(image, i % SIDE, i / SIDE, rgb);
        for (int k = 0; k < 3; k++)
            bytes[18 + 3 * i + k] = rgb[2 - k];
    }
    put_bytes("a.tga", bytes, sizeof bytes);
}

struct loaded {
    struct scene scene;
    struct host_world world;
    struct warnings report;
};

static struct loaded load(const char *path)
{
    struct loaded l = {.report = {0}};
    struct error err;

    check_or_say(scene_load(&l.scene, path, SCENE_UP_OF_FILE, &l.report,
                            &err) &&
                     world_init(&l.world, &l.scene, 1, &l.report, &err),
                 err.text);
    return l;
}

static void unload(struct loaded *l)
{
    world_free(&l->world);
    scene_free(&l->scene);
    warnings_free(&l->report);
}

static struct loaded load_material(const char *statements)
{
    char *mtl = xformat("newmtl m\n%s\n", statements);
    struct loaded l;

    put("a.mtl", mtl);
    put("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\n"
                 "f 1/1 2/1 3/1\n");
    l = load("a.obj");
    unlink("a.mtl");
    unlink("a.obj");
    free(mtl);
    return l;
}

static void images_of_normals_are_normals(void **state)
{
    (void)state;
    for (int i = 0; i < IMAGES; i++) {
        struct loaded l;
        const struct material *m;

        print_message("image %d\n", i);
        put_image((enum image)i);
        l = load_material("map_Bump -bm 1 a.tga");
        m = &l.world.materials[1];
        assert_int_equal(m->normal_texture, is_normals[i] ? 0 : NO_INDEX);
        assert_int_equal(m->bump_texture, is_normals[i] ? NO_INDEX : 0);
        assert_int_equal(l.report.entry_count, is_normals[i]);
        if (is_normals[i])
            assert_string_equal(l.report.entries[0].text,
                                "a.mtl:2: found a map of normals, expected "
                                "heights: used as norm");
        unload(&l);
    }
    unlink("a.tga");
}

static void named_normals_are_not_judged(void **state)
{
    static const char *const keys[] = {"norm a.tga", "map_Kn a.tga",
                                       "norm a.tga\nbump b.tga"};

    (void)state;
    put_image(RAMP);
    for (int i = 0; i < 3; i++) {
        struct loaded l = load_material(keys[i]);

        assert_int_equal(l.world.materials[1].normal_texture, 0);
        assert_int_equal(l.world.materials[1].bump_texture, NO_INDEX);
        unload(&l);
    }
    unlink("a.tga");
}

static void normals_of_blender_are_normals(void **state)
{
    char *path = shared_path("suites/blender/b5_0.obj");
    uint32_t count = 0;
    struct loaded l;

    (void)state;
    l = load(path);
    for (uint32_t i = 0; i < l.world.material_count; i++) {
        assert_int_equal(l.world.materials[i].bump_texture, NO_INDEX);
        count += l.world.materials[i].normal_texture != NO_INDEX;
    }
    assert_int_equal(count, 1);
    unload(&l);
    free(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_of_normals_are_normals),
        cmocka_unit_test(named_normals_are_not_judged),
    };
    const struct CMUnitTest shared[] = {
        cmocka_unit_test(normals_of_blender_are_normals),
    };

    /* before the folder changes */
    return cmocka_run_group_tests(shared, NULL, NULL) +
           cmocka_run_group_tests(tests, enter_folder, leave_empty_folder);
}
