// SPDX-License-Identifier: MIT
#include "scene/pose_fit.h"

#include <math.h>
#include <string.h>

#include "base/geometry.h"
#include "world/bvh/instance_trees.h"
#include "kernels/instance.h"

/* Elevation of the camera that frames a scene, and its azimuth before a model,
 * of which it shows two sides, and before a wall that it would see edge-on. */
#define FRAME_ELEVATION_DEG 20
#define FRAME_AZIMUTH_DEG   30

/* Thickness of such a wall, relative to its length. */
#define WALL_THICKNESS 1e-3

/* Distance of the camera from a scene that is a point, in normalised units. */
#define POINT_DISTANCE 3

void pose_fit_begin(struct pose_fit *f, const struct pose *pose, double aspect)
{
    f->slope_y = CAMERA_FILL * tan(angle_rad(pose->fovy_deg) / 2);
    f->slope_x = f->slope_y * aspect;
    pose_axes(pose, &f->axes);
    for (int i = 0; i < 4; i++) {
        const double *across = i < 2 ? f->axes.right : f->axes.up;
        double slope = i < 2 ? f->slope_x : f->slope_y;

        f->most[i] = -INFINITY;
        for (int k = 0; k < 3; k++)
            f->planes[i][k] = (i % 2 == 0 ? across[k] : -across[k]) -
                              slope * f->axes.forward[k];
    }
}

bool pose_fit_add(struct pose_fit *f, const double point[3])
{
    bool is_beyond = false;

    for (int i = 0; i < 4; i++) {
        double d = vec3d_dot(f->planes[i], point);

        if (d <= f->most[i])
            continue;
        is_beyond = true;
        f->most[i] = d;
        memcpy(f->last[i], point, sizeof f->last[i]);
    }
    return is_beyond;
}

void pose_fit_add_box(struct pose_fit *f, const double half[3])
{
    for (int corner = 0; corner < 8; corner++) {
        double p[3];

        for (int i = 0; i < 3; i++)
            p[i] = corner >> i & 1 ? half[i] : -half[i];
        pose_fit_add(f, p);
    }
}

/* Returns where the eye is across, at the depth z, if the two points that are
 * furthest to one side and to the other are as far from the middle of the
 * picture. All others are between their planes then. */
static double middle(const struct pose_fit *f, int side, const double across[3],
                     double z)
{
    const double *a = f->last[side], *b = f->last[side + 1];
    double depth_a = fmax(vec3d_dot(a, f->axes.forward) - z, 0);
    double depth_b = fmax(vec3d_dot(b, f->axes.forward) - z, 0);
    double depth = depth_a + depth_b; /* 0: the eye is in both */

    return depth > 0 ? (vec3d_dot(a, across) * depth_b +
                        vec3d_dot(b, across) * depth_a) /
                           depth
                     : (f->most[side] - f->most[side + 1]) / 2;
}

void pose_fit_place(const struct pose_fit *f, const double center[3],
                    double unit, double radius, struct pose *pose)
{
    double x, y;
    double z = fmin(-(f->most[0] + f->most[1]) / (2 * f->slope_x),
                    -(f->most[2] + f->most[3]) / (2 * f->slope_y));

    z = fmin(-radius, z);
    if (!(z < 0))
        z = -pose_reach(pose) / unit;
    x = middle(f, 0, f->axes.right, z);
    y = middle(f, 2, f->axes.up, z);
    for (int i = 0; i < 3; i++) {
        pose->at[i] =
            center[i] + unit * (x * f->axes.right[i] + y * f->axes.up[i]);
        pose->eye[i] = pose->at[i] + unit * z * f->axes.forward[i];
    }
}

/* ---- scenes ---- */

static bool add_position(struct pose_fit *f, struct vec3 p)
{
    return pose_fit_add(f, (const double[3]){(double)p.x, (double)p.y,
                                             (double)p.z});
}

/* Adds the corners of consecutive triangles. */
static void add_tris(struct pose_fit *f, const struct world *w, uint32_t first,
                     uint32_t count)
{
    uint32_t instance = count > 0 ? instance_of(w, first) : NO_INDEX;

    for (uint32_t i = first; i < first + count; i++) {
        struct tri t = tri_at(w, i, instance);

        for (int k = 0; k < 3; k++)
            add_position(f, position_at(w, t.v[k], instance));
    }
}

/* Adds all triangles. Most instances are between others, as their boxes show.
 */
static void add_model(struct pose_fit *f, const struct scene *scene)
{
    const struct world w = scene_shape(scene);
    struct mesh_box box = {.mesh = NO_INDEX};
    uint64_t tris = 0;

    add_tris(f, &w, 0, plain_tri_count(&w));
    for (uint32_t i = 0; i < scene->placed_count; i++) {
        const struct instance *at = &scene->placed[i];
        struct pose_fit with_box = *f;
        struct vec3 corners[8];
        bool is_beyond = false;

        instance_box_corners(&w, i, &box, corners);
        for (int k = 0; k < 8; k++)
            is_beyond |= add_position(&with_box, corners[k]);
        if (!is_beyond)
            continue;
        tris += at->tri_count;
        if (tris <= INSTANCE_TRIS_MAX)
            add_tris(f, &w, at->first_tri, at->tri_count);
        else
            *f = with_box;
    }
}

void scene_frame(const struct scene *scene, struct view *view)
{
    double elevation = angle_rad(FRAME_ELEVATION_DEG);
    double distance = POINT_DISTANCE / scene->scale;
    double azimuth, half[3];
    struct pose *pose = &view->pose;
    struct pose_fit fit;

    for (int k = 0; k < 3; k++)
        half[k] =
            (scene->bounds_hi[k] / 2 - scene->bounds_lo[k] / 2) * scene->scale;
    azimuth = scene->is_model || half[0] < WALL_THICKNESS * half[2]
                  ? angle_rad(FRAME_AZIMUTH_DEG)
                  : 0;
    memcpy(pose->at, scene->center, sizeof pose->at);
    pose->eye[0] = pose->at[0] + distance * cos(elevation) * sin(azimuth);
    pose->eye[1] = pose->at[1] + distance * sin(elevation);
    pose->eye[2] = pose->at[2] + distance * cos(elevation) * cos(azimuth);
    pose_fit_begin(&fit, pose, (double)view->width_px / view->height_px);
    if (scene->is_model && scene->tri_count > 0)
        add_model(&fit, scene);
    else
        pose_fit_add_box(&fit, half);
    pose_fit_place(&fit, scene->center, 1 / scene->scale, vec3d_length(half),
                   pose);
}
