// SPDX-License-Identifier: MIT
/*
 * Which view counts, what the command line changes in it, what is said about
 * scenes without camera, light or faces; and the JSON about a render.
 */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "session/session_save.h"
#include "session/stats_json.h"

#include "tests/unit/files.h"

#define TRIANGLE "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
#define CAMERA   "eye 0 0 5\nat 0 0 0\n"

/* An odd name, which the statistics must still be able to tell. */
#define ODD "odd\"\\\n\xff\xc3\xa9.obj"

static const char *const names[] = {"s.obj", "s.view",   "camera.txt", "o.view",
                                    "s.mtl", "out.json", "s.view~",    ODD};

static int leave(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        unlink(names[i]);
    return leave_empty_folder(state);
}

static int remove_files(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        unlink(names[i]);
    return 0;
}

static struct options options_for(const char *scene)
{
    return (struct options){.scene_path = scene,
                            .spp = 2,
                            .max_bounces = -1,
                            .thread_count = 1};
}

static void open_session(struct session *s, const struct options *o)
{
    struct error err;

    check_or_say(session_open(s, o, clock_ns(), &err), err.text);
}

static void test_view_files(void **state)
{
    struct options o = options_for("s.obj");
    struct session s;

    (void)state;
    put("s.obj", TRIANGLE);
    put("camera.txt", CAMERA "fovy 11\n");
    open_session(&s, &o);
    assert_true(s.edit.now.view.pose.fovy_deg == 11.0);
    assert_string_equal(s.view_path, "s.view"); /* camera.txt is not ours */
    session_close(&s);

    put("s.view", CAMERA "fovy 22\n");
    open_session(&s, &o);
    assert_true(s.edit.now.view.pose.fovy_deg == 22.0);
    assert_true(s.opened.fovy_deg == 22.0);
    session_close(&s);

    put("o.view", CAMERA "fovy 33\n");
    o.view_path = "o.view";
    open_session(&s, &o);
    assert_true(s.edit.now.view.pose.fovy_deg == 33.0);
    assert_string_equal(s.view_path, "o.view");
    session_close(&s);
}

static void test_options_win(void **state)
{
    struct options o = options_for("s.obj");
    struct session s;

    (void)state;
    put("s.obj", TRIANGLE);
    put("s.view", CAMERA "res 300 200\nmax_bounces 4\n");
    open_session(&s, &o);
    assert_int_equal(s.edit.now.view.width_px, 300);
    assert_int_equal(s.edit.now.view.height_px, 200);
    assert_int_equal(s.edit.now.view.max_bounces, 4);
    session_close(&s);

    o.width_px = 150;
    o.has_max_bounces = true;
    o.max_bounces = 0;
    open_session(&s, &o);
    assert_int_equal(s.edit.now.view.width_px, 150);
    assert_int_equal(s.edit.now.view.height_px, 100);
    assert_int_equal(s.edit.now.view.max_bounces, 0);
    session_close(&s);

    o.width_px = 0;
    o.height_px = 1;
    open_session(&s, &o);
    assert_int_equal(s.edit.now.view.width_px, 2); /* 1.5 to the nearest */
    session_close(&s);

    o.width_px = 65536;
    o.height_px = 7;
    open_session(&s, &o);
    assert_int_equal(s.edit.now.view.width_px, 65536);
    assert_int_equal(s.edit.now.view.height_px, 7);
    session_close(&s);

    /* without a size in the view file the shape is 1024x576 */
    put("s.view", CAMERA);
    o.width_px = 512;
    o.height_px = 0;
    open_session(&s, &o);
    assert_int_equal(s.edit.now.view.height_px, 288);
    session_close(&s);
}

static void is_text(const char *name, const char *expected)
{
    struct error err;
    size_t size_bytes;
    char *text;

    check_or_say(file_read(name, &text, &size_bytes, &err), err.text);
    assert_string_equal(text, expected);
    free(text);
}

static void save_view(struct session *s)
{
    struct file_change change;
    struct error err;

    check_or_say(session_save_view(s, &change, &err), err.text);
}

/* The size and the bounces of -w, -h and -d are for one run: the file keeps its
 * own, or none, also when it is loaded anew meanwhile. */
static void test_options_are_not_written(void **state)
{
    struct options o = options_for("s.obj");
    struct session s, fresh;
    struct error err;

    (void)state;
    put("s.obj", TRIANGLE);
    put("s.view", CAMERA "up 0 1 0\nfovy 40\nres 300 200\nmax_bounces 4\n");
    o.width_px = 150;
    o.has_max_bounces = true;
    o.max_bounces = 0;
    open_session(&s, &o);
    save_view(&s);
    is_text("s.view", CAMERA "up 0 1 0\nfovy 40\nres 300 200\nmax_bounces 4\n");
    assert_int_equal(s.edit.now.view.width_px, 150);

    put("s.view", CAMERA "up 0 1 0\nfovy 40\nres 300 100\nmax_bounces 5\n");
    check_or_say(session_load(&fresh, &o, clock_ns(), &err), err.text);
    session_take(&s, &fresh);
    session_close(&fresh);
    assert_int_equal(s.edit.now.view.width_px,
                     150); /* the option wins as before */
    assert_int_equal(s.edit.now.view.height_px, 50);
    assert_int_equal(s.edit.now.view.max_bounces, 0);
    save_view(&s);
    is_text("s.view", CAMERA "up 0 1 0\nfovy 40\nres 300 100\nmax_bounces 5\n");
    session_close(&s);

    unlink("s.view"); /* a new file says nothing of them */
    o.height_px = 10;
    open_session(&s, &o);
    save_view(&s);
    session_close(&s);
    o = options_for("s.obj");
    open_session(&s, &o);
    assert_false(s.edit.now.view.has_size);
    assert_int_equal(s.edit.now.view.width_px, 1024);
    assert_int_equal(s.edit.now.view.max_bounces, -1);
    session_close(&s);
}

/* One step back: the text before the last change, whatever is written twice. */
static void test_view_before_is_kept(void **state)
{
    const char *first = "# mine\n" CAMERA "up 0 1 0\nfovy 40\n";
    const char *second = "# mine\neye 1 0 5\nat 0 0 0\nup 0 1 0\nfovy 40\n";
    const char *third = "# mine\neye 2 0 5\nat 0 0 0\nup 0 1 0\nfovy 40\n";
    struct options o = options_for("s.obj");
    struct file_change change;
    struct session s;
    struct error err;

    (void)state;
    put("s.obj", TRIANGLE);
    put("s.view", first);
    open_session(&s, &o);
    save_view(&s); /* nothing has changed: nothing is to be kept */
    assert_int_equal(access("s.view~", F_OK), -1);
    s.edit.now.view.pose.eye[0] = 1;
    for (int i = 0; i < 2; i++) {
        save_view(&s);
        is_text("s.view", second);
        is_text("s.view~", first);
    }
    s.edit.now.view.pose.eye[0] = 2;
    save_view(&s);
    is_text("s.view", third);
    is_text("s.view~", second);

    /* what cannot be kept is not replaced */
    unlink("s.view~");
    assert_int_equal(mkdir("s.view~", 0777), 0);
    s.edit.now.view.pose.eye[0] = 3;
    assert_false(session_save_view(&s, &change, &err));
    assert_non_null(strstr(err.text, "s.view~: "));
    is_text("s.view", third);
    assert_int_equal(rmdir("s.view~"), 0);
    session_close(&s);
}

static void test_light(void **state)
{
    struct options o = options_for("s.obj");
    struct session s;

    (void)state;
    put("s.obj", TRIANGLE);
    open_session(&s, &o);
    assert_non_null(strstr(s.notice, "no light"));
    assert_true(s.edit.now.view.lighting.background[1] > 0.0);
    session_close(&s);

    /* a person who wants it dark gets it dark */
    put("s.view", CAMERA "background 0 0 0\n");
    open_session(&s, &o);
    assert_string_equal(s.notice, "");
    assert_true(s.edit.now.view.lighting.background[1] == 0.0);
    session_close(&s);

    put("s.view", CAMERA);
    put("s.obj", "mtllib s.mtl\nusemtl lamp\n" TRIANGLE);
    put("s.mtl", "newmtl lamp\nKe 1 1 1\n");
    open_session(&s, &o);
    assert_string_equal(s.notice, "");
    assert_true(s.edit.now.view.lighting.background[1] == 0.0);
    session_close(&s);

    put("s.obj", "v 0 0 0\n");
    open_session(&s, &o);
    assert_non_null(strstr(s.notice, "no faces"));
    assert_true(s.edit.now.view.lighting.background[1] == 0.0);
    session_close(&s);
}

/* The whole scene is seen when nobody says from where. */
static void test_framing(void **state)
{
    struct options o = options_for("s.obj");
    struct session s;
    struct error err;

    (void)state;
    put("s.obj", "v 100 0 0\nv 101 0 0\nv 100 3 0\nf 1 2 3\n");
    open_session(&s, &o);
    check_or_say(pose_check(&s.edit.now.view.pose, "framed", &err), err.text);
    assert_true(s.edit.now.view.pose.at[0] > 99.0 &&
                s.edit.now.view.pose.at[0] < 102.0);
    session_close(&s);
}

static void test_errors(void **state)
{
    struct options o = options_for("s.obj");
    struct session s;
    struct error err;

    (void)state;
    assert_false(session_open(&s, &o, clock_ns(), &err));
    assert_string_equal(err.text, "s.obj: no such file or folder");
    session_close(&s);

    put("s.obj", TRIANGLE);
    o.view_path = "o.view";
    assert_false(session_open(&s, &o, clock_ns(), &err));
    assert_string_equal(err.text, "o.view: no such file or folder");
    session_close(&s);

    o.view_path = NULL;
    o.has_crop = true;
    o.crop = (struct rect){1000, 0, 25, 576};
    assert_false(session_open(&s, &o, clock_ns(), &err));
    assert_string_equal(err.text,
                        "--crop: found 1000,0,25,576, expected a part of the "
                        "picture, which has 1024x576 pixels");
    session_close(&s);

    o.crop.width = 24;
    open_session(&s, &o);
    session_close(&s);
}

static void test_statistics(void **state)
{
    struct options o = options_for(ODD);
    struct session s;
    struct error err;
    char *text;
    size_t size_bytes;

    (void)state;
    put(ODD, TRIANGLE);
    o.width_px = 6;
    o.height_px = 4;
    open_session(&s, &o);
    assert_true(session_restart(&s, 2, &err));
    assert_true(render_wait(s.render, 60000));
    assert_true(stats_json_write(&s, "out.json", &err));
    session_close(&s);

    assert_true(file_read("out.json", &text, &size_bytes, &err));
    assert_non_null(
        strstr(text,
               "\"scene\": \"odd\\\"\\\\\\u000a\\ufffd\xc3\xa9.obj\",\n"));
    assert_non_null(strstr(text, "\"width\": 6,\n"));
    assert_non_null(strstr(text, "\"spp\": 2,\n"));
    assert_non_null(strstr(text, "\"samples\": 48,\n"));
    assert_non_null(strstr(text, "\"stopped\": false,\n"));
    assert_non_null(strstr(text, "\"threads\": 1,\n"));
    assert_null(strstr(text, "nan"));
    assert_null(strstr(text, "inf"));
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_view_files, remove_files),
        cmocka_unit_test_teardown(test_options_win, remove_files),
        cmocka_unit_test_teardown(test_options_are_not_written, remove_files),
        cmocka_unit_test_teardown(test_view_before_is_kept, remove_files),
        cmocka_unit_test_teardown(test_light, remove_files),
        cmocka_unit_test_teardown(test_framing, remove_files),
        cmocka_unit_test_teardown(test_errors, remove_files),
        cmocka_unit_test_teardown(test_statistics, remove_files),
    };

    return cmocka_run_group_tests_name("session", tests, enter_folder, leave);
}
