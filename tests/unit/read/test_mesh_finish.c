// SPDX-License-Identifier: MIT
/* Material, light and camera of models, and the MTL file that edits go to. */
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/file.h"
#include "base/geometry.h"
#include "engine/scene_load.h"
#include "read/mesh_finish.h"
#include "read/mtl.h"
#include "read/mtl_save.h"
#include "tests/unit/check.h"
#include "tests/unit/files.h"

static const char model[] =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
    "property float y\nproperty float z\nelement face 4\n"
    "property list uchar int vertex_indices\nend_header\n"
    "0 0 0\n4 0 0\n0 3 0\n0 0 2\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

struct opened {
    struct scene scene;
    struct host_world world;
    struct view view;
    struct warnings report;
};

static void open_model(struct opened *o, const char *path, const char *view)
{
    const struct scene_options how = {.path = path, .thread_count = 1};
    struct error err;
    char *view_path;

    *o = (struct opened){.scene = {.path = NULL}};
    view_init(&o->view);
    check_or_say(view_find(&o->view, path, view, &view_path, &o->report,
                           &err) &&
                     scene_open(&o->scene, &o->world, &o->view, &how,
                                &o->report, &err),
                 err.text);
    free(view_path);
}

static void close_model(struct opened *o)
{
    world_free(&o->world);
    scene_free(&o->scene);
    view_free(&o->view);
    warnings_free(&o->report);
}

static double mean(const double rgb[3])
{
    return (rgb[0] + rgb[1] + rgb[2]) / 3;
}

static void models_are_of_clay(void **state)
{
    struct opened o;
    const struct material_values *clay;

    (void)state;
    open_model(&o, "m.ply", NULL);
    assert_int_equal(mtl_find(&o.scene, "clay"), o.scene.tris[0].material);
    clay = &o.scene.material_origins[o.scene.tris[0].material].source;
    check_close(mean(clay->base_color.rgb), .6, .01);
    assert_true(clay->base_color.rgb[0] > clay->base_color.rgb[2]); /* warm */
    assert_string_equal(o.scene.mtl_paths[0], "m.ply.mtl");
    assert_int_equal(o.report.entry_count, 0);
    close_model(&o);
}

static void a_file_beside_the_model_replaces_clay(void **state)
{
    struct opened o;
    struct material_values *clay;

    (void)state;
    put("m.ply.mtl", "newmtl other\nKd 1 0 0\nnewmtl clay\nKd 0 1 0\n");
    open_model(&o, "m.ply", NULL);
    clay = &o.scene.material_origins[o.scene.tris[0].material].source;
    check_close(clay->base_color.rgb[0], 0, 0);
    check_close(clay->base_color.rgb[1], 1, 0);
    assert_int_equal(o.scene.mtl_path_count, 1);
    assert_int_not_equal(mtl_find(&o.scene, "other"), NO_INDEX);
    assert_int_equal(o.report.entry_count, 0);
    close_model(&o);
    unlink("m.ply.mtl");
}

/* The first save writes the whole material, also as a copy, and a later one
 * what has changed. */
static void edits_are_saved_beside_the_model(void **state)
{
    struct opened o;
    struct material_values clay, copy;
    struct file_change change;
    struct error err;

    (void)state;
    open_model(&o, "m.ply", NULL);
    clay = o.scene.material_origins[MESH_MATERIAL].source;
    copy = clay;
    copy.base_color = (struct mtl_color){{.25, .5, .75}, 1};
    check_or_say(
        mtl_save(&o.scene, "m.ply.mtl",
                 (struct mtl_changes){
                     &(struct mtl_change){"clay.2", "clay", &clay, &copy}, 1},
                 &change, &err),
        err.text);
    close_model(&o);
    has("m.ply.mtl", "\nnewmtl clay.2\nKd 0.25 0.5 0.75\nKd_roughness 0.5\n");
    open_model(&o, "m.ply", NULL);
    copy = o.scene.material_origins[MESH_MATERIAL].source;
    assert_true(material_values_equal(&copy, &clay));
    copy.diffuse_roughness.value = .25;
    check_or_say(mtl_save(&o.scene, "m.ply.mtl",
                          (struct mtl_changes){
                              &(struct mtl_change){"clay", NULL, &clay, &copy},
                              1},
                          &change, &err),
                 err.text);
    close_model(&o);
    open_model(&o, "m.ply", NULL);
    assert_true(
        material_values_equal(&o.scene.material_origins[MESH_MATERIAL].source,
                              &copy));
    assert_int_not_equal(mtl_find(&o.scene, "clay.2"), NO_INDEX);
    close_model(&o);
    has("m.ply", model);
    unlink("m.ply.mtl");
}

/* A light of the view file, or a background, is the only one. */
static void the_studio_is_only_for_models_without_light(void **state)
{
    struct opened o;

    (void)state;
    open_model(&o, "m.ply", NULL);
    assert_int_equal(o.view.lamps.count, 1);
    assert_true(o.view.lighting.has_background);
    assert_false(view_has_soft_sky(&o.view));
    close_model(&o);
    put("a.view", "light point 0 9 0\n");
    open_model(&o, "m.ply", "a.view");
    assert_int_equal(o.view.lamps.count, 1);
    assert_false(o.view.lighting.has_background);
    close_model(&o);
    put("a.view", "background 0 0 0\n");
    open_model(&o, "m.ply", "a.view");
    assert_int_equal(o.view.lamps.count, 0);
    close_model(&o);
    unlink("a.view");
}

/* All corners are in the picture, and one is near its edge. */
static void the_camera_is_near(void **state)
{
    static const char *const sizes[] = {"res 400 100\n", "res 100 400\n"};

    (void)state;
    for (int i = 0; i < 2; i++) {
        double most = 0;
        struct opened o;
        struct axes axes;

        put("a.view", sizes[i]);
        open_model(&o, "m.ply", "a.view");
        pose_axes(&o.view.pose, &axes);
        for (uint32_t v = 0; v < o.scene.position_count; v++) {
            const struct vec3 *f = &o.scene.positions[v];
            double p[3] = {(double)f->x, (double)f->y, (double)f->z};
            double tangent = tan(angle_rad(o.view.pose.fovy_deg) / 2), depth;

            for (int k = 0; k < 3; k++)
                p[k] = p[k] / o.scene.scale + o.scene.center[k] -
                       o.view.pose.eye[k];
            depth = vec3d_dot(p, axes.forward) * tangent;
            most = fmax(most, fabs(vec3d_dot(p, axes.up)) / depth);
            most = fmax(most, fabs(vec3d_dot(p, axes.right)) / depth *
                                  o.view.height_px / o.view.width_px);
        }
        check_close(most, .9, .05);
        close_model(&o);
    }
    unlink("a.view");
}

static int begin(void **state)
{
    if (enter_folder(state) != 0)
        return -1;
    put("m.ply", model);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models_are_of_clay),
        cmocka_unit_test(a_file_beside_the_model_replaces_clay),
        cmocka_unit_test(edits_are_saved_beside_the_model),
        cmocka_unit_test(the_studio_is_only_for_models_without_light),
        cmocka_unit_test(the_camera_is_near),
    };

    return cmocka_run_group_tests(tests, begin, remove_folder);
}
