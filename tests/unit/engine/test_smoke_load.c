// SPDX-License-Identifier: MIT
/*
 * test_smoke_load.c - the grids that a view names, files that fail, and models
 * of files. This test is the program that reads OpenVDB files: see main().
 */
#include "engine/smoke_load.h"

#include <math.h>

#include "read/child/vdb_read.h"
#include "read/child/voxel_file.h"
#include "tests/unit/files.h"
#include "tests/unit/smoke_world.h"
#include "tests/unit/vdb_file.h"

static float voxel(const void *unused, const int32_t v[3], bool *active)
{
    (void)unused;
    *active = true;
    return (float)(1 + (v[0] + v[1] + v[2]) % 4);
}

/* Writes an OpenVDB file with the grids "density" and "heat", and a NumPy file,
 * one of whose numbers is none. */
static void put_files(void)
{
    const float numbers[4] = {1, NAN, 3, 4};
    struct vdb_file f;
    struct vdb_grid g = {.name = "density", .voxel = voxel, .last = {9, 9, 9}};
    size_t size;
    char *bytes;

    vdb_file_begin(&f, 224, 2);
    vdb_file_add(&f, &g);
    g.name = "heat";
    vdb_file_add(&f, &g);
    bytes = vdb_file_end(&f, &size);
    put_bytes("a.vdb", bytes, size);
    free(bytes);
    bytes = npy_file_of((const uint32_t[3]){4, 1, 1}, numbers, &size);
    put_bytes("a.npy", bytes, size);
    put_bytes("short.npy", bytes, size - 1);
    free(bytes);
    put("text", "no grid");
}

struct loaded {
    struct smoke_world w;
    struct view view;
    struct warnings report;
};

/* Loads a view of smokes from a list of files, grids and temperatures. */
static bool load(struct loaded *l, const char *const names[][3],
                 struct error *err)
{
    static char program[] = "/proc/self/exe";

    *l = (struct loaded){.report = {0}};
    smoke_world_init(&l->w);
    l->w.scene.program = program;
    for (int i = 0; names[i][0] != NULL; i++) {
        char texts[3][32];
        struct smoke s = {.path = texts[0],
                          .grid = texts[1],
                          .temperature = texts[2],
                          .numbers = smoke_defaults};

        for (int k = 0; k < 3; k++)
            snprintf(texts[k], sizeof texts[k], "%s", names[i][k]);
        set3(s.numbers.absorb, 1, 1, 1);
        s.numbers.kelvin = 500;
        assert_true(smokes_add(&l->view.smokes, &s));
    }
    return smoke_load(&l->w.host, &l->w.scene, &l->view, &l->report, err);
}

static void unload(struct loaded *l)
{
    warnings_free(&l->report);
    smokes_free(&l->view.smokes);
    smoke_world_free(&l->w);
}

static void grids_are_read_once(void **state)
{
    static const char *const names[][3] = {{"a.vdb", "", "heat"},
                                           {"a.npy", "", ""},
                                           {"a.vdb", "heat", "heat"},
                                           {"a.npy", "", ""},
                                           {NULL, NULL, NULL}};
    struct error err = {""};
    struct loaded l;
    uint64_t generation;

    (void)state;
    check_or_say(load(&l, names, &err), err.text);
    assert_int_equal(l.w.host.grid_count, 3);
    assert_int_equal(l.w.host.smoke_count, 4);
    assert_int_equal(l.w.host.glow_count, 2 * GLOW_ENTRIES);
    assert_int_equal(l.report.entry_count, 1);
    check_has(l.report.entries[0].text,
              "a.npy: found 1 voxels that are no numbers: took 0 for them");
    generation = l.w.host.generation;
    check_or_say(smoke_load(&l.w.host, &l.w.scene, &l.view, &l.report, &err),
                 err.text);
    assert_int_equal(l.w.host.grid_count, 3);
    assert_true(l.w.host.generation == generation);
    unload(&l);
}

static void failures_are_one_line(void **state)
{
    static const struct {
        const char *names[2][3], *parts[2];
    } cases[] = {
        {{{"none.vdb", "", ""}}, {"none.vdb: ", "no such file or folder"}},
        {{{"none.npy", "", ""}}, {"none.npy: ", "no such file or folder"}},
        {{{"a.npy", "density", ""}},
         {"a.npy: found no grid 'density'", "without a name"}},
        {{{"a.npy", "", "heat"}}, {"a.npy: found no grid 'heat'", ""}},
        {{{"a.vdb", "Density", ""}}, {"a.vdb: ", "'Density'"}},
        {{{"a.vdb", "", "cold"}}, {"a.vdb: ", "'cold'"}},
        {{{"short.npy", "", ""}},
         {"short.npy: found 15 bytes of numbers, expected 16", ""}},
        {{{"text", "", ""}}, {"text: ", ""}},
        {{{".", "", ""}}, {".: ", ""}},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct error err = {""};
        struct loaded l;

        assert_false(load(&l, cases[i].names, &err));
        check_has(err.text, cases[i].parts[0]);
        check_has(err.text, cases[i].parts[1]);
        assert_null(strchr(err.text, '\n'));
        assert_int_equal(l.w.host.smoke_count, 0);
        unload(&l);
    }
}

/* ---- models ---- */

/* All voxels have one value. */
static float even_voxel(const void *value, const int32_t v[3], bool *active)
{
    (void)v;
    *active = true;
    return *(const float *)value;
}

struct grid_of_file {
    const char *name;
    float value;
    bool is_empty;
};

/* Opens a file of grids of 8^3 voxels as a scene. */
static void open_model(struct scene *scene, const struct grid_of_file *grids,
                       uint32_t count)
{
    static char program[] = "/proc/self/exe";
    struct warnings report = {.entry_count = 0};
    struct vdb_file f;
    struct error err;
    size_t size;
    char *bytes;

    vdb_file_begin(&f, 224, count);
    for (uint32_t i = 0; i < count; i++) {
        const struct vdb_grid g = {.name = grids[i].name,
                                   .voxel = even_voxel,
                                   .context = &grids[i].value,
                                   .is_of_blender = true,
                                   .first[0] = grids[i].is_empty};

        vdb_file_add(&f, &g);
    }
    bytes = vdb_file_end(&f, &size);
    put_bytes("model.vdb", bytes, size);
    *scene = (struct scene){.program = program};
    check_or_say(voxel_scene_parse(scene, bytes, size, "model.vdb", &report,
                                   &err),
                 err.text);
    warnings_free(&report);
    free(bytes);
    assert_true(scene->up_is_z);
}

static void check_smoke(const struct smoke *s, const char *grid, double scatter,
                        double absorb)
{
    assert_string_equal(s->path, "model.vdb");
    assert_string_equal(s->grid, grid);
    check_close(s->numbers.scatter[1], scatter, 1e-12);
    check_close(s->numbers.absorb[1], absorb, 1e-12);
}

static void check_heat(const struct smoke *s, const char *grid, double kelvin)
{
    assert_string_equal(s->temperature, grid);
    check_close(s->numbers.kelvin, kelvin, 0);
}

/* The flame is 3 deep across 8 voxels, and 3000 kelvins hot. Smoke beside it is
 * as dense as its values say, up to 24. */
static void flames_glow(void **state)
{
    static const struct {
        struct grid_of_file heat;
        double kelvin;
        const char *name; /* of the grid that gives the temperature */
    } cases[] = {
        {{"temperature", 3, false}, 1000, "temperature"},
        {{"heat", 1, false}, 3000, "heat"},
        {{"temperature", 1800, false}, 1, "temperature"},
        {{"temperature", 0, false}, 6000, "flame"},
        {{"shadow", 7, false}, 6000, "flame"},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct grid_of_file grids[] = {cases[i].heat,
                                             {"flame", .5f, false},
                                             {"density", .25f, false}};
        struct scene scene;

        open_model(&scene, grids, 3);
        assert_int_equal(scene.smokes.count, 2);
        check_smoke(&scene.smokes.items[0], "", 3, .06);
        check_heat(&scene.smokes.items[0], "", 1);
        check_smoke(&scene.smokes.items[1], "flame", 0, .75);
        check_heat(&scene.smokes.items[1], cases[i].name, cases[i].kelvin);
        check_close(scene.smokes.items[1].numbers.glow, 8, 0);
        scene_free(&scene);
    }
}

static void flames_need_no_smoke(void **state)
{
    static const struct grid_of_file grids[] = {{"flames", .5f, false},
                                                {"heat", 1, false},
                                                {"density", 1, true}};
    struct scene scene;

    (void)state;
    for (uint32_t count = 2; count <= 3; count++) {
        open_model(&scene, grids, count);
        assert_int_equal(scene.smokes.count, 1);
        check_smoke(&scene.smokes.items[0], "flames", 0, .75);
        check_heat(&scene.smokes.items[0], "heat", 3000);
        scene_free(&scene);
    }
}

/* Smoke without a flame is white, unless it has kelvins. */
static void smoke_glows_at_kelvins(void **state)
{
    static const float temperatures[] = {0, 1, 499, 500, 2000};

    (void)state;
    for (int i = 0; i < 5; i++) {
        const struct grid_of_file grids[] = {{"flame", 0, false},
                                             {"density", .25f, false},
                                             {"temperature", temperatures[i],
                                              false}};
        bool has_glow = temperatures[i] >= 500;
        struct scene scene;

        open_model(&scene, grids, 3);
        assert_int_equal(scene.smokes.count, 1);
        check_smoke(&scene.smokes.items[0], "", 12, .24);
        check_heat(&scene.smokes.items[0], has_glow ? "temperature" : "", 1);
        check_close(scene.smokes.items[0].numbers.glow, has_glow ? 8 : 1, 0);
        scene_free(&scene);
    }
}

static int open_files(void **state)
{
    if (enter_folder(state) != 0)
        return -1;
    put_files();
    return 0;
}

int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(grids_are_read_once),
        cmocka_unit_test(failures_are_one_line),
        cmocka_unit_test(flames_glow),
        cmocka_unit_test(flames_need_no_smoke),
        cmocka_unit_test(smoke_glows_at_kelvins),
    };
    const struct library_limits limits = {20, (uint64_t)1 << 40};

    if (count == 5 && strcmp(arguments[1], "--voxels") == 0)
        _Exit(vdb_child(arguments[4], limits, stdout) ? 0 : 1);
    return cmocka_run_group_tests(tests, open_files, remove_folder);
}
