// SPDX-License-Identifier: MIT
/*
 * test_mesh_suites.c - PLY and STL files of other programs, and broken ones
 *
 * The files and what independent readers see in them are in ../shared/suites or
 * $GLIM_SHARED/suites. expected.json has a line for each file.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "engine/scene_load.h"
#include "terminal/xmalloc.h"
#include "tests/unit/shared.h"
#include "world/world.h"

/* Expectation of a file: one line of expected.json. */
struct expectation {
    char *path;
    const char *line;
    bool loads, is_refused;
};

/* Returns the text behind `key` in a line, at or after `from`. */
static const char *behind(const char *from, const char *key)
{
    const char *found = strstr(from, key);
    const char *end = strchr(from, '\n');

    return found != NULL && (end == NULL || found < end) ? found + strlen(key)
                                                         : NULL;
}

static void check_box(const struct scene *s, const struct expectation *e)
{
    const char *keys[] = {"\"lo\": [", "\"hi\": ["};

    for (int i = 0; i < 2; i++) {
        const char *p = behind(e->line, keys[i]);
        const double *bounds = i == 0 ? s->bounds_lo : s->bounds_hi;

        assert_non_null(p);
        for (int k = 0; k < 3; k++) {
            char *end;
            double want = strtod(p, &end);

            assert_true(end > p);
            p = end + (k < 2);
            /* the numbers have six digits */
            check_close(bounds[k], want, 1e-6 + 6e-6 * fabs(want));
        }
    }
}

/* Triangles without area are dropped, and counted by the readers. */
static void check_count(const struct scene *s, const struct expectation *e)
{
    const char *p = behind(e->line, "\"source\": ");

    p = p != NULL ? behind(p, "\"triangles\": ") : NULL;
    assert_non_null(p);
    assert_int_equal(s->tri_count + s->dropped_count, strtol(p, NULL, 10));
}

static void check_indices(const struct scene *s)
{
    for (uint32_t i = 0; i < s->tri_count; i++) {
        const struct tri *t = &s->tris[i];

        assert_true(t->material < s->material_count);
        assert_true(s->tri_objects[i] < s->object_count);
        for (int k = 0; k < 3; k++) {
            assert_true(t->v[k] < s->position_count);
            assert_true(t->vn[k] == NO_INDEX || t->vn[k] < s->normal_count);
            assert_true(t->vt[k] == NO_INDEX || t->vt[k] < s->uv_count);
        }
    }
}

static void check_file(const struct expectation *e)
{
    struct scene scene = {.path = NULL};
    struct host_world world = {.tris = NULL};
    struct warnings report = {0};
    /* boxes are in the file's own axes */
    const struct scene_options how = {.path = e->path,
                                      .up = SCENE_UP_Y,
                                      .thread_count = 1};
    struct view view;
    struct error err = {""};
    bool ok;

    view_init(&view);
    ok = scene_open(&scene, &world, &view, &how, &report, &err);
    if (e->loads && !ok)
        print_error("%s\n", err.text);
    if (e->is_refused && ok)
        print_error("%s: is not refused\n", e->path);
    assert_true(ok || !e->loads);
    assert_false(ok && e->is_refused);
    if (ok)
        check_indices(&scene);
    else
        assert_true(strncmp(err.text, e->path, strlen(e->path)) == 0 &&
                    strchr(err.text, '\n') == NULL);
    if (e->loads) {
        check_count(&scene, e);
        check_box(&scene, e);
    }
    view_free(&view);
    world_free(&world);
    scene_free(&scene);
    warnings_free(&report);
}

/* Checks all files of a suite. Returns their number. */
static int check_suite(const char *suite, const char *expected)
{
    char *path = shared_path(expected);
    char *start = xformat("\"%s/", suite);
    char *text;
    size_t size_bytes;
    struct error err;
    int count = 0;

    check_or_say(file_read(path, &text, &size_bytes, &err), err.text);
    for (const char *line = text; line != NULL; line = strchr(line, '\n')) {
        struct expectation e = {.line = line += *line == '\n'};
        const char *name = line + 1;
        const char *kind;

        if (strncmp(line, start, strlen(start)) != 0)
            continue;
        kind = behind(line, "\"expected\": ");
        assert_non_null(kind);
        e.loads = strncmp(kind, "\"loads\"", 7) == 0;
        e.is_refused = strncmp(kind, "\"refuse\"", 8) == 0;
        e.path = xformat("%s/suites/%.*s", shared_folder(),
                         (int)strcspn(name, "\""), name);
        check_file(&e);
        free(e.path);
        count++;
    }
    free(text);
    free(start);
    free(path);
    return count;
}

static void ply_files_are_as_others_see_them(void **state)
{
    (void)state;
    assert_int_equal(check_suite("ply", "suites/ply/expected.json"), 73);
}

static void stl_files_are_as_others_see_them(void **state)
{
    (void)state;
    assert_int_equal(check_suite("stl", "suites/stl/expected.json"), 55);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ply_files_are_as_others_see_them),
        cmocka_unit_test(stl_files_are_as_others_see_them),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
