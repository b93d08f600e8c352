// SPDX-License-Identifier: MIT
/* test_image_folder.c - images beside a file are found by what they contain */
#include "tests/unit/check.h"
#include "tests/unit/files.h"

#include <sys/stat.h>
#include <unistd.h>

#include "image/image_folder.h"

/* A TGA of one grey pixel. */
static const char tga[] = "\0\0\3\0\0\0\0\0\0\0\0\0\1\0\1\0\x08\0\x7f";

static void images_are_found(void **state)
{
    static const char *const expected[] = {"deep/c.ppm", "photo", "t.tga"};
    struct image_folder images;
    char beside[200];

    (void)state;
    put("photo", "P6 1 1 255\nabc");
    put(".hidden", "P6 1 1 255\nabc");
    put("notes.png", "no image\n");
    put("empty.png", "");
    put_bytes("t.tga", tga, sizeof tga - 1);
    put_bytes("t.data", tga, sizeof tga - 1);
    assert_int_equal(mkdir("folder.png", 0700), 0);
    assert_int_equal(mkdir("deep", 0700), 0);
    assert_int_equal(mkdir("deep/deeper", 0700), 0);
    put("deep/c.ppm", "P6 1 1 255\nabc");
    put("deep/deeper/d.ppm", "P6 1 1 255\nabc");
    assert_int_equal(mkfifo("pipe.png", 0600), 0); /* would block */
    image_folder_list(&images, "scene.obj");
    assert_int_equal(images.count, 3);
    for (int i = 0; i < 3; i++)
        assert_string_equal(images.paths[i], expected[i]);
    image_folder_free(&images);
    snprintf(beside, sizeof beside, "%s/scene.obj", folder);
    image_folder_list(&images, beside);
    assert_int_equal(images.count, 3);
    assert_memory_equal(images.paths[1], folder, strlen(folder));
    image_folder_free(&images);
    image_folder_list(&images, "none/scene.obj");
    assert_int_equal(images.count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_are_found),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
