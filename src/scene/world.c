// SPDX-License-Identifier: MIT
#include "scene/world.h"

#include <math.h>
#include <string.h>

#include "base/angle.h"
#include "picture/color.h"

/* The sine of the angle below which `up` is parallel to the view. */
#define PARALLEL 1e-6

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

static void cross(const double a[3], const double b[3], double to[3])
{
    to[0] = a[1] * b[2] - a[2] * b[1];
    to[1] = a[2] * b[0] - a[0] * b[2];
    to[2] = a[0] * b[1] - a[1] * b[0];
}

/* Scales v to length 1; false, with v unchanged, if it has no direction. */
static bool normalize(double v[3])
{
    double most = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    double x = v[0] / most, y = v[1] / most, z = v[2] / most;
    double length = sqrt(x * x + y * y + z * z);

    if (!(most > 0 && length < INFINITY))
        return false;
    v[0] = x / length;
    v[1] = y / length;
    v[2] = z / length;
    return true;
}

/* `right` of the picture; where `up` says nothing, the axis that is least
 * along `forward` stands in for it, and the result is false. */
static bool find_right(const double forward[3], const double view_up[3],
                       double right[3])
{
    double up[3] = {view_up[0], view_up[1], view_up[2]};
    int axis = 0;

    if (normalize(up)) {
        cross(forward, up, right);
        if (hypot(hypot(right[0], right[1]), right[2]) >= PARALLEL) {
            normalize(right);
            return true;
        }
    }
    for (int k = 1; k < 3; k++)
        axis = fabs(forward[k]) < fabs(forward[axis]) ? k : axis;
    memset(up, 0, sizeof up);
    up[axis] = 1;
    cross(forward, up, right);
    normalize(right);
    return false;
}

bool scene_up_is_parallel(const struct view *view)
{
    double forward[3], right[3];

    for (int k = 0; k < 3; k++)
        forward[k] = view->pose.at[k] / 2 - view->pose.eye[k] / 2;
    return normalize(forward) && !find_right(forward, view->pose.up, right);
}

static struct vec3 scaled(const double v[3], double scale)
{
    return (struct vec3){(float)(v[0] * scale), (float)(v[1] * scale),
                         (float)(v[2] * scale)};
}

/* What a lens adds to a pinhole camera. */
static void add_lens(const struct scene *scene, const struct view *view,
                     struct camera *camera)
{
    double focus = view->pose.focus;

    if (focus == 0)
        focus = hypot(hypot(view->pose.at[0] - view->pose.eye[0],
                            view->pose.at[1] - view->pose.eye[1]),
                      view->pose.at[2] - view->pose.eye[2]);
    camera->lens_radius =
        (float)fmin(view->pose.aperture / 2 * scene->scale, EYE_MAX);
    camera->focus =
        (float)fmin(fmax(focus * scene->scale, 1 / EYE_MAX), EYE_MAX);
}

static bool make_camera(const struct scene *scene, const struct view *view,
                        struct camera *camera, struct error *err)
{
    double tangent = tan(angle_rad(view->pose.fovy_deg) / 2);
    double forward[3], right[3], up[3], eye[3];

    for (int k = 0; k < 3; k++) {
        forward[k] = view->pose.at[k] / 2 - view->pose.eye[k] / 2;
        eye[k] = (view->pose.eye[k] - scene->center[k]) * scene->scale;
        if (!(fabs(eye[k]) < EYE_MAX))
            return fail(err,
                        "camera: found eye %g %g %g, expected it nearer to the "
                        "scene",
                        view->pose.eye[0], view->pose.eye[1],
                        view->pose.eye[2]);
    }
    if (!normalize(forward))
        return fail(err,
                    "camera: found eye and at both at %g %g %g, expected two "
                    "points",
                    view->pose.at[0], view->pose.at[1], view->pose.at[2]);
    find_right(forward, view->pose.up, right);
    cross(right, forward, up);
    camera->eye = scaled(eye, 1);
    camera->width = (float)view->width_px;
    camera->height = (float)view->height_px;
    camera->forward = scaled(forward, 1);
    camera->right = scaled(right, tangent * view->width_px / view->height_px);
    camera->up = scaled(up, tangent);
    add_lens(scene, view, camera);
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
        return path_guide_update(&scene->guide, &w, sky, NULL, err);
    /* without threads this one works */
    pool = thread_count > 1 ? pool_create(thread_count, err) : NULL;
    ok = (scene->tree.nodes != NULL ||
          bvh8_build(&scene->tree, &w.world, pool, err)) &&
         path_guide_update(&scene->guide, &w, sky, pool, err);
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
    if (!view_check(view, "camera", err) ||
        !make_camera(scene, view, &w.settings.camera, err))
        return false;
    *world = w;
    return true;
}
