// SPDX-License-Identifier: MIT
/*
 * test_session.c - which view counts and what options change in it; messages
 * about scenes without camera, light or faces; the JSON about a render; images
 * that are given to materials
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

/* A name with odd characters that the statistics must contain. */
#define ODD "odd\"\\\n\xff\xc3\xa9.obj"

static const char *const names[] = {"s.obj", "s.view",   "camera.txt", "o.view",
                                    "s.mtl", "out.json", "s.view~",    ODD,
                                    "a.ppm", "b.ppm",    "s.obj.mtl"};

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

static void view_files_are_found(void **state)
{
    struct options o = options_for("s.obj");
    struct session s;

    (void)state;
    put("s.obj", TRIANGLE);
    put("camera.txt", CAMERA "fovy 11\n");
    open_session(&s, &o);
    assert_true(s.edit.now.view.pose.fovy_deg == 11.0);
    /* The file camera.txt belongs to another program. */
    assert_string_equal(s.engine.view_path, "s.view");
    session_close(&s);

    put("s.view", CAMERA "fovy 22\n");
    open_session(&s, &o);
    assert_true(s.edit.now.view.pose.fovy_deg == 22.0);
    assert_true(s.opened_pose.fovy_deg == 22.0);
    session_close(&s);

    put("o.view", CAMERA "fovy 33\n");
    o.view_path = "o.view";
    open_session(&s, &o);
    assert_true(s.edit.now.view.pose.fovy_deg == 33.0);
    assert_string_equal(s.engine.view_path, "o.view");
    session_close(&s);
}

static void options_win_over_the_view(void **state)
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
    assert_int_equal(s.edit.now.view.width_px, 2); /* 1.5 rounded */
    session_close(&s);

    o.width_px = 65536;
    o.height_px = 7;
    open_session(&s, &o);
    assert_int_equal(s.edit.now.view.width_px, 65536);
    assert_int_equal(s.edit.now.view.height_px, 7);
    session_close(&s);

    /* Without a size in the view file the shape is 1024x576. */
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

/* The size and the bounces of -w, -h and -d are for one run. The file keeps its
 * own, or none, even if it is loaded again meanwhile. */
static void options_are_not_written(void **state)
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
    session_take_loaded(&s, &fresh);
    session_close(&fresh);
    assert_int_equal(s.edit.now.view.width_px,
                     150); /* the option wins as before */
    assert_int_equal(s.edit.now.view.height_px, 50);
    assert_int_equal(s.edit.now.view.max_bounces, 0);
    save_view(&s);
    is_text("s.view", CAMERA "up 0 1 0\nfovy 40\nres 300 100\nmax_bounces 5\n");
    session_close(&s);

    unlink("s.view"); /* a new file has none of them */
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

/* The previous text is kept as a backup, however often the same text is
 * written. */
static void previous_view_is_kept(void **state)
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
    save_view(&s); /* without a change nothing is kept */
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

    /* A file without a possible backup is not replaced. */
    unlink("s.view~");
    assert_int_equal(mkdir("s.view~", 0777), 0);
    s.edit.now.view.pose.eye[0] = 3;
    assert_false(session_save_view(&s, &change, &err));
    assert_non_null(strstr(err.text, "s.view~: "));
    is_text("s.view", third);
    assert_int_equal(rmdir("s.view~"), 0);
    session_close(&s);
}

static void scenes_without_light_have_a_sky(void **state)
{
    struct options o = options_for("s.obj");
    struct session s;

    (void)state;
    put("s.obj", TRIANGLE);
    open_session(&s, &o);
    assert_non_null(strstr(s.notice, "no light"));
    assert_true(s.edit.now.view.lighting.background[1] > 0.0);
    session_close(&s);

    /* A person may choose darkness. */
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
    assert_string_equal(s.notice, "no faces: s.obj: found no visible face: "
                                  "only the background is rendered");
    assert_true(s.edit.now.view.lighting.background[1] == 0.0);
    session_close(&s);

    /* the reason and its line, as in batch mode */
    put("s.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n");
    open_session(&s, &o);
    assert_string_equal(s.notice, "no faces: s.obj:3: found vertex 3 in a "
                                  "face, expected 1 to 2 or -1 to -2: face "
                                  "dropped");
    session_close(&s);
}

/* Without a camera the whole scene is shown. */
static void scenes_without_a_camera_are_framed(void **state)
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

static void errors_have_their_message(void **state)
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

static void statistics_are_json(void **state)
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
    assert_true(session_restart(&s, (struct render_limits){.spp = 2}, &err));
    assert_true(render_wait(s.engine.render, 60000));
    assert_true(stats_json_write(&s, false, "out.json", &err));
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

#define SQUARE                                                             \
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n" \
    "f 1/1 2/2 3/3 4/4\n"

static void render_both(struct session *s, struct session *other)
{
    struct frame frames[2];
    struct session *both[] = {s, other};
    struct error err;

    for (int i = 0; i < 2; i++) {
        struct render *r = both[i]->engine.render;

        assert_true(
            session_restart(both[i], (struct render_limits){.spp = 4}, &err));
        assert_true(render_wait(r, 60000));
        assert_true(frame_init(&frames[i], 16, 16, &err));
        film_preview(render_film(r), NULL, session_develop(both[i]),
                     &frames[i]);
    }
    assert_memory_equal(frames[0].rgb, frames[1].rgb, 3 * 16 * 16);
    frame_free(&frames[0]);
    frame_free(&frames[1]);
}

/* Saves the changes, and renders the same picture as the files that are written
 * then: `mtl` beside a scene without an MTL file. */
static void check_saved(struct session *s, const char *mtl)
{
    struct file_watch watch;
    struct session again;
    struct error err;
    char *what;

    file_watch_init(&watch);
    check_or_say(session_save_edit(s, &watch, &what, &err), err.text);
    assert_string_equal(what, "wrote 1 material to s.obj.mtl");
    free(what);
    file_watch_free(&watch);
    has("s.obj.mtl", mtl);
    open_session(&again, s->options);
    render_both(s, &again);
    session_close(&again);
}

static void images_are_given_to_materials(void **state)
{
    struct options o = options_for("s.obj");
    struct session s;
    struct error err;

    (void)state;
    o.width_px = o.height_px = 16;
    put("s.obj", SQUARE);
    put("s.view", CAMERA "background 1 1 1\n");
    put_bytes("a.ppm", "P6 2 1 255\n\xff\0\0\0\xff\0", 17);
    put_bytes("b.ppm", "P6 1 2 255\n\0\0\xff\x80\x80\x80", 17);
    open_session(&s, &o);
    assert_false(session_set_map(&s, 1, MTL_MAP_COLOR, "s.obj", &err));
    assert_non_null(strstr(err.text, "s.obj: found no image that can be read"));
    assert_true(session_set_map(&s, 1, MTL_MAP_COLOR, "a.ppm", &err));
    check_saved(&s, "\nnewmtl material\nmap_Kd a.ppm\n");
    /* another one takes its place; undo puts it back */
    assert_true(session_set_map(&s, 1, MTL_MAP_COLOR, "b.ppm", &err));
    check_saved(&s, "\nnewmtl material\nmap_Kd b.ppm\n");
    assert_string_equal(edit_undo(&s.edit), "material material");
    check_saved(&s, "\nnewmtl material\nmap_Kd a.ppm\n");
    assert_true(session_set_map(&s, 1, MTL_MAP_ROUGHNESS, "b.ppm", &err));
    check_saved(&s, "\nnewmtl material\nmap_Kd a.ppm\nmap_Pr b.ppm\n");
    session_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(view_files_are_found, remove_files),
        cmocka_unit_test_teardown(options_win_over_the_view, remove_files),
        cmocka_unit_test_teardown(options_are_not_written, remove_files),
        cmocka_unit_test_teardown(previous_view_is_kept, remove_files),
        cmocka_unit_test_teardown(scenes_without_light_have_a_sky,
                                  remove_files),
        cmocka_unit_test_teardown(scenes_without_a_camera_are_framed,
                                  remove_files),
        cmocka_unit_test_teardown(errors_have_their_message, remove_files),
        cmocka_unit_test_teardown(statistics_are_json, remove_files),
        cmocka_unit_test_teardown(images_are_given_to_materials, remove_files),
    };

    return cmocka_run_group_tests_name("session", tests, enter_folder, leave);
}
