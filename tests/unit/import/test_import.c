// SPDX-License-Identifier: MIT
/*
 * Files that libassimp reads, against closed forms, and children that fail in
 * every way. This test is the program of the children: see main().
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "import/import.h"
#include "import/import_child.h"
#include "tests/unit/check.h"
#include "tests/unit/files.h"

/* A triangle of Collada, under a node that is moved by (10, 20, 30) and one
 * that is turned a quarter around z and mirrored in x. */
static const char collada[] =
    "<?xml version='1.0'?>\n"
    "<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
    "version='1.4.1'>\n"
    "<asset><up_axis>Y_UP</up_axis></asset>\n"
    "<library_effects><effect id='e'><profile_COMMON><technique sid='t'>"
    "<lambert><diffuse><color>0.2 0.4 0.6 1</color></diffuse></lambert>"
    "</technique></profile_COMMON></effect></library_effects>\n"
    "<library_materials><material id='m' name='blue'><instance_effect "
    "url='#e'/></material></library_materials>\n"
    "<library_geometries><geometry id='g'><mesh><source id='p'>"
    "<float_array id='pa' count='9'>0 0 0 2 0 0 0 1 0</float_array>"
    "<technique_common><accessor source='#pa' count='3' stride='3'>"
    "<param name='X' type='float'/><param name='Y' type='float'/>"
    "<param name='Z' type='float'/></accessor></technique_common></source>"
    "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices>"
    "<triangles count='1' material='s'><input semantic='VERTEX' source='#v' "
    "offset='0'/><p>0 1 2</p></triangles></mesh></geometry>"
    "</library_geometries>\n"
    "<library_visual_scenes><visual_scene id='vs'><node id='outer'>"
    "<translate>10 20 30</translate><node id='flag'>"
    "<rotate>0 0 1 90</rotate><scale>-1 1 1</scale>"
    "<instance_geometry url='#g'><bind_material><technique_common>"
    "<instance_material symbol='s' target='#m'/></technique_common>"
    "</bind_material></instance_geometry></node></node></visual_scene>"
    "</library_visual_scenes>\n"
    "<scene><instance_visual_scene url='#vs'/></scene></COLLADA>\n";

static const char tetrahedron[] =
    "OFF\n4 4 0\n0 0 0\n4 0 0\n0 3 0\n0 0 2\n3 0 2 1\n3 0 1 3\n3 0 3 2\n"
    "3 1 2 3\n";

/* Reads a file of this text. Returns false with the message, after which the
 * scene is freed. */
static bool read_text(struct scene *scene, const char *name, const char *text,
                      const char *program, struct error *err)
{
    struct warnings report = {0};
    bool ok;

    put(name, text);
    *scene = (struct scene){.program = program};
    ok = import_parse(scene, text, strlen(text), name, &report, err) &&
         scene_finish(scene, &report, err);
    warnings_free(&report);
    if (!ok)
        scene_free(scene);
    return ok;
}

static void nodes_place_their_meshes(void **state)
{
    /* (x, y) -> (-x, y) -> turned: (-y, -x) -> moved */
    static const double lo[3] = {9, 18, 30}, hi[3] = {10, 20, 30};
    struct scene scene;
    struct error err;

    (void)state;
    if (import_missing() != NULL)
        skip();
    check_or_say(read_text(&scene, "m.dae", collada, "/proc/self/exe", &err),
                 err.text);
    assert_int_equal(scene.tri_count, 1);
    for (int k = 0; k < 3; k++) {
        assert_float_equal(scene.bounds_lo[k], lo[k], 1e-5);
        assert_float_equal(scene.bounds_hi[k], hi[k], 1e-5);
    }
    /* the mirror keeps the side that the triangle faces: its normal (0, 0, 1)
     * is turned about z only, and so is the winding */
    assert_float_equal(scene.tris[0].ng.z, 1, 1e-6);
    assert_string_equal(scene.object_names[scene.tri_objects[0]], "flag");
    assert_string_equal(scene.material_names[scene.tris[0].material], "blue");
    assert_float_equal(scene.materials[scene.tris[0].material].color.y, 0.4,
                       1e-6);
    scene_free(&scene);
}

static void faces_without_normals_have_creases(void **state)
{
    struct scene scene;
    struct error err;

    (void)state;
    if (import_missing() != NULL)
        skip();
    check_or_say(read_text(&scene, "t.off", tetrahedron, "/proc/self/exe",
                           &err),
                 err.text);
    assert_int_equal(scene.tri_count, 4);
    /* all angles are above 40 degrees: the faces are flat */
    for (uint32_t i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++)
            assert_int_equal(scene.tris[i].vn[k], NO_INDEX);
    scene_free(&scene);
}

/* Writes a program of the shell and returns its path. */
static const char *shell_program(const char *script)
{
    char text[256];

    snprintf(text, sizeof text, "#!/bin/sh\n%s\n", script);
    put("child", text);
    chmod("child", 0700);
    return "./child";
}

static void failures_are_one_line(void **state)
{
    static const struct {
        const char *script, *message;
    } cases[] = {
        {"kill -SEGV $$", "x.fbx: libassimp crashed (Segmentation fault)"},
        {"kill -XCPU $$", "x.fbx: libassimp does not end"},
        {"echo 'libassimp: no scene'; exit 1", "x.fbx: libassimp: no scene"},
        {"exit 3", "x.fbx: libassimp ended with status 3"},
        {"echo something", "x.fbx: found no end in what libassimp read"},
        {"yes other | head -c 5000",
         "x.fbx: found another version in what libassimp read"},
    };
    struct scene scene;
    struct error err;

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_false(read_text(&scene, "x.fbx", "text",
                               shell_program(cases[i].script), &err));
        check_has(err.text, cases[i].message);
    }
    assert_false(read_text(&scene, "x.fbx", "text", "/nowhere/glim", &err));
    assert_non_null(strstr(err.text, "could not be run: No such file"));
    assert_false(read_text(&scene, "x.fbx", "text", NULL, &err));
    assert_non_null(strstr(err.text, "only the program glim reads"));
}

static void other_bytes_are_refused(void **state)
{
    static const char *const names[] = {"x.fbx", "x.dae", "x.3ds", "x.blend",
                                        "x.lwo"};
    struct scene scene;
    struct error err;

    (void)state;
    if (import_missing() != NULL)
        skip();
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        assert_false(read_text(&scene, names[i], "neither one nor the other",
                               "/proc/self/exe", &err));
        assert_non_null(strstr(err.text, names[i]));
        assert_null(strchr(err.text, '\n'));
    }
}

int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nodes_place_their_meshes),
        cmocka_unit_test(faces_without_normals_have_creases),
        cmocka_unit_test(failures_are_one_line),
        cmocka_unit_test(other_bytes_are_refused),
    };
    const struct import_limits limits = {20, (uint64_t)1 << 40};

    if (count == 5 && strcmp(arguments[1], "--import") == 0)
        _Exit(import_child(arguments[4], limits, stdout) ? 0 : 1);
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
