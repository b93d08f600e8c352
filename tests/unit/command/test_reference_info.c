// SPDX-License-Identifier: MIT
/*
 * test_reference_info.c - the file beside a reference, written and read, and
 * files by others
 */
#include "tests/unit/files.h"

#include "command/reference_info.h"

static void a_written_file_is_read(void **state)
{
    static char program[] = "glim", quoted[] = "a \"b\".obj";
    char *arguments[] = {program, quoted, NULL};
    struct reference_info info = {true, 1.5e-6, 2.5e-5, 2e-5, 3e-5, 7, 8};
    struct reference_origin origin = {.width = 3,
                                      .height = 2,
                                      .spp = 64,
                                      .mean = 0.25,
                                      .seconds = 1,
                                      .scene_path = quoted,
                                      .arguments = arguments};
    struct reference_info read;
    struct error err;

    (void)state;
    check_or_say(reference_info_write(&info, &origin, "a.json", &err),
                 err.text);
    read = reference_info_read("a.pfm");
    assert_true(read.is_known);
    check_close(read.mse, 1.5e-6, 1e-12);
    check_close(read.relmse, 2.5e-5, 1e-12);
    check_close(read.relmse_low, 2e-5, 1e-12);
    check_close(read.relmse_high, 3e-5, 1e-12);
    check_close(read.first_seed, 7, 0);
    check_close(read.seed_count, 8, 0);
    assert_false(reference_info_write(&info, &origin, "none/a.json", &err));
    assert_false(reference_info_read("b.pfm").is_known);
}

/* The form that references by Blender's Cycles have. */
static void files_by_others_are_read(void **state)
{
    (void)state;
    put("c.json", "{\"renderer\": \"Cycles 3.4.1\", \"spp\": 4096, "
                  "\"mse\": 6.5e-07, \"relmse\": 2.4e-05}");
    check_close(reference_info_read("c.pfm").relmse, 2.4e-5, 1e-12);
    check_close(reference_info_read("c.pfm").mse, 6.5e-7, 1e-12);
    check_close(reference_info_read("c.pfm").seed_count, 0, 0);
}

static void other_files_are_no_error(void **state)
{
    static const char *const texts[] = {"",
                                        "{}",
                                        "{\"relmse\": 1}",
                                        "{\"relmse\": \"x\", \"mse\": 1}",
                                        "{\"relmse\": nan, \"mse\": 1}",
                                        "{\"relmse\": 1, \"mse\": inf}",
                                        "{\"relmse\": 1e999, \"mse\": 1}",
                                        "{\"relmse\": -1, \"mse\": 1}",
                                        "{\"relmse\":",
                                        "{\"relmse\": 1, \"mse\": -1}"};

    (void)state;
    for (int i = 0; i < 10; i++) {
        put("d.json", texts[i]);
        assert_false(reference_info_read("d.pfm").is_known);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_written_file_is_read),
        cmocka_unit_test(files_by_others_are_read),
        cmocka_unit_test(other_files_are_no_error),
    };

    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
