// SPDX-License-Identifier: MIT
#include "studio/camera/camera_moves.h"

#include <math.h>

#include "base/geometry.h"

/* Least angle to the poles, where the picture would turn about its centre. */
#define POLE_RAD 0.01

void camera_move(struct pose *pose, double right, double up, double forward)
{
    struct axes axes;

    pose_axes(pose, &axes);
    for (int i = 0; i < 3; i++) {
        double step =
            right * axes.right[i] + up * axes.up[i] + forward * axes.forward[i];

        pose->eye[i] += step;
        pose->at[i] += step;
    }
}

void camera_turn(struct pose *pose, double right_rad, double up_rad)
{
    double reach = pose_reach(pose);
    double azimuth_cos = cos(right_rad), azimuth_sin = sin(right_rad);
    double level[3], polar;
    struct axes axes;

    pose_axes(pose, &axes);
    /* `right` and `level` span the plane perpendicular to the pole; `level` is
     * the forward axis without its part along the pole */
    vec3d_cross(axes.pole, axes.right, level);
    vec3d_normalize(level);
    polar = acos(fmax(-1, fmin(1, vec3d_dot(axes.forward, axes.pole))));
    polar = fmax(POLE_RAD, fmin(M_PI - POLE_RAD, polar - up_rad));
    for (int i = 0; i < 3; i++) {
        double around = azimuth_cos * level[i] + azimuth_sin * axes.right[i];

        pose->at[i] = pose->eye[i] +
                      reach * (cos(polar) * axes.pole[i] + sin(polar) * around);
    }
}

/* Computes the coordinates of `point` relative to `from` along the axes. */
static void to_axes(const struct axes *axes, const double from[3],
                    const double point[3], double xyz[3])
{
    double offset[3];

    vec3d_sub(point, from, offset);
    xyz[0] = vec3d_dot(offset, axes->right);
    xyz[1] = vec3d_dot(offset, axes->up);
    xyz[2] = vec3d_dot(offset, axes->forward);
}

/* `around` keeps its coordinates in the axes of the camera. */
void camera_orbit(struct pose *pose, const double around[3], double right_rad,
                  double up_rad)
{
    struct axes axes;
    double xyz[3];

    pose_axes(pose, &axes);
    to_axes(&axes, pose->eye, around, xyz);
    camera_turn(pose, -right_rad, -up_rad);
    pose_axes(pose, &axes);
    for (int i = 0; i < 3; i++) {
        double eye = around[i] - xyz[0] * axes.right[i] - xyz[1] * axes.up[i] -
                     xyz[2] * axes.forward[i];

        pose->at[i] += eye - pose->eye[i];
        pose->eye[i] = eye;
    }
}

/* Returns one of the eight corners of a box. */
static void corner_of(const double lo[3], const double hi[3], int corner,
                      double p[3])
{
    for (int i = 0; i < 3; i++)
        p[i] = corner >> i & 1 ? hi[i] : lo[i];
}

void camera_frame(struct pose *pose, double aspect, const double lo[3],
                  const double hi[3])
{
    double center[3], half[3];
    struct pose_fit fit;

    for (int i = 0; i < 3; i++) {
        center[i] = lo[i] / 2 + hi[i] / 2;
        half[i] = hi[i] / 2 - lo[i] / 2;
    }
    pose_fit_begin(&fit, pose, aspect);
    pose_fit_add_box(&fit, half);
    pose_fit_place(&fit, center, 1, vec3d_length(half), pose);
}

/* The box is invisible if all corners are beyond the same plane of the
 * frustum. */
bool camera_sees_box(const struct pose *pose, double aspect, const double lo[3],
                     const double hi[3])
{
    double slope_y = tan(angle_rad(pose->fovy_deg) / 2);
    double slope_x = slope_y * aspect;
    double most[5] = {-INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY};
    struct axes axes;

    pose_axes(pose, &axes);
    for (int corner = 0; corner < 8; corner++) {
        double p[3], xyz[3];

        corner_of(lo, hi, corner, p);
        to_axes(&axes, pose->eye, p, xyz);
        most[0] = fmax(most[0], xyz[2]);
        most[1] = fmax(most[1], slope_x * xyz[2] - xyz[0]);
        most[2] = fmax(most[2], slope_x * xyz[2] + xyz[0]);
        most[3] = fmax(most[3], slope_y * xyz[2] - xyz[1]);
        most[4] = fmax(most[4], slope_y * xyz[2] + xyz[1]);
    }
    for (int i = 0; i < 5; i++)
        if (!(most[i] >= 0))
            return false;
    return true;
}

double camera_depth(const struct pose *pose, const double point[3])
{
    struct axes axes;
    double xyz[3];

    pose_axes(pose, &axes);
    to_axes(&axes, pose->eye, point, xyz);
    return xyz[2];
}

void camera_widen(struct pose *pose, double factor)
{
    double half_rad = atan(factor * tan(angle_rad(pose->fovy_deg) / 2));

    pose->fovy_deg =
        fmax(FOVY_MIN_DEG, fmin(FOVY_MAX_DEG, angle_deg(2 * half_rad)));
}
