// SPDX-License-Identifier: MIT
/*
 * test_suites.c - OBJ and MTL files of other programs, and broken ones
 *
 * Files of the shared folder are looked for in ../shared or $GLIM_SHARED.
 */
#include <glob.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "engine/scene_load.h"
#include "read/mtl.h"
#include "read/obj.h"
#include "scene/pose_fit.h"
#include "terminal/xmalloc.h"
#include "tests/unit/shared.h"
#include "world/world.h"

struct loaded {
    struct scene scene;
    struct host_world world;
    struct warnings report;
    struct error err;
    bool ok;
};

static struct loaded load(const char *path)
{
    struct loaded l = {.ok = false};

    l.ok = scene_load(&l.scene, path, SCENE_UP_OF_FILE, &l.report, &l.err) &&
           world_init(&l.world, &l.scene, 1, &l.report, &l.err);
    return l;
}

static void unload(struct loaded *l)
{
    world_free(&l->world);
    scene_free(&l->scene);
    warnings_free(&l->report);
}

static char *read_text(const char *path)
{
    char *text = NULL;
    size_t size_bytes;
    struct error err;

    if (!file_read(path, &text, &size_bytes, &err)) {
        print_error("%s\n", err.text);
        _fail(__FILE__, __LINE__);
    }
    return text;
}

static uint64_t warned(const struct warnings *r, const char *kind)
{
    for (int i = 0; i < r->entry_count; i++) {
        if (strcmp(r->entries[i].kind, kind) == 0)
            return r->entries[i].count;
    }
    return 0;
}

static void check_finite(struct vec3 v)
{
    assert_true(isfinite(v.x) && isfinite(v.y) && isfinite(v.z));
}

static void check_indices(const uint32_t i[3], uint32_t count, bool may_lack)
{
    bool lacks = may_lack && i[0] == NO_INDEX;

    for (int k = 0; k < 3; k++)
        assert_true(lacks ? i[k] == NO_INDEX : i[k] < count);
}

/* Checks the invariants that a renderer relies on. */
static void check_scene(const struct scene *s)
{
    for (uint32_t t = 0; t < s->tri_count; t++) {
        check_indices(s->tris[t].v, s->position_count, false);
        check_indices(s->tris[t].vn, s->normal_count, true);
        check_indices(s->tris[t].vt, s->uv_count, true);
        assert_true(s->tris[t].material < s->material_count);
        assert_true(s->tri_objects[t] < s->object_count);
        assert_true(t == 0 || s->tri_faces[t] >= s->tri_faces[t - 1]);
        for (int k = 0; k < 3 && s->tris[t].vn[0] != NO_INDEX; k++) {
            struct vec3 n = s->normals[s->tris[t].vn[k]];

            check_close((double)(n.x * n.x + n.y * n.y + n.z * n.z), 1, 1e-5);
        }
    }
    for (uint32_t i = 0; i < s->position_count; i++)
        check_finite(s->positions[i]);
    for (uint32_t i = 0; i < s->uv_count; i++)
        assert_true(isfinite(s->uvs[i].x) && isfinite(s->uvs[i].y));
    for (uint32_t i = 0; i < s->material_count; i++) {
        const struct material *m = &s->materials[i];

        check_finite(m->color);
        check_finite(m->emission);
        check_close((double)m->opacity, 0.5, 0.5);
        check_close((double)m->alpha, 0.5, 0.5);
        check_close((double)m->color.x, 0.5, 0.5);
        assert_true(m->ior > 0 && isfinite(m->ior));
        assert_true(m->kind <= MATERIAL_PRINCIPLED);
        assert_true(m->color_texture == NO_INDEX ||
                    m->color_texture < s->texture_count);
        assert_true(m->emission_texture == NO_INDEX ||
                    m->emission_texture < s->texture_count);
    }
}

/* Returns the text of a member of an object in expected.json, or NULL. */
static const char *member(const char *object, const char *key)
{
    char *quoted = xformat("\"%s\":", key);
    const char *end = strchr(object, '}');
    const char *found = strstr(object, quoted);
    size_t length = strlen(quoted);

    free(quoted);
    return found != NULL && found < end ? found + length : NULL;
}

/* Returns false if a bound is not a number. */
static bool read_bounds(const char *object, double bounds[6])
{
    const char *p = member(object, "bbox_of_faces");

    for (int i = 0; p != NULL && i < 6; i++) {
        char *end;

        p += strspn(p, " \n[],");
        bounds[i] = strtod(p, &end);
        if (end == p)
            return false;
        p = end;
    }
    return p != NULL;
}

/* The numbers in expected.json have five digits. */
static void check_bounds(const struct scene *s, const double bounds[6])
{
    for (int k = 0; k < 3; k++) {
        double bound = 1e-5 + 1e-6 * fabs(bounds[k]);

        check_close(s->bounds_lo[k], bounds[k], bound);
        check_close(s->bounds_hi[k], bounds[3 + k], bound);
    }
}

/* These files are known to differ from what Blender makes of them. */
static const struct {
    const char *name;
    const char *error; /* end of the message */
    int lost;          /* number of triangles */
} exceptions[] = {
    {"number_formats.obj", ":11: found '3.1+e2' after v, expected a number", 0},
    {"invalid-face-definition.obj", NULL, 0},
    {"test-nan.obj", NULL, 2}, /* the floor: its vertices are nan and inf */
};

static void check_suite_file(const char *path, const char *object)
{
    struct loaded l = load(path);
    const char *triangles = member(object, "triangles_if_fanned");
    double bounds[6];
    int lost = 0;

    for (size_t i = 0; i < sizeof exceptions / sizeof exceptions[0]; i++) {
        if (strcmp(strrchr(path, '/') + 1, exceptions[i].name) != 0)
            continue;
        lost = exceptions[i].lost;
        if (exceptions[i].error == NULL)
            continue;
        assert_false(l.ok);
        assert_non_null(strstr(l.err.text, exceptions[i].error));
        unload(&l);
        return;
    }
    if (!l.ok)
        print_error("%s\n", l.err.text);
    assert_true(l.ok);
    check_scene(&l.scene);
    if (triangles != NULL)
        check_close(l.scene.tri_count,
                    (double)strtol(triangles, NULL, 10) - lost, 0);
    if (read_bounds(object, bounds))
        check_bounds(&l.scene, bounds);
    unload(&l);
}

static void obj_suite_has_the_expected_scenes(void **state)
{
    char *folder = shared_path("suites/obj");
    char *expected_path = xformat("%s/expected.json", folder);
    char *pattern = xformat("%s/*/*.obj", folder);
    char *expected = read_text(expected_path);
    glob_t files;

    (void)state;
    assert_int_equal(glob(pattern, 0, NULL, &files), 0);
    assert_true(files.gl_pathc >= 30);
    for (size_t i = 0; i < files.gl_pathc; i++) {
        char *key = xformat("\"obj%s\":", files.gl_pathv[i] + strlen(folder));
        const char *object = strstr(expected, key);

        free(key);
        assert_non_null(object);
        check_suite_file(files.gl_pathv[i], object);
    }
    globfree(&files);
    free(expected);
    free(pattern);
    free(expected_path);
    free(folder);
}

static void mtl_suite_is_read(void **state)
{
    char *folder = shared_path("suites/obj");
    char *pattern = xformat("%s/*/*.mtl", folder);
    glob_t files;

    (void)state;
    assert_int_equal(glob(pattern, 0, NULL, &files), 0);
    assert_true(files.gl_pathc >= 10);
    for (size_t i = 0; i < files.gl_pathc; i++) {
        struct loaded l = {.ok = false};
        char *text = read_text(files.gl_pathv[i]);

        assert_true(mtl_parse(&l.scene, text, strlen(text), files.gl_pathv[i],
                              &l.report, &l.err));
        check_scene(&l.scene);
        free(text);
        unload(&l);
    }
    globfree(&files);
    free(pattern);
    free(folder);
}

/* Compares with the table of triangles in the README. */
static void real_scenes_have_the_expected_triangles(void **state)
{
    char *readme_path = shared_path("scenes-real/README.md");
    char *readme = read_text(readme_path);
    int count = 0;

    (void)state;
    for (char *line = readme; line != NULL; line = strchr(line, '\n')) {
        char name[64];
        unsigned triangles;
        char *path;
        struct loaded l;

        line += *line == '\n';
        if (sscanf(line, "| %63[A-Za-z_-] | %u |", name, &triangles) != 2 ||
            triangles == 0)
            continue;
        path = xformat("%.*s/%s/%s.obj",
                       (int)(strrchr(readme_path, '/') - readme_path),
                       readme_path, name, name);
        l = load(path);
        assert_true(l.ok);
        check_scene(&l.scene);
        check_close(l.scene.tri_count +
                        (double)warned(&l.report, "triangles without area"),
                    triangles, 0);
        count++;
        unload(&l);
        free(path);
    }
    assert_true(count >= 11);
    free(readme);
    free(readme_path);
}

/* Compares with the README and the SOURCE.txt files. */
static void real_materials_have_the_expected_values(void **state)
{
    static const struct {
        const char *scene, *material;
        uint32_t kind;
        double color, alpha, ior, emission; /* red channels */
    } cases[] = {
        {"CornellBox-Original", "light", MATERIAL_DIFFUSE, .78, 0, 1.5, 17},
        {"CornellBox-Original", "leftWall", MATERIAL_DIFFUSE, .63, 0, 1.5, 0},
        {"CornellBox-Mirror", "tallBox", MATERIAL_METAL, .95, 0, 1.5, 0},
        {"CornellBox-Sphere", "leftSphere", MATERIAL_METAL, .95, 0, 1.5, 0},
        {"CornellBox-Sphere", "rightSphere", MATERIAL_GLASS, .1,
         0.0995037190209989, 2.5, 0},
        {"CornellBox-Glossy", "light", MATERIAL_DIFFUSE, .78, 0, 1.5, 10},
        {"bunny", "light", MATERIAL_DIFFUSE, 0, 0, 1.5, 12},
        {"teapot", "model", MATERIAL_METAL, .95, .16, 1.5, 0},
        {"spot", "model", MATERIAL_DIFFUSE, 1, 0, 1.5, 0},
        {"veach_ajar", "Floor", MATERIAL_METAL, .464024, 0.1, 1.5, 0},
        {"veach_ajar", "Material", MATERIAL_GLASS, 1, 0, 1.5, 0},
        {"veach_ajar", "light0", MATERIAL_DIFFUSE, 0, 0, 1.5, 50},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char *name =
            xformat("scenes-real/%s/%s.mtl", cases[i].scene, cases[i].scene);
        char *path = shared_path(name);
        char *text = read_text(path);
        struct loaded l = {.ok = false};
        const struct material *m;

        assert_true(
            mtl_parse(&l.scene, text, strlen(text), path, &l.report, &l.err));
        assert_int_equal(l.report.entry_count, 0);
        m = &l.scene.materials[mtl_find(&l.scene, cases[i].material)];
        assert_int_equal(m->kind, cases[i].kind);
        check_close((double)m->alpha, cases[i].alpha, 1e-6);
        check_close((double)m->ior, cases[i].ior, 1e-6);
        check_close((double)m->emission.x, cases[i].emission, 1e-6);
        if (m->color_texture == NO_INDEX)
            check_close((double)m->color.x, cases[i].color, 1e-6);
        unload(&l);
        free(text);
        free(path);
        free(name);
    }
}

/* This text has a statement of each kind. */
static const char good_obj[] =
    "# a comment\nmtllib no.mtl other.mtl\no first\nv -0.5 -.5 0.5e0\n"
    "v 0.5 -0.5 0.5 1.0\nv 0.5 0.5 5e-1\nv -0.5 0.5 0.5\nv 0 0.25 0.5\n"
    "vt 0 0\nvt 1.0 0.0\nvt 1 1\nvt 0 1\nvn 0 0 1\nvn 0.6 0 0.8\n"
    "usemtl two words\nf 1/1/1 2/2/1 3/3/2\nf -3/-2/-1 -2/-1/-2 1/1/1\n"
    "s off\ng second third\nf 1 2 3 5 4\nf 1//1 2//1 \\\n 3//2\nl 1 2\np 1\n"
    "f 1/1 2/2 5/3 3/4\nvp 0.1\nusemtl b\nv 1e3 -2.5E+2 12345678901234567890\n"
    "f 6 1 2 3 4\n";

static const char good_mtl[] =
    "# a comment\nnewmtl two words\nKd 0.5 0.25 1\nKs 0.9 0.9 0.9\nNs 120.5\n"
    "Ni 1.5\nd 0.5\nTr .5\nTf 1 0.5 .25\nillum 7\nmap_Kd -s 2 2 2 no.png\n"
    "newmtl b\nKe 17 12 4\nPr 0.3\nPm 1.0\nmap_Ke no.png\nillum 2\nKa 1 1 1\n"
    "map_Bump -bm 0.5 n.png\nnewmtl b\nKd 1\nd -halo 1\n";

/* Loads text from memory of the exact size and builds its world. */
static void load_broken(const char *text, size_t size_bytes, bool is_mtl)
{
    struct loaded l = {.ok = false};
    char *copy = malloc(size_bytes == 0 ? 1 : size_bytes);
    struct view view;
    struct world world;

    assert_non_null(copy);
    memcpy(copy, text, size_bytes);
    l.scene.path = xstrdup("a");
    if (is_mtl)
        l.ok = mtl_parse(&l.scene, copy, size_bytes, "a", &l.report, &l.err);
    else
        l.ok = obj_parse(&l.scene, copy, size_bytes, "a", &l.report, &l.err);
    free(copy);
    if (!l.ok) {
        assert_in_range(strlen(l.err.text), 5, sizeof l.err.text - 1);
        assert_null(strchr(l.err.text, '\n'));
        unload(&l);
        return;
    }
    assert_true(scene_finish(&l.scene, &l.report, &l.err));
    assert_true(world_init(&l.world, &l.scene, 1, &l.report, &l.err));
    check_scene(&l.scene);
    view_init(&view);
    scene_frame(&l.scene, &view);
    world_lend(&l.world, &l.scene, &view, 0, &world, &l.err);
    view_free(&view);
    unload(&l);
}

static void break_in_many_ways(const char *good, size_t size_bytes, bool is_mtl)
{
    uint64_t random = 12345;
    char *text = malloc(size_bytes);

    assert_non_null(text);
    for (size_t i = 0; i < 500; i++)
        load_broken(good, i * size_bytes / 500, is_mtl);
    for (int i = 0; i < 2000; i++) {
        int flips = 1 + (int)(4 * check_random(&random));

        memcpy(text, good, size_bytes);
        for (int k = 0; k < flips; k++)
            text[(size_t)(check_random(&random) * (double)size_bytes)] =
                (char)(unsigned char)(256 * check_random(&random));
        load_broken(text, size_bytes, is_mtl);
    }
    /* Changes bytes to ones that have a meaning. */
    for (int i = 0; i < 2000; i++) {
        static const char some[] = "-/.e0919 \n\r\\#vfn\t";

        memcpy(text, good, size_bytes);
        for (int k = 0; k < 3; k++)
            text[(size_t)(check_random(&random) * (double)size_bytes)] =
                some[(size_t)(check_random(&random) * (sizeof some - 1))];
        load_broken(text, size_bytes, is_mtl);
    }
    free(text);
}

static void broken_obj_files_do_no_harm(void **state)
{
    (void)state;
    break_in_many_ways(good_obj, sizeof good_obj - 1, false);
}

static void broken_mtl_files_do_no_harm(void **state)
{
    (void)state;
    break_in_many_ways(good_mtl, sizeof good_mtl - 1, true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(obj_suite_has_the_expected_scenes),
        cmocka_unit_test(mtl_suite_is_read),
        cmocka_unit_test(real_scenes_have_the_expected_triangles),
        cmocka_unit_test(real_materials_have_the_expected_values),
        cmocka_unit_test(broken_obj_files_do_no_harm),
        cmocka_unit_test(broken_mtl_files_do_no_harm),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
