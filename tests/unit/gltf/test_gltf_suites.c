// SPDX-License-Identifier: MIT
/*
 * test_gltf_suites.c - glTF files of other programs, and broken ones
 *
 * The files and what independent readers see in them are in ../shared/suites or
 * $GLIM_SHARED/suites: gltf/expected.json has an object for each file.
 */
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "engine/scene_load.h"
#include "read/child/draco_child.h"
#include "read/gltf/gltf_draco.h"
#include "terminal/xmalloc.h"
#include "tests/unit/shared.h"

/* Extensions that a file may be refused for, by name. */
static const char *const optional_extensions[] = {
    "KHR_texture_basisu",
    "EXT_texture_webp",
};

static bool is_refused_by_name(const struct error *err)
{
    for (size_t i = 0;
         i < sizeof optional_extensions / sizeof optional_extensions[0]; i++)
        if (strstr(err->text, optional_extensions[i]) != NULL)
            return true;
    return gltf_draco_missing() != NULL &&
           strstr(err->text, GLTF_DRACO) != NULL;
}

static void check_box(const struct scene *s, const json_t *file)
{
    const char *keys[] = {"lo", "hi"};

    for (int i = 0; i < 2; i++) {
        const json_t *box = json_object_get(file, keys[i]);
        const double *bounds = i == 0 ? s->bounds_lo : s->bounds_hi;

        for (size_t k = 0; k < json_array_size(box); k++) {
            double want = json_number_value(json_array_get(box, k));
            double reach = fmax(fabs(s->bounds_lo[k]), fabs(s->bounds_hi[k]));

            /* quantised positions differ by one step among the readers */
            check_close(bounds[k], want, 1e-5 + 4e-5 * reach);
        }
    }
}

static void read_vector(const json_t *of, const char *key, double to[3])
{
    for (size_t k = 0; k < 3; k++)
        to[k] = json_number_value(json_array_get(json_object_get(of, key), k));
}

static bool is_near(const double a[3], const double b[3], double tolerance)
{
    return fabs(a[0] - b[0]) < tolerance && fabs(a[1] - b[1]) < tolerance &&
           fabs(a[2] - b[2]) < tolerance;
}

static bool has_camera(const struct scene *s, const json_t *camera)
{
    const json_t *yfov = json_object_get(camera, "yfov");
    double eye[3], dir[3];

    read_vector(camera, "eye", eye);
    read_vector(camera, "dir", dir);
    for (uint32_t i = 0; i < s->camera_count; i++) {
        const struct pose *pose = &s->cameras[i].pose;
        struct axes axes;

        pose_axes(pose, &axes);
        if (is_near(pose->eye, eye, 1e-4) && is_near(axes.forward, dir, 2e-5) &&
            (yfov == NULL || fabs(pose->fovy_deg * M_PI / 180 -
                                  json_number_value(yfov)) < 1e-5))
            return true;
    }
    return false;
}

static bool has_light(const struct scene *s, const json_t *light)
{
    const char *type = json_string_value(json_object_get(light, "type"));
    double intensity = json_number_value(json_object_get(light, "intensity"));
    double position[3], dir[3], color[3];

    read_vector(light, "position", position);
    read_vector(light, "dir", dir);
    read_vector(light, "color", color);
    for (int k = 0; k < 3; k++)
        color[k] *= intensity;
    for (uint32_t i = 0; i < s->lamps.count; i++) {
        const struct lamp *l = &s->lamps.items[i];
        double to[3];

        if (!is_near(l->rgb, color, 1e-6 + 1e-6 * intensity))
            continue;
        if (strcmp(type, "directional") == 0 && l->kind == LAMP_DIRECTIONAL) {
            lamp_direction(l, to);
            for (int k = 0; k < 3; k++)
                to[k] = -to[k];
            if (is_near(to, dir, 2e-5))
                return true;
        }
        for (int k = 0; k < 3; k++)
            to[k] = l->at[k] - l->position[k];
        if (l->kind != LAMP_DIRECTIONAL &&
            is_near(l->position, position, 1e-4) &&
            (strcmp(type, "point") == 0 ? l->kind == LAMP_POINT
                                        : is_near(to, dir, 2e-5)))
            return true;
    }
    return false;
}

/* Cameras and lights are those that a reader by the letter of the specification
 * sees. */
static void check_view(const struct scene *s, const json_t *file)
{
    const json_t *spec =
        json_object_get(json_object_get(file, "readers"), "spec");
    const json_t *cameras = json_object_get(spec, "cameras");
    const json_t *lights = json_object_get(spec, "lights");

    assert_int_equal(s->camera_count, json_array_size(cameras));
    assert_int_equal(s->lamps.count, json_array_size(lights));
    for (size_t i = 0; i < json_array_size(cameras); i++)
        assert_true(has_camera(s, json_array_get(cameras, i)));
    for (size_t i = 0; i < json_array_size(lights); i++)
        assert_true(has_light(s, json_array_get(lights, i)));
}

static void check_scene(const struct scene *s, const json_t *file)
{
    const json_t *count = json_object_get(file, "triangles");

    /* triangles without area are dropped, and counted by the readers */
    assert_non_null(count);
    assert_int_equal(scene_tri_total(s) + s->dropped_count,
                     json_integer_value(count));
    check_box(s, file);
    check_view(s, file);
}

/* JSON must not begin with a byte order mark, but readers may ignore it
 * (RFC 8259, 8.1), and editors on Windows write it. */
static bool must_be_refused(const char *path, const char *kind)
{
    return strcmp(kind, "refuse") == 0 && strstr(path, "/bom.gltf") == NULL;
}

/* Loads a file. What it is read as comes in `file`. */
static void check_file(const char *path, const json_t *file)
{
    const char *kind = json_string_value(json_object_get(file, "expected"));
    struct scene scene = {.thread_count = 2, .program = "/proc/self/exe"};
    struct warnings report = {0};
    struct error err = {""};
    bool ok = scene_load(&scene, path, SCENE_UP_OF_FILE, &report, &err);

    if (!ok) {
        assert_true(strncmp(err.text, path, strlen(path)) == 0);
        assert_null(strchr(err.text, '\n'));
    }
    if (ok && must_be_refused(path, kind))
        print_error("%s: is not refused\n", path);
    assert_false(ok && must_be_refused(path, kind));
    if (strcmp(kind, "loads") == 0 && (ok || !is_refused_by_name(&err))) {
        check_or_say(ok, err.text);
        check_scene(&scene, file);
    }
    scene_free(&scene);
    warnings_free(&report);
}

/* Replaces a word that is no JSON by 0. */
static void blank(char *text, const char *word)
{
    for (char *p = text; (p = strstr(p, word)) != NULL;) {
        memset(p, ' ', strlen(word));
        *p = '0';
    }
}

/* Reads the expectations; those of numbers that are not finite are not used. */
static json_t *read_expected(void)
{
    char *path = shared_path("suites/gltf/expected.json"), *text;
    struct error err;
    size_t size_bytes;
    json_t *files;

    check_or_say(file_read(path, &text, &size_bytes, &err), err.text);
    blank(text, "NaN");
    blank(text, "Infinity");
    files = json_loads(text, 0, NULL);
    assert_non_null(files);
    free(text);
    free(path);
    return files;
}

static void files_are_as_others_see_them(void **state)
{
    json_t *files = read_expected(), *file;
    const char *name;
    int count = 0;

    (void)state;
    json_object_foreach (files, name, file) {
        char *path = xformat("%s/suites/%s", shared_folder(), name);

        if (access(path, R_OK) == 0) { /* one line is of no single file */
            check_file(path, file);
            count++;
        }
        free(path);
    }
    json_decref(files);
    assert_int_equal(count, 447);
}

int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_as_others_see_them),
    };

    const struct library_limits limits = {20, (uint64_t)1 << 30};

    /* this test is the program of the copies that unpack */
    if (count == 3 && strcmp(arguments[1], "--unpack") == 0)
        _Exit(draco_child(limits, stdout) ? 0 : 1);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
