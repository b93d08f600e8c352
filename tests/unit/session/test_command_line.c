// SPDX-License-Identifier: MIT
/*
 * test_command_line.c - what each option sets, and the exact messages about
 * wrong ones
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "session/command_line.h"

#include <cmocka.h> /* last: it has a macro fail() */

#define ARGS_MAX 40

/* Parses "a b c" as the arguments behind the program's name. */
static bool parse(struct options *o, const char *line, struct error *err)
{
    static char text[512];
    static char program[] = "glim";
    char *argv[ARGS_MAX] = {program};
    int argc = 1;

    assert_true(strlen(line) < sizeof text);
    strcpy(text, line);
    for (char *p = text; *p; argc++) {
        assert_true(argc < ARGS_MAX - 1);
        argv[argc] = p;
        p += strcspn(p, " ");
        if (*p)
            *p++ = '\0';
    }
    err->text[0] = '\0';
    options_init(o);
    return options_parse(o, argc, argv, err);
}

static struct options good(const char *line)
{
    struct options o;
    struct error err;

    if (!parse(&o, line, &err))
        fail_msg("'%s': %s", line, err.text);
    return o;
}

static void bad(const char *line, const char *text)
{
    struct options o;
    struct error err;

    if (parse(&o, line, &err))
        fail_msg("'%s' was taken, expected: %s", line, text);
    assert_string_equal(err.text, text);
    free(o.view_lines);
}

static void defaults_are_set(void **state)
{
    struct options o = good("a.obj");

    (void)state;
    assert_string_equal(o.scene_path, "a.obj");
    assert_null(o.view_path);
    assert_null(o.output_path);
    assert_null(o.stats_path);
    assert_int_equal(o.width_px, 0);
    assert_int_equal(o.height_px, 0);
    assert_int_equal(o.spp, 16);
    assert_false(o.has_spp);
    assert_int_equal(o.thread_count, 0);
    assert_int_equal(o.max_bounces, -1);
    assert_false(o.has_max_bounces);
    assert_int_equal(o.seed, 0);
    assert_false(o.batch || o.up != SCENE_UP_OF_FILE || o.has_crop ||
                 o.phoe_keys);
    assert_int_equal(o.display.color, COLOR_AUTO);
    assert_int_equal(o.display.glyph, GLYPH_AUTO);
    assert_true(o.display.cell_aspect == 0.0);
    assert_false(o.show_help || o.show_version || o.list_devices);
    assert_int_equal(o.backend, BACKEND_CPU);
    assert_null(o.device);
    assert_null(o.kernels_path);
}

static void every_option_sets_its_value(void **state)
{
    struct options o =
        good("-b -t 2 --seed 7 -d 5 -c other.view --stats run.json -o out.pfm "
             "-w 1280 -h 720 -s 500 --crop 1,2,3,4 --up z -f house.obj");

    (void)state;
    assert_true(o.batch && o.up == SCENE_UP_Z && o.has_crop);
    assert_int_equal(o.thread_count, 2);
    assert_int_equal(o.seed, 7);
    assert_true(o.has_max_bounces);
    assert_int_equal(o.max_bounces, 5);
    assert_string_equal(o.view_path, "other.view");
    assert_string_equal(o.stats_path, "run.json");
    assert_string_equal(o.output_path, "out.pfm");
    assert_int_equal(o.width_px, 1280);
    assert_int_equal(o.height_px, 720);
    assert_true(o.has_spp);
    assert_int_equal(o.spp, 500);
    assert_int_equal(o.crop.x, 1);
    assert_int_equal(o.crop.y, 2);
    assert_int_equal(o.crop.width, 3);
    assert_int_equal(o.crop.height, 4);
    assert_string_equal(o.scene_path, "house.obj");
}

static void words_select_values(void **state)
{
    (void)state;
    assert_int_equal(good("a --color 24").display.color, COLOR_24BIT);
    assert_int_equal(good("a --color=24bit").display.color, COLOR_24BIT);
    assert_int_equal(good("a --color 256").display.color, COLOR_256);
    assert_int_equal(good("a --color 16").display.color, COLOR_16);
    assert_int_equal(good("a --color mono").display.color, COLOR_MONO);
    assert_int_equal(good("a --color auto").display.color, COLOR_AUTO);
    assert_int_equal(good("a --theme light").display.theme, THEME_MODE_LIGHT);
    assert_int_equal(good("a --theme plain").display.theme, THEME_MODE_PLAIN);
    assert_int_equal(good("a --glyph auto").display.glyph, GLYPH_AUTO);
    assert_int_equal(good("a --glyph space").display.glyph, GLYPH_SPACE);
    assert_int_equal(good("a --glyph ascii").display.glyph, GLYPH_ASCII);
    assert_int_equal(good("a --glyph half").display.glyph, GLYPH_HALF);
    assert_int_equal(good("a --glyph block").display.glyph, GLYPH_BLOCK);
    assert_int_equal(good("a --glyph braille").display.glyph, GLYPH_BRAILLE);
    assert_int_equal(good("a --glyph shade").display.glyph, GLYPH_SHADE);
    assert_int_equal(good("a --glyph sixel").display.glyph, GLYPH_SIXEL);
    assert_int_equal(good("a --glyph kitty").display.glyph, GLYPH_KITTY);
    assert_int_equal(good("a --up y").up, SCENE_UP_Y);
    assert_true(good("a --phoe-keys").phoe_keys);
    assert_true(good("a --cell-aspect 1.5e0").display.cell_aspect == 1.5);
    bad("a --color red",
        "--color: found 'red', expected 24, 256, 16, mono or auto");
    bad("a --glyph=",
        "--glyph: found '', expected auto, half, block, braille, shade, space, "
        "ascii, sixel or kitty");
    bad("a --up x", "--up: found 'x', expected y, z or a direction X,Y,Z: 3 "
                    "numbers from -1e30 to 1e30");
}

static void values_of_the_view_become_its_lines(void **state)
{
    struct options o =
        good("a --eye 1,-2,.5 --at 0,0,1e3 --up 0,0,1 --fov 30 --sky-strength "
             "2 --sky #fff --exposure -1 --tone aces --camera Left");

    (void)state;
    assert_string_equal(o.view_lines,
                        "eye 1 -2 0.5\nat 0 0 1000\nup 0 0 1\nfovy 30  \n"
                        "sky_strength 2  \nbackground 1 1 1\n"
                        "exposure -1  \ntone aces\n");
    assert_string_equal(o.camera, "Left");
    assert_true(o.has_sky && o.has_exposure && o.has_tone &&
                o.up == SCENE_UP_OF_FILE);
    free(o.view_lines);
    o = good("a --sky ./1,2,3");
    assert_string_equal(o.view_lines, "sky 1,2,3\n");
    free(o.view_lines);
    assert_null(good("a --up z").view_lines);
    bad("a --sky 1,2,3 --sun 0,9", "--sun: found --sky, expected one of the "
                                   "two");
}

#define WRONG_ERROR \
    ", expected an error such as 1% or 0.01: above 0, at most 100%"
#define WRONG_TIME \
    ", expected a time such as 90, 1.5m or 2h: above 0, at most 1e9 s"

static void limits_are_parsed(void **state)
{
    (void)state;
    assert_true(good("a -e 1%").error_limit == 0.01);
    assert_true(good("a -e .5e-1").error_limit == 0.05);
    assert_true(good("a -e0.25%").error_limit == 0.0025);
    assert_true(good("a -e 100%").error_limit == 1);
    assert_true(good("a --time 60").time_ns == 60000000000u);
    assert_true(good("a --time=.25s").time_ns == 250000000u);
    assert_true(good("a --time 1.5m").time_ns == 90000000000u);
    assert_true(good("a --time 2h").time_ns == 7200000000000u);
    assert_true(good("a --time 1e9").time_ns == 1000000000000000000u);
    assert_true(good("a --time 1e-30").time_ns == 1);
    bad("a -e 0", "-e: found '0'" WRONG_ERROR);
    bad("a -e 1", "-e: found '1'" WRONG_ERROR);
    bad("a -e 100.1%", "-e: found '100.1%'" WRONG_ERROR);
    bad("a -e nan%", "-e: found 'nan%'" WRONG_ERROR);
    bad("a -e 1%x", "-e: found '1%x'" WRONG_ERROR);
    bad("a -e", "-e: found no value, expected an error such as 1% or 0.01");
    bad("a --time -0", "--time: found '-0'" WRONG_TIME);
    bad("a --time 1e99", "--time: found '1e99'" WRONG_TIME);
    bad("a --time 300000h", "--time: found '300000h'" WRONG_TIME);
    bad("a --time 1ms", "--time: found '1ms'" WRONG_TIME);
    bad("a --time 1S", "--time: found '1S'" WRONG_TIME);
}

/* The samples are a limit if they were given or if there is no other. */
static void samples_need_not_be_a_limit(void **state)
{
    struct options o = good("a");

    (void)state;
    assert_int_equal(options_limits(&o).spp, 16);
    o = good("a -s 4");
    assert_int_equal(options_limits(&o).spp, 4);
    o = good("a -e 1%");
    assert_int_equal(options_limits(&o).spp, 0);
    assert_true(options_limits(&o).error > 0);
    o = good("a --time 1");
    assert_int_equal(options_limits(&o).spp, 0);
    assert_int_equal(options_limits(&o).time_ns, 1000000000);
    o = good("a --time 1 -e 1% -s 16");
    assert_int_equal(options_limits(&o).spp, 16);
}

static void misspelt_options_have_their_message(void **state)
{
    (void)state;
    assert_int_equal(good("-w640 a").width_px, 640);
    assert_int_equal(good("a -bt3").thread_count, 3);
    assert_int_equal(good("a --seed=9").seed, 9);
    assert_string_equal(good("-- -b").scene_path, "-b");
    assert_string_equal(good("a -bo -").output_path, "-");
    assert_int_equal(good("-w 3 a -w 4").width_px, 4);
    bad("a -x", "unknown option '-x', see glim --help");
    bad("a -bx", "unknown option '-x', see glim --help");
    bad("a --w 4", "unknown option '--w', see glim --help");
    bad("a --seeds=4", "--seeds: not an option of glim, see glim --help");
    bad("a --=4", "unknown option '--', see glim --help");
    bad("a --see 4", "unknown option '--see', see glim --help");
    bad("a --phoe-keys=1", "--phoe-keys: found '1', expected no value");
}

static void wrong_numbers_have_their_message(void **state)
{
    (void)state;
    assert_int_equal(good("a -w 1 -h 65536").height_px, 65536);
    assert_int_equal(good("a -s 1000000000000").spp, 1000000000000u);
    assert_int_equal(good("a --seed 4294967295").seed, 4294967295u);
    assert_int_equal(good("a -d 0").max_bounces, 0);
    assert_int_equal(good("a -d 999").max_bounces, 999);
    assert_int_equal(good("a -t 1024").thread_count, 1024);
    bad("a -w abc", "-w: found 'abc', expected a whole number from 1 to 65536");
    bad("a -w 0", "-w: found '0', expected a whole number from 1 to 65536");
    bad("a -w 10px",
        "-w: found '10px', expected a whole number from 1 to 65536");
    bad("a -w +1", "-w: found '+1', expected a whole number from 1 to 65536");
    bad("a -w 0x10",
        "-w: found '0x10', expected a whole number from 1 to 65536");
    bad("a -w 65537",
        "-w: found '65537', expected a whole number from 1 to 65536");
    bad("a -w 99999999999999999999",
        "-w: found '99999999999999999999', expected a whole number from 1 to "
        "65536");
    bad("a -s 0",
        "-s: found '0', expected a whole number from 1 to 1000000000000");
    bad("a -s 1.5",
        "-s: found '1.5', expected a whole number from 1 to 1000000000000");
    bad("a -t 0", "-t: found '0', expected a whole number from 1 to 1024");
    bad("a -d -1", "-d: found '-1', expected a whole number from 0 to 999");
    bad("a -d 1000", "-d: found '1000', expected a whole number from 0 to 999");
    bad("a --seed 4294967296",
        "--seed: found '4294967296', expected a whole number from 0 to "
        "4294967295");
    bad("a --cell-aspect nan",
        "--cell-aspect: found 'nan', expected a number from 0.25 to 8");
    bad("a --cell-aspect 0x1",
        "--cell-aspect: found '0x1', expected a number from 0.25 to 8");
    bad("a --cell-aspect 9",
        "--cell-aspect: found '9', expected a number from 0.25 to 8");
    bad("a --cell-aspect=",
        "--cell-aspect: found '', expected a number from 0.25 to 8");
}

static void sub_commands_have_their_own_operands(void **state)
{
    struct options o = good("compare a.pfm --tiles 4 b.pfm -o d.png");

    (void)state;
    assert_int_equal(o.command, COMMAND_COMPARE);
    assert_true(o.batch);
    assert_string_equal(o.picture_path, "a.pfm");
    assert_string_equal(o.reference_path, "b.pfm");
    assert_string_equal(o.output_path, "d.png");
    assert_int_equal(o.tile_count, 4);
    assert_null(o.scene_path);
    assert_true(good("compare a b --false-alarms 1e-3").false_alarms == 1e-3);
    o = good("curve ref.pfm --csv c.csv -s 64 -w 32 a.obj");
    assert_int_equal(o.command, COMMAND_CURVE);
    assert_string_equal(o.reference_path, "ref.pfm");
    assert_string_equal(o.scene_path, "a.obj");
    assert_string_equal(o.csv_path, "c.csv");
    assert_string_equal(good("curve -f a.obj ref.pfm").scene_path, "a.obj");
    o = good("reference out.pfm a.obj --seeds 5 --seed 0");
    assert_int_equal(o.command, COMMAND_REFERENCE);
    assert_string_equal(o.output_path, "out.pfm");
    assert_string_equal(o.scene_path, "a.obj");
    assert_int_equal(o.seed_count, 5);
    assert_true(o.has_seed && !good("reference out.pfm a.obj").has_seed);
    /* only the first word is a sub-command */
    assert_int_equal(good("./compare").command, COMMAND_RENDER);
    assert_string_equal(good("-- compare").scene_path, "compare");
    assert_string_equal(good("-b compare").scene_path, "compare");
    bad("compare a b -s 4",
        "-s: not an option of glim compare, see glim --help");
    bad("a --tiles 4", "--tiles: not an option of glim, see glim --help");
}

/* -h is the height, but a person may expect help. */
static void help_is_recognised(void **state)
{
    (void)state;
    assert_true(good("--help").show_help);
    assert_true(good("--version").show_version);
    assert_true(good("-o a.png --help -w x").show_help);
    bad("-h", "-h: found no value, expected a height in pixels (for help: glim "
              "--help)");
    bad("-h a.obj", "-h: found 'a.obj', expected a whole number from 1 to "
                    "65536 (for help: glim --help)");
    bad("-help", "-h: found 'elp', expected a whole number from 1 to 65536 "
                 "(for help: glim --help)");
}

/* Checks that --name=value is refused with what is expected. */
static void refuse_value(const char *name, const char *value,
                         const char *expected)
{
    char program[] = "glim", scene[] = "a", option[64];
    char *argv[] = {program, scene, option, NULL};
    struct options o;
    struct error err;

    snprintf(option, sizeof option, "--%s=%s", name, value);
    options_init(&o);
    if (options_parse(&o, 3, argv, &err))
        fail_msg("%s was taken", option);
    assert_non_null(strstr(err.text, expected));
    assert_non_null(strstr(err.text, value));
}

static void traces_are_read_or_refused(void **state)
{
    static const char *const wrong[] = {"",       "1",      "1,2",      "1,2,",
                                        "1,2,3,", "1,2,-3", "1, 2,3",   "a,2,3",
                                        "1,2,3x", ",,",     "65536,0,0"};
    struct options o = good("a --trace=65535,2,999999999999");

    (void)state;
    assert_true(o.has_trace && o.batch);
    assert_int_equal(o.trace.x, 65535);
    assert_int_equal(o.trace.y, 2);
    assert_int_equal(o.trace.index, 999999999999);
    o = good("--trace 1,2,3 a.png b.obj");
    assert_string_equal(o.picture_path, "a.png");
    assert_string_equal(o.scene_path, "b.obj");
    assert_string_equal(good("-b a.png").scene_path, "a.png");
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        refuse_value("trace", wrong[i], "expected X,Y,SAMPLE");
}

static void crops_are_read_or_refused(void **state)
{
    static const char *const wrong[] = {
        "1,2,3", "1,2,3,4,5", "1,2,3,0",  "a,2,3,4",          "1,,3,4",
        "",      "1,2,3,4 ",  "-1,2,3,4", "1,2,99999999999,4"};

    (void)state;
    assert_int_equal(good("a --crop 0,0,65536,1").crop.width, 65536);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        refuse_value("crop", wrong[i], "expected X,Y,W,H");
}

static void backends_are_chosen(void **state)
{
    (void)state;
    assert_int_equal(good("a --backend cpu").backend, BACKEND_CPU);
    assert_int_equal(good("a --backend opencl").backend, BACKEND_OPENCL);
    assert_int_equal(good("a --backend auto").backend, BACKEND_AUTO);
    assert_int_equal(good("a --device 2").backend, BACKEND_OPENCL);
    assert_int_equal(good("a --kernels k").backend, BACKEND_OPENCL);
    assert_int_equal(good("a --device x --backend auto").backend, BACKEND_AUTO);
    assert_int_equal(good("a --backend auto --kernels k").backend,
                     BACKEND_AUTO);
    assert_string_equal(good("a --device rtx").device, "rtx");
    assert_string_equal(good("a --kernels=k/l").kernels_path, "k/l");
    bad("a --backend cuda",
        "--backend: found 'cuda', expected cpu, opencl or auto");
    bad("a --device=", "--device: found '', expected the number or name of a "
                       "device");
    bad("a --device 1 --backend cpu",
        "--device: found --backend cpu, expected opencl or auto");
    bad("--backend cpu a --kernels k",
        "--kernels: found --backend cpu, expected opencl or auto");
}

static void list_devices_stands_alone(void **state)
{
    struct options o = good("--list-devices -t 3");

    (void)state;
    assert_true(o.list_devices);
    assert_null(o.scene_path);
    assert_int_equal(o.thread_count, 3);
    assert_true(good("--sessions").list_sessions);
    bad("--list-devices -t 0",
        "-t: found '0', expected a whole number from 1 to 1024");
}

static void wrong_combinations_have_their_message(void **state)
{
    (void)state;
    bad("",
        "found no scene, expected: glim [options] scene.obj (see glim --help)");
    bad("-b",
        "found no scene, expected: glim [options] scene.obj (see glim --help)");
    bad("a.obj b.obj", "found a second scene 'b.obj', expected only 'a.obj'");
    bad("-f a.obj b.obj",
        "found a second scene 'b.obj', expected only 'a.obj'");
    bad("a -o x.png", "-o: found no -b, expected batch mode (on the screen p "
                      "saves a picture)");
    bad("-b a --watch", "--watch: found -b, expected the screen");
    bad("-b a -o - --stats -",
        "--stats: found - beside -o -, expected the name of a file");
    bad("-b a -o x.jpg", "-o: found 'x.jpg', expected a name that ends in "
                         ".png, .hdr, .pfm or .exr, "
                         "or - for standard output");
    bad("-f", "-f: found no value, expected the name of a scene");
}

/* Options win over GLIM_COLOR, even "auto". The variable is read only if a
 * picture goes to a terminal. */
static void environment_gives_way_to_options(void **state)
{
    (void)state;
    setenv("GLIM_COLOR", "256", 1);
    assert_int_equal(good("a").display.color, COLOR_256);
    assert_int_equal(good("a --color 16").display.color, COLOR_16);
    assert_int_equal(good("a --color auto").display.color, COLOR_AUTO);
    assert_int_equal(good("-b a").display.color, COLOR_AUTO);
    assert_int_equal(good("-b --ansi 80x24 a").display.color, COLOR_256);
    setenv("GLIM_COLOR", "red", 1);
    bad("a", "GLIM_COLOR: found 'red', expected 24, 256, 16, mono or auto");
    setenv("GLIM_COLOR", "", 1);
    assert_int_equal(good("a").display.color, COLOR_AUTO);
    unsetenv("GLIM_COLOR");
}

static void text_sizes_are_read_or_refused(void **state)
{
    struct options o = good("-b --ansi 80x24 a");

    (void)state;
    assert_int_equal(o.text_cols, 80);
    assert_int_equal(o.text_rows, 24);
    bad("-b --ansi 80 a", "--ansi: found '80', expected COLSxROWS: two whole "
                          "numbers from 1 to 2000");
    bad("-b --ansi 80x2001 a",
        "--ansi: found '80x2001', expected COLSxROWS: two whole numbers from "
        "1 to 2000");
    bad("-b --ansi x24 a", "--ansi: found 'x24', expected COLSxROWS: two "
                           "whole numbers from 1 to 2000");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_set),
        cmocka_unit_test(every_option_sets_its_value),
        cmocka_unit_test(words_select_values),
        cmocka_unit_test(values_of_the_view_become_its_lines),
        cmocka_unit_test(environment_gives_way_to_options),
        cmocka_unit_test(text_sizes_are_read_or_refused),
        cmocka_unit_test(limits_are_parsed),
        cmocka_unit_test(samples_need_not_be_a_limit),
        cmocka_unit_test(misspelt_options_have_their_message),
        cmocka_unit_test(wrong_numbers_have_their_message),
        cmocka_unit_test(sub_commands_have_their_own_operands),
        cmocka_unit_test(help_is_recognised),
        cmocka_unit_test(traces_are_read_or_refused),
        cmocka_unit_test(crops_are_read_or_refused),
        cmocka_unit_test(wrong_combinations_have_their_message),
        cmocka_unit_test(backends_are_chosen),
        cmocka_unit_test(list_devices_stands_alone),
    };

    return cmocka_run_group_tests_name("options", tests, NULL, NULL);
}
