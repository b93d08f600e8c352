// SPDX-License-Identifier: MIT
/*
 * test_gltf_load.c - what scenes of glTF have where the file does not say it:
 * units of lights, the default material; and what is said of it
 */
#include <math.h>
#include <stdlib.h>
#include <unistd.h>
#include <string.h>

#include "base/memory.h"
#include "engine/scene_load.h"
#include "read/view_file.h"
#include "tests/unit/files.h"

struct opened {
    struct scene scene;
    struct host_world world;
    struct view view;
    struct warnings report;
    struct error err;
};

/* Opens model.gltf with the lines of a view. */
static bool open_with(struct opened *o, const char *lines)
{
    const struct scene_options how = {.path = "model.gltf",
                                      .thread_count = 1,
                                      .view_lines = lines};

    memset(o, 0, sizeof *o);
    view_init(&o->view);
    return scene_open(&o->scene, &o->world, &o->view, &how, &o->report,
                      &o->err);
}

static void open_model(struct opened *o, const char *lines)
{
    bool ok = open_with(o, lines);

    check_or_say(ok, o->err.text);
}

static void close_model(struct opened *o)
{
    world_free(&o->world);
    scene_free(&o->scene);
    view_free(&o->view);
    warnings_free(&o->report);
}

/* Returns true if a warning has this text. */
static bool warns(const struct opened *o, const char *text)
{
    for (int i = 0; i < o->report.entry_count; i++)
        if (strstr(o->report.entries[i].text, text) != NULL)
            return true;
    return false;
}

/* Writes model.gltf: a triangle in a primitive with these members, and further
 * members of the root, with commas before them. */
static void put_model(const char *generator, const char *primitive,
                      const char *nodes, const char *root)
{
    char *text = format_text(
        "{\"asset\":{\"version\":\"2.0\",\"generator\":\"%s\"},"
        "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
        "\"count\":3,\"type\":\"VEC3\"}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}%s}]}],"
        "\"nodes\":[{\"mesh\":0}%s]%s}",
        generator, primitive, nodes, root);

    assert_non_null(text);
    put("model.gltf", text);
    free(text);
}

/* ---- units of lights ---- */

#define IO        "Khronos glTF Blender I/O "
#define FOUR_PI   (4 * M_PI)
#define NOT_KNOWN "unit that the file does not tell"

static void put_lights(const char *generator, double point, double sun)
{
    char *root = format_text(
        ",\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":"
        "\"point\",\"intensity\":%.17g},{\"type\":\"directional\","
        "\"intensity\":%.17g}]}},\"extensionsUsed\":[\"KHR_lights_punctual\"]",
        point, sun);

    assert_non_null(root);
    put_model(generator, "",
              ",{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}},"
              "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}}}",
              root);
    free(root);
}

static double lamp_of(const struct opened *o, uint32_t kind)
{
    for (uint32_t i = 0; i < o->view.lamps.count; i++)
        if (o->view.lamps.items[i].kind == kind)
            return o->view.lamps.items[i].rgb[0];
    return -1;
}

/* Blender's lamp of P watts has the intensity P / 4 pi, its sun the irradiance
 * of its strength. The modes of the exporter write P / 4 pi lm/W (Standard),
 * P / 4 pi (Unitless) and P (Raw), and versions before 3.4 write P. */
static void lights_of_blender_have_its_watts(void **state)
{
    static const struct {
        const char *version;
        double lumens; /* of a watt */
        bool is_raw;
        double watts, strength;
        bool is_guessed;
    } cases[] = {
        {IO "v4.0.44", 683, false, 1000, 3, false},
        {IO "v4.0.44", 1, false, 1000, 3, false},
        {IO "v4.0.44", 1, true, 1000, 3, false},
        {IO "v3.4.50", 683, false, 37.5, 0.8, false},
        {IO "v3.4.50", 1, false, 100, 0, false},
        {IO "v5.0.21", 1, true, 60, 0, false},
        {IO "v5.0.21", 683, false, 0, 1, false},
        {IO "v5.0.21", 1, false, 0, 2.5, false},
        {IO "v3.3.27", 1, true, 1000, 3, false},
        {IO "v1.2.75", 1, true, 54351.4, 3, false},
        {IO "v4.2.8", 683, false, 1234.5678, 3.14159, true},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double point =
            cases[i].watts * cases[i].lumens / (cases[i].is_raw ? 1 : FOUR_PI);
        struct opened o;

        print_message("%s, %g, %g\n", cases[i].version, point,
                      cases[i].strength * cases[i].lumens);
        put_lights(cases[i].version, point,
                   cases[i].strength * cases[i].lumens);
        open_model(&o, NULL);
        check_close(lamp_of(&o, LAMP_POINT), cases[i].watts / FOUR_PI,
                    1e-6 * cases[i].watts);
        check_close(lamp_of(&o, LAMP_DIRECTIONAL), cases[i].strength,
                    1e-6 * cases[i].strength);
        assert_int_equal(warns(&o, NOT_KNOWN), cases[i].is_guessed);
        close_model(&o);
    }
}

/* Powers of five and six digits, as Blender 5.0.1 wrote them: they are floats
 * there. 6710.008 is near a number of three digits, but not by a float's
 * error. Other programs keep five digits, of a kilowatt here. */
static void lights_have_the_digits_of_floats(void **state)
{
    static const struct {
        double intensity, watts;
        bool is_guessed;
    } cases[] = {
        {6710.0081211258475, 123.456, true},
        {9.824316429174008, 123.456, true},
        {123.45600128173828, 123.456, true},
        {2955.0862703384464, 54.37, false},
        {4.326627042955265, 54.37, false},
        {54.369998931884766, 54.37, false},
        {79.577, 1000, false},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct opened o;

        put_lights(IO "v5.0.21", cases[i].intensity, 0);
        open_model(&o, NULL);
        check_close(lamp_of(&o, LAMP_POINT), cases[i].watts / FOUR_PI,
                    1e-5 * cases[i].watts / FOUR_PI);
        assert_int_equal(warns(&o, NOT_KNOWN), cases[i].is_guessed);
        close_model(&o);
    }
}

static void other_programs_write_candela(void **state)
{
    struct opened o;

    (void)state;
    put_lights("three.js", 1000, 3);
    open_model(&o, NULL);
    check_close(lamp_of(&o, LAMP_POINT), 1000, 0);
    check_close(lamp_of(&o, LAMP_DIRECTIONAL), 3, 0);
    assert_false(warns(&o, NOT_KNOWN));
    close_model(&o);
}

/* A line of the view sets the unit, without a warning, and is saved. Lights of
 * the view itself stay. */
static void views_set_the_unit(void **state)
{
    static const struct {
        const char *line;
        double point, sun;
    } cases[] = {
        {"light_unit lumen\n", 1234.5 / 683, 683.0 / 683},
        {"light_unit watt\n", 1234.5 / FOUR_PI, 683},
        {"light_unit none\n", 1234.5, 683},
    };
    struct opened o;

    (void)state;
    put_lights(IO "v4.0.44", 1234.5, 683);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct error err;
        char *text;
        size_t size_bytes;

        open_model(&o, cases[i].line);
        check_close(lamp_of(&o, LAMP_POINT), cases[i].point,
                    1e-12 * cases[i].point);
        check_close(lamp_of(&o, LAMP_DIRECTIONAL), cases[i].sun,
                    1e-12 * cases[i].sun);
        assert_false(warns(&o, NOT_KNOWN));
        check_or_say(view_format(&o.view, &(struct file_bytes){"v.view", "", 0},
                                 &text, &size_bytes, &err),
                     err.text);
        assert_non_null(strstr(text, cases[i].line));
        free(text);
        close_model(&o);
    }
    open_model(&o, "light_unit lumen\nlight point 1 2 3 intensity 5 5 5\n");
    assert_int_equal(o.view.lamps.count, 1);
    check_close(lamp_of(&o, LAMP_POINT), 5, 0);
    close_model(&o);
    assert_false(open_with(&o, "light_unit candela\n"));
    check_has(o.err.text, "expected auto, lumen, watt or none");
    close_model(&o);
}

/* ---- materials ---- */

/* The specification's default material is that of {}: white metal, rough. */
static void primitives_without_material_have_the_default(void **state)
{
    static const char *const roots[] = {"", ",\"materials\":[{}]",
                                        ",\"materials\":[{\"name\":\"default\","
                                        "\"pbrMetallicRoughness\":"
                                        "{\"metallicFactor\":0}}]"};
    struct opened want, o;

    (void)state;
    put_model("", ",\"material\":0", "", ",\"materials\":[{}]");
    open_model(&want, NULL);
    for (size_t i = 0; i < sizeof roots / sizeof roots[0]; i++) {
        const struct material *m, *w;

        put_model("", "", "", roots[i]);
        open_model(&o, NULL);
        m = &o.scene.materials[o.scene.tris[0].material];
        w = &want.scene.materials[want.scene.tris[0].material];
        check_close((double)m->color.x, 1, 0);
        check_close((double)m->metalness, 1, 0);
        assert_memory_equal(m, w, sizeof *m);
        close_model(&o);
    }
    close_model(&want);
}

#define GLASS                                                         \
    ",\"materials\":[{\"name\":\"Pane\",\"extensions\":{"             \
    "\"KHR_materials_transmission\":{\"transmissionFactor\":1}%s}}]," \
    "\"extensionsUsed\":[\"KHR_materials_transmission\","             \
    "\"KHR_materials_volume\"]"

/* Blender's glass without a volume is a thin shell, with one hint. */
static void thin_glass_of_blender_has_a_hint(void **state)
{
    static const struct {
        const char *generator, *volume;
        bool has_hint;
    } cases[] = {
        {IO "v5.0.21", "", true},
        {IO "v5.0.21", ",\"KHR_materials_volume\":{\"thicknessFactor\":0.1}",
         false},
        {"three.js", "", false},
    };
    struct opened o;

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char *root = format_text(GLASS, cases[i].volume);

        put_model(cases[i].generator, ",\"material\":0", "", root);
        free(root);
        open_model(&o, NULL);
        assert_int_equal(warns(&o, "found 'Pane', glass without a volume"),
                         cases[i].has_hint);
        assert_int_equal(o.scene.materials[1].is_thin != 0,
                         *cases[i].volume == '\0');
        close_model(&o);
    }
    /* what the hint says removes it */
    put_model(IO "v5.0.21", ",\"material\":0", "",
              ",\"materials\":[{\"name\":\"Pane\",\"extensions\":{"
              "\"KHR_materials_transmission\":{\"transmissionFactor\":1}}}]");
    put("model.gltf.mtl", "newmtl Pane\nTf 1 1 1\nTf_thin 0\n");
    put("model.mtl", "newmtl Pane\nTf 1 1 1\nTf_thin 0\n");
    open_model(&o, NULL);
    assert_true(o.scene.materials[1].is_thin == 0);
    assert_false(warns(&o, "glass without a volume"));
    close_model(&o);
    unlink("model.gltf.mtl");
    unlink("model.mtl");
}

/* ---- KTX2 ---- */

#define TEXTURED(textures, required)                                     \
    ",\"images\":[{\"uri\":\"a.ktx2\"},{\"uri\":\"a.png\"}],"            \
    "\"textures\":[{" textures "\"extensions\":{\"KHR_texture_basisu\":" \
    "{\"source\":0}}}],\"materials\":[{\"pbrMetallicRoughness\":{"       \
    "\"baseColorTexture\":{\"index\":0}}}],"                             \
    "\"extensionsUsed\":[\"KHR_texture_basisu\"]" required
#define REQUIRED  ",\"extensionsRequired\":[\"KHR_texture_basisu\"]"
#define CONVERTER "'gltf-transform ktxdecompress IN OUT' converts"

static void ktx2_images_have_a_message(void **state)
{
    struct opened o;

    (void)state;
    put("a.png", "P3 1 1 255 255 0 0\n");
    put_model("", ",\"material\":0", "", TEXTURED("\"source\":1,", REQUIRED));
    open_model(&o, NULL); /* the other image is used */
    assert_int_equal(o.scene.texture_count, 1);
    assert_string_equal(path_name(o.scene.texture_paths[0]), "a.png");
    assert_false(warns(&o, "KHR_texture_basisu"));
    close_model(&o);
    put_model("", ",\"material\":0", "", TEXTURED("", ""));
    open_model(&o, NULL);
    assert_int_equal(o.scene.texture_count, 0);
    assert_true(warns(&o, CONVERTER));
    close_model(&o);
    put_model("", ",\"material\":0", "", TEXTURED("", REQUIRED));
    assert_false(open_with(&o, NULL));
    check_has(o.err.text, CONVERTER);
    check_has(o.err.text, "KHR_texture_basisu");
    close_model(&o);
}

/* ---- files ---- */

/* Buffers and the profiles of lamps are files of the scene, which --watch looks
 * at: each once, and none of a data URI. */
static void buffers_are_files_of_the_scene(void **state)
{
    static const char *const files[] = {"model.gltf", "v.view",
                                        "model.gltf.mtl", "a.bin", "b.bin"};
    struct opened o;
    uint32_t count = 0;
    const char *name;

    (void)state;
    put_bytes("a.bin", "0123", 4);
    put_bytes("b.bin", "0123", 4);
    put("model.gltf", "{\"asset\":{\"version\":\"2.0\"},\"buffers\":["
                      "{\"byteLength\":4,\"uri\":\"a.bin\"},"
                      "{\"byteLength\":4,\"uri\":\"b.bin\"},"
                      "{\"byteLength\":1,\"uri\":\"data:;base64,AAAA\"},"
                      "{\"byteLength\":2,\"uri\":\"./a.bin\"}]}");
    open_model(&o, NULL);
    while ((name = scene_file(&o.scene, &o.view, "v.view", count)) != NULL) {
        assert_true(count < sizeof files / sizeof *files);
        assert_string_equal(name, files[count]);
        count++;
    }
    assert_int_equal(count, sizeof files / sizeof *files);
    close_model(&o);
    put("i.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 50\n"
                 "0 90\n0\n9 9\n");
    open_model(&o, "light point 0 0 0 ies i.ies\nlight point 1 0 0\n"
                   "light point 0 0 1 ies i.ies\n");
    assert_string_equal(scene_file(&o.scene, &o.view, "v.view", count),
                        "i.ies");
    assert_null(scene_file(&o.scene, &o.view, "v.view", count + 1));
    close_model(&o);
    unlink("a.bin");
    unlink("b.bin");
    unlink("i.ies");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(buffers_are_files_of_the_scene),
        cmocka_unit_test(lights_of_blender_have_its_watts),
        cmocka_unit_test(lights_have_the_digits_of_floats),
        cmocka_unit_test(other_programs_write_candela),
        cmocka_unit_test(views_set_the_unit),
        cmocka_unit_test(primitives_without_material_have_the_default),
        cmocka_unit_test(thin_glass_of_blender_has_a_hint),
        cmocka_unit_test(ktx2_images_have_a_message),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
