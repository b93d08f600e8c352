// SPDX-License-Identifier: MIT
/*
 * test_autosave_history.c - a kept session has the undo history of the one that
 * was lost: the same states at each undo and redo, under the same names
 */
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/file.h"
#include "session/autosave_state.h"
#include "session/session_save.h"

#include "tests/unit/files.h"

static struct options options = {.scene_path = "s.obj",
                                 .width_px = 1,
                                 .height_px = 1,
                                 .spp = 1,
                                 .max_bounces = -1,
                                 .thread_count = 1};

/* Without a background the scene has the soft sky, until a file with a lamp is
 * saved. */
static void put_scene(bool has_background)
{
    put("s.obj", "mtllib s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                 "o floor\nusemtl white\nf 1 2 3\no wall\nusemtl red\n"
                 "f 1 2 4\n");
    put("s.mtl", "newmtl white\nKd .8 .8 .8\nnewmtl red\nKd .7 .1 .1\n");
    put("s.view", has_background ? "eye 0 0 5\nat 0 0 0\nbackground 1 1 1\n"
                                 : "eye 0 0 5\nat 0 0 0\n");
}

static void open_session(struct session *s)
{
    struct error err;

    check_or_say(session_open(s, &options, clock_ns(), &err), err.text);
}

static uint64_t seed = 5;

static uint32_t random_below(uint32_t count)
{
    return (uint32_t)(check_random(&seed) * count);
}

static uint32_t any_material(const struct edit *e)
{
    uint32_t i = 1 + random_below(e->material_count - 1);

    while (!e->now.is_there[i])
        i--;
    return i;
}

static void add_or_move_lamp(struct edit *e)
{
    struct lamp lamp;

    if (e->now.view.lamps.count > 2) {
        edit_remove_lamp(e, random_below(e->now.view.lamps.count));
        return;
    }
    lamp_init(&lamp, LAMP_POINT);
    lamp.position[0] = check_random(&seed);
    edit_add_lamp(e, &lamp);
}

/* Changes a value, also back to that of the files. */
static void change_anything(struct edit *e, bool may_duplicate)
{
    uint32_t m = any_material(e), object = random_below(e->object_count);
    struct material_values source = e->now.sources[m];
    struct lighting light = e->now.view.lighting;
    struct pose pose = e->now.view.pose;

    switch (random_below(may_duplicate ? 8 : 7)) {
    case 0:
        source.base_color =
            (struct mtl_color){{check_random(&seed), 0.5, 0}, 1};
        edit_material(e, m, &source);
        break;
    case 1:
        if (e->saved.is_there[m])
            edit_material(e, m, &e->saved.sources[m]);
        break;
    case 2:
        light.exposure = random_below(3) / 3.0;
        edit_lighting(e, &light);
        break;
    case 3:
        pose.eye[random_below(3)] = check_random(&seed);
        edit_pose(e, &pose);
        break;
    case 4: edit_shot(e, random_below(3)); break;
    case 5: edit_assign(e, object, random_below(2) ? NO_INDEX : m); break;
    case 6: add_or_move_lamp(e); break;
    case 7: edit_assign(e, object, edit_duplicate(e, m)); break;
    }
}

/* Returns the material's name, "" for that of the OBJ file. */
static const char *assigned_name(const struct edit *e, uint32_t object)
{
    uint32_t material = e->now.assigned[object];

    return material != NO_INDEX ? e->names[material] : "";
}

static void check_same_materials(const struct edit *a, const struct edit *b)
{
    for (uint32_t i = 0; i < a->material_count; i++) {
        uint32_t k = edit_find_material(b, a->names[i]);

        if (!a->now.is_there[i])
            continue;
        assert_int_not_equal(k, NO_INDEX);
        assert_true(b->now.is_there[k]);
        assert_true(
            material_values_equal(&a->now.sources[i], &b->now.sources[k]));
        assert_int_equal(edit_is_saved(a, i), edit_is_saved(b, k));
    }
}

static void check_same_state(const struct edit *a, const struct edit *b)
{
    const struct view *v = &a->now.view, *w = &b->now.view;

    check_same_materials(a, b);
    check_same_materials(b, a);
    for (uint32_t i = 0; i < a->object_count; i++)
        assert_string_equal(assigned_name(a, i), assigned_name(b, i));
    assert_true(lighting_equal(&v->lighting, &w->lighting));
    assert_true(lamps_equal(&v->lamps, &w->lamps));
    assert_memory_equal(&v->pose, &w->pose, sizeof v->pose);
    for (int i = 0; i < VIEW_SHOTS; i++) {
        assert_int_equal(v->has_shot[i], w->has_shot[i]);
        if (v->has_shot[i])
            assert_memory_equal(&v->shots[i], &w->shots[i], sizeof v->shots[i]);
    }
}

/* Walks through both histories to the end. Returns the number of steps. */
static int walk(struct edit *a, struct edit *b,
                const char *(*step)(struct edit *))
{
    int count = 0;

    for (;; count++) {
        const char *in_a = step(a), *in_b = step(b);

        if (in_a == NULL || in_b == NULL) {
            assert_true(in_a == in_b);
            return count;
        }
        assert_string_equal(in_a, in_b);
        check_same_state(a, b);
    }
}

static void keep(struct autosave_file *k, struct session *s)
{
    struct error err;

    *k = (struct autosave_file){.scene = NULL};
    check_or_say(autosave_history_take(k, s, "/tmp/k", &err), err.text);
}

static void restore(const struct autosave_file *k, struct session *s)
{
    struct error err;
    uint32_t missing;

    open_session(s);
    check_or_say(autosave_history_restore(k, s, "/tmp/k", &missing, &err),
                 err.text);
    assert_int_equal(missing, 0);
}

static void save(struct session *s)
{
    struct file_watch nothing = {.fd = -1};
    struct error err;
    char *what;

    check_or_say(session_save_edit(s, &nothing, &what, &err), err.text);
    free(what);
}

/* In every third session the changes are saved on the way. */
static void histories_are_restored(void **state)
{
    int steps = 0;

    (void)state;
    for (int round = 0; round < 60; round++) {
        struct session s, again;
        struct autosave_file kept;
        bool saves = round % 3 == 0;

        put_scene(saves);
        open_session(&s);
        for (int i = 0; i < round; i++) {
            edit_end_step(&s.edit);
            change_anything(&s.edit, !saves);
            if (random_below(6) == 0)
                edit_undo(&s.edit);
            if (random_below(12) == 0)
                edit_redo(&s.edit);
            if (saves && i == round / 2)
                save(&s);
        }
        for (uint32_t i = random_below(4); i > 0; i--)
            edit_undo(&s.edit);
        keep(&kept, &s);
        restore(&kept, &again);
        check_same_state(&s.edit, &again.edit);
        steps += walk(&s.edit, &again.edit, edit_redo);
        steps += walk(&s.edit, &again.edit, edit_undo);
        walk(&s.edit, &again.edit, edit_redo);
        autosave_file_free(&kept);
        session_close(&s);
        session_close(&again);
    }
    assert_true(steps > 1000);
}

/* Images that were added are there again, and can be undone. */
static void added_images_are_restored(void **state)
{
    struct autosave_file kept;
    struct session s, again;
    struct error err;
    const struct edit *e = &again.edit;
    uint32_t red;

    (void)state;
    put_scene(true);
    put_bytes("a.ppm", "P6 1 1 255\nabc", 14);
    open_session(&s);
    red = edit_find_material(&s.edit, "red");
    assert_true(session_set_map(&s, red, MTL_MAP_COLOR, "a.ppm", &err));
    keep(&kept, &s);
    restore(&kept, &again);
    assert_int_not_equal(e->now.sources[red].maps[MTL_MAP_COLOR], NO_INDEX);
    assert_string_equal(
        path_name(again.engine.scene
                      .texture_paths[e->now.sources[red].maps[MTL_MAP_COLOR]]),
        "a.ppm");
    assert_string_equal(edit_undo(&again.edit), "material red");
    assert_int_equal(e->now.sources[red].maps[MTL_MAP_COLOR], NO_INDEX);
    autosave_file_free(&kept);
    session_close(&s);
    session_close(&again);
    remove("a.ppm");
}

/* Taking the history changes nothing, and a gesture goes on. */
static void sessions_go_on_after_they_were_kept(void **state)
{
    struct session s;
    struct autosave_file kept;
    struct pose pose;
    uint32_t version;

    (void)state;
    put_scene(false);
    open_session(&s);
    pose = s.edit.now.view.pose;
    edit_begin_gesture(&s.edit, 3, 1000);
    pose.eye[0] = 1;
    edit_pose(&s.edit, &pose);
    edit_compare(&s.edit, true);
    version = s.edit.version;
    keep(&kept, &s);
    autosave_file_free(&kept);
    assert_int_equal(s.edit.version, version);
    assert_true(s.edit.is_comparing);
    assert_false(edit_begin_gesture(&s.edit, 3, 2000));
    pose.eye[0] = 2;
    edit_pose(&s.edit, &pose);
    assert_string_equal(edit_undo(&s.edit), "camera");
    assert_true(s.edit.now.view.pose.eye[0] == 0);
    assert_null(edit_undo(&s.edit));
    session_close(&s);
}

/* One of two sessions with the same changes is kept after each of them. The
 * changes are in gestures, some of which go on, and in undone steps. */
static void keeping_changes_nothing(void **state)
{
    struct session kept, other;
    struct session *both[] = {&kept, &other};
    struct autosave_file file;

    (void)state;
    put_scene(true);
    open_session(&kept);
    open_session(&other);
    for (uint64_t i = 0; i < 300; i++) {
        uint64_t begin = seed;

        for (int k = 0; k < 2; k++) {
            struct edit *e = &both[k]->edit;
            uint32_t what;

            seed = begin;
            what = random_below(8);
            if (what == 0)
                edit_undo(e);
            else if (what == 1)
                edit_redo(e);
            else if (what == 2)
                edit_end_step(e);
            edit_begin_gesture(e, 1 + random_below(3), i * 400000000);
            if (what > 1)
                change_anything(e, false);
        }
        keep(&file, &kept);
        autosave_file_free(&file);
        check_same_state(&kept.edit, &other.edit);
    }
    for (int i = 0; i < 300; i++) {
        const char *a = edit_undo(&kept.edit), *b = edit_undo(&other.edit);

        assert_int_equal(a == NULL, b == NULL);
        check_same_state(&kept.edit, &other.edit);
    }
    session_close(&kept);
    session_close(&other);
}

/* The oldest steps are left out. */
static void long_histories_are_cut(void **state)
{
    struct session s, again;
    struct autosave_file kept;
    struct pose pose;
    int count = 0;

    (void)state;
    put_scene(false);
    open_session(&s);
    pose = s.edit.now.view.pose;
    for (int i = 0; i < 3 * AUTOSAVE_STEPS_MAX; i++) {
        edit_end_step(&s.edit);
        pose.eye[0] = i;
        edit_pose(&s.edit, &pose);
    }
    keep(&kept, &s);
    restore(&kept, &again);
    check_same_state(&s.edit, &again.edit);
    while (edit_undo(&again.edit) != NULL)
        count++;
    assert_int_equal(count, AUTOSAVE_STEPS_MAX);
    assert_true(again.edit.now.view.pose.eye[0] == 2 * AUTOSAVE_STEPS_MAX - 1);
    autosave_file_free(&kept);
    session_close(&s);
    session_close(&again);
}

/* A state with 1,000 assignments is some 20 KB, of which 1 MiB is kept. */
static void large_histories_are_cut(void **state)
{
    static char obj[40000];
    struct session s;
    struct autosave_file kept;
    int length = sprintf(obj, "mtllib s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n");

    (void)state;
    put_scene(false);
    for (int i = 0; i < 1000; i++)
        length += sprintf(obj + length, "o object_%04d\nf 1 2 3\n", i);
    put("s.obj", obj);
    open_session(&s);
    for (uint32_t i = 0; i < s.edit.object_count; i++) {
        edit_end_step(&s.edit);
        edit_assign(&s.edit, i, 1);
    }
    keep(&kept, &s);
    assert_in_range(kept.sizes[AUTOSAVE_HISTORY], 1 << 19, 1 << 20);
    autosave_file_free(&kept);
    session_close(&s);
}

/* A text that is cut or changed anywhere gives a message or a history, nothing
 * worse. */
static void damaged_histories_have_their_message(void **state)
{
    struct session s;
    struct autosave_file kept, part;
    struct error err;
    uint32_t missing;
    size_t size;

    (void)state;
    put_scene(false);
    open_session(&s);
    for (int i = 0; i < 4; i++) {
        edit_end_step(&s.edit);
        change_anything(&s.edit, true);
    }
    keep(&kept, &s);
    session_close(&s);
    open_session(&s);
    size = kept.sizes[AUTOSAVE_HISTORY];
    for (size_t cut = 0; cut < size; cut += 1 + cut / 50) {
        char *text = malloc(cut + 1);

        assert_non_null(text);
        memcpy(text, kept.parts[AUTOSAVE_HISTORY], cut);
        text[cut] = '\0';
        part = kept;
        part.parts[AUTOSAVE_HISTORY] = text;
        part.sizes[AUTOSAVE_HISTORY] = cut;
        assert_false(
            autosave_history_restore(&part, &s, "/tmp/k", &missing, &err));
        check_has(err.text, "/tmp/k");
        free(text);
    }
    autosave_file_free(&kept);
    session_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(histories_are_restored),
        cmocka_unit_test(added_images_are_restored),
        cmocka_unit_test(sessions_go_on_after_they_were_kept),
        cmocka_unit_test(keeping_changes_nothing),
        cmocka_unit_test(long_histories_are_cut),
        cmocka_unit_test(large_histories_are_cut),
        cmocka_unit_test(damaged_histories_have_their_message),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
