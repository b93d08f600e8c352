// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"
#include "tests/unit/folder.h"
#include "tests/unit/shared.h"

#include <glob.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "read/view_file.h"
#include "scene/view.h"
#include "terminal/xmalloc.h"

static struct file_change change; /* the most recent write */

/* Returns a path in the test's folder, valid until the next call. */
static const char *file(const char *name)
{
    static char path[256];

    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static const char *put(const char *text)
{
    const char *path = file("t.view");
    FILE *f = fopen(path, "wb");

    assert_non_null(f);
    fputs(text, f);
    assert_int_equal(fclose(f), 0);
    return path;
}

static void read_text(struct view *view, const char *text)
{
    struct warnings report = {0};
    struct error err = {""};

    view_init(view);
    if (!view_read(view, put(text), &report, &err))
        print_error("%s\n", err.text);
    assert_string_equal(err.text, "");
    assert_int_equal(report.entry_count, 0);
    warnings_free(&report);
}

/* Checks the error; `expected` is the text behind the file's name. */
static void refused(const char *text, const char *expected)
{
    struct warnings report = {0};
    struct error err;
    struct view view;
    char whole[1400];

    view_init(&view);
    snprintf(whole, sizeof whole, "%s:%s", file("t.view"), expected);
    if (view_read(&view, put(text), &report, &err))
        snprintf(err.text, sizeof err.text, "nothing");
    if (strcmp(err.text, whole) != 0)
        print_error("'%s':\nfound    %s\nexpected %s\n", text, err.text, whole);
    assert_string_equal(err.text, whole);
    warnings_free(&report);
    view_free(&view);
}

static void is3(const double v[3], double x, double y, double z)
{
    assert_true(v[0] == x && v[1] == y && v[2] == z);
}

static void absent_keys_have_their_defaults(void **state)
{
    struct view view;

    (void)state;
    read_text(&view, "");
    assert_false(view.has_camera || view.has_size ||
                 view.lighting.has_background);
    is3(view.pose.up, 0, 1, 0);
    assert_true(view.pose.fovy_deg == 40 && view.lighting.sky_strength == 1);
    assert_int_equal(view.width_px, 1024);
    assert_int_equal(view.height_px, 576);
    assert_int_equal(view.max_bounces, -1);
    assert_null(view.lighting.sky_path);
    view_free(&view);
}

static void all_keys_are_read(void **state)
{
    struct view view;
    char sky[256];

    (void)state;
    read_text(&view, "\xef\xbb\xbf# a comment\r\n"
                     "eye 278 273 -8e2\r\n"
                     "\tat   .5\t+1 -0.25 # of the box\r\n"
                     "\r\n"
                     "up 0 0 2\r\n"
                     "fovy 39.3077\r\n"
                     "res 256 128\r\n"
                     "background 1 0.5 0\r\n"
                     "max_bounces 64\r\n"
                     "sky my sky #1.hdr  \r\n"
                     "sky_strength 2.5\r\n"
                     "sky_rotation -90\r\n"
                     "aperture 0.5\r\n"
                     "focus 1e3\r\n"
                     "tone aces # bright\r\n"
                     "exposure -1.5");
    assert_true(view.has_camera && view.has_size &&
                view.lighting.has_background);
    is3(view.pose.eye, 278, 273, -800);
    is3(view.pose.at, 0.5, 1, -0.25);
    is3(view.pose.up, 0, 0, 2);
    assert_true(view.pose.fovy_deg == 39.3077);
    assert_int_equal(view.width_px, 256);
    assert_int_equal(view.height_px, 128);
    is3(view.lighting.background, 1, 0.5, 0);
    assert_int_equal(view.max_bounces, 64);
    snprintf(sky, sizeof sky, "%s/my sky #1.hdr", folder);
    assert_string_equal(view.lighting.sky_path, sky);
    assert_true(view.lighting.sky_strength == 2.5 &&
                view.lighting.sky_rotation_deg == -90);
    assert_true(view.pose.aperture == 0.5 && view.pose.focus == 1000);
    assert_true(view.lighting.exposure == -1.5);
    assert_int_equal(view.lighting.tone, TONE_ACES);
    view_free(&view);
}

/* What a line of fog leaves out is 0, and so is what has no effect. */
static void fog_is_read(void **state)
{
    const struct fog none = {.falloff = 0};
    struct view view;
    const struct fog *fog = &view.lighting.fog;

    (void)state;
    read_text(&view, "fog scatter .1 .2 .3 absorb 0 1e-30 1e30 anisotropy "
                     "-1\theight -2 falloff 5 # at dawn\n");
    is3(fog->scatter, .1, .2, .3);
    is3(fog->absorb, 0, 1e-30, 1e30);
    assert_true(fog->anisotropy == -1 && fog->base == -2 && fog->falloff == 5);
    view_free(&view);
    read_text(&view, "fog falloff 3 height 1 absorb 0 0 1\n");
    is3(fog->scatter, 0, 0, 0);
    is3(fog->absorb, 0, 0, 1);
    assert_true(fog->anisotropy == 0 && fog->base == 1 && fog->falloff == 3);
    view_free(&view);
    read_text(&view, "fog height 2 scatter 1 1 1\n");
    assert_true(fog->base == 0 && fog->falloff == 0);
    view_free(&view);
    read_text(&view, "fog scatter 1 1 1\nfog\n");
    assert_memory_equal(fog, &none, sizeof none);
    view_free(&view);
    read_text(&view, "fog scatter 0 0 0 anisotropy .5 falloff 2\n");
    assert_memory_equal(fog, &none, sizeof none);
    view_free(&view);
}

static void later_lines_override_earlier_ones(void **state)
{
    struct warnings report = {0};
    struct error err;
    struct view view;

    (void)state;
    read_text(&view, "eye 1 2 3\nat 0 0 0\nfovy 20\nsky a.png\n");
    assert_true(view_read(&view, put("eye 4 5 6\nsky b.png\nsky c.png\n"),
                          &report, &err));
    assert_true(view.has_camera && view.pose.fovy_deg == 20);
    is3(view.pose.eye, 4, 5, 6);
    is3(view.pose.at, 0, 0, 0);
    assert_string_equal(strrchr(view.lighting.sky_path, '/'), "/c.png");
    view_free(&view);
}

static void limits_are_accepted(void **state)
{
    struct view view;

    (void)state;
    read_text(&view, "fovy 179.9\n");
    assert_true(view.pose.fovy_deg == 179.9);
    view_free(&view);
    /* The camera accepts a view along up. */
    read_text(&view, "eye 0 5 0\nat 0 0 0\nup 0 1 0\nres 1 1\n");
    assert_true(view.has_camera);
    view_free(&view);
    read_text(&view, "res 65536 65536\nmax_bounces -1\nmax_bounces 0\n");
    assert_int_equal(view.max_bounces, 0);
    view_free(&view);
}

static void wrong_lines_have_their_message(void **state)
{
    static const char angle[] = "an angle above 0 and below 180 degrees";
    static const char sizes[] = "2 whole numbers from 1 to 65536";
    static const char light[] = "3 numbers from 0 to 1e30";
    static const char point[] = "3 numbers from -1e30 to 1e30";
    static const char kinds[] = "point, spot or directional";
    static const char smoke[] =
        "grid, scatter, absorb, anisotropy, temperature, kelvin, glow, up, "
        "at, scale or box";
    static const char sun[] = "an azimuth from -360 to 360 and an elevation "
                              "from -90 to 90 degrees";
    static const char number[] = "a number from 1 to 9";
    static const char media[] =
        "scatter, absorb, anisotropy, height or falloff";
    static const char parts[] = "eye, at, up, fovy, aperture or focus";
    static const struct {
        const char *text, *found, *expected, *key;
    } cases[] = {
        {"fovy 0", "'0'", angle, "fovy"},
        {"fovy 180", "'180'", angle, "fovy"},
        {"fovy -40", "'-40'", angle, "fovy"},
        {"fovy nan", "'nan'", angle, "fovy"},
        {"fovy 1e400", "'1e400'", angle, "fovy"},
        {"fovy", "the end of the line", angle, "fovy"},
        {"fovy 40 50", "'50'", angle, "fovy"},
        {"fovy 40deg", "'40deg'", angle, "fovy"},
        {"fovy forty", "'forty'", angle, "fovy"},
        {"res 0 10", "'0'", sizes, "res"},
        {"res 10 -1", "'-1'", sizes, "res"},
        {"res 10.5 10", "'10.5'", sizes, "res"},
        {"res 10 65537", "'65537'", sizes, "res"},
        {"res 10", "the end of the line", sizes, "res"},
        {"res 10 # 20", "the end of the line", sizes, "res"},
        {"res 256x256", "'256x256'", sizes, "res"},
        {"background 0 -1 0", "'-1'", light, "background"},
        {"background 0 0 inf", "'inf'", light, "background"},
        {"background 0 0 nan", "'nan'", light, "background"},
        {"background 0 0", "the end of the line", light, "background"},
        {"eye 1 2", "the end of the line", point, "eye"},
        {"eye 1 2 3 4", "'4'", point, "eye"},
        {"eye 1,2,3", "'1,2,3'", point, "eye"},
        {"at nan 0 0", "'nan'", point, "at"},
        {"up 0 inf 0", "'inf'", point, "up"},
        {"max_bounces 1.5", "'1.5'", "a whole number, or -1 for no limit",
         "max_bounces"},
        {"max_bounces 99999999999", "'99999999999'",
         "a whole number, or -1 for no limit", "max_bounces"},
        {"sky_strength -1", "'-1'", "a number from 0 to 1e30", "sky_strength"},
        {"sky_rotation x", "'x'", "an angle from -1e6 to 1e6 degrees",
         "sky_rotation"},
        {"aperture -1", "'-1'", "a number from 0 to 1e30", "aperture"},
        {"focus inf", "'inf'", "a number from 0 to 1e30", "focus"},
        {"exposure nan", "'nan'", "a number of stops from -100 to 100",
         "exposure"},
        {"tone", "the end of the line", "linear, reinhard or aces", "tone"},
        {"tone bright", "'bright'", "linear, reinhard or aces", "tone"},
        {"light", "the end of the line", kinds, "light"},
        {"light area 1 2 3", "'area'", kinds, "light"},
        {"light point 1 2", "the end of the line", point, "point"},
        {"light point 1 2 nan", "'nan'", point, "point"},
        {"light point 1 2 3 at 0 0 0", "'at'", "intensity, radius or ies",
         "point"},
        {"light point 1 2 3 intensity 1 -1 1", "'-1'", light, "intensity"},
        {"light point 1 2 3 radius inf", "'inf'", "a number from 0 to 1e30",
         "radius"},
        {"light point 1 2 3 7", "'7'", "intensity, radius or ies", "point"},
        {"light spot 1 2 3", "the end of the line", "at", "spot"},
        {"light spot 1 2 3 at 0 0 0 outer 91", "'91'",
         "an angle from 0 to 90 degrees", "outer"},
        {"light spot 1 2 3 at 0 0 0 angle 9", "'angle'",
         "at, intensity, inner, outer, radius or ies", "spot"},
        {"light directional 1", "the end of the line", sun, "directional"},
        {"light directional 1 91", "'91'", sun, "directional"},
        {"light directional 1 2 intensity 1 1 1", "'intensity'",
         "irradiance or angle", "directional"},
        {"light directional 1 2 angle 181", "'181'",
         "an angle from 0 to 180 degrees", "angle"},
        {"fog dense", "'dense'", media, "fog"},
        {"fog .1 .1 .1", "'.1'", media, "fog"},
        {"fog scatter 1 1", "the end of the line", light, "scatter"},
        {"fog scatter 1 1 1 1", "'1'", media, "fog"},
        {"fog scatter 1 1 -1", "'-1'", light, "scatter"},
        {"fog absorb 1 nan 1", "'nan'", light, "absorb"},
        {"fog absorb 1 2e30 1", "'2e30'", light, "absorb"},
        {"fog absorb 1 absorb 2", "'absorb'", light, "absorb"},
        {"fog anisotropy 1.1", "'1.1'", "a number from -1 to 1", "anisotropy"},
        {"fog height", "the end of the line", "a number from -1e30 to 1e30",
         "height"},
        {"fog falloff -1", "'-1'", "a number from 0 to 1e30", "falloff"},
        {"medium", "the end of the line", "a file", "medium"},
        {"medium \"\"", "the end of the line", "a file", "medium"},
        {"medium \"a", "the end of the line", "a file", "medium"},
        {"medium a.vdb grid", "the end of the line", "a name behind grid",
         "medium"},
        {"medium a.vdb density", "'density'", smoke, "medium"},
        {"medium a.vdb scatter 1 1", "the end of the line", light, "scatter"},
        {"medium a.vdb absorb 1 1 -1", "'-1'", light, "absorb"},
        {"medium a.vdb anisotropy 1.5", "'1.5'", "a number from -1 to 1",
         "anisotropy"},
        {"medium a.vdb at 1 2 x", "'x'", point, "at"},
        {"medium a.vdb scale 0", "'0'", "a number from 1e-30 to 1e30", "scale"},
        {"medium a.vdb temperature", "the end of the line",
         "a name behind temperature", "medium"},
        {"medium a.vdb up x", "'x'", "y or z behind up", "medium"},
        {"medium a.vdb kelvin -1", "'-1'", "a number from 0 to 1e30", "kelvin"},
        {"view", "the end of the line", number, "view"},
        {"view 0 eye 0 0 1 at 0 0 0", "'0'", number, "view"},
        {"view 10 eye 0 0 1 at 0 0 0", "'10'", number, "view"},
        {"view 1.5 eye 0 0 1 at 0 0 0", "'1.5'", number, "view"},
        {"view 1 res 3 4", "'res'", parts, "view"},
        {"view 1 eye 0 0 1 at 0 0 0 0", "'0'", parts, "view"},
        {"view 1 eye 0 0", "the end of the line", point, "eye"},
        {"view 1 eye 0 0 1", "the end of the line", "eye and at", "view"},
        {"view 1 at 0 0 1", "the end of the line", "eye and at", "view"},
    };
    char text[200], expected[400];

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        snprintf(text, sizeof text, "# first line\n%s\nexposure 0\n",
                 cases[i].text);
        snprintf(expected, sizeof expected, "2: found %s, expected %s for %s",
                 cases[i].found, cases[i].expected, cases[i].key);
        refused(text, expected);
    }
    refused("up 0 0 0", "1: found 0 0 0, expected a direction for up");
    refused("light spot 1 2 3 at 1 2 3\n",
            "1: found a spot at its own position, expected another point for "
            "at");
    refused("light spot -0 2 3 at 0 2 3\n",
            "1: found a spot at its own position, expected another point for "
            "at");
    refused("light spot 1 2 3 at 0 0 0 outer 5 inner 6\n",
            "1: found inner 6 above outer 5, expected inner within outer");
    refused("sky\n", "1: found no name, expected an image file for sky");
    refused("eye 1 2 3\n\nat 1 2 3\nup 0 1 0\n",
            "3: found eye and at in one point, expected two");
    refused("\neye 1 2 3\n", "2: found only 'eye', expected eye and at");
    refused("at 1 2 3\n", "1: found only 'at', expected eye and at");
    refused("\nview 1 eye 1 2 3 at 1 2 3\n",
            "2: found eye and at in one point, expected two");
    refused("view 1 eye 1 2 3 at 0 0 0 up 0 0 0\n",
            "1: found 0 0 0, expected a direction for up");
}

/* A numbered view has the values of the keys above it, except those on its
 * line. */
static void numbered_views_have_the_keys_above(void **state)
{
    struct view view;

    (void)state;
    read_text(&view, "eye 0 0 5\nat 0 0 0\n"
                     "view 9 eye 1 2 3 at 4 5 6\n"
                     "fovy 30\naperture .5\n"
                     "view 2 at 1 0 0 eye 7 8 9 focus 3\\\n up 1 0 0 # wide\n");
    for (int i = 0; i < VIEW_SHOTS; i++)
        assert_int_equal(view.has_shot[i], i == 1 || i == 8);
    is3(view.shots[8].eye, 1, 2, 3);
    is3(view.shots[8].at, 4, 5, 6);
    is3(view.shots[8].up, 0, 1, 0);
    assert_true(view.shots[8].fovy_deg == 40 && view.shots[8].aperture == 0);
    is3(view.shots[1].eye, 7, 8, 9);
    is3(view.shots[1].at, 1, 0, 0);
    is3(view.shots[1].up, 1, 0, 0);
    assert_true(view.shots[1].fovy_deg == 30 && view.shots[1].aperture == .5 &&
                view.shots[1].focus == 3);
    is3(view.pose.eye, 0, 0, 5);
    is3(view.pose.at, 0, 0, 0);
    assert_true(view.pose.focus == 0);
    view_free(&view);
}

static void unreadable_files_have_their_message(void **state)
{
    struct warnings report = {0};
    struct error err;
    struct view view;

    (void)state;
    view_init(&view);
    assert_false(view_read(&view, file("none"), &report, &err));
    assert_non_null(strstr(err.text, "/none: no such file"));
    assert_false(view_read(&view, folder, &report, &err));
    assert_non_null(strstr(err.text, ": found a folder"));
}

static void unknown_keys_are_warned_of(void **state)
{
    struct warnings report = {0};
    struct error err;
    struct view view;
    char expected[400];

    (void)state;
    view_init(&view);
    assert_true(view_read(&view, put("fov 30\nshutter 1\nfovy 50\nEYE 1\n"),
                          &report, &err));
    assert_true(view.pose.fovy_deg == 50);
    assert_int_equal(report.entry_count, 1);
    assert_int_equal(report.entries[0].count, 3);
    snprintf(expected, sizeof expected,
             "%s:1: found the unknown key 'fov': ignored", file("t.view"));
    assert_string_equal(report.entries[0].text, expected);
    warnings_free(&report);
}

/* Random bytes are read or refused. */
static void random_bytes_do_no_harm(void **state)
{
    uint64_t random = 3;
    char noise[512];

    (void)state;
    for (int i = 0; i < 2000; i++) {
        struct warnings report = {0};
        struct error err;
        struct view view;
        static const char some[] = "eyeatupfovyres 0123.e-+# \n\r\t\\\0\xff";
        FILE *f = fopen(file("noise"), "wb");
        size_t size = (size_t)(check_random(&random) * sizeof noise);

        for (size_t j = 0; j < size; j++)
            noise[j] =
                some[(size_t)(check_random(&random) * (sizeof some - 1))];
        assert_non_null(f);
        fwrite(noise, 1, size, f);
        fclose(f);
        view_init(&view);
        if (!view_read(&view, file("noise"), &report, &err))
            assert_null(strchr(err.text, '\n'));
        warnings_free(&report);
        view_free(&view);
    }
}

static void is_same(const struct view *a, const struct view *b)
{
    assert_memory_equal(a->pose.eye, b->pose.eye, sizeof a->pose.eye);
    assert_memory_equal(a->pose.at, b->pose.at, sizeof a->pose.at);
    assert_memory_equal(a->pose.up, b->pose.up, sizeof a->pose.up);
    assert_memory_equal(a->lighting.background, b->lighting.background,
                        sizeof a->lighting.background);
    assert_int_equal(a->has_camera, b->has_camera);
    assert_int_equal(a->has_size, b->has_size);
    assert_int_equal(a->lighting.has_background, b->lighting.has_background);
    assert_int_equal(a->width_px, b->width_px);
    assert_int_equal(a->height_px, b->height_px);
    assert_int_equal(a->max_bounces, b->max_bounces);
    assert_true(a->pose.fovy_deg == b->pose.fovy_deg);
    assert_true(a->lighting.sky_strength == b->lighting.sky_strength);
    assert_true(a->lighting.sky_rotation_deg == b->lighting.sky_rotation_deg);
    assert_true(a->pose.aperture == b->pose.aperture);
    assert_true(a->pose.focus == b->pose.focus);
    assert_true(a->lighting.exposure == b->lighting.exposure);
    for (int i = 0; i < VIEW_SHOTS; i++) {
        const struct pose *p = &a->shots[i], *q = &b->shots[i];

        assert_int_equal(a->has_shot[i], b->has_shot[i]);
        is3(p->eye, q->eye[0], q->eye[1], q->eye[2]);
        is3(p->at, q->at[0], q->at[1], q->at[2]);
        is3(p->up, q->up[0], q->up[1], q->up[2]);
        assert_true(p->fovy_deg == q->fovy_deg && p->aperture == q->aperture &&
                    p->focus == q->focus);
    }
}

static void written_views_are_read_back(void **state)
{
    struct warnings report = {0};
    struct error err;
    struct view view, again;

    (void)state;
    view_init(&view);
    assert_true(view_write(&view, file("w.view"), &change, &err));
    view_init(&again);
    assert_true(view_read(&again, file("w.view"), &report, &err));
    is_same(&view, &again);
    view = (struct view){
        .pose = {.eye = {1.0 / 3, -2e-9, 1e20},
                 .at = {0.1 + 0.2, 5, -7},
                 .up = {0, 0.6, 0.8},
                 .fovy_deg = 100.0 / 7,
                 .aperture = 0.05,
                 .focus = 7.25},
        .has_camera = true,
        .width_px = 31,
        .height_px = 17,
        .has_size = true,
        .lighting = {.background = {0.1, 2, 3},
                     .has_background = true,
                     .sky_strength = 0.3,
                     .sky_rotation_deg = 12.5,
                     .sun = {.is_on = true,
                             .azimuth_deg = -100.0 / 3,
                             .elevation_deg = 1e-7,
                             .turbidity = 7.1},
                     .exposure = -0.7},
        .max_bounces = 3,
    };
    view.shots[0] = view.pose;
    view.shots[8] = (struct pose){.eye = {1, 1e-9, 1},
                                  .at = {0, 1.0 / 3},
                                  .up = {0, 1},
                                  .fovy_deg = 3};
    view.has_shot[0] = view.has_shot[8] = true;
    assert_true(view_write(&view, file("w.view"), &change, &err));
    assert_true(view_read(&again, file("w.view"), &report, &err));
    is_same(&view, &again);
    assert_int_equal(report.entry_count, 0);
}

static void views_are_written_in_this_form(void **state)
{
    struct error err;
    struct view view;
    char text[1000] = "";

    (void)state;
    read_text(&view, "eye 278 273 -800\nat 278 273 0\nfovy 39.3077\n"
                     "res 256 256\nsky s.hdr\nexposure -.5\n");
    assert_true(view_write(&view, file("x.view"), &change, &err));
    FILE *f = fopen(file("x.view"), "r");
    assert_non_null(f);
    assert_true(fread(text, 1, sizeof text - 1, f) > 0);
    fclose(f);
    assert_int_equal(text[0], '#');
    assert_string_equal(strstr(text, "eye"),
                        "eye 278 273 -800\nat 278 273 0\nup 0 1 0\n"
                        "fovy 39.3077\nres 256 256\nsky s.hdr\n"
                        "exposure -0.5\n");
    view_free(&view);
}

static void is_file(const char *path, const char *expected)
{
    char text[1000];
    FILE *f = fopen(path, "r");

    assert_non_null(f);
    text[fread(text, 1, sizeof text - 1, f)] = '\0';
    fclose(f);
    assert_string_equal(text, expected);
}

static void lights_are_read(void **state)
{
    struct view view;
    const struct lamp *l;

    (void)state;
    read_text(&view, "light point 1 2 3 # a bulb\n"
                     "light spot 4 5 6 at 7 8 9 inner 10 outer 20 "
                     "intensity 1 2 3 radius .5\n"
                     "exposure 1\n"
                     "light directional -30 60 angle .5 irradiance 4 5 6\n");
    assert_int_equal(view.lamps.count, 3);
    l = view.lamps.items;
    assert_int_equal(l[0].kind, LAMP_POINT);
    is3(l[0].position, 1, 2, 3);
    is3(l[0].rgb, 1, 1, 1);
    assert_true(l[0].radius == 0);
    assert_int_equal(l[1].kind, LAMP_SPOT);
    is3(l[1].position, 4, 5, 6);
    is3(l[1].at, 7, 8, 9);
    is3(l[1].rgb, 1, 2, 3);
    assert_true(l[1].inner_deg == 10 && l[1].outer_deg == 20 &&
                l[1].radius == 0.5);
    assert_int_equal(l[2].kind, LAMP_DIRECTIONAL);
    assert_true(l[2].azimuth_deg == -30 && l[2].elevation_deg == 60 &&
                l[2].angle_deg == 0.5);
    is3(l[2].rgb, 4, 5, 6);
    view_free(&view);
}

/* All lights are written at the place of the first one. */
static void lights_are_written_in_this_form(void **state)
{
    struct error err;
    struct view view;
    const char *path = put("light point 1 2 3 radius 0\n# mine\n"
                           "light spot 1 2 3 outer 45 at 0 0 -1e-9 inner 5\n"
                           "light directional 10 20 irradiance 1 1 1\n");
    struct warnings report = {0};

    (void)state;
    view_init(&view);
    assert_true(view_read(&view, path, &report, &err));
    view.lamps.items[0].rgb[2] = 0.25;
    assert_true(view_write(&view, path, &change, &err));
    is_file(path, "light point 1 2 3 intensity 1 1 0.25\n"
                  "light spot 1 2 3 at 0 0 -1e-09 inner 5\n"
                  "light directional 10 20\n# mine\n");
    view_free(&view);
}

static const char smoke_lines[] =
    "medium smoke.vdb scatter 1 2 3\n"
    "medium \"a b.vdb\" grid \"my \"\"grid\"\"\" scatter 1 1 1 absorb "
    ".5 .25 .125 anisotropy -.5 at 1 -2 3 scale .01 # small\n"
    "medium fire.vdb absorb 1 1 1 temperature heat kelvin 2000 glow 3 up z "
    "box 0 0 0 1 2 3\n";

static void smokes_are_read(void **state)
{
    struct warnings report = {0};
    struct error err = {""};
    struct view view, copy;
    const struct smoke *s;

    (void)state;
    view_init(&view);
    view_init(&copy);
    check_or_say(view_read(&view, put(smoke_lines), &report, &err), err.text);
    assert_int_equal(report.entry_count, 0);
    assert_int_equal(view.smokes.count, 3);
    s = view.smokes.items;
    assert_string_equal(s[0].path, file("smoke.vdb"));
    assert_string_equal(s[0].grid, "");
    is3(s[0].numbers.scatter, 1, 2, 3);
    is3(s[0].numbers.absorb, 0, 0, 0);
    is3(s[0].numbers.at, 0, 0, 0);
    assert_true(s[0].numbers.anisotropy == 0 && s[0].numbers.scale == 1);
    assert_string_equal(s[1].path, file("a b.vdb"));
    assert_string_equal(s[1].grid, "my \"grid\"");
    is3(s[1].numbers.absorb, .5, .25, .125);
    is3(s[1].numbers.at, 1, -2, 3);
    assert_true(s[1].numbers.anisotropy == -.5 && s[1].numbers.scale == .01);
    assert_string_equal(s[0].temperature, "");
    assert_false(s[0].up_is_z || smoke_has_box(&s[0].numbers));
    assert_string_equal(s[2].temperature, "heat");
    assert_true(s[2].numbers.kelvin == 2000 && s[2].numbers.glow == 3);
    assert_true(s[2].up_is_z && smoke_has_box(&s[2].numbers));
    is3(s[2].numbers.box, 0, 0, 0);
    is3(s[2].numbers.box + 3, 1, 2, 3);
    assert_true(view_copy(&copy, &view));
    assert_true(smokes_equal(&copy.smokes, &view.smokes));
    copy.smokes.items[1].grid[0] = 'M';
    assert_false(smokes_equal(&copy.smokes, &view.smokes));
    copy.smokes.items[1].grid[0] = 'm';
    copy.smokes.items[2].up_is_z = false;
    assert_false(smokes_equal(&copy.smokes, &view.smokes));
    copy.smokes.items[2].up_is_z = true;
    copy.smokes.items[2].numbers.glow = 4;
    assert_false(smokes_equal(&copy.smokes, &view.smokes));
    view_free(&copy);
    view_free(&view);
}

/* Lines that did not change stay as they were; others are written in full, at
 * the place of the first one. */
static void smokes_are_written_in_this_form(void **state)
{
    struct warnings report = {0};
    struct error err;
    struct view view;
    const char *path = put(smoke_lines);

    (void)state;
    view_init(&view);
    assert_true(view_read(&view, path, &report, &err));
    assert_true(view_write(&view, path, &change, &err));
    is_file(path, smoke_lines);
    view.smokes.items[0].numbers.scatter[2] = .75;
    assert_true(view_write(&view, path, &change, &err));
    is_file(path, "medium smoke.vdb scatter 1 2 0.75 absorb 0 0 0 "
                  "anisotropy 0\n"
                  "medium \"a b.vdb\" grid \"my \"\"grid\"\"\" scatter "
                  "1 1 1 absorb 0.5 0.25 0.125 anisotropy -0.5 at 1 -2 3 "
                  "scale 0.01\n"
                  "medium fire.vdb scatter 0 0 0 absorb 1 1 1 anisotropy 0 "
                  "temperature heat kelvin 2000 glow 3 up z box 0 0 0 1 2 3\n");
    view.smokes.items[0].grid[0] = '\0';
    free(view.smokes.items[0].path);
    view.smokes.items[0].path = strdup("a\nb");
    assert_false(view_write(&view, path, &change, &err));
    assert_non_null(strstr(err.text, "found a line end in the medium's name"));
    warnings_free(&report);
    view_free(&view);
}

/* Comments, order and unknown lines are kept with a new camera. */
static void lines_of_others_are_kept(void **state)
{
    struct warnings report = {0};
    struct error err;
    struct view view;
    const char *path = put("# my room\r\nfovy 30\n\n  # the door\neye 1 2 3\n"
                           "assign door oak\nat 0 0 0 # eye\neye 4 5 6\n"
                           "shutter 2 \\\n eye");

    (void)state;
    view_init(&view);
    assert_true(view_read(&view, path, &report, &err));
    warnings_free(&report);
    view.pose.eye[0] = 7;
    view.lighting.exposure = 2;
    view.has_shot[3] = true;
    view.shots[3] = view.pose;
    assert_true(view_write(&view, path, &change, &err));
    is_file(path, "# my room\r\nfovy 30\n\n  # the door\neye 7 5 6\n"
                  "assign door oak\nat 0 0 0 # eye\n"
                  "shutter 2 \\\n eye\n"
                  "exposure 2\n"
                  "view 4 eye 7 5 6 at 0 0 0 up 0 1 0 fovy 30 aperture 0 "
                  "focus 0\n");
    view_free(&view);
}

/* The line of fog stays as it was written until the fog changes, and goes with
 * it. */
static void fog_is_written_at_its_place(void **state)
{
    const char *path = put("fovy 30\nfog absorb .10 0 0 scatter 0 0 0 # red\n"
                           "exposure 1\n");
    struct warnings report = {0};
    struct error err;
    struct view view;

    (void)state;
    view_init(&view);
    assert_true(view_read(&view, path, &report, &err));
    view.lighting.exposure = 2;
    assert_true(view_write(&view, path, &change, &err));
    is_file(path, "fovy 30\nfog absorb .10 0 0 scatter 0 0 0 # red\n"
                  "exposure 2\n");
    view.lighting.fog.scatter[1] = 1e-30;
    view.lighting.fog.base = 4;
    assert_true(view_write(&view, path, &change, &err));
    is_file(path, "fovy 30\nfog scatter 0 1e-30 0 absorb 0.1 0 0 anisotropy 0\n"
                  "exposure 2\n");
    view.lighting.fog.falloff = .5;
    assert_true(view_write(&view, path, &change, &err));
    is_file(path, "fovy 30\nfog scatter 0 1e-30 0 absorb 0.1 0 0 anisotropy 0 "
                  "height 4 falloff 0.5\nexposure 2\n");
    view.lighting.fog = (struct fog){.anisotropy = .5};
    assert_true(view_write(&view, path, &change, &err));
    is_file(path, "fovy 30\nexposure 2\n");
    view_free(&view);
}

/* What has not changed stays as it was written, to the digit. */
static void unchanged_lines_are_kept(void **state)
{
    const char *text = "eye .5 1e0 -3.0 # the door\nat 0 0 00\nfovy 39.30\n"
                       "background .6 .6 .6\nlight point 1 2 3 radius 0\n"
                       "view 2 eye 1 1 1 at 0 0 .0\nexposure +1\n"
                       "up 0 0 2";
    const char *path = put(text);
    struct warnings report = {0};
    struct error err;
    struct view view;

    (void)state;
    view_init(&view);
    assert_true(view_read(&view, path, &report, &err));
    assert_true(view_write(&view, path, &change, &err));
    is_file(path, "eye .5 1e0 -3.0 # the door\nat 0 0 00\nfovy 39.30\n"
                  "background .6 .6 .6\nlight point 1 2 3 radius 0\n"
                  "view 2 eye 1 1 1 at 0 0 .0\nexposure +1\n"
                  "up 0 0 2\n");
    view.pose.fovy_deg = 50;
    assert_true(view_write(&view, path, &change, &err));
    is_file(path, "eye .5 1e0 -3.0 # the door\nat 0 0 00\nfovy 50\n"
                  "background .6 .6 .6\nlight point 1 2 3 radius 0\n"
                  "view 2 eye 1 1 1 at 0 0 .0\nexposure +1\n"
                  "up 0 0 2\n");
    view_free(&view);
}

/* The path of the sky in a view file leads to the same file from any current
 * folder. */
static void sky_paths_lead_to_the_file(void **state)
{
    static const struct {
        const char *view_path, *sky, *line;
    } cases[] = {
        {"a/v.view", "a/s.hdr", "sky s.hdr\n"},
        {"a/v.view", "a/deep/s x.hdr", "sky deep/s x.hdr\n"},
        {"a/v.view", "a/deep/../s.hdr", "sky s.hdr\n"},
        {"v.view", "a/s.hdr", "sky a/s.hdr\n"},
        {"./v.view", "s.hdr", "sky s.hdr\n"},
        {"a/v.view", "s.hdr", NULL}, /* absolute */
        {"a/v.view", "ab/s.hdr", NULL},
    };
    char line[5000], real[4096];

    (void)state;
    assert_int_equal(chdir(folder), 0);
    mkdir("a", 0777);
    mkdir("a/deep", 0777);
    mkdir("ab", 0777);
    assert_non_null(realpath(".", real));
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct error err;
        struct view view;
        char text[1000] = "";

        view_init(&view);
        view.lighting.sky_path = xstrdup(cases[i].sky);
        assert_true(view_write(&view, cases[i].view_path, &change, &err));
        view_free(&view);
        FILE *f = fopen(cases[i].view_path, "r");
        assert_non_null(f);
        assert_true(fread(text, 1, sizeof text - 1, f) > 0);
        fclose(f);
        snprintf(line, sizeof line, "sky %s/%s\n", real, cases[i].sky);
        assert_string_equal(strstr(text, "sky"),
                            cases[i].line ? cases[i].line : line);
    }
    struct error err;
    struct view view;
    view_init(&view);
    view.lighting.sky_path = xstrdup("two\nlines");
    assert_false(view_write(&view, "bad.view", &change, &err));
    assert_int_not_equal(access("bad.view", F_OK), 0);
    view_free(&view);
    assert_int_equal(chdir("/"), 0);
}

static void copies_own_their_texts(void **state)
{
    struct view a, b;

    (void)state;
    view_init(&a);
    view_init(&b);
    a.lighting.sky_path = xstrdup("one");
    b.lighting.sky_path = xstrdup("two");
    view_copy(&b, &a);
    assert_string_equal(b.lighting.sky_path, "one");
    assert_ptr_not_equal(a.lighting.sky_path, b.lighting.sky_path);
    view_free(&a);
    assert_string_equal(b.lighting.sky_path, "one");
    view_free(&b);
}

/* The camera files of other programs in the shared folder are read. */
static void shared_camera_files_are_read(void **state)
{
    char pattern[512];
    glob_t found;

    (void)state;
    snprintf(pattern, sizeof pattern, "%s/scenes-*/*/camera.txt",
             shared_folder());
    if (glob(pattern, 0, NULL, &found) != 0) {
        print_message("skipped: there is no %s\n", pattern);
        skip();
    }
    for (size_t i = 0; i < found.gl_pathc; i++) {
        struct warnings report = {0};
        struct error err = {""};
        struct view view;
        view_init(&view);
        assert_true(view_read(&view, found.gl_pathv[i], &report, &err));
        assert_true(view.has_camera && view.has_size);
        assert_int_equal(report.entry_count, 0);
        view_free(&view);
    }
    globfree(&found);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(
            shared_camera_files_are_read), /* before the folder changes */
        cmocka_unit_test(absent_keys_have_their_defaults),
        cmocka_unit_test(all_keys_are_read),
        cmocka_unit_test(fog_is_read),
        cmocka_unit_test(later_lines_override_earlier_ones),
        cmocka_unit_test(limits_are_accepted),
        cmocka_unit_test(wrong_lines_have_their_message),
        cmocka_unit_test(unreadable_files_have_their_message),
        cmocka_unit_test(unknown_keys_are_warned_of),
        cmocka_unit_test(random_bytes_do_no_harm),
        cmocka_unit_test(written_views_are_read_back),
        cmocka_unit_test(views_are_written_in_this_form),
        cmocka_unit_test(sky_paths_lead_to_the_file),
        cmocka_unit_test(copies_own_their_texts),
        cmocka_unit_test(numbered_views_have_the_keys_above),
        cmocka_unit_test(lines_of_others_are_kept),
        cmocka_unit_test(fog_is_written_at_its_place),
        cmocka_unit_test(unchanged_lines_are_kept),
        cmocka_unit_test(lights_are_read),
        cmocka_unit_test(lights_are_written_in_this_form),
        cmocka_unit_test(smokes_are_read),
        cmocka_unit_test(smokes_are_written_in_this_form),
    };

    return cmocka_run_group_tests_name("view", tests, make_folder,
                                       remove_folder);
}
