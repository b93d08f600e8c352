// SPDX-License-Identifier: MIT
#include "scene/world.h"

#include <math.h>
#include <string.h>

#include "base/geometry.h"
#include "picture/color.h"

/* A framed scene is seen from this far above, with this much air around. */
#define FRAME_ELEVATION_DEG 20
#define FRAME_MARGIN        1.05

/* Float coordinates whose squares do not overflow. */
#define EYE_MAX 1e18

/* Half the field of view along the narrower side of the picture. */
static double narrow_angle_rad(const struct view *view)
{
    double half = angle_rad(view->pose.fovy_deg) / 2;

    if (view->width_px < view->height_px)
        half = atan(tan(half) * view->width_px / view->height_px);
    return half;
}

void scene_frame(const struct scene *scene, struct view *view)
{
    double elevation = angle_rad(FRAME_ELEVATION_DEG);
    double radius = 0;
    double distance;

    for (int k = 0; k < 3; k++) {
        double half =
            (scene->bounds_hi[k] / 2 - scene->bounds_lo[k] / 2) * scene->scale;

        radius += half * half;
    }
    radius = radius > 0 ? sqrt(radius) : 1;
    distance = FRAME_MARGIN * radius / sin(narrow_angle_rad(view));
    memcpy(view->pose.at, scene->center, sizeof view->pose.at);
    memcpy(view->pose.eye, scene->center, sizeof view->pose.eye);
    view->pose.eye[1] += distance * sin(elevation) / scene->scale;
    view->pose.eye[2] += distance * cos(elevation) / scene->scale;
}

static struct vec3 scaled(const double v[3], double scale)
{
    return (struct vec3){(float)(v[0] * scale), (float)(v[1] * scale),
                         (float)(v[2] * scale)};
}

static bool make_camera(const struct scene *scene, const struct view *view,
                        struct camera *camera, struct error *err)
{
    const struct pose *pose = &view->pose;
    double tangent = tan(angle_rad(pose->fovy_deg) / 2);
    double focus = pose->focus == 0 ? pose_reach(pose) : pose->focus;
    double eye[3];
    struct axes axes;

    for (int k = 0; k < 3; k++) {
        eye[k] = (pose->eye[k] - scene->center[k]) * scene->scale;
        if (!(fabs(eye[k]) < EYE_MAX))
            return fail(err,
                        "camera: found eye %g %g %g, expected it nearer to the "
                        "scene",
                        pose->eye[0], pose->eye[1], pose->eye[2]);
    }
    pose_axes(pose, &axes);
    *camera = (struct camera){
        .eye = scaled(eye, 1),
        .width = (float)view->width_px,
        .height = (float)view->height_px,
        .forward = scaled(axes.forward, 1),
        .right = scaled(axes.right, tangent * view->width_px / view->height_px),
        .up = scaled(axes.up, tangent),
        .lens_radius = (float)fmin(pose->aperture / 2 * scene->scale, EYE_MAX),
        .focus = (float)fmin(fmax(focus * scene->scale, 1 / EYE_MAX), EYE_MAX),
    };
    return true;
}

static struct sky make_sky(const struct scene *scene, const struct view *view)
{
    double angle = angle_rad(view->lighting.sky_rotation_deg);
    double one[3] = {1, 1, 1};
    struct sky sky = {
        .color = scaled(view->lighting.background, 1),
        .rotation_sin = (float)sin(angle),
        .rotation_cos = (float)cos(angle),
    };

    if (scene->sky_texels != NULL) {
        sky.color = scaled(one, view->lighting.sky_strength);
        sky.width = scene->sky_width;
        sky.height = scene->sky_height;
    }
    return sky;
}

bool scene_guide(struct scene *scene, const struct view *view, int thread_count,
                 struct error *err)
{
    struct bvh8_world w = {.world = scene_arrays(scene), .tree = &scene->tree};
    struct vec3 color = make_sky(scene, view).color;
    double sky = color_mean(color);
    struct pool *pool;
    bool ok;

    lights_lend(&scene->lights, &w.world);
    if (scene->sky_texels != NULL)
        sky *= scene->sky_table.mean;
    if (!path_guide_needs_rays(&scene->guide, &w.world, sky))
        return path_guide_update(&scene->guide, &w, &scene->lights, sky, NULL,
                                 err);
    /* without threads this one works */
    pool = thread_count > 1 ? pool_create(thread_count, err) : NULL;
    ok = (scene->tree.nodes != NULL ||
          bvh8_build(&scene->tree, &w.world, pool, err)) &&
         path_guide_update(&scene->guide, &w, &scene->lights, sky, pool, err);
    pool_destroy(pool);
    return ok;
}

bool scene_world(const struct scene *scene, const struct view *view,
                 uint32_t seed, struct world *world, struct error *err)
{
    struct world w = scene_arrays(scene);

    w.settings.sky = make_sky(scene, view);
    lights_lend(&scene->lights, &w);
    sky_table_lend(&scene->sky_table, &w);
    path_guide_lend(&scene->guide, &w);
    w.settings.max_vertices = view->max_bounces < 0
                                  ? PATH_HARD_STOP
                                  : (uint32_t)view->max_bounces + 1;
    w.settings.seed = seed;
    w.settings.features = scene_features(scene);
    if (!pose_check(&view->pose, "camera", err) ||
        !make_camera(scene, view, &w.settings.camera, err))
        return false;
    *world = w;
    return true;
}
