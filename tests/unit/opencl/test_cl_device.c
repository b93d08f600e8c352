// SPDX-License-Identifier: MIT
/*
 * test_cl_device.c - the list of devices: which device a word selects, how the
 * list is printed, and the real driver's devices
 */
#include "tests/unit/check.h"

#include <unistd.h>

#include "render/opencl/cl_api.h"
#include "render/opencl/cl_device.h"

static char alpha[] = "Alpha Graphics";
static char portable[] = "Portable Computing Language";
static char big[] = "Alpha 4090 Big";
static char small[] = "Alpha 3 Small";
static char cpu[] = "pthread-Some(R) CPU";
static char v12[] = "OpenCL 1.2";
static char v30[] = "OpenCL 3.0 PoCL HSTR: x";
static char driver_a[] = "535.1.2";
static char driver_b[] = "3.1";

static struct cl_device made_up[] = {
    {.platform_name = portable,
     .name = cpu,
     .version = v30,
     .driver_version = driver_b,
     .is_cpu = true,
     .memory_bytes = (uint64_t)3 << 29,
     .compute_units = 2},
    {.platform_name = alpha,
     .name = small,
     .version = v12,
     .driver_version = driver_a,
     .is_gpu = true,
     .memory_bytes = (uint64_t)8 << 30,
     .compute_units = 20},
    {.platform_name = alpha,
     .name = big,
     .version = v12,
     .driver_version = driver_a,
     .is_gpu = true,
     .memory_bytes = (uint64_t)80 << 30,
     .compute_units = 144},
};

static const struct cl_devices all = {made_up, 3};
static const struct cl_devices cpu_only = {made_up, 1};

static void selects(const char *word, int number)
{
    struct error err = {""};
    const struct cl_device *d = cl_device_find(&all, word, &err);

    check_or_say(d, err.text);
    assert_int_equal(d - made_up + 1, number);
}

static void selects_none(const char *word, const char *expected)
{
    struct error err;

    assert_null(cl_device_find(&all, word, &err));
    assert_string_equal(err.text, expected);
}

static void words_select_devices(void **state)
{
    struct error err;

    (void)state;
    selects("1", 1);
    selects("2", 2);
    selects("3", 3); /* although the digit is in a name */
    selects("4090 ", 3);
    selects("big", 3);
    selects("ALPHA 3", 2);
    selects("portable", 1);
    selects("(r)", 1);
    selects(NULL, 2);
    assert_ptr_equal(cl_device_find(&cpu_only, NULL, &err), made_up);
}

static void words_without_a_device_have_their_message(void **state)
{
    (void)state;
    selects_none("alpha",
                 "--device: found 'alpha' in the names of 2 devices, expected "
                 "one of 2 'Alpha 3 Small', 3 'Alpha 4090 Big'");
    selects_none("4", "--device: found no device '4', expected one of 1 "
                      "'pthread-Some(R) CPU', 2 'Alpha 3 Small', 3 'Alpha 4090 "
                      "Big'"); /* although the digit is in a name */
    selects_none("0", "--device: found no device '0', expected one of 1 "
                      "'pthread-Some(R) CPU', 2 'Alpha 3 Small', 3 'Alpha 4090 "
                      "Big'");
    selects_none("beta", "--device: found no device 'beta', expected one of 1 "
                         "'pthread-Some(R) CPU', 2 'Alpha 3 Small', 3 'Alpha "
                         "4090 Big'");
    selects_none("01",
                 "--device: found no device '01', expected one of 1 "
                 "'pthread-Some(R) CPU', 2 'Alpha 3 Small', 3 'Alpha 4090 "
                 "Big'");
}

static void lists_are_printed_in_columns(void **state)
{
    char text[1024];
    FILE *out = fmemopen(text, sizeof text, "w");

    (void)state;
    cl_devices_print(&all, out);
    fclose(out);
    assert_string_equal(
        text, " N  kind   units      memory  version     driver   device"
              "               platform\n"
              " 1  CPU        2     1.5 GiB  OpenCL 3.0  3.1      "
              "pthread-Some(R) CPU  Portable Computing Language\n"
              " 2  GPU       20     8.0 GiB  OpenCL 1.2  535.1.2  "
              "Alpha 3 Small        Alpha Graphics\n"
              " 3  GPU      144    80.0 GiB  OpenCL 1.2  535.1.2  "
              "Alpha 4090 Big       Alpha Graphics\n");
}

static void real_devices_are_listed(void **state)
{
    struct cl_devices list;
    struct error err;
    uint64_t memory_bytes =
        (uint64_t)sysconf(_SC_PHYS_PAGES) * (uint64_t)sysconf(_SC_PAGESIZE);

    (void)state;
    if (!cl_device_list(&list, &err)) {
        check_has(err.text, "OpenCL: ");
        print_message("skip: %s\n", err.text);
        skip();
    }
    assert_true(list.count > 0);
    for (int i = 0; i < list.count; i++) {
        const struct cl_device *d = &list.items[i];

        assert_non_null(d->platform);
        assert_non_null(d->id);
        assert_true(d->compute_units > 0);
        assert_true(d->max_alloc_bytes >= (uint64_t)1 << 20);
        assert_true(d->max_alloc_bytes <= d->memory_bytes);
        assert_memory_equal(d->version, "OpenCL ", 7);
        assert_true(*d->name != '\0' && *d->name != ' ');
        assert_true(*d->driver_version != '\0');
        if (d->is_cpu)
            assert_true(d->memory_bytes <= memory_bytes);
    }
    cl_devices_free(&list);
    assert_null(list.items);
    assert_int_equal(list.count, 0);
    cl_devices_free(&list);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_select_devices),
        cmocka_unit_test(words_without_a_device_have_their_message),
        cmocka_unit_test(lists_are_printed_in_columns),
        cmocka_unit_test(real_devices_are_listed),
    };

    cl_environment_prepare(0);
    return cmocka_run_group_tests_name("cl_device", tests, NULL, NULL);
}
