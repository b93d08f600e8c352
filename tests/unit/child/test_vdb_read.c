// SPDX-License-Identifier: MIT
/*
 * test_vdb_read.c - grids that a copy of the program sends, and copies that
 * fail in every way. This test is the program of the copies: see main().
 */

#include "read/child/vdb_read.h"
#include "read/vdb.h"
#include "tests/unit/check.h"
#include "tests/unit/child/shell_program.h"
#include "tests/unit/files.h"
#include "tests/unit/vdb_file.h"

#define SELF "/proc/self/exe"

static float voxel(const void *unused, const int32_t v[3], bool *active)
{
    (void)unused;
    *active = true;
    return (float)(v[0] * 100 + v[1] * 10 + v[2]);
}

/* Writes a file of two grids, "heat" with a background of 1, and "density". */
static char *put_file(const char *path, size_t *size)
{
    struct vdb_file f;
    struct vdb_grid g = {.name = "heat",
                         .background = 1,
                         .first = {1, 1, 1},
                         .flags = VDB_ACTIVE_MASK | VDB_ZIP};
    char *bytes;

    vdb_file_begin(&f, 224, 2);
    vdb_file_add(&f, &g);
    g.name = "density";
    g.voxel = voxel;
    g.last[0] = g.last[1] = g.last[2] = 20;
    vdb_file_add(&f, &g);
    bytes = vdb_file_end(&f, size);
    put_bytes(path, bytes, *size);
    return bytes;
}

static void copies_send_what_they_read(void **state)
{
    struct voxel_grid got, want;
    struct error err;
    size_t size;
    char *bytes = put_file("a.vdb", &size);
    uint64_t places;

    (void)state;
    for (int i = 0; i < 3; i++) {
        const char *name = i == 0 ? NULL : i == 1 ? "density" : "heat";

        check_or_say(vdb_read(&got, "a.vdb", name, SELF, &err), err.text);
        assert_true(vdb_parse(&want, bytes, size, name, &err));
        places = voxel_grid_place_count(&want);
        assert_int_equal(voxel_grid_place_count(&got), places);
        assert_int_equal(places, i == 2 ? 0 : 125);
        assert_int_equal(got.brick_count, want.brick_count);
        check_close(got.background, 1, 0);
        assert_memory_equal(&got.to_world, &want.to_world, sizeof got.to_world);
        assert_memory_equal(got.first, want.first, sizeof got.first);
        assert_memory_equal(got.origin, want.origin, sizeof got.origin);
        assert_memory_equal(got.index, want.index, places * sizeof *got.index);
        assert_memory_equal(got.majorants, want.majorants,
                            places * sizeof *got.majorants);
        assert_memory_equal(got.values, want.values,
                            got.brick_count * BRICK_VOXELS *
                                sizeof *got.values);
        voxel_grid_free(&got);
        voxel_grid_free(&want);
    }
    free(bytes);
    unlink("a.vdb");
}

static void failures_are_one_line(void **state)
{
    static const struct {
        const char *script, *message;
    } cases[] = {
        {"kill -SEGV $$", "x.vdb: its reader crashed (Segmentation fault)"},
        {"kill -XCPU $$", "x.vdb: its reader does not end"},
        {"echo 'found no grid'; exit 1", "x.vdb: found no grid"},
        {"exit 3", "x.vdb: its reader ended with status 3"},
        {"echo something", "x.vdb: found no end in what its reader sent"},
        {"yes other | head -c 5000",
         "x.vdb: found another end in what its reader sent"},
    };
    struct voxel_grid grid;
    struct error err;

    (void)state;
    put("x.vdb", "text");
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_false(vdb_read(&grid, "x.vdb", NULL,
                              shell_program(cases[i].script), &err));
        check_has(err.text, cases[i].message);
        voxel_grid_free(&grid);
    }
    assert_false(vdb_read(&grid, "x.vdb", NULL, "/nowhere/glim", &err));
    check_has(err.text, "x.vdb: its reader could not be run: No such file");
    assert_false(vdb_read(&grid, "x.vdb", NULL, NULL, &err));
    check_has(err.text, "x.vdb: found a file that only the program glim reads");
    assert_false(vdb_read(&grid, "none.vdb", NULL, SELF, &err));
    check_has(err.text, "none.vdb: no such file");
    assert_false(vdb_read(&grid, ".", NULL, SELF, &err));
    check_has(err.text, ".: ");
    assert_false(vdb_read(&grid, "x.vdb", NULL, SELF, &err));
    assert_string_equal(err.text, "x.vdb: found its end at byte 4, expected 4 "
                                  "more bytes");
    put("x.vdb", "text of another format");
    assert_false(vdb_read(&grid, "x.vdb", "smoke", SELF, &err));
    assert_string_equal(err.text, "x.vdb: found no OpenVDB file");
    unlink("x.vdb");
    unlink("child");
}

static void check_stream(const struct voxel_grid *grid, const char *message)
{
    char bytes[sizeof *grid + 2 * sizeof(uint32_t) + 2 * 512 * sizeof(float)];
    uint64_t places = voxel_grid_place_count(grid);
    size_t size = sizeof *grid;
    struct voxel_grid got;
    struct error err = {""};

    memcpy(bytes, grid, sizeof *grid);
    memcpy(bytes + size, grid->index, places * sizeof *grid->index);
    size += places * sizeof *grid->index;
    memcpy(bytes + size, grid->majorants, places * sizeof *grid->majorants);
    size += places * sizeof *grid->majorants;
    memcpy(bytes + size, grid->values, 512 * sizeof *grid->values);
    size += 512 * sizeof *grid->values;
    assert_int_equal(vdb_stream_read(&got, bytes, size, &err),
                     message[0] == '\0');
    assert_string_equal(err.text, message);
    voxel_grid_free(&got);
    assert_false(vdb_stream_read(&got, bytes, size - 1, &err));
    voxel_grid_free(&got);
}

static void wrong_numbers_are_refused(void **state)
{
    uint32_t index[1] = {0};
    float majorants[1] = {0}, values[512] = {0};
    struct voxel_grid grid;

    (void)state;
    memset(&grid, 0, sizeof grid);
    grid.sides[0] = grid.sides[1] = grid.sides[2] = grid.brick_count = 1;
    grid.index = index;
    grid.majorants = majorants;
    grid.values = values;
    check_stream(&grid, "");
    index[0] = 1;
    check_stream(&grid, "found a place without its brick in what its reader "
                        "sent");
    index[0] = 0;
    values[511] = NAN;
    check_stream(&grid, "found voxels without numbers in what its reader sent");
    values[511] = 0;
    majorants[0] = INFINITY;
    check_stream(&grid, "found voxels without numbers in what its reader sent");
    majorants[0] = 0;
    grid.to_world.m[2][3] = -INFINITY;
    check_stream(&grid,
                 "found a transform without numbers in what its reader sent");
}

static void wrong_sizes_are_refused(void **state)
{
    struct voxel_grid grid, got;
    struct error err;

    (void)state;
    for (int a = 0; a < 3; a++) {
        memset(&grid, 0, sizeof grid);
        grid.sides[0] = grid.sides[1] = grid.sides[2] = UINT32_MAX;
        grid.sides[a] = 0;
        grid.brick_count = UINT32_MAX;
        assert_false(
            vdb_stream_read(&got, (const char *)&grid, sizeof grid, &err));
        check_has(err.text, "found another end");
        voxel_grid_free(&got);
    }
}

int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(copies_send_what_they_read),
        cmocka_unit_test(failures_are_one_line),
        cmocka_unit_test(wrong_numbers_are_refused),
        cmocka_unit_test(wrong_sizes_are_refused),
    };
    const struct library_limits limits = {20, (uint64_t)1 << 40};

    if (count == 5 && strcmp(arguments[1], "--voxels") == 0)
        _Exit(vdb_child(arguments[4], limits, stdout) ? 0 : 1);
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
