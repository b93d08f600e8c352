// SPDX-License-Identifier: MIT
/*
 * The kernels as one text: what is put where, what the marks say to a C
 * preprocessor and to a driver, and what is wrong with files that lack.
 */
#include "tests/unit/check.h"
#include "tests/unit/folder.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "opencl/cl_device.h"
#include "opencl/cl_source.h"
#include "terminal/xmalloc.h"

/* By the C library alone. */
static void put(const char *name, const char *text)
{
    char path[256];

    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    assert_int_equal(fclose(f), 0);
}

/* The four entries, of which only the second one has anything to say. */
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

static void test_order(void **state)
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

static void test_nesting(void **state)
{
    (void)state;
    put("a.h", "a1\n  #  include\t\"kernels/b.h\" // why\na3\n");
    put("b.h", "b1\n#include \"kernels/a.h\"\nb3"); /* no end of line */
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

static void test_once_for_all_entries(void **state)
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

static void test_other_lines_stay(void **state)
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

static void test_missing(void **state)
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

/* What is within the program is what is in the repository. */
static void test_embedded(void **state)
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

static void test_embedded_text(void **state)
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

/* Vectors of the authors, http://www.isthe.com/chongo/src/fnv/test_fnv.c */
static void test_hash(void **state)
{
    (void)state;
    assert_true(cl_source_hash("") == 0xcbf29ce484222325u);
    assert_true(cl_source_hash("a") == 0xaf63dc4c8601ec8cu);
    assert_true(cl_source_hash("foobar") == 0x85944171f73967e8u);
}

/* The driver's log of building the text, for free(); skips where there is no
 * driver. */
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

static void test_driver_names_our_line(void **state)
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

static void test_driver_takes_kernels(void **state)
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
        cmocka_unit_test(test_order),
        cmocka_unit_test(test_nesting),
        cmocka_unit_test(test_once_for_all_entries),
        cmocka_unit_test(test_other_lines_stay),
        cmocka_unit_test(test_missing),
        cmocka_unit_test(test_embedded),
        cmocka_unit_test(test_embedded_text),
        cmocka_unit_test(test_hash),
        cmocka_unit_test(test_driver_names_our_line),
        cmocka_unit_test(test_driver_takes_kernels),
    };

    return cmocka_run_group_tests_name("cl_source", tests, make_folder,
                                       remove_folder);
}
