// SPDX-License-Identifier: MIT
/*
 * test_cl_api.c - the table of functions is complete and loaded once; codes
 * have names
 */
#include "tests/unit/check.h"

#include "render/opencl/cl_api.h"

static void all_functions_are_loaded_once(void **state)
{
    struct error err;
    const struct cl_api *cl = cl_api_open(&err);

    (void)state;
    if (!cl) {
        check_has(err.text, "libOpenCL.so.1");
        print_message("skip: no OpenCL library here\n");
        skip();
    }
    assert_ptr_equal(cl, cl_api_open(&err));
#define CHECK_MEMBER(name) check_or_say(cl->name, #name);
    CL_API_FUNCTIONS(CHECK_MEMBER)
#undef CHECK_MEMBER
}

/* The values are from the appendix of the specification. */
static void codes_have_the_specification_s_names(void **state)
{
    (void)state;
    assert_string_equal(cl_error_name(0), "CL_SUCCESS");
    assert_string_equal(cl_error_name(-1), "CL_DEVICE_NOT_FOUND");
    assert_string_equal(cl_error_name(-5), "CL_OUT_OF_RESOURCES");
    assert_string_equal(cl_error_name(-11), "CL_BUILD_PROGRAM_FAILURE");
    assert_string_equal(cl_error_name(-54), "CL_INVALID_WORK_GROUP_SIZE");
    assert_string_equal(cl_error_name(-1001), "CL_PLATFORM_NOT_FOUND_KHR");
    assert_string_equal(cl_error_name(-9999), "an unknown OpenCL error");
    assert_string_equal(cl_error_name(1), "an unknown OpenCL error");
}

/* OpenCL 1.2 has the codes 0 to -19 and -30 to -68. Only the loader's code has
 * a name besides these. */
static void all_codes_have_names(void **state)
{
    (void)state;
    for (int code = 5; code >= -1100; code--) {
        bool is_known = (code <= 0 && code >= -19) ||
                        (code <= -30 && code >= -68) || code == -1001;

        if (is_known)
            assert_memory_equal(cl_error_name(code), "CL_", 3);
        else
            assert_string_equal(cl_error_name(code), "an unknown OpenCL error");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_functions_are_loaded_once),
        cmocka_unit_test(codes_have_the_specification_s_names),
        cmocka_unit_test(all_codes_have_names),
    };

    return cmocka_run_group_tests_name("cl_api", tests, NULL, NULL);
}
