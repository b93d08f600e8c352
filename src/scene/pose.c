// SPDX-License-Identifier: MIT
#include "scene/pose.h"

#include <math.h>
#include <string.h>

#include "base/geometry.h"

/* Sine of the angle below which `up` counts as parallel to the direction. */
#define PARALLEL 1e-6

static bool is_finite(const double v[3])
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

static bool is_zero(const double v[3])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

bool pose_check(const struct pose *pose, const char *place, struct error *err)
{
    double look[3];

    vec3d_sub(pose->at, pose->eye, look);
    if (!is_finite(look) || !is_finite(pose->up))
        return fail(err,
                    "%s: found a camera at infinity, expected finite "
                    "numbers for eye, at and up",
                    place);
    if (is_zero(look))
        return fail(err, "%s: found eye and at in one point, expected two",
                    place);
    if (is_zero(pose->up))
        return fail(err, "%s: found 0 0 0, expected a direction for up", place);
    if (!(pose->fovy_deg > 0 && pose->fovy_deg < 180))
        return fail(err,
                    "%s: found a fovy of %g degrees, expected one above "
                    "0 and below 180",
                    place, pose->fovy_deg);
    return true;
}

/* Sets *v to the unit vector of one axis. */
static void set_axis(double v[3], int axis, double sign)
{
    memset(v, 0, 3 * sizeof *v);
    v[axis] = sign;
}

/* Computes the right axis. Returns false if the pole is parallel to the forward
 * axis, so that a coordinate axis replaces it. */
static bool find_right(struct axes *axes)
{
    const double *forward = axes->forward;
    double other[3];
    int least = 0;

    vec3d_cross(forward, axes->pole, axes->right);
    if (vec3d_length(axes->right) >= PARALLEL) {
        vec3d_normalize(axes->right);
        return true;
    }
    for (int k = 1; k < 3; k++)
        least = fabs(forward[k]) < fabs(forward[least]) ? k : least;
    set_axis(other, least, 1);
    vec3d_cross(forward, other, axes->right);
    vec3d_normalize(axes->right);
    return false;
}

/* Computes all axes. Returns false if a coordinate axis replaces up. */
static bool find_axes(const struct pose *pose, struct axes *axes)
{
    bool has_right;

    memcpy(axes->pole, pose->up, sizeof axes->pole);
    if (!vec3d_normalize(axes->pole))
        set_axis(axes->pole, 1, 1);
    /* differences of halves do not overflow */
    for (int k = 0; k < 3; k++)
        axes->forward[k] = pose->at[k] / 2 - pose->eye[k] / 2;
    if (!vec3d_normalize(axes->forward))
        set_axis(axes->forward, 2, -1);
    has_right = find_right(axes);
    vec3d_cross(axes->right, axes->forward, axes->up);
    return has_right;
}

void pose_axes(const struct pose *pose, struct axes *axes)
{
    find_axes(pose, axes);
}

bool pose_up_is_parallel(const struct pose *pose)
{
    struct axes axes;

    return !find_axes(pose, &axes);
}

double pose_reach(const struct pose *pose)
{
    double look[3], reach;

    vec3d_sub(pose->at, pose->eye, look);
    reach = vec3d_length(look);
    return reach > 0 && !isinf(reach) ? reach : 1;
}
