// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/obj.h"
#include "tests/unit/check.h"
#include "tests/unit/locales.h"

/* A unit square of four vertices, to which tests add faces. */
#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

struct loaded {
    struct scene scene;
    struct warnings report;
    struct error err;
    bool ok;
};

static struct loaded load_bytes(const char *text, size_t size_bytes)
{
    struct loaded l = {.ok = false};
    char *copy = malloc(size_bytes == 0 ? 1 : size_bytes);

    /* exactly as long as it is, so that a sanitizer sees any step beyond */
    assert_non_null(copy);
    memcpy(copy, text, size_bytes);
    l.ok = obj_parse(&l.scene, copy, size_bytes, "a.obj", &l.report, &l.err);
    free(copy);
    return l;
}

static struct loaded load(const char *text)
{
    return load_bytes(text, strlen(text));
}

static void unload(struct loaded *l)
{
    scene_free(&l->scene);
    warnings_free(&l->report);
}

static struct loaded load_good(const char *text, uint32_t tri_count)
{
    struct loaded l = load(text);

    if (!l.ok)
        print_error("%s\n", l.err.text);
    assert_true(l.ok);
    assert_int_equal(l.scene.tri_count, tri_count);
    return l;
}

/* Loads without any warning. */
static void check_clean(const char *text, uint32_t tri_count)
{
    struct loaded l = load_good(text, tri_count);

    if (l.report.entry_count > 0)
        print_error("%s\n", l.report.entries[0].text);
    assert_int_equal(l.report.entry_count, 0);
    unload(&l);
}

static void check_refused(const char *text, const char *message)
{
    struct loaded l = load(text);

    assert_false(l.ok);
    assert_string_equal(l.err.text, message);
    unload(&l);
}

/* One kind of warning with this text, so often. */
static void check_warned(const char *text, uint32_t tri_count,
                         const char *message, uint64_t count)
{
    struct loaded l = load_good(text, tri_count);

    assert_int_equal(l.report.entry_count, 1);
    assert_string_equal(l.report.entries[0].text, message);
    assert_int_equal(l.report.entries[0].count, count);
    unload(&l);
}

static void check_tri(const struct scene *scene, uint32_t t, uint32_t a,
                      uint32_t b, uint32_t c)
{
    assert_int_equal(scene->tris[t].v[0], a);
    assert_int_equal(scene->tris[t].v[1], b);
    assert_int_equal(scene->tris[t].v[2], c);
}

static void test_index_forms(void **state)
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

/* Where only some corners have one, the triangle has none. */
static void test_all_three_or_none(void **state)
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

static void test_negative_indices_count_so_far(void **state)
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

static void test_bad_indices_drop_the_face(void **state)
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

static void test_malformed_faces(void **state)
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

/* Normals that somebody took out of the file do not cost its faces. */
static void test_absent_normals(void **state)
{
    (void)state;
    check_warned(SQUARE "f 1//1 2//1 3//1\n", 1,
                 "a.obj:5: found normal 1 in a face, but none before it: face "
                 "used without",
                 3);
}

static void test_number_values(void **state)
{
    static const double expected[] = {.5,   5,   1,      -5,    1e5,
                                      1e-2, 0,   0,      0.1,   123456789,
                                      1e22, -0., 5e-324, 1e300, 0.3};
    struct loaded l;

    (void)state;
    l = load_good("v .5 5. +1\nv -.5e1 1e+05 1E-2\nv 1e-400 -1e-400 .1\n"
                  "v 123456789 1e22 -0\n"
                  "v 5e-324 1e300 0.299999999999999988897769753748\n"
                  "l 1 2\n",
                  0);
    for (size_t i = 0; i < sizeof expected / sizeof expected[0]; i++)
        assert_true(l.scene.file_positions[i] == expected[i]);
    unload(&l);
}

/* The decimal comma of a locale must not matter, either way. */
static void test_locale_does_not_matter(void **state)
{
    char *old = strdup(setlocale(LC_ALL, NULL));

    (void)state;
    if (!set_language(LC_ALL, "de_DE"))
        skip();
    check_refused("v 1,5 0 0\n",
                  "a.obj:1: found '1,5' after v, expected a number");
    test_number_values(state);
    setlocale(LC_ALL, old);
    free(old);
}

static void test_malformed_numbers(void **state)
{
    (void)state;
    check_refused(SQUARE "v 1 2 x\n",
                  "a.obj:5: found 'x' after v, expected a number");
    check_refused("v 1 2\n",
                  "a.obj:1: found the end of the line after v, expected a "
                  "number");
    check_refused("v 1 2",
                  "a.obj:1: found the end of the line after v, expected a "
                  "number");
    check_refused("v 0x10 0 0\n",
                  "a.obj:1: found '0x10' after v, expected a number");
    check_refused("#\r\n\rv 1 2 3.1+e2\r\n",
                  "a.obj:3: found '3.1+e2' after v, expected a number");
    check_refused("vn 0 1 --1\n",
                  "a.obj:1: found '--1' after vn, expected a number");
    check_refused("vt\n", "a.obj:1: found the end of the line after vt, "
                          "expected a number");
    check_refused("v 1 2 \033[31m\n",
                  "a.obj:1: found '?[31m' after v, expected a number");
}

static void test_vertices_that_are_not_finite(void **state)
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

static void test_lines_and_blanks(void **state)
{
    (void)state;
    check_clean("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n", 1);
    check_clean("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r", 1);
    check_clean("v 0 0 0\rv 1 0 0\nv 0 1 0\r\n\n\rf 1 2 3", 1);
    check_clean("\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3", 1);
    check_clean("  v\t0   0\t\t0  \n\tv 1 0 0\nv  0 1 0 # a\n#f 1\n f 1 2 3 ",
                1);
    check_clean("v 0 0 0\nv 1 \\\n 0 \\\r\n 0\nv 0 1\\\r 0\nf 1 2 \\\n3\n", 1);
    /* comments end with paths of folders */
    check_clean("# c:\\models\\\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 1);
    check_clean("v 0 0 0 1\nv 1 0 0 0.5\nv 0 1 0\nvt 0 0 0\nvt 1\n"
                "s off\nl 1 2\np 1\nf 1 2 3 # x\n",
                1);
    check_clean("v 0 0 0\\", 0);
}

static void test_joined_lines_count(void **state)
{
    (void)state;
    check_refused("v 0 \\\n0 \\\n0\nv x\n",
                  "a.obj:4: found 'x' after v, expected a number");
}

/* A polygon of 100,000 corners on one line of 1 MB. */
static void test_long_line(void **state)
{
    uint32_t n = 100000;
    char *text = malloc(80 * (size_t)n);
    size_t used = 0;
    struct loaded l;

    (void)state;
    assert_non_null(text);
    for (uint32_t i = 0; i < n; i++) {
        double angle = 2 * 3.14159265358979323846 * i / n;

        used += (size_t)sprintf(text + used, "v %.17g %.17g 0\n", cos(angle),
                                sin(angle));
    }
    text[used++] = 'f';
    for (uint32_t i = 0; i < n; i++)
        used += (size_t)sprintf(text + used, "       %u", i + 1);
    l = load_good(text, n - 2);
    assert_int_equal(l.report.entry_count, 0);
    unload(&l);
    free(text);
}

static void test_not_an_obj_file(void **state)
{
    static const char utf16[] = "\xff\xfev\0 \0"
                                "0\0";
    struct loaded l;

    (void)state;
    check_refused("", "a.obj: not an OBJ file: found no OBJ statement");
    check_refused("\n\n# v 1 2 3\n",
                  "a.obj: not an OBJ file: found no OBJ statement");
    check_refused("Hello, world\n",
                  "a.obj: not an OBJ file: found no OBJ statement");
    l = load_bytes(utf16, sizeof utf16 - 1);
    assert_false(l.ok);
    assert_string_equal(l.err.text, "a.obj: not an OBJ file: found binary data "
                                    "or UTF-16, expected text");
    unload(&l);
    l = load_bytes("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
    assert_false(l.ok);
    unload(&l);
    assert_false(obj_read(&l.scene, "/", &l.report, &l.err));
    assert_false(obj_read(&l.scene, "no/such.obj", &l.report, &l.err));
    unload(&l);
}

static void test_unknown_statements(void **state)
{
    struct loaded l = load_good(SQUARE "vw 1\nlod 1\nvw 2\nvw\nf 1 2 3\n", 1);

    (void)state;
    assert_int_equal(l.report.entry_count, 2);
    assert_string_equal(l.report.entries[0].text,
                        "a.obj:5: found 'vw', which glim does not use");
    assert_int_equal(l.report.entries[0].count, 3);
    assert_string_equal(l.report.entries[1].text,
                        "a.obj:6: found 'lod', which glim does not use");
    unload(&l);
}

/* Behind a place: a weight is nothing to say, a colour is. */
static void test_colors_of_vertices(void **state)
{
    static const char said[] =
        "a.obj:1: found the colour of a vertex, which glim does not use";

    (void)state;
    check_clean("v 0 0 0 1\nv 1 0 0 1 # a b c\nv 0 1 0 1\nf 1 2 3\n", 1);
    check_warned("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n", 1,
                 said, 1);
    check_warned("v 0 0 0 1 .5 .5 .5\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 1, said, 1);
}

static void test_free_forms(void **state)
{
    (void)state;
    check_warned(SQUARE "cstype bspline\ndeg 3\ncurv 0 1 1 2\nend\nf 1 2 3\n",
                 1,
                 "a.obj:5: found 'cstype', a free-form curve or surface, which "
                 "glim does not draw",
                 4);
}

static void test_objects(void **state)
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

/* Faces keep their number in the file, also behind dropped ones. */
static void test_face_numbers(void **state)
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

static void test_unknown_materials(void **state)
{
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
    for (int t = 0; t < 4; t++)
        assert_int_equal(l.scene.tris[t].material, 0);
    check_close(l.scene.materials[0].color.x, 0.8, 1e-7);
    unload(&l);
}

static void test_texture_coordinates_are_tame(void **state)
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

/* So many names that time which grows with their square would be minutes. */
static void test_many_names(void **state)
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_index_forms),
        cmocka_unit_test(test_all_three_or_none),
        cmocka_unit_test(test_negative_indices_count_so_far),
        cmocka_unit_test(test_bad_indices_drop_the_face),
        cmocka_unit_test(test_malformed_faces),
        cmocka_unit_test(test_absent_normals),
        cmocka_unit_test(test_number_values),
        cmocka_unit_test(test_locale_does_not_matter),
        cmocka_unit_test(test_malformed_numbers),
        cmocka_unit_test(test_vertices_that_are_not_finite),
        cmocka_unit_test(test_lines_and_blanks),
        cmocka_unit_test(test_joined_lines_count),
        cmocka_unit_test(test_long_line),
        cmocka_unit_test(test_not_an_obj_file),
        cmocka_unit_test(test_unknown_statements),
        cmocka_unit_test(test_colors_of_vertices),
        cmocka_unit_test(test_free_forms),
        cmocka_unit_test(test_objects),
        cmocka_unit_test(test_face_numbers),
        cmocka_unit_test(test_unknown_materials),
        cmocka_unit_test(test_texture_coordinates_are_tame),
        cmocka_unit_test(test_many_names),
    };

    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
