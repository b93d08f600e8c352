// SPDX-License-Identifier: MIT
/*
 * test_light_probe.c - light that surfaces reflect is measured, and decides
 * whether a model is lit as a studio
 */
#include "engine/scene_load.h"

#include <stdlib.h>
#include <unistd.h>

#include "base/memory.h"
#include "read/view_file.h"
#include "tests/unit/check.h"
#include "tests/unit/files.h"

struct opened {
    struct scene scene;
    struct host_world world;
    struct view view;
    struct warnings report;
};

static void open_files(struct opened *o, const char *scene, const char *view)
{
    struct scene_options how = {.path = scene,
                                .up = SCENE_UP_OF_FILE,
                                .thread_count = 2};
    char *path = NULL;
    struct error err;

    *o = (struct opened){.report = {0}};
    view_init(&o->view);
    put("v.view", view);
    check_or_say(view_find(&o->view, scene, "v.view", &path, &o->report,
                           &err) &&
                     scene_open(&o->scene, &o->world, &o->view, &how,
                                &o->report, &err),
                 err.text);
    free(path);
}

static void close_files(struct opened *o)
{
    world_free(&o->world);
    scene_free(&o->scene);
    view_free(&o->view);
    warnings_free(&o->report);
}

/* ---- measurement ---- */

#define DOWN "eye 0 3 0\nat 0 0 0\nup 0 0 -1\n"

/* A plane that fills the picture. */
static void check_plane(const char *material, const char *view, double mean,
                        double shown, double with_seen)
{
    char *mtl = format_text("newmtl m\n%s\n", material);
    struct light_probe p;
    struct opened o;
    struct error err;

    put("p.mtl", mtl);
    put("p.obj", "mtllib p.mtl\nusemtl m\nv -9 0 -9\nv -9 0 9\nv 9 0 9\n"
                 "v 9 0 -9\nf 1 2 3 4\n");
    open_files(&o, "p.obj", view);
    check_or_say(light_probe_take(&p, &o.world, &o.scene, &o.view, false, &err),
                 err.text);
    check_close(p.mean, mean, 1e-6);
    check_close(p.shown, shown, 0);
    check_or_say(light_probe_take(&p, &o.world, &o.scene, &o.view, true, &err),
                 err.text);
    check_close(p.mean, with_seen, 1e-6);
    close_files(&o);
    free(mtl);
}

/* A lamp in a globe of glass lights the floor. */
static void lamps_in_glass_count(void **state)
{
    struct light_probe p;
    struct opened o;
    struct error err;

    (void)state;
    put("p.mtl", "newmtl m\nKd .5 .5 .5\nnewmtl glass\nillum 7\nNi 1.5\n"
                 "newmtl lamp\nKd 0 0 0\nKe 50 50 50\n");
    put("p.obj", "mtllib p.mtl\nusemtl m\nv -9 0 -9\nv -9 0 9\nv 9 0 9\n"
                 "v 9 0 -9\nf 1 2 3 4\nusemtl lamp\n"
                 "v -.1 1 -.1\nv .1 1 -.1\nv 0 1 .1\nf -3 -2 -1\n"
                 "usemtl glass\nv .3 1 0\nv -.3 1 0\nv 0 1.3 0\nv 0 .7 0\n"
                 "v 0 1 .3\nv 0 1 -.3\n"
                 "f -6 -4 -2\nf -2 -4 -5\nf -5 -4 -1\nf -1 -4 -6\n"
                 "f -2 -3 -6\nf -5 -3 -2\nf -1 -3 -5\nf -6 -3 -1\n");
    open_files(&o, "p.obj", "eye 0 .6 2\nat 0 0 0\nbackground 0 0 0\n");
    check_or_say(light_probe_take(&p, &o.world, &o.scene, &o.view, false, &err),
                 err.text);
    check_at_most(0.3, p.shown);
    close_files(&o);
}

/* Under a sky of radiance 1 a plane of albedo a has radiance a, which counts as
 * 1 at most and after the exposure; emission is seen, not reflected. */
static void reflected_light_is_measured(void **state)
{
    (void)state;
    check_plane("Kd .5", DOWN "background 1 1 1\n", .5, 1, .5);
    check_plane("Kd .5", DOWN "background 1 1 1\nexposure -2\n", .125, 1, .125);
    check_plane("Kd .5", DOWN "background 9 9 9\n", 1, 1, 1);
    check_plane("Kd .5", DOWN "background .004 .004 .004\n", .002, 0, .002);
    check_plane("Kd 0\nKe .25", DOWN "background 0 0 0\n", 0, 0, .25);
    check_plane("Kd .5 0 0", DOWN "background 1 1 1\n", .5 * .2126, 1,
                .5 * .2126);
}

/* ---- decision ---- */

/* Writes a red floor of side 2 and a square lamp over it or below it, with this
 * half side and height, and a point light of this intensity over it. */
static void put_model(float half, float height, double strength,
                      double intensity)
{
    const float points[2][4][3] = {
        {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}},
        {{-half, height, -half},
         {-half, height, half},
         {half, height, half},
         {half, height, -half}}};
    const uint16_t corners[6] = {0, 1, 2, 0, 2, 3};
    unsigned char bytes[sizeof points + sizeof corners];
    char *text = format_text(
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,"
        "\"scenes\":[{\"nodes\":[0,1,2]}],\"nodes\":[{\"mesh\":0},{\"mesh\":1},"
        "{\"translation\":[0,1,0],\"extensions\":{\"KHR_lights_punctual\":"
        "{\"light\":0}}}],"
        "\"extensionsUsed\":[\"KHR_lights_punctual\","
        "\"KHR_materials_emissive_strength\"],"
        "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":"
        "\"point\",\"intensity\":%g}]}},"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
        "\"indices\":2,\"material\":0}]},{\"primitives\":[{\"attributes\":{"
        "\"POSITION\":1},\"indices\":2,\"material\":1}]}],"
        "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":"
        "[0.8,0.1,0.1,1],\"metallicFactor\":0}},{\"pbrMetallicRoughness\":{"
        "\"baseColorFactor\":[0,0,0,1]},\"emissiveFactor\":[1,0.5,0.25],"
        "\"extensions\":{\"KHR_materials_emissive_strength\":{"
        "\"emissiveStrength\":%g}}}],"
        "\"buffers\":[{\"byteLength\":%zu,\"uri\":\"m.bin\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,"
        "\"byteOffset\":48,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":96,"
        "\"byteLength\":12}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,"
        "\"type\":\"VEC3\"},{\"bufferView\":1,\"componentType\":5126,"
        "\"count\":4,\"type\":\"VEC3\"},{\"bufferView\":2,\"componentType\":"
        "5123,\"count\":6,\"type\":\"SCALAR\"}]}",
        intensity, strength, sizeof bytes);

    memcpy(bytes, points, sizeof points);
    memcpy(bytes + sizeof points, corners, sizeof corners);
    put_bytes("m.bin", bytes, sizeof bytes);
    put("m.gltf", text);
    free(text);
}

/* A lamp counts by what it does for the floor that the camera sees: a diode
 * does little for all its radiance, and a large lamp much; one below the floor,
 * or of little intensity, does nothing. A message says so for what would be a
 * lamp. */
static void light_that_shows_little_is_helped(void **state)
{
    static const struct {
        float half, height;
        double strength, intensity;
        const char *view;
        bool is_studio, says_so;
    } cases[] = {
        {.02f, .2f, 25, 0, "", true, true}, /* a diode */
        {.02f, .2f, 1, 0, "", true, false}, /* an eye that glows */
        {.5f, .5f, 25, 0, "", false, false},
        {.5f, .5f, 1, 0, "", false, false}, /* a ceiling of emissiveFactor 1 */
        {.5f, -.5f, 25, 0, "", true, true}, /* hidden by the floor */
        {.5f, 500, 25, 0, "", true, true},  /* so far that both are specks */
        {.02f, .2f, 0, 5, "", false, false},
        {.02f, .2f, 0, 1e-3, "", true, true}, /* milliwatts for watts */
        {.02f, .2f, 25, 0, "background 0 0 0\n", false, false},
        {.02f, .2f, 25, 0, "light point 0 1 0\n", false, false},
        {.02f, .2f, 25, 0, "exposure 8\n", false, false},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct opened o;

        put_model(cases[i].half, cases[i].height, cases[i].strength,
                  cases[i].intensity);
        open_files(&o, "m.gltf", cases[i].view);
        assert_int_equal(o.view.lighting.background[0] > 0, cases[i].is_studio);
        assert_int_equal(warnings_have(&o.report, SCENE_LITTLE_LIGHT),
                         cases[i].says_so);
        close_files(&o);
    }
    unlink("m.bin");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reflected_light_is_measured),
        cmocka_unit_test(lamps_in_glass_count),
        cmocka_unit_test(light_that_shows_little_is_helped),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
