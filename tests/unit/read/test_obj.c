// SPDX-License-Identifier: MIT
/* test_obj.c - faces of OBJ files: indices, objects, materials, numbers */
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "tests/unit/files.h"
#include "tests/unit/read/obj_texts.h"

static void check_tri(const struct scene *scene, uint32_t t, uint32_t a,
                      uint32_t b, uint32_t c)
{
    assert_int_equal(scene->tris[t].v[0], a);
    assert_int_equal(scene->tris[t].v[1], b);
    assert_int_equal(scene->tris[t].v[2], c);
}

static void all_forms_of_indices_are_read(void **state)
{
    static const char *const faces[] = {
        "f 1 2 3\n",          "f 1/1 2/2 3/1\n",
        "f 1//1 2//1 3//2\n", "f 1/1/1 2/2/2 3/1/2\n",
        "f -4 -3 -2\n",       "f -4/-2/-2 2/-1/-1 3/1/1\n",
        "f 1/ 2/ 3/\n",       "f 1// 2// 3//\n",
    };

    (void)state;
    for (size_t i = 0; i < sizeof faces / sizeof faces[0]; i++) {
        char text[256];
        struct loaded l;
        bool has_vt = strstr(faces[i], "/1 ") || strstr(faces[i], "/-2/");
        bool has_vn = strstr(faces[i], "//1") || strstr(faces[i], "/1/1") ||
                      strstr(faces[i], "/-2/-2");

        has_vt = has_vt && !strstr(faces[i], "//");
        snprintf(text, sizeof text,
                 SQUARE "vt 0 0\nvt 1 0.5\nvn 0 0 2\nvn 0 3 4\n%s", faces[i]);
        l = load_good(text, 1);
        assert_int_equal(l.report.entry_count, 0);
        check_tri(&l.scene, 0, 0, 1, 2);
        assert_int_equal(l.scene.tris[0].vt[0], has_vt ? 0 : NO_INDEX);
        assert_int_equal(l.scene.tris[0].vt[1], has_vt ? 1 : NO_INDEX);
        assert_int_equal(l.scene.tris[0].vn[0], has_vn ? 0 : NO_INDEX);
        check_close(l.scene.normals[1].y, 0.6, 1e-7);
        check_close(l.scene.normals[1].z, 0.8, 1e-7);
        unload(&l);
    }
}

/* A triangle has normals only if all three corners have one; texture
 * coordinates likewise. */
static void all_three_corners_have_normals_or_none(void **state)
{
    struct loaded l =
        load_good(SQUARE "vt 0 0\nvn 0 0 1\nvn 0 0 0\nvn nan 0 1\nvn inf 0 1\n"
                         "f 1/1/1 2 3/1/1\nf 1//1 2//2 3//1\nf 1//3 2//1 3//1\n"
                         "f 1//1 2//4 3//1\nf 1//1 2//1 3//1\n",
                  5);

    (void)state;
    for (int t = 0; t < 5; t++) {
        for (int k = 0; k < 3; k++) {
            assert_int_equal(l.scene.tris[t].vt[k], NO_INDEX);
            assert_int_equal(l.scene.tris[t].vn[k], t == 4 ? 0 : NO_INDEX);
        }
    }
    unload(&l);
}

static void negative_indices_count_back_from_the_face(void **state)
{
    struct loaded l = load_good("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n"
                                "v 0 0 1\nv 1 0 1\nv 0 1 1\nf -3 -2 -1\n"
                                "f 1 -2 -1\n",
                                3);

    (void)state;
    check_tri(&l.scene, 0, 0, 1, 2);
    check_tri(&l.scene, 1, 3, 4, 5);
    check_tri(&l.scene, 2, 0, 4, 5);
    unload(&l);
}

static void faces_with_bad_indices_are_dropped(void **state)
{
    (void)state;
    check_warned(SQUARE "f 1 2 0\nf 1 2 3\nf 1 2 0\n", 1,
                 "a.obj:5: found vertex 0 in a face, expected 1 to 4 or -1 to "
                 "-4: face dropped",
                 2);
    check_warned(SQUARE
                 "f 1 2 5\nf 1 2 -5\nf 1 2 4294967295\nf 1 2 4294967297\n"
                 "f 1 2 -9223372036854775808\n"
                 "f 1 2 99999999999999999999999999\n",
                 0,
                 "a.obj:5: found vertex 5 in a face, expected 1 to 4 or -1 to "
                 "-4: face dropped",
                 6);
    check_warned(
        SQUARE "vt 0 0\nf 1/1 2/1 3/2\n", 0,
        "a.obj:6: found texture vertex 2 in a face, expected 1 to 1 or "
        "-1 to -1: face dropped",
        1);
    check_warned(SQUARE "vn 0 0 1\nf 1//1 2//0 3//1\n", 0,
                 "a.obj:6: found normal 0 in a face, expected 1 to 1 or -1 to "
                 "-1: face dropped",
                 1);
    check_warned(
        "f 1 2 3\n", 0,
        "a.obj:1: found vertex 1 in a face, but none before it: face dropped",
        1);
    check_warned(SQUARE "f 1 2\nf 1\nf\n", 0,
                 "a.obj:5: found a face with 2 corners, expected 3 or more: "
                 "face dropped",
                 3);
}

static void malformed_faces_are_refused(void **state)
{
    static const char *const corners[] = {"x",  "1x", "1/x", "1/1/x", "1/1/1/1",
                                          "/1", "-",  "+1",  "1.5",   "//"};

    (void)state;
    for (size_t i = 0; i < sizeof corners / sizeof corners[0]; i++) {
        char text[256];
        char message[256];

        snprintf(text, sizeof text, SQUARE "vt 0 0\nvn 0 0 1\nf 1 2 %s\n",
                 corners[i]);
        snprintf(message, sizeof message,
                 "a.obj:7: found '%s' in a face, expected v, v/vt, v//vn or "
                 "v/vt/vn: face dropped",
                 corners[i]);
        check_warned(text, 0, message, 1);
    }
}

/* A file whose normals were removed keeps its faces. */
static void faces_with_absent_normals_are_kept(void **state)
{
    (void)state;
    check_warned(SQUARE "f 1//1 2//1 3//1\n", 1,
                 "a.obj:5: found normal 1 in a face, but none before it: face "
                 "used without",
                 3);
}

static void faces_of_infinite_vertices_are_dropped(void **state)
{
    (void)state;
    check_warned(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan -nan 0\nv inf 0 0\n"
        "v 1e400 0 0\nv -1.#IND 0 0\nv 1.#INF00 0 0\nv -nan(ind) 0 0\n"
        "f 1 2 3\nf 1 2 4\nf 1 2 5\nf 1 2 6\nf 1 2 7\nf 1 2 8\n"
        "f 1 2 3 9\n",
        1,
        "a.obj:11: found a face with a vertex that is not finite: face "
        "dropped",
        6);
}

static void faces_have_their_object(void **state)
{
    struct loaded l = load_good(SQUARE "f 1 2 3\ng wall left\nf 1 2 3\n"
                                       "o two  words \nf 1 2 3\ng inner\n"
                                       "f 1 2 3\no wall left\nf 1 2 3\n",
                                5);
    static const uint32_t objects[] = {0, 1, 2, 2, 1};

    (void)state;
    assert_int_equal(l.scene.object_count, 3);
    assert_string_equal(l.scene.object_names[0], "");
    assert_string_equal(l.scene.object_names[1], "wall left");
    assert_string_equal(l.scene.object_names[2], "two  words");
    for (int t = 0; t < 5; t++)
        assert_int_equal(l.scene.tri_objects[t], objects[t]);
    unload(&l);
}

/* Faces keep their numbers in the file after dropped faces. */
static void faces_keep_their_numbers(void **state)
{
    struct loaded l =
        load_good(SQUARE "f 1 2 3\nf 1 2 9\nf 1 2 3 4\nf 4 3 2\n", 4);
    static const uint32_t faces[] = {0, 2, 2, 3};

    (void)state;
    for (int t = 0; t < 4; t++)
        assert_int_equal(l.scene.tri_faces[t], faces[t]);
    check_tri(&l.scene, 1, 0, 1, 2);
    check_tri(&l.scene, 2, 0, 2, 3);
    unload(&l);
}

static void unknown_materials_are_warned_of(void **state)
{
    static const char *const names[] = {"red", "two words", "red", "material"};
    struct loaded l =
        load_good(SQUARE "usemtl red\nf 1 2 3\nusemtl two words \nf 1 2 3\n"
                         "usemtl red\nf 1 2 3\nusemtl\nf 1 2 3\n",
                  4);

    (void)state;
    assert_int_equal(l.report.entry_count, 2);
    assert_string_equal(
        l.report.entries[0].text,
        "a.obj:5: found no material 'red': grey is used instead");
    assert_string_equal(
        l.report.entries[1].text,
        "a.obj:7: found no material 'two words': grey is used instead");
    for (int t = 0; t < 4; t++) {
        uint32_t material = l.scene.tris[t].material;

        assert_string_equal(l.scene.material_names[material], names[t]);
        check_close(l.scene.materials[material].color.x, 0.8, 1e-7);
    }
    unload(&l);
}

/* Without an MTL file the materials belong to one beside the OBJ file, which is
 * read if it is there, also in place of one that is missing. */
static void materials_without_mtl_have_a_file(void **state)
{
    struct loaded l;
    uint32_t red;

    (void)state;
    l = load_good(SQUARE "f 1 2 3\n", 1);
    assert_true(l.scene.has_own_mtl && !l.scene.is_model);
    assert_string_equal(l.scene.mtl_paths[0], "a.obj.mtl");
    assert_string_equal(l.scene.material_names[l.scene.tris[0].material],
                        "material");
    assert_int_equal(l.report.entry_count, 0);
    unload(&l);
    put("a.obj.mtl", "newmtl red\nKd .9 0 0\nnewmtl material\nKd 0 0 .7\n"
                     "newmtl material.2\nKd 0 1 0\n");
    l = load_good("mtllib none.mtl\n" SQUARE "f 1 2 3\nusemtl red\nf 1 2 3\n"
                  "usemtl blue\nf 1 2 3\n",
                  3);
    check_close(l.scene.materials[l.scene.tris[0].material].color.z, 0.7, 1e-7);
    red = l.scene.tris[1].material;
    check_close(l.scene.materials[red].color.x, 0.9, 1e-7);
    assert_int_equal(l.scene.material_count, 5);
    assert_int_equal(l.report.entry_count, 2);
    assert_string_equal(l.report.entries[0].text,
                        "a.obj:1: found no file 'none.mtl' for mtllib: its "
                        "materials are missing");
    assert_string_equal(
        l.report.entries[1].text,
        "a.obj:9: found no material 'blue': grey is used instead");
    unload(&l);
    put("one.mtl", "newmtl red\nKd 1 0 0\n");
    l = load_good("mtllib one.mtl\n" SQUARE "usemtl red\nf 1 2 3\n", 1);
    assert_false(l.scene.has_own_mtl);
    check_close(l.scene.materials[l.scene.tris[0].material].color.x, 1, 1e-7);
    unload(&l);
    unlink("one.mtl");
    unlink("a.obj.mtl");
}

static void texture_coordinates_are_finite(void **state)
{
    struct loaded l = load_good("vt nan inf\nvt 1e9 -1e300\nvt 1e400 0.25\n"
                                "vt -3.5 1000000\nvt 12345678.75 -0.25\n",
                                0);

    (void)state;
    for (uint32_t i = 0; i < l.scene.uv_count; i++) {
        check_at_most(fabs((double)l.scene.uvs[i].x), 1e6);
        check_at_most(fabs((double)l.scene.uvs[i].y), 1e6);
    }
    check_close(l.scene.uvs[3].x, -3.5, 0);
    check_close(l.scene.uvs[4].x, 0.75, 0);
    check_close(l.scene.uvs[4].y, -0.25, 0);
    unload(&l);
}

/* With this many names, quadratic time would be minutes. */
static void many_names_take_linear_time(void **state)
{
    uint32_t n = 200000;
    char *text = malloc(64 * (size_t)n);
    size_t used = 0;
    struct loaded l;

    (void)state;
    assert_non_null(text);
    for (uint32_t i = 0; i < n; i++)
        used +=
            (size_t)sprintf(text + used, "o o%u\nusemtl m%u\nq%u\n", i, i, i);
    text[used++] = 'o';
    text[used] = '\0';
    l = load_good(text, 0);
    assert_int_equal(l.scene.object_count, n + 1);
    assert_int_equal(l.report.entry_count, 2 * WARNINGS_NAMES_MAX + 2);
    unload(&l);
    free(text);
}

/* IEC 61966-2-1. */
static double linear(double x)
{
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

/* ZBrush: MMRRGGBB for each vertex, in comments that go on. */
static void colors_of_zbrush_are_read(void **state)
{
    struct loaded l =
        load_good(SQUARE "#MRGB ffff0000ff00ff00\n#MRGB FF3366CC\nf 1 2 3 4\n",
                  2);
    static const double colors[4][3] = {{1, 0, 0},
                                        {0, 1, 0},
                                        {.2, .4, .8},
                                        {1, 1, 1}};

    (void)state;
    assert_int_equal(l.report.entry_count, 0);
    assert_int_equal(l.scene.color_count, 4);
    for (int i = 0; i < 4; i++) {
        check_close((double)l.scene.colors[i].x, linear(colors[i][0]), 1e-6);
        check_close((double)l.scene.colors[i].y, linear(colors[i][1]), 1e-6);
        check_close((double)l.scene.colors[i].z, linear(colors[i][2]), 1e-6);
    }
    unload(&l);
    l = load_good("v 0 0 0\n#MRGB 00ffffff0\n#MRGBA 1\n# MRGB\n", 0);
    assert_string_equal(l.report.entries[0].text,
                        "a.obj:2: found '0' in #MRGB, expected 8 hexadecimal "
                        "digits for each vertex before it: not used");
    unload(&l);
}

/* libassimp gives such faces the material of the MTL file. With several it
 * takes the last one, which is no better than any other. */
static void a_single_material_needs_no_usemtl(void **state)
{
    struct loaded l;

    (void)state;
    put("one.mtl", "newmtl red\nKd 1 0 0\n");
    l = load_good("mtllib one.mtl\n" SQUARE "f 1 2 3\n", 1);
    assert_int_equal(l.scene.tris[0].material, 1);
    assert_string_equal(l.report.entries[0].text,
                        "a.obj: found faces without usemtl, and one material: "
                        "'red' is used");
    unload(&l);
    put("one.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    l = load_good("mtllib one.mtl\n" SQUARE "f 1 2 3\n", 1);
    assert_int_equal(l.scene.tris[0].material, 0);
    assert_string_equal(l.report.entries[0].text,
                        "a.obj: found faces without usemtl, and 2 materials: "
                        "grey is used");
    unload(&l);
    l = load_good("mtllib one.mtl\n" SQUARE "usemtl blue\nf 1 2 3\n", 1);
    assert_int_equal(l.scene.tris[0].material, 2);
    assert_int_equal(l.report.entry_count, 0);
    unload(&l);
    unlink("one.mtl");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_forms_of_indices_are_read),
        cmocka_unit_test(all_three_corners_have_normals_or_none),
        cmocka_unit_test(negative_indices_count_back_from_the_face),
        cmocka_unit_test(faces_with_bad_indices_are_dropped),
        cmocka_unit_test(malformed_faces_are_refused),
        cmocka_unit_test(faces_with_absent_normals_are_kept),
        cmocka_unit_test(faces_of_infinite_vertices_are_dropped),
        cmocka_unit_test(faces_have_their_object),
        cmocka_unit_test(faces_keep_their_numbers),
        cmocka_unit_test(unknown_materials_are_warned_of),
        cmocka_unit_test(materials_without_mtl_have_a_file),
        cmocka_unit_test(texture_coordinates_are_finite),
        cmocka_unit_test(many_names_take_linear_time),
        cmocka_unit_test(colors_of_zbrush_are_read),
        cmocka_unit_test(a_single_material_needs_no_usemtl),
    };

    return cmocka_run_group_tests(tests, enter_folder, leave_empty_folder);
}
