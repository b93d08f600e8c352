// SPDX-License-Identifier: MIT
#include "glim/camera.h"

#include <math.h>

#define PI_D 3.14159265358979323846

/* From the poles: the picture must not turn about its middle. */
#define POLE_RAD 0.01

struct axes {
    double right[3], up[3], forward[3];
};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(double out[3], const double a[3], const double b[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* False, with *v unchanged, if it has no direction. */
static bool make_unit(double v[3])
{
    double length = sqrt(dot(v, v));

    if (!(length > 0.0) || isinf(length))
        return false;
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return true;
}

/* A unit vector across v. */
static void any_across(double out[3], const double v[3])
{
    double axis[3] = {0, 0, 0};
    int least = 0;

    for (int i = 1; i < 3; i++) {
        if (fabs(v[i]) < fabs(v[least]))
            least = i;
    }
    axis[least] = 1;
    cross(out, v, axis);
    make_unit(out);
}

static void up_of(const struct view *view, double up[3])
{
    for (int i = 0; i < 3; i++)
        up[i] = view->up[i];
    if (!make_unit(up)) {
        up[0] = up[2] = 0;
        up[1] = 1;
    }
}

static void axes_of(const struct view *view, struct axes *axes)
{
    double up[3];

    up_of(view, up);
    for (int i = 0; i < 3; i++)
        axes->forward[i] = view->at[i] - view->eye[i];
    if (!make_unit(axes->forward)) {
        axes->forward[0] = axes->forward[1] = 0;
        axes->forward[2] = -1;
    }
    cross(axes->right, axes->forward, up);
    /* what is left of a vector along `up` is only rounding */
    if (dot(axes->right, axes->right) < 1e-20 || !make_unit(axes->right))
        any_across(axes->right, axes->forward);
    cross(axes->up, axes->right, axes->forward);
}

void camera_move(struct view *view, double right, double up, double forward)
{
    struct axes axes;

    axes_of(view, &axes);
    for (int i = 0; i < 3; i++) {
        double step =
            right * axes.right[i] + up * axes.up[i] + forward * axes.forward[i];

        view->eye[i] += step;
        view->at[i] += step;
    }
    view->has_camera = true;
}

void camera_turn(struct view *view, double right_rad, double up_rad)
{
    struct axes axes;
    double up[3], level[3], across[3], to_at[3];
    double polar, azimuth_cos, azimuth_sin, distance;

    up_of(view, up);
    axes_of(view, &axes);
    for (int i = 0; i < 3; i++)
        to_at[i] = view->at[i] - view->eye[i];
    distance = sqrt(dot(to_at, to_at));
    if (!(distance > 0.0) || isinf(distance))
        distance = 1;
    /* `across` and `level` span the plane that `up` stands on; the look is
     * over `level` */
    for (int i = 0; i < 3; i++)
        across[i] = axes.right[i];
    cross(level, up, across);
    make_unit(level);
    polar = acos(fmax(-1.0, fmin(1.0, dot(axes.forward, up)))) - up_rad;
    polar = fmax(POLE_RAD, fmin(PI_D - POLE_RAD, polar));
    azimuth_cos = cos(right_rad);
    azimuth_sin = sin(right_rad);
    for (int i = 0; i < 3; i++) {
        double around = azimuth_cos * level[i] + azimuth_sin * across[i];

        view->at[i] = view->eye[i] +
                      distance * (cos(polar) * up[i] + sin(polar) * around);
    }
    view->has_camera = true;
}
