// SPDX-License-Identifier: MIT
/*
 * test_scene_files.c - the scenes to choose from: those opened last, folders
 * and files of a folder that glim reads; and their pictures
 */
#include "tests/unit/check.h"
#include "tests/unit/folder.h"

#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "session/scene_files.h"
#include "session/state_list.h"

static void make_file(const char *name)
{
    FILE *to = fopen(name, "w");

    assert_non_null(to);
    fclose(to);
}

static void endings_are_those_of_formats(void **state)
{
    static const char *const good[] = {"a.obj", "A.OBJ", "b.glb",    "c.gltf",
                                       "d.ply", "e.stl", "a.obj.gz", "x.y.obj"};
    static const char *const bad[] = {"a.mtl", "a.view", "a.png", "obj",
                                      ".obj",  "a.gz",   "",      "a.objx"};

    (void)state;
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++)
        check_or_say(scene_files_reads(good[i]), good[i]);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        check_or_say(!scene_files_reads(bad[i]), bad[i]);
}

/* Checks the text and kind of file i. */
static void check_file(const struct scene_files *s, int i, const char *text,
                       bool is_folder)
{
    assert_true(i < s->count);
    assert_string_equal(s->files[i].text, text);
    assert_int_equal(s->files[i].is_folder, is_folder);
    assert_int_equal(s->files[i].path[0], '/');
}

static void folders_are_listed(void **state)
{
    struct scene_files s;
    char path[300];

    (void)state;
    assert_int_equal(mkdir("f", 0700), 0);
    assert_int_equal(mkdir("f/models", 0700), 0);
    assert_int_equal(mkdir("f/.hidden", 0700), 0);
    make_file("f/b.obj");
    make_file("f/b.mtl");
    make_file("f/a.glb");
    make_file("f/.c.obj");
    recent_add("f/b.obj");
    snprintf(path, sizeof path, "%s/f", folder);
    scene_files_list(&s, path);
    assert_int_equal(s.count, 4);
    check_file(&s, 0, "../", true);
    check_file(&s, 1, "models/", true);
    check_file(&s, 2, "a.glb", false);
    check_file(&s, 3, "b.obj", false);
    scene_files_free(&s);
    /* what was opened last comes first, in the list of the current folder */
    assert_int_equal(chdir("f"), 0);
    setenv("HOME", folder, 1);
    scene_files_list(&s, NULL);
    check_file(&s, 0, "~/f/b.obj", false);
    check_file(&s, 1, "../", true);
    check_file(&s, 2, "models/", true);
    assert_string_equal(s.title, "~/f");
    scene_files_free(&s);
    assert_int_equal(chdir(".."), 0);
    /* one that does not exist is the root */
    scene_files_list(&s, "nowhere");
    assert_string_equal(s.folder, "/");
    scene_files_free(&s);
}

static void pictures_come_back(void **state)
{
    struct frame frame, read = {.rgb = NULL};
    struct error err;

    (void)state;
    make_file("p.obj");
    assert_false(scene_picture_read("p.obj", &read));
    assert_true(frame_init(&frame, 30, 20, &err));
    for (int i = 0; i < 3 * 30 * 20; i++)
        frame.rgb[i] = (uint8_t)(i * 7);
    scene_picture_keep("p.obj", &frame);
    assert_true(scene_picture_read("p.obj", &read));
    assert_int_equal(read.width, 30);
    assert_int_equal(read.height, 20);
    assert_memory_equal(read.rgb, frame.rgb, 3 * 30 * 20);
    frame_free(&read);
    assert_false(scene_picture_read("q.obj", &read));
    assert_false(scene_picture_read("-", &read));
    frame_free(&frame);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(endings_are_those_of_formats),
        cmocka_unit_test(folders_are_listed),
        cmocka_unit_test(pictures_come_back),
    };

    return cmocka_run_group_tests(tests, enter_folder_with_state,
                                  remove_folder);
}
