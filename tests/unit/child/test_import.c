// SPDX-License-Identifier: MIT
/*
 * Files that libassimp reads, against closed forms, and children that fail in
 * every way. This test is the program of the children: see main().
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "read/child/import.h"
#include "read/child/import_child.h"
#include "tests/unit/check.h"
#include "tests/unit/child/shell_program.h"
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

/* The same triangle with a camera, a light of each kind and an ambient one, all
 * of which are moved by (1, 2, 3). %s is the program that wrote it. */
static const char lit[] =
    "<?xml version='1.0'?>\n"
    "<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
    "version='1.4.1'>\n"
    "<asset><contributor><authoring_tool>%s</authoring_tool></contributor>"
    "<up_axis>Y_UP</up_axis></asset>\n"
    "<library_cameras><camera id='c' "
    "name='c'><optics><technique_common><perspective>"
    "<xfov>60</xfov><aspect_ratio>2</aspect_ratio><znear>1</znear>"
    "<zfar>9</zfar></perspective></technique_common></optics></camera>"
    "</library_cameras>\n"
    "<library_lights><light id='p'><technique_common><point>"
    "<color>1 2 4</color><constant_attenuation>0</constant_attenuation>"
    "<quadratic_attenuation>2</quadratic_attenuation></point>"
    "</technique_common></light><light id='s'><technique_common><spot>"
    "<color>3 3 3</color><falloff_angle>60</falloff_angle></spot>"
    "</technique_common></light><light id='d'><technique_common><directional>"
    "<color>5 5 5</color></directional></technique_common></light>"
    "<light id='a'><technique_common><ambient><color>1 1 1</color></ambient>"
    "</technique_common></light></library_lights>\n"
    "<library_geometries><geometry id='g'><mesh><source id='q'>"
    "<float_array id='qa' count='9'>0 0 0 2 0 0 0 1 0</float_array>"
    "<technique_common><accessor source='#qa' count='3' stride='3'>"
    "<param name='X' type='float'/><param name='Y' type='float'/>"
    "<param name='Z' type='float'/></accessor></technique_common></source>"
    "<vertices id='v'><input semantic='POSITION' source='#q'/></vertices>"
    "<triangles count='1'><input semantic='VERTEX' source='#v' "
    "offset='0'/><p>0 1 2</p></triangles></mesh></geometry>"
    "</library_geometries>\n"
    "<library_visual_scenes><visual_scene id='vs'><node id='flag'>"
    "<instance_geometry url='#g'/></node><node id='moved'>"
    "<translate>1 2 3</translate><node id='nc' name='nc'>"
    "<instance_camera url='#c'/></node><node id='np' name='np'>"
    "<instance_light url='#p'/></node><node id='ns' name='ns'>"
    "<instance_light url='#s'/></node><node id='nd' name='nd'>"
    "<instance_light url='#d'/></node><node id='na' name='na'>"
    "<instance_light url='#a'/></node></node></visual_scene>"
    "</library_visual_scenes>\n"
    "<scene><instance_visual_scene url='#vs'/></scene></COLLADA>\n";

/* A triangle of glTF, which libassimp reads as well, with an image of one pixel
 * inside. */
static const char with_image[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
    "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":"
    "{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":0}]}],"
    "\"materials\":[{\"name\":\"picture\",\"pbrMetallicRoughness\":"
    "{\"baseColorTexture\":{\"index\":0}}}],"
    "\"textures\":[{\"source\":0}],\"images\":[{\"mimeType\":\"image/png\","
    "\"uri\":\"data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mNwaDgAAAKEAY"
    "EYanSHAAAAAElFTkSuQmCC"
    "\"}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
    "\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[2,1,0]},{\"bufferView\":1,"
    "\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,"
    "\"byteOffset\":36,\"byteLength\":24}],\"buffers\":[{\"byteLength\":60,"
    "\"uri\":\"data:application/octet-stream;base64,"
    "AAAAAAAAAAAAAAAAAAAAQAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAA"
    "AAAAAAAIA/"
    "\"}]}";

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

/* Reads the scene of `lit` as this program wrote it. */
static void read_lit(struct scene *scene, const char *generator)
{
    char text[2 * sizeof lit];
    struct error err;

    snprintf(text, sizeof text, lit, generator);
    check_or_say(read_text(scene, "l.dae", text, "/proc/self/exe", &err),
                 err.text);
    assert_int_equal(scene->camera_count, 1);
    assert_int_equal(scene->lamps.count, 3);
}

static void cameras_and_lights_are_those_of_their_nodes(void **state)
{
    static const double place[3] = {1, 2, 3};
    const struct pose *pose;
    struct scene scene;

    (void)state;
    if (import_missing() != NULL)
        skip();
    read_lit(&scene, "a program");
    pose = &scene.cameras[0].pose;
    assert_string_equal(scene.cameras[0].name, "nc");
    for (int k = 0; k < 3; k++) {
        assert_float_equal(pose->eye[k], place[k], 1e-6);
        assert_float_equal(pose->at[k], place[k] - (k == 2), 1e-6);
        assert_float_equal(pose->up[k], k == 1, 1e-6);
        assert_float_equal(scene.lamps.items[0].position[k], place[k], 1e-6);
    }
    /* half of the width is at tan 30 degrees, half of the height at half */
    assert_float_equal(tan(pose->fovy_deg / 360 * M_PI), tan(M_PI / 6) / 2,
                       1e-6);
    const struct lamp *spot = &scene.lamps.items[1];
    assert_int_equal(spot->kind, LAMP_SPOT);
    assert_float_equal(spot->outer_deg, 30, 1e-4);
    assert_float_equal(spot->inner_deg, 30 * 0.85, 1e-4);
    const struct lamp *sun = &scene.lamps.items[2];
    double to[3];
    lamp_direction(sun, to);
    assert_int_equal(sun->kind, LAMP_DIRECTIONAL);
    assert_float_equal(to[2], 1, 1e-6);
    scene_free(&scene);
}

/* A white surface that faces a light of colour c has radiance c; of one that
 * fades as 2 d^2 it has c / (2 d^2). A light of Blender has c watts. */
static void intensities_are_those_of_the_program(void **state)
{
    /* from (1, 2, 3) to the middle of the triangle, (1, 0.5, 0) */
    const double square = 1.5 * 1.5 + 3 * 3;
    struct scene scene;

    (void)state;
    if (import_missing() != NULL)
        skip();
    read_lit(&scene, "a program");
    assert_float_equal(scene.lamps.items[0].rgb[1] / square,
                       M_PI * 2 / (2 * square), 1e-6);
    assert_float_equal(scene.lamps.items[1].rgb[0] / square, M_PI * 3, 1e-5);
    assert_float_equal(scene.lamps.items[2].rgb[0], M_PI * 5, 1e-5);
    scene_free(&scene);
    read_lit(&scene, "Blender 3.4.1");
    assert_float_equal(scene.lamps.items[0].rgb[2], 4 / (4 * M_PI), 1e-6);
    assert_float_equal(scene.lamps.items[1].rgb[0], 3 / (4 * M_PI), 1e-6);
    assert_float_equal(scene.lamps.items[2].rgb[0], 5, 1e-6);
    scene_free(&scene);
}

static void images_in_the_file_are_textures(void **state)
{
    struct scene scene;
    struct error err;
    uint32_t texture;

    (void)state;
    if (import_missing() != NULL)
        skip();
    check_or_say(read_text(&scene, "i.gltf", with_image, "/proc/self/exe",
                           &err),
                 err.text);
    assert_int_equal(scene.image_count, 1);
    assert_string_equal(scene.images[0].name, "i.gltf#image0");
    assert_memory_equal((const char *)scene.images[0].bytes + 1, "PNG", 3);
    texture = scene.materials[scene.tris[0].material].color_texture;
    assert_true(texture < scene.texture_count);
    assert_string_equal(scene.texture_paths[texture], "i.gltf#image0");
    scene_free(&scene);
}

/* 1 - sqrt(N) / 10, as libassimp computes it of 3ds Max's exponents: -2.2 is
 * N = 1024, whose highlight is as wide as the facets of alpha^2 = 2 / (N + 2).
 */
static void exponents_are_no_mirrors(void **state)
{
    static const char factor[] = "\"pbrMetallicRoughness\":"
                                 "{\"roughnessFactor\":-2.2,";
    const char *at = strstr(with_image, "\"pbrMetallicRoughness\":{");
    size_t length = strlen("\"pbrMetallicRoughness\":{");
    struct warnings report = {0};
    struct scene scene = {.program = "/proc/self/exe"};
    char text[2048];
    struct error err;
    int size;

    (void)state;
    if (import_missing() != NULL)
        skip();
    size = snprintf(text, sizeof text, "%.*s%s%s", (int)(at - with_image),
                    with_image, factor, at + length);
    put("r.gltf", text);
    check_or_say(import_parse(&scene, text, (size_t)size, "r.gltf", &report,
                              &err),
                 err.text);
    check_close((double)scene.materials[scene.tris[0].material].alpha,
                sqrt(2 / 1026.), 1e-5);
    assert_string_equal(report.entries[0].text,
                        "r.gltf: found 1 material whose roughness libassimp "
                        "computes, expected 0 to 1: as wide as its highlight");
    assert_int_equal(report.entry_count, 1);
    warnings_free(&report);
    scene_free(&scene);
    unlink("r.gltf");
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
        cmocka_unit_test(cameras_and_lights_are_those_of_their_nodes),
        cmocka_unit_test(intensities_are_those_of_the_program),
        cmocka_unit_test(images_in_the_file_are_textures),
        cmocka_unit_test(exponents_are_no_mirrors),
        cmocka_unit_test(failures_are_one_line),
        cmocka_unit_test(other_bytes_are_refused),
    };
    const struct library_limits limits = {20, (uint64_t)1 << 40};

    if (count == 5 && strcmp(arguments[1], "--import") == 0)
        _Exit(import_child(arguments[4], limits, stdout) ? 0 : 1);
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
