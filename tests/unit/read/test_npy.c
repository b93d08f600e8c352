// SPDX-License-Identifier: MIT
/*
 * test_npy.c - NumPy files of known numbers, of all types, versions and orders;
 * and broken files
 */
#include <math.h>

#include "read/npy.h"
#include "tests/unit/npy_file.h"
#include "tests/unit/vdb_file.h"

/* Sides of the array along x, y and z: one brick and parts of others. */
#define NX 11
#define NY 3
#define NZ 9

#define COUNT ((size_t)NX * NY * NZ)

/* Returns the number of a voxel, which all types have: 0 to 255. */
static unsigned number_at(uint32_t x, uint32_t y, uint32_t z)
{
    return x == 4 ? 0 : (x * 7 + y * 31 + z * 13) % 256;
}

/* Writes a number of a type; the lowest byte is the first. */
static size_t put_number(const char *type, double number, unsigned char *to)
{
    float f = (float)number;
    uint16_t half = half_bits(f), word = (uint16_t)number;

    if (strcmp(type, "f2") == 0)
        memcpy(to, &half, sizeof half);
    else if (strcmp(type, "f4") == 0)
        memcpy(to, &f, sizeof f);
    else if (strcmp(type, "f8") == 0)
        memcpy(to, &number, sizeof number);
    else if (strcmp(type, "u2") == 0)
        memcpy(to, &word, sizeof word);
    else
        *to = (unsigned char)number;
    return (size_t)(type[1] - '0');
}

/* Returns a file of the numbers. */
static char *file_of(int version, char order, const char *type, bool x_is_first,
                     size_t *size_bytes)
{
    static unsigned char bytes[COUNT * 8];
    char dictionary[200];
    size_t at = 0;

    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t x = x_is_first ? i / NZ / NY : i % NX;
        uint32_t y = x_is_first ? i / NZ % NY : i / NX % NY;
        uint32_t z = x_is_first ? i % NZ : i / NX / NY;
        unsigned char number[8];
        size_t size = put_number(type, number_at(x, y, z), number);

        for (size_t k = 0; k < size; k++)
            bytes[at++] = number[order == '>' ? size - 1 - k : k];
    }
    snprintf(dictionary, sizeof dictionary,
             "{'descr': '%c%s', 'fortran_order': %s, 'shape': (%d, %d, %d), }",
             order, type, x_is_first ? "True" : "False", NZ, NY, NX);
    return npy_file_with(version, dictionary, bytes, at, size_bytes);
}

static void check_numbers(const struct voxel_grid *g)
{
    static const int32_t last[3] = {NX - 1, NY - 1, NZ - 1};
    static const uint32_t sides[3] = {2, 1, 2};

    for (int a = 0; a < 3; a++) {
        assert_int_equal(g->first[a], 0);
        assert_int_equal(g->last[a], last[a]);
        assert_int_equal(g->origin[a], 0);
        assert_int_equal(g->sides[a], sides[a]);
        for (int k = 0; k < 4; k++)
            check_close(g->to_world.m[a][k], k == a ? 1 : k == 3 ? 0.5 : 0, 0);
    }
    for (int z = -1; z <= NZ; z++)
        for (int y = -1; y <= NY; y++)
            for (int x = -1; x <= NX; x++) {
                bool is_in =
                    x >= 0 && x < NX && y >= 0 && y < NY && z >= 0 && z < NZ;

                check_close(voxel_grid_value(g, x, y, z),
                            is_in ? number_at((uint32_t)x, (uint32_t)y,
                                              (uint32_t)z)
                                  : 0,
                            0);
            }
    assert_int_equal(g->replaced_count, 0);
    assert_int_equal(g->background, 0);
}

static void all_kinds_have_their_numbers(void **state)
{
    static const char *const types[] = {"f2", "f4", "f8", "u1", "u2"};
    static const char orders[] = "<>|=";

    (void)state;
    for (int version = 1; version <= 3; version++)
        for (int t = 0; t < 5; t++)
            for (int o = 0; o < 8; o++) {
                size_t size;
                char *bytes = file_of(version, orders[o / 2], types[t],
                                      o % 2 != 0, &size);
                struct voxel_grid grid;
                struct error err;

                assert_true(npy_matches(bytes, size));
                check_or_say(npy_parse(&grid, bytes, size, &err), err.text);
                check_numbers(&grid);
                voxel_grid_free(&grid);
                free(bytes);
            }
}

static void majorants_bound_the_numbers(void **state)
{
    struct voxel_grid grid;
    struct error err;
    size_t size;
    char *bytes = file_of(1, '<', "f4", false, &size);

    (void)state;
    check_or_say(npy_parse(&grid, bytes, size, &err), err.text);
    for (uint32_t i = 0; i < 4; i++) {
        const int64_t at[3] = {8 * (i / 2), 0, 8 * (i % 2)};
        float most = 0;

        for (int x = -1; x <= 8; x++)
            for (int y = -1; y <= 8; y++)
                for (int z = -1; z <= 8; z++)
                    most = fmaxf(most, voxel_grid_value(&grid, at[0] + x,
                                                        at[1] + y, at[2] + z));
        check_close(grid.majorants[i], most * (1 + 0x1p-20f), 0);
    }
    voxel_grid_free(&grid);
    free(bytes);
}

/* What is no number becomes 0, and numbers beyond the largest become that. */
static void odd_numbers_are_replaced(void **state)
{
    static const double numbers[8] = {NAN,   INFINITY, -INFINITY, 1e300,
                                      -1e39, 1e-300,   -0.0,      7};
    static const float want[8] = {0, 0, 0, 1e30f, -1e30f, 0, 0, 7};
    static const char dictionary[] =
        "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 2, 2)}";
    struct voxel_grid grid;
    struct error err;
    size_t size;
    char *bytes = npy_file_with(1, dictionary, numbers, sizeof numbers, &size);

    (void)state;
    check_or_say(npy_parse(&grid, bytes, size, &err), err.text);
    for (int i = 0; i < 8; i++)
        check_close(voxel_grid_value(&grid, i & 1, i >> 1 & 1, i >> 2), want[i],
                    0);
    assert_int_equal(grid.replaced_count, 3);
    voxel_grid_free(&grid);
    free(bytes);
}

/* ---- broken files ---- */

static void check_fails(const char *bytes, size_t size, const char *message)
{
    /* a copy of this length, for sanitizers */
    char *copy = malloc(size + (size == 0));
    struct voxel_grid grid;
    struct error err = {""};

    assert_non_null(copy);
    memcpy(copy, bytes, size);
    assert_false(npy_parse(&grid, copy, size, &err));
    if (message != NULL)
        assert_string_equal(err.text, message);
    assert_true(err.text[0] != '\0' && strchr(err.text, '\n') == NULL);
    voxel_grid_free(&grid);
    free(copy);
}

#define OTHER_TYPE \
    "found an array of other numbers, expected f2, f4, f8, u1 or u2"
#define OTHER_SHAPE \
    "found an array of another shape, expected 3 axes of 1 to 2048 numbers"
#define NO_ORDER                                                               \
    "found no order of axes in its header, expected 'fortran_order': True or " \
    "False"

static void wrong_headers_are_told(void **state)
{
    static const struct {
        const char *dictionary, *message;
    } cases[] = {
        {"", OTHER_TYPE},
        {"{'descr': '<i4', 'fortran_order': False, 'shape': (1, 1, 1)}",
         OTHER_TYPE},
        {"{'descr': '<f4, 'fortran_order': False, 'shape': (1, 1, 1)}",
         OTHER_TYPE},
        {"{'descr': 'f4', 'fortran_order': False, 'shape': (1, 1, 1)}",
         OTHER_TYPE},
        {"{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (1, 1, "
         "1)}",
         OTHER_TYPE},
        {"{'descr': '<f4', 'fortran_order': False}", OTHER_SHAPE},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': ()}", OTHER_SHAPE},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1)}",
         OTHER_SHAPE},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1, 1, 1)}",
         OTHER_SHAPE},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (0, 1, 1)}",
         OTHER_SHAPE},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (1, -1, 1)}",
         OTHER_SHAPE},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2049, 1, 1)}",
         OTHER_SHAPE},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': "
         "(18446744073709551617, 1, 1)}",
         OTHER_SHAPE},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1, 1",
         OTHER_SHAPE},
        {"{'descr': '<f4', 'shape': (1, 1, 1)}", NO_ORDER},
        {"{'descr': '<f4', 'fortran_order': 0, 'shape': (1, 1, 1)}", NO_ORDER},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2048, 2048, "
         "2048)}",
         "found 4 bytes of numbers, expected 34359738368 by its shape"},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1, 1)}",
         "found 4 bytes of numbers, expected 8 by its shape"},
        {"{'descr': '|u1', 'fortran_order': False, 'shape': (1, 3, 1)}",
         "found 4 bytes of numbers, expected 3 by its shape"},
    };
    static const float number = 1;

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        size_t size;
        char *bytes = npy_file_with(1 + (int)(i % 3), cases[i].dictionary,
                                    &number, sizeof number, &size);

        check_fails(bytes, size, cases[i].message);
        free(bytes);
    }
}

/* Each beginning of a file fails; the first bytes do not matter to it alone. */
static void short_files_fail(void **state)
{
    static const char none[] =
        "found no header of a NumPy file of version 1 to 3";
    static const char digits[] = "\x93NUMPY\1\0\50\0"
                                 "'descr':'<f4','shape':(1,1,1234567890123";

    (void)state;
    for (int version = 1; version <= 3; version++) {
        size_t size;
        char *bytes = file_of(version, '<', "f2", false, &size);

        for (size_t i = 0; i < size; i++)
            check_fails(bytes, i, i < 12 ? none : NULL);
        bytes[6] = version == 1 ? 0 : 4;
        check_fails(bytes, size, none);
        bytes[0] = 'N';
        assert_false(npy_matches(bytes, size));
        check_fails(bytes, size, none);
        bytes[0] = '\x93';
        bytes[6] = (char)version;
        memset(bytes + 8, 0xff, 2);
        check_fails(bytes, size, "found the end of the file in its header");
        free(bytes);
    }
    assert_false(npy_matches(digits, 5));
    check_fails(digits, sizeof digits - 1, OTHER_SHAPE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_kinds_have_their_numbers),
        cmocka_unit_test(majorants_bound_the_numbers),
        cmocka_unit_test(odd_numbers_are_replaced),
        cmocka_unit_test(wrong_headers_are_told),
        cmocka_unit_test(short_files_fail),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
