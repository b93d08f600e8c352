// SPDX-License-Identifier: MIT
/*
 * test_cl_source.c - the kernels as one text: the order of files, the line
 * marks for a C preprocessor and for a driver, and errors about missing files
 */
#include "tests/unit/check.h"
#include "tests/unit/folder.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "render/opencl/cl_device.h"
#include "render/opencl/cl_source.h"
#include "terminal/xmalloc.h"

/* Writes a file by the C library alone. */
static void put(const char *name, const char *text)
{
    char path[256];

    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    assert_int_equal(fclose(f), 0);
}

/* Writes the four entry files; only the second one is not empty. */
static void put_entries(const char *pathtracer)
{
    put("ray_generator.cl", "");
    put("pathtracer.cl", pathtracer);
    put("compositor.cl", "");
    put("clear_buffers.cl", "");
}

static char *text_of_folder(void)
{
    struct error err;
    char *text = cl_source_text(folder, &err);

    check_or_say(text, err.text);
    return text;
}

static void text_is(const char *expected)
{
    char *text = text_of_folder();

    assert_string_equal(text, expected);
    free(text);
}

static void fails(const char *expected)
{
    struct error err;

    assert_null(cl_source_text(folder, &err));
    assert_string_equal(err.text, expected);
}

static void entries_are_in_order(void **state)
{
    (void)state;
    put("ray_generator.cl", "a\n");
    put("pathtracer.cl", "b\n");
    put("compositor.cl", "c\n");
    put("clear_buffers.cl", "d\n");
    text_is("#line 1 \"kernels/ray_generator.cl\"\na\n"
            "#line 1 \"kernels/pathtracer.cl\"\nb\n"
            "#line 1 \"kernels/compositor.cl\"\nc\n"
            "#line 1 \"kernels/clear_buffers.cl\"\nd\n");
}

static void included_files_replace_their_lines(void **state)
{
    (void)state;
    put("a.h", "a1\n  #  include\t\"kernels/b.h\" // why\na3\n");
    /* No line feed at the end. */
    put("b.h", "b1\n#include \"kernels/a.h\"\nb3");
    put_entries("#include \"kernels/a.h\"\n#include \"kernels/b.h\"\np3\n");
    text_is("#line 1 \"kernels/ray_generator.cl\"\n"
            "#line 1 \"kernels/pathtracer.cl\"\n"
            "#line 1 \"kernels/a.h\"\na1\n"
            "#line 1 \"kernels/b.h\"\nb1\n\nb3\n"
            "#line 3 \"kernels/a.h\"\na3\n"
            "#line 2 \"kernels/pathtracer.cl\"\n\np3\n"
            "#line 1 \"kernels/compositor.cl\"\n"
            "#line 1 \"kernels/clear_buffers.cl\"\n");
}

static void files_are_included_once(void **state)
{
    (void)state;
    put("a.h", "only here\n");
    put_entries("#include \"kernels/a.h\"\n");
    put("clear_buffers.cl", "#include \"kernels/a.h\"\n");
    char *text = text_of_folder();
    char *first = strstr(text, "only here");
    assert_non_null(first);
    assert_null(strstr(first + 1, "only here"));
    free(text);
}

static void other_lines_stay(void **state)
{
    static const char *const lines[] = {
        "#include <math.h>",
        "// #include \"kernels/none.h\"",
        "x #include \"kernels/none.h\"",
        "#included \"kernels/none.h\"",
        "#include \"kernels/none.h",
        "#include \"none.h\"",
    };

    (void)state;
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        put_entries(lines[i]);
        char *text = text_of_folder();
        check_has(text, lines[i]);
        free(text);
    }
}

static void missing_files_have_their_message(void **state)
{
    char expected[256];
    struct error err;

    (void)state;
    put("wants.h", "\n\n#include \"kernels/none.h\"\n");
    put_entries("\n#include \"kernels/wants.h\"\n");
    snprintf(expected, sizeof expected,
             "kernels/wants.h:3: %s/none.h: no such file or folder", folder);
    fails(expected);
    put_entries("");
    snprintf(expected, sizeof expected, "%s/compositor.cl", folder);
    assert_int_equal(unlink(expected), 0);
    snprintf(expected, sizeof expected,
             "%s/compositor.cl: no such file or folder", folder);
    fails(expected);
    assert_null(cl_source_text("/nowhere", &err));
    assert_string_equal(err.text,
                        "/nowhere/ray_generator.cl: no such file or folder");
}

/* The embedded files are those of the repository. */
static void embedded_files_are_those_of_the_repository(void **state)
{
    size_t count = 0;
    struct error err;

    (void)state;
    for (const struct cl_source_file *f = cl_source_files; f->name; f++) {
        char *text;
        size_t size_bytes;

        check_or_say(file_read(f->name, &text, &size_bytes, &err), err.text);
        assert_string_equal(f->text, text);
        assert_int_equal(strlen(f->text), size_bytes);
        free(text);
        count++;
    }
    char counting[] = "ls kernels/*.h kernels/*.cl 2>/dev/null | wc -l";
    FILE *ls = popen(counting, "r");
    size_t file_count = 0;
    assert_int_equal(fscanf(ls, "%zu", &file_count), 1);
    pclose(ls);
    assert_int_equal(count, file_count);
}

static void embedded_text_is_that_of_the_folder(void **state)
{
    struct error err;
    char *within = cl_source_text(NULL, &err);

    (void)state;
    check_or_say(within, err.text);
    char *outside = cl_source_text("kernels", &err);
    check_or_say(outside, err.text);
    assert_string_equal(within, outside);
    free(within);
    free(outside);
}

/* Test vectors of the authors:
 * http://www.isthe.com/chongo/src/fnv/test_fnv.c */
static void hash_is_fnv(void **state)
{
    (void)state;
    assert_true(cl_source_hash("") == 0xcbf29ce484222325u);
    assert_true(cl_source_hash("a") == 0xaf63dc4c8601ec8cu);
    assert_true(cl_source_hash("foobar") == 0x85944171f73967e8u);
}

/* Returns the driver's log of building the text, for free(). Skips the test
 * without a driver. */
static char *log_of(const char *text, cl_int *status)
{
    struct error err;
    struct cl_devices list;
    size_t size_bytes = 0;

    if (!cl_device_list(&list, &err)) {
        print_message("skip: %s\n", err.text);
        skip();
    }
    const struct cl_api *cl = cl_api_open(&err);
    cl_device_id device = cl_device_find(&list, NULL, &err)->id;
    cl_context context =
        cl->CreateContext(NULL, 1, &device, NULL, NULL, status);
    assert_int_equal(*status, CL_SUCCESS);
    cl_program program =
        cl->CreateProgramWithSource(context, 1, &text, NULL, status);
    assert_int_equal(*status, CL_SUCCESS);
    *status = cl->BuildProgram(program, 1, &device, "-cl-std=CL1.2 -Werror",
                               NULL, NULL);
    cl->GetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, 0, NULL,
                            &size_bytes);
    char *log = xcalloc(size_bytes + 1, 1);
    cl->GetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, size_bytes,
                            log, NULL);
    cl->ReleaseProgram(program);
    cl->ReleaseContext(context);
    cl_devices_free(&list);
    return log;
}

static void driver_names_the_line_of_the_file(void **state)
{
    cl_int status;

    (void)state;
    put("good.h", "typedef int good;\n\n");
    put("bad.h", "#include \"kernels/good.h\"\n\n\ngood f(void) { return "
                 "unknown; }\n");
    put_entries("#include \"kernels/bad.h\"\n\nalso_unknown x;\n");
    char *text = text_of_folder();
    char *log = log_of(text, &status);
    assert_int_equal(status, CL_BUILD_PROGRAM_FAILURE);
    check_has(log, "kernels/bad.h:4:");
    check_has(log, "kernels/pathtracer.cl:3:");
    free(log);
    free(text);
}

static void driver_builds_the_kernels(void **state)
{
    struct error err;
    cl_int status;
    char *text = cl_source_text(NULL, &err);

    (void)state;
    check_or_say(text, err.text);
    char *log = log_of(text, &status);
    check_or_say(status == CL_SUCCESS, log);
    free(log);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(entries_are_in_order),
        cmocka_unit_test(included_files_replace_their_lines),
        cmocka_unit_test(files_are_included_once),
        cmocka_unit_test(other_lines_stay),
        cmocka_unit_test(missing_files_have_their_message),
        cmocka_unit_test(embedded_files_are_those_of_the_repository),
        cmocka_unit_test(embedded_text_is_that_of_the_folder),
        cmocka_unit_test(hash_is_fnv),
        cmocka_unit_test(driver_names_the_line_of_the_file),
        cmocka_unit_test(driver_builds_the_kernels),
    };

    return cmocka_run_group_tests_name("cl_source", tests, make_folder,
                                       remove_folder);
}
