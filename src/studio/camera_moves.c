// SPDX-License-Identifier: MIT
#include "studio/camera_moves.h"

#include <math.h>

#include "base/angle.h"

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
        up[i] = view->pose.up[i];
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
        axes->forward[i] = view->pose.at[i] - view->pose.eye[i];
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

        view->pose.eye[i] += step;
        view->pose.at[i] += step;
    }
    view->has_camera = true;
}

/* Never 0: what is looked at has a distance. */
static double reach_of(const struct view *view)
{
    double to_at[3], reach;

    for (int i = 0; i < 3; i++)
        to_at[i] = view->pose.at[i] - view->pose.eye[i];
    reach = sqrt(dot(to_at, to_at));
    return reach > 0.0 && !isinf(reach) ? reach : 1;
}

void camera_turn(struct view *view, double right_rad, double up_rad)
{
    struct axes axes;
    double up[3], level[3], across[3];
    double polar, azimuth_cos, azimuth_sin;
    double reach = reach_of(view);

    up_of(view, up);
    axes_of(view, &axes);
    /* `across` and `level` span the plane that `up` stands on; the look is
     * over `level` */
    for (int i = 0; i < 3; i++)
        across[i] = axes.right[i];
    cross(level, up, across);
    make_unit(level);
    polar = acos(fmax(-1.0, fmin(1.0, dot(axes.forward, up)))) - up_rad;
    polar = fmax(POLE_RAD, fmin(M_PI - POLE_RAD, polar));
    azimuth_cos = cos(right_rad);
    azimuth_sin = sin(right_rad);
    for (int i = 0; i < 3; i++) {
        double around = azimuth_cos * level[i] + azimuth_sin * across[i];

        view->pose.at[i] = view->pose.eye[i] +
                           reach * (cos(polar) * up[i] + sin(polar) * around);
    }
    view->has_camera = true;
}

/* `around` keeps its coordinates along the axes that the camera carries. */
void camera_orbit(struct view *view, const double around[3], double right_rad,
                  double up_rad)
{
    struct axes axes;
    double offset[3], right, up, forward;

    axes_of(view, &axes);
    for (int i = 0; i < 3; i++)
        offset[i] = around[i] - view->pose.eye[i];
    right = dot(offset, axes.right);
    up = dot(offset, axes.up);
    forward = dot(offset, axes.forward);
    camera_turn(view, -right_rad, -up_rad);
    axes_of(view, &axes);
    for (int i = 0; i < 3; i++) {
        double eye = around[i] - right * axes.right[i] - up * axes.up[i] -
                     forward * axes.forward[i];

        view->pose.at[i] += eye - view->pose.eye[i];
        view->pose.eye[i] = eye;
    }
}

/* The nearest place (*x, *z) before points from which all are seen by a camera
 * along z that sees as far to the sides as `slope` times the distance; `right`
 * and `left` are the greatest x - slope z and -x - slope z of the points. */
static void stand_before(double right, double left, double slope, double *x,
                         double *z)
{
    *x = (right - left) / 2;
    *z = -(right + left) / (2 * slope);
}

void camera_frame(struct view *view, const double lo[3], const double hi[3])
{
    double slope_y = CAMERA_FILL * tan(angle_rad(view->pose.fovy_deg) / 2);
    double slope_x = slope_y * view->width_px / view->height_px;
    double right = -INFINITY, left = -INFINITY;
    double above = -INFINITY, below = -INFINITY;
    double center[3], x, y, z, z_across, z_high;
    double reach = reach_of(view), radius = 0;
    struct axes axes;

    axes_of(view, &axes);
    for (int corner = 0; corner < 8; corner++) {
        double p[3];

        for (int i = 0; i < 3; i++) {
            center[i] = lo[i] / 2 + hi[i] / 2;
            p[i] = (corner >> i & 1 ? hi[i] : lo[i]) - center[i];
        }
        radius = sqrt(dot(p, p));
        x = dot(p, axes.right);
        y = dot(p, axes.up);
        z = dot(p, axes.forward);
        right = fmax(right, x - slope_x * z);
        left = fmax(left, -x - slope_x * z);
        above = fmax(above, y - slope_y * z);
        below = fmax(below, -y - slope_y * z);
    }
    stand_before(right, left, slope_x, &x, &z_across);
    stand_before(above, below, slope_y, &y, &z_high);
    /* a wide lens would see all of it from its nearest corner */
    z = fmin(-radius, fmin(z_across, z_high));
    if (!(z < 0))
        z = -reach; /* a point */
    for (int i = 0; i < 3; i++) {
        view->pose.at[i] = center[i] + x * axes.right[i] + y * axes.up[i];
        view->pose.eye[i] = view->pose.at[i] + z * axes.forward[i];
    }
    view->has_camera = true;
}

/* All corners lie beyond one of the planes through the eye that bound what is
 * seen, or behind it. */
bool camera_sees_box(const struct view *view, const double lo[3],
                     const double hi[3])
{
    double slope_y = tan(angle_rad(view->pose.fovy_deg) / 2);
    double slope_x = slope_y * view->width_px / view->height_px;
    double most[5] = {-INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY};
    struct axes axes;

    axes_of(view, &axes);
    for (int corner = 0; corner < 8; corner++) {
        double p[3], x, y, z;

        for (int i = 0; i < 3; i++)
            p[i] = (corner >> i & 1 ? hi[i] : lo[i]) - view->pose.eye[i];
        x = dot(p, axes.right);
        y = dot(p, axes.up);
        z = dot(p, axes.forward);
        most[0] = fmax(most[0], z);
        most[1] = fmax(most[1], slope_x * z - x);
        most[2] = fmax(most[2], slope_x * z + x);
        most[3] = fmax(most[3], slope_y * z - y);
        most[4] = fmax(most[4], slope_y * z + y);
    }
    for (int i = 0; i < 5; i++)
        if (!(most[i] >= 0))
            return false;
    return true;
}

double camera_depth(const struct view *view, const double point[3])
{
    struct axes axes;
    double offset[3];

    axes_of(view, &axes);
    for (int i = 0; i < 3; i++)
        offset[i] = point[i] - view->pose.eye[i];
    return dot(offset, axes.forward);
}

void camera_widen(struct view *view, double factor)
{
    double half_rad = atan(factor * tan(angle_rad(view->pose.fovy_deg) / 2));

    view->pose.fovy_deg =
        fmax(FOVY_MIN_DEG, fmin(FOVY_MAX_DEG, angle_deg(2 * half_rad)));
}
