// SPDX-License-Identifier: MIT
/*
 * test_reload.c - a session that takes changed files renders the same bits as
 * one opened after the change; broken files leave the old scene
 */
#include "tests/unit/files.h"

#include <unistd.h>

#include "base/clock.h"
#include "read/view_file.h"
#include "session/save.h"

#define OBJ                                                                  \
    "mtllib s.mtl\nusemtl m\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nv 0 0 -1\nf 1 2 " \
    "3\n"                                                                    \
    "f 1 2 4\n"
#define MTL  "newmtl m\nKd .7 .5 .3\n"
#define VIEW "eye 0 0 5\nat 0 0 0\nres 24 16\nbackground .5 .5 .5\n"

#define FLOATS (3 * 24 * 16)

static struct options options = {.scene_path = "s.obj",
                                 .spp = 2,
                                 .max_bounces = -1,
                                 .thread_count = 1};

static void open_scene(struct session *s)
{
    struct error err;

    put("s.obj", OBJ);
    put("s.mtl", MTL);
    put("s.view", VIEW);
    check_or_say(session_open(s, &options, clock_ns(), &err), err.text);
}

static void render(struct session *s, float *pixels)
{
    struct error err;

    check_or_say(session_restart(s, (struct render_limits){.spp = 2}, &err),
                 err.text);
    assert_true(render_wait(s->engine.render, 10000));
    assert_int_equal(render_progress(s->engine.render).state, RENDER_DONE);
    film_linear(render_film(s->engine.render), pixels);
}

/* Writes a file, lets the open session take it, and compares with a new
 * session. */
static void check_reload(struct session *s, const char *name, const char *text,
                         bool has_same_shape)
{
    float before[FLOATS], taken[FLOATS], opened[FLOATS];
    struct session fresh;
    struct error err;
    uint64_t shape;

    render(s, before);
    shape = s->engine.world.versions[WORLD_SHAPE];
    put(name, text);
    check_or_say(session_load(&fresh, &options, clock_ns(), &err), err.text);
    session_take_loaded(s, &fresh);
    session_close(&fresh);
    assert_int_equal(s->engine.world.versions[WORLD_SHAPE] == shape,
                     has_same_shape);
    render(s, taken);
    session_close(s);
    check_or_say(session_open(s, &options, clock_ns(), &err), err.text);
    render(s, opened);
    session_close(s);
    check_or_say(memcmp(taken, before, sizeof taken) != 0, text);
    assert_memory_equal(taken, opened, sizeof taken);
}

static void is_taken(const char *name, const char *text, bool has_same_shape)
{
    struct session s;

    open_scene(&s);
    check_reload(&s, name, text, has_same_shape);
}

static void changed_files_are_taken(void **state)
{
    (void)state;
    is_taken("s.mtl", "newmtl m\nKd .1 .5 .9\n", true);
    is_taken("s.mtl", "newmtl x\nKd 1 1 1\nnewmtl m\nKe 1 2 3\n", true);
    is_taken("s.view", VIEW "exposure 1\nmax_bounces 0\nfovy 20\n", true);
    is_taken("s.view", "eye 1 2 5\nat 0 0 0\nres 24 16\nbackground 1 0 0\n",
             true);
    is_taken("s.obj", "v -1 -1 0\nv 1 -1 0\nv 0 2 0\nf 1 2 3\n", false);
    is_taken("s.obj", OBJ "v 3 3 3\nf 1 3 5\n", false);
    /* One triangle is reversed: the same places in another order. */
    is_taken("s.obj",
             "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nv 0 0 -1\nf 1 3 2\nf 1 2 4\n",
             false);
}

/* Where a lamp is the only light, only the picture needs a tree, and the new
 * scene has none. */
static void trees_are_built_only_for_pictures(void **state)
{
    struct session s;
    struct error err;

    (void)state;
    put("s.obj", OBJ);
    put("s.mtl", "newmtl m\nKe 1 2 3\n");
    put("s.view", "eye 0 0 5\nat 0 0 0\nres 24 16\nbackground 0 0 0\n");
    check_or_say(session_open(&s, &options, clock_ns(), &err), err.text);
    assert_null(world_tree(&s.engine.world));
    check_reload(&s, "s.mtl", "newmtl m\nKe 3 2 1\n", true);
}

/* A camera that the person has moved stays if the file's camera has not
 * changed. */
static void cameras_stay(void **state)
{
    struct session s, fresh;
    struct error err;

    (void)state;
    for (int moves = 0; moves < 2; moves++) {
        open_scene(&s);
        s.edit.now.view.pose.eye[0] = 1.5;
        put("s.view", moves ? "eye 0 9 5\nat 0 0 0\nexposure 2\n"
                            : "eye 0 0 5\nat 0 0 0\nexposure 2\n");
        assert_true(session_load(&fresh, &options, clock_ns(), &err));
        session_take_loaded(&s, &fresh);
        session_close(&fresh);
        check_close(s.edit.now.view.pose.eye[0], moves ? 0 : 1.5, 0);
        check_close(s.edit.now.view.pose.eye[1], moves ? 9 : 0, 0);
        check_close(s.edit.now.view.lighting.exposure, 2, 0);
        assert_int_equal(s.edit.now.view.width_px, 1024); /* without res */
        check_close(s.opened_pose.eye[0], 0, 0);
        session_close(&s);
    }
}

/* Numbered views of the file appear, disappear and change; the others stay. */
static void numbered_views_are_taken(void **state)
{
    struct session s, fresh;
    struct file_change change;
    struct error err;

    (void)state;
    open_scene(&s);
    for (int i = 0; i < 2; i++) {
        s.edit.now.view.shots[i] = s.edit.now.view.pose;
        s.edit.now.view.has_shot[i] = true;
    }
    s.edit.now.view.pose.eye[0] = 7;
    s.edit.now.view.shots[2] = s.edit.now.view.pose;
    s.edit.now.view.has_shot[2] = true;
    check_or_say(view_write(&s.edit.now.view, "s.view", &change, &err),
                 err.text);
    session_close(&s);
    check_or_say(session_open(&s, &options, clock_ns(), &err), err.text);
    s.edit.now.view.shots[3].eye[0] = 5; /* set by the person, in no file */
    s.edit.now.view.has_shot[3] = true;
    check_or_say(session_load(&fresh, &options, clock_ns(), &err), err.text);
    for (int i = 0; i < 2; i++) {
        struct edit *e = &fresh.edit;
        struct view *view = i == 0 ? &e->now.view : &e->saved.view;

        view->has_shot[0] = false;
        view->shots[1].eye[0] = 2;
    }
    session_take_loaded(&s, &fresh);
    session_close(&fresh);
    assert_false(s.edit.now.view.has_shot[0]);
    check_close(s.edit.now.view.shots[1].eye[0], 2, 0);
    check_close(s.edit.now.view.shots[2].eye[0], 7, 0);
    assert_true(s.edit.now.view.has_shot[3]);
    check_close(s.edit.now.view.shots[3].eye[0], 5, 0);
    session_close(&s);
}

/* Cameras placed by the program do not jump when the scene grows. */
static void framed_cameras_stay(void **state)
{
    struct session s, fresh;
    struct error err;
    double eye;

    (void)state;
    open_scene(&s);
    session_close(&s);
    unlink("s.view");
    assert_true(session_open(&s, &options, clock_ns(), &err));
    eye = s.edit.now.view.pose.eye[2];
    put("s.obj", OBJ "v 9 9 9\nf 1 3 5\n");
    assert_true(session_load(&fresh, &options, clock_ns(), &err));
    assert_true(fresh.edit.now.view.pose.eye[2] != eye);
    session_take_loaded(&s, &fresh);
    session_close(&fresh);
    check_close(s.edit.now.view.pose.eye[2], eye, 0);
    session_close(&s);
}

/* Looks at the files until none has changed since the last look. */
static void look_now(struct live_render *w)
{
    do {
        w->files_ns = clock_ns();
        live_render_update(w);
    } while (w->watch.is_changing);
}

/* Checks the files and waits for what is then loaded. */
static void end_reload(struct live_render *w)
{
    if (!w->reload.loading.is_busy)
        look_now(w);
    assert_true(w->reload.loading.is_busy);
    live_render_end_reload(w);
}

static void open_work(struct live_render *w, struct session *s)
{
    struct error err;

    open_scene(s);
    assert_true(live_render_init(w, s, &err));
}

static void close_work(struct live_render *w, struct session *s)
{
    live_render_free(w);
    session_close(s);
}

static void broken_files_leave_the_scene(void **state)
{
    struct session s;
    struct live_render w;

    (void)state;
    open_work(&w, &s);
    put("s.mtl", "newmtl m\nKd .1 x\n");
    look_now(&w);
    assert_true(w.has_changed_files);
    live_render_reload(&w);
    end_reload(&w);
    assert_true(w.message.is_error);
    assert_non_null(strstr(w.message.text, "s.mtl:2: "));
    check_close(s.engine.world.materials[1].color.x, .7f, 0);
    look_now(&w);
    assert_false(w.has_changed_files); /* the message appears once */
    put("s.mtl", "newmtl m\nKd .25 0 0\n");
    look_now(&w);
    assert_true(w.has_changed_files);
    live_render_reload(&w);
    end_reload(&w);
    assert_false(w.message.is_error);
    assert_string_equal(w.message.text, "loaded s.obj");
    check_close(s.engine.world.materials[1].color.x, .25, 0);
    assert_int_equal(w.progress.state, RENDER_RUNNING);
    close_work(&w, &s);
}

static void warnings_are_shown(void **state)
{
    struct session s;
    struct live_render w;

    (void)state;
    open_work(&w, &s);
    put("s.obj", OBJ "usemtl other\nf 1 3 4\n");
    live_render_reload(&w);
    end_reload(&w);
    assert_non_null(strstr(w.message.text, "loaded, 1 warning: s.obj:"));
    close_work(&w, &s);
}

static void watched_files_are_loaded_at_once(void **state)
{
    struct session s;
    struct live_render w;

    (void)state;
    options.watch = true;
    open_work(&w, &s);
    put("s.mtl", "newmtl m\nKd .25 0 0\n");
    end_reload(&w);
    check_close(s.engine.world.materials[1].color.x, .25, 0);
    /* A render of normal mode that would be lost prevents it. */
    live_render_set_live(&w, false);
    live_render_start_or_halt(&w);
    put("s.mtl", "newmtl m\nKd .5 0 0\n");
    look_now(&w);
    assert_true(w.has_changed_files);
    assert_false(w.reload.loading.is_busy);
    live_render_reload(&w); /* only a message */
    assert_false(w.reload.loading.is_busy);
    live_render_set_live(&w, true);
    end_reload(&w);
    check_close(s.engine.world.materials[1].color.x, .5, 0);
    close_work(&w, &s);
    options.watch = false;
}

/* Where the system reports no changes, files are checked once per second. */
static void unwatched_files_are_checked_each_second(void **state)
{
    struct session s;
    struct live_render w;

    (void)state;
    open_work(&w, &s);
    close(w.watch.fd);
    w.watch.fd = -1;
    look_now(&w);
    assert_false(w.has_changed_files);
    assert_true(w.files_ns < clock_ns() + UINT64_C(2000000000));
    put("s.mtl", "newmtl m\nKd .25 0 0\n");
    look_now(&w);
    assert_true(w.has_changed_files);
    close_work(&w, &s);
}

static void own_views_are_no_change(void **state)
{
    struct session s;
    struct live_render w;

    (void)state;
    open_work(&w, &s);
    s.edit.now.view.lighting.exposure = 3;
    save_view(&w);
    look_now(&w);
    assert_false(w.has_changed_files);
    put("s.mtl", MTL "\n");
    s.edit.now.view.lighting.exposure = 4;
    save_view(&w);
    look_now(&w);
    assert_true(w.has_changed_files); /* the other file */
    close_work(&w, &s);
}

/* A saved material is not a change either; a write by others after it is
 * one. */
static void own_materials_are_no_change(void **state)
{
    struct session s;
    struct live_render w;
    struct material_values red;

    (void)state;
    open_work(&w, &s);
    red = s.edit.now.sources[1];
    red.base_color.rgb[0] = .125;
    edit_material(&s.edit, 1, &red);
    assert_true(save_edit(&w));
    look_now(&w);
    assert_false(w.has_changed_files);
    put("s.mtl", MTL "\n");
    look_now(&w);
    assert_true(w.has_changed_files);
    /* It remains one when the next save overwrites it. */
    red.base_color.rgb[0] = .25;
    edit_material(&s.edit, 1, &red);
    assert_true(save_edit(&w));
    look_now(&w);
    assert_true(w.has_changed_files);
    close_work(&w, &s);
}

/* An image chosen as sky in the panel is watched at once, even if it is still
 * broken. */
static void chosen_skies_are_watched(void **state)
{
    struct session s;
    struct live_render w;
    struct lighting light;
    char path[] = "sky.png";

    (void)state;
    open_work(&w, &s);
    light = s.edit.now.view.lighting;
    light.sky_path = path;
    edit_lighting(&s.edit, &light);
    put("sky.png", "no image");
    assert_true(live_render_is_outdated(&w));
    while (live_render_is_outdated(&w))
        live_render_update(&w);
    look_now(&w);
    assert_false(w.has_changed_files);
    put("sky.png", "no image either");
    look_now(&w);
    assert_true(w.has_changed_files);
    close_work(&w, &s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(changed_files_are_taken),
        cmocka_unit_test(trees_are_built_only_for_pictures),
        cmocka_unit_test(cameras_stay),
        cmocka_unit_test(numbered_views_are_taken),
        cmocka_unit_test(framed_cameras_stay),
        cmocka_unit_test(broken_files_leave_the_scene),
        cmocka_unit_test(warnings_are_shown),
        cmocka_unit_test(watched_files_are_loaded_at_once),
        cmocka_unit_test(unwatched_files_are_checked_each_second),
        cmocka_unit_test(own_views_are_no_change),
        cmocka_unit_test(own_materials_are_no_change),
        cmocka_unit_test(chosen_skies_are_watched),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
