// SPDX-License-Identifier: MIT
/* test_obj_lines.c - lines of OBJ files: numbers, blanks, and what is refused
 */
#include <math.h>
#include <stdlib.h>

#include "engine/scene_load.h"
#include "tests/unit/locales.h"
#include "tests/unit/read/obj_texts.h"

static void numbers_have_their_values(void **state)
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

/* A locale with a decimal comma changes nothing. */
static void locale_changes_nothing(void **state)
{
    char *old = strdup(setlocale(LC_ALL, NULL));

    (void)state;
    if (!set_language(LC_ALL, "de_DE"))
        skip();
    check_refused("v 1,5 0 0\n",
                  "a.obj:1: found '1,5' after v, expected a number");
    numbers_have_their_values(state);
    setlocale(LC_ALL, old);
    free(old);
}

static void malformed_numbers_are_refused(void **state)
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

static void blanks_and_line_ends_are_skipped(void **state)
{
    (void)state;
    check_clean("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n", 1);
    check_clean("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r", 1);
    check_clean("v 0 0 0\rv 1 0 0\nv 0 1 0\r\n\n\rf 1 2 3", 1);
    check_clean("\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3", 1);
    check_clean("  v\t0   0\t\t0  \n\tv 1 0 0\nv  0 1 0 # a\n#f 1\n f 1 2 3 ",
                1);
    check_clean("v 0 0 0\nv 1 \\\n 0 \\\r\n 0\nv 0 1\\\r 0\nf 1 2 \\\n3\n", 1);
    /* A comment may end with the path of a folder. */
    check_clean("# c:\\models\\\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 1);
    check_clean("v 0 0 0 1\nv 1 0 0 0.5\nv 0 1 0\nvt 0 0 0\nvt 1\n"
                "s off\nl 1 2\np 1\nf 1 2 3 # x\n",
                1);
    check_clean("v 0 0 0\\", 0);
}

static void joined_lines_are_counted(void **state)
{
    (void)state;
    check_refused("v 0 \\\n0 \\\n0\nv x\n",
                  "a.obj:4: found 'x' after v, expected a number");
}

/* Tests a polygon of 100,000 corners on one line of 1 MB. */
static void long_lines_are_read(void **state)
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

static void other_files_are_refused(void **state)
{
    static const char utf16[] = "\xff\xfev\0 \0"
                                "0\0";
    static const char unmarked[] = "\0v\0 \0001\0 \0002\0 \0003\0\n";
    static const char binary[] = "v 1 2 3\n\0\0 v 1 2 3\n";
    struct loaded l;

    (void)state;
    check_refused("", "a.obj: not an OBJ file: found no OBJ statement");
    check_refused("\n\n# v 1 2 3\n",
                  "a.obj: not an OBJ file: found no OBJ statement");
    check_refused("Hello, world\n",
                  "a.obj: not an OBJ file: found no OBJ statement");
    l = load_bytes(utf16, sizeof utf16 - 1);
    assert_false(l.ok);
    assert_string_equal(l.err.text,
                        "a.obj: found text in UTF-16, expected UTF-8");
    unload(&l);
    l = load_bytes(unmarked, sizeof unmarked - 1);
    assert_string_equal(l.err.text,
                        "a.obj: found text in UTF-16, expected UTF-8");
    unload(&l);
    l = load_bytes(binary, sizeof binary - 1);
    assert_string_equal(l.err.text, "a.obj: not an OBJ file: found binary "
                                    "data, expected text");
    unload(&l);
    l = load_bytes("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
    assert_false(l.ok);
    unload(&l);
    assert_false(
        scene_load(&l.scene, "/", SCENE_UP_OF_FILE, &l.report, &l.err));
    assert_string_equal(l.err.text, "/: found a folder, expected a file");
    assert_false(scene_load(&l.scene, "no/such.obj", SCENE_UP_OF_FILE,
                            &l.report, &l.err));
    assert_string_equal(l.err.text, "no/such.obj: no such file or folder");
    unload(&l);
}

static void unknown_statements_are_warned_of(void **state)
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

static void check_color(const char *text, uint32_t vertex, double r, double g,
                        double b)
{
    struct loaded l = load_good(text, 1);
    struct vec3 c = l.scene.colors[vertex];

    assert_int_equal(l.report.entry_count, 0);
    assert_int_equal(l.scene.color_count, 3);
    check_close((double)c.x, r, 1e-6);
    check_close((double)c.y, g, 1e-6);
    check_close((double)c.z, b, 1e-6);
    unload(&l);
}

/* A fourth number of a vertex is a weight; three more are a colour in sRGB, in
 * which 0.5 is 0.2140411 (IEC 61966-2-1). */
static void vertices_have_colors(void **state)
{
    static const char shades[] =
        "v 0 0 0\nv 1 0 0 0 .5 1\nv 0 1 0 1 1 1 1\nf 1 2 3\n";
    static const char bytes[] =
        "v 0 0 0 0 127.5 255\nv 1 0 0 1 nan -3\nv 0 1 0 1e9 0 0\nf 1 2 3\n";
    struct loaded l =
        load_good("v 0 0 0 1\nv 1 0 0 1 # a b c\nv 0 1 0 1\nf 1 2 3\n", 1);

    (void)state;
    assert_null(l.scene.colors);
    unload(&l);
    check_color(shades, 0, 1, 1, 1);
    check_color(shades, 1, 0, 0.2140411, 1);
    check_color(shades, 2, 1, 1, 1);
    check_color(bytes, 0, 0, 0.2140411, 1);
    check_color(bytes, 2, 1, 0, 0);
}

static void free_form_surfaces_are_warned_of(void **state)
{
    (void)state;
    check_warned(SQUARE "cstype bspline\ndeg 3\ncurv 0 1 1 2\nend\nf 1 2 3\n",
                 1,
                 "a.obj:5: found 'cstype', a free-form curve or surface, which "
                 "glim does not draw",
                 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_have_their_values),
        cmocka_unit_test(locale_changes_nothing),
        cmocka_unit_test(malformed_numbers_are_refused),
        cmocka_unit_test(blanks_and_line_ends_are_skipped),
        cmocka_unit_test(joined_lines_are_counted),
        cmocka_unit_test(long_lines_are_read),
        cmocka_unit_test(other_files_are_refused),
        cmocka_unit_test(unknown_statements_are_warned_of),
        cmocka_unit_test(vertices_have_colors),
        cmocka_unit_test(free_form_surfaces_are_warned_of),
    };

    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
