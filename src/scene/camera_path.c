// SPDX-License-Identifier: MIT
#include "scene/camera_path.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/geometry.h"

/* Sine of the angle below which two directions count as one. */
#define SAME 1e-9

/* ---- turns ---- */

/* Returns sine and cosine, exact at quarters of a turn. */
static void sine_cosine(double angle_deg, double *sine, double *cosine)
{
    double quarter = remainder(angle_deg, 360) / 90;

    *sine = sin(angle_rad(90 * quarter));
    *cosine = cos(angle_rad(90 * quarter));
    if (quarter == rint(quarter)) {
        *sine = rint(*sine);
        *cosine = rint(*cosine);
    }
}

/* Rotates v around a unit axis (Rodrigues' formula). */
static void rotate(double v[3], const double axis[3], double angle_deg)
{
    double along = vec3d_dot(axis, v), across[3], sine, cosine;

    sine_cosine(angle_deg, &sine, &cosine);
    vec3d_cross(axis, v, across);
    for (int k = 0; k < 3; k++)
        v[k] =
            cosine * v[k] + sine * across[k] + (1 - cosine) * along * axis[k];
}

void pose_turn(struct pose *pose, double angle_deg)
{
    struct axes axes;
    double offset[3];

    if (remainder(angle_deg, 360) == 0)
        return;
    pose_axes(pose, &axes);
    vec3d_sub(pose->eye, pose->at, offset);
    rotate(offset, axes.pole, angle_deg);
    for (int k = 0; k < 3; k++)
        pose->eye[k] = pose->at[k] + offset[k];
}

/* ---- quaternions: w, x, y, z of unit length ---- */

struct quaternion {
    double w, v[3];
};

static double quaternion_dot(struct quaternion a, struct quaternion b)
{
    return a.w * b.w + vec3d_dot(a.v, b.v);
}

static struct quaternion product(struct quaternion a, struct quaternion b)
{
    struct quaternion q = {.w = a.w * b.w - vec3d_dot(a.v, b.v)};

    vec3d_cross(a.v, b.v, q.v);
    for (int k = 0; k < 3; k++)
        q.v[k] += a.w * b.v[k] + b.w * a.v[k];
    return q;
}

static struct quaternion inverse(struct quaternion q)
{
    return (struct quaternion){q.w, {-q.v[0], -q.v[1], -q.v[2]}};
}

/* Sets the axis times half the angle of a rotation. */
static void logarithm(struct quaternion q, double to[3])
{
    double length = vec3d_length(q.v);
    double scale = length > SAME ? atan2(length, q.w) / length : 1;

    for (int k = 0; k < 3; k++)
        to[k] = scale * q.v[k];
}

static struct quaternion exponential(const double v[3])
{
    double length = vec3d_length(v);
    double scale = length > SAME ? sin(length) / length : 1;

    return (struct quaternion){cos(length),
                               {scale * v[0], scale * v[1], scale * v[2]}};
}

static struct quaternion slerp(struct quaternion a, struct quaternion b,
                               double t)
{
    double way[3];

    logarithm(product(inverse(a), b), way);
    for (int k = 0; k < 3; k++)
        way[k] *= t;
    return product(a, exponential(way));
}

/* Returns the rotation of the camera with these axes (Shepperd 1978: from the
 * largest component, which no rounding makes vanish). */
static struct quaternion rotation_of(const struct axes *a)
{
    const double m[3][3] = {
        {a->right[0], a->up[0], -a->forward[0]},
        {a->right[1], a->up[1], -a->forward[1]},
        {a->right[2], a->up[2], -a->forward[2]},
    };
    double trace = m[0][0] + m[1][1] + m[2][2], scale;
    struct quaternion q;
    int i = 0, j, k;

    for (int n = 1; n < 3; n++)
        i = m[n][n] > m[i][i] ? n : i;
    j = (i + 1) % 3;
    k = (i + 2) % 3;
    if (trace > m[i][i]) {
        q.w = sqrt(1 + trace) / 2;
        scale = 1 / (4 * q.w);
        for (int n = 0; n < 3; n++)
            q.v[n] = scale * (m[(n + 2) % 3][(n + 1) % 3] -
                              m[(n + 1) % 3][(n + 2) % 3]);
        return q;
    }
    q.v[i] = sqrt(1 + m[i][i] - m[j][j] - m[k][k]) / 2;
    scale = 1 / (4 * q.v[i]);
    q.v[j] = scale * (m[j][i] + m[i][j]);
    q.v[k] = scale * (m[k][i] + m[i][k]);
    q.w = scale * (m[k][j] - m[j][k]);
    return q;
}

/* Sets the direction in which a rotated camera looks: -z turned by q. */
static void direction_of(struct quaternion q, double to[3])
{
    const struct quaternion z = {0, {0, 0, -1}};
    struct quaternion turned = product(product(q, z), inverse(q));

    memcpy(to, turned.v, sizeof turned.v);
    vec3d_normalize(to);
}

/* ---- the path ---- */

/* A place between two keys. */
struct span {
    int last; /* of all keys, from 0 */
    int key;  /* the last one before the place */
    double t; /* from that key to the next, 0 to 1 */
};

/* Returns the cubic of Catmull and Rom through four values. */
static double cubic(const double p[4], double t)
{
    return p[1] + t / 2 *
                      (p[2] - p[0] +
                       t * (2 * p[0] - 5 * p[1] + 4 * p[2] - p[3] +
                            t * (3 * (p[1] - p[2]) + p[3] - p[0])));
}

/* Interpolates one value of each key. Beyond an end, the neighbour of the end
 * is reflected. */
static double between(const struct span *s, const double *values)
{
    double p[4];

    for (int i = 0; i < 4; i++) {
        int key = s->key + i - 1;

        if (key < 0)
            p[i] = 2 * values[0] - values[1];
        else if (key > s->last)
            p[i] = 2 * values[s->last] - values[s->last - 1];
        else
            p[i] = values[key];
    }
    return cubic(p, s->t);
}

/* Interpolates a vector of each key, which is `offset` bytes into a pose. */
static void between_vectors(const struct span *s, const struct pose *keys,
                            size_t offset, double to[3])
{
    double values[CAMERA_PATH_MAX];

    for (int k = 0; k < 3; k++) {
        for (int i = 0; i <= s->last; i++) {
            const char *at = (const char *)&keys[i] + offset;

            memcpy(&values[i], at + (size_t)k * sizeof *to, sizeof *to);
        }
        to[k] = between(s, values);
    }
}

/* Returns the inner point of Shoemake's spline at a key (1987, "Quaternion
 * calculus and fast animation"). */
static struct quaternion inner_point(const struct span *s,
                                     const struct quaternion *q, int key)
{
    double next[3], last[3], way[3];

    if (key == 0 || key == s->last)
        return q[key];
    logarithm(product(inverse(q[key]), q[key + 1]), next);
    logarithm(product(inverse(q[key]), q[key - 1]), last);
    for (int k = 0; k < 3; k++)
        way[k] = -(next[k] + last[k]) / 4;
    return product(q[key], exponential(way));
}

/* Interpolates the directions of the keys. Each quaternion has the sign that is
 * nearer to the one before, so that the camera takes the short way. */
static void between_directions(const struct span *s, const struct pose *keys,
                               double to[3])
{
    struct quaternion q[CAMERA_PATH_MAX], outer, inner;
    struct axes axes;

    for (int i = 0; i <= s->last; i++) {
        pose_axes(&keys[i], &axes);
        q[i] = rotation_of(&axes);
        if (i > 0 && quaternion_dot(q[i - 1], q[i]) < 0)
            q[i] = (struct quaternion){-q[i].w,
                                       {-q[i].v[0], -q[i].v[1], -q[i].v[2]}};
    }
    outer = slerp(q[s->key], q[s->key + 1], s->t);
    inner =
        slerp(inner_point(s, q, s->key), inner_point(s, q, s->key + 1), s->t);
    direction_of(slerp(outer, inner, 2 * s->t * (1 - s->t)), to);
}

/* Interpolates what must stay above 0 by its logarithm, and the lens. */
static double between_numbers(const struct span *s, const struct pose *keys,
                              struct pose *to)
{
    double reach[CAMERA_PATH_MAX], fovy[CAMERA_PATH_MAX];
    double aperture[CAMERA_PATH_MAX], focus[CAMERA_PATH_MAX];
    bool has_focus = false;

    for (int i = 0; i <= s->last; i++) {
        double distance = pose_reach(&keys[i]);

        reach[i] = log(distance);
        fovy[i] = log(tan(angle_rad(keys[i].fovy_deg) / 2));
        aperture[i] = keys[i].aperture;
        focus[i] = log(keys[i].focus > 0 ? keys[i].focus : distance);
        has_focus |= keys[i].focus > 0;
    }
    to->fovy_deg = 2 * angle_deg(atan(exp(between(s, fovy))));
    to->aperture = fmax(between(s, aperture), 0);
    to->focus = has_focus ? exp(between(s, focus)) : 0;
    return exp(between(s, reach));
}

struct pose camera_path_at(const struct pose *keys, int count, double u)
{
    struct span s = {.last = count - 1, .key = (int)u};
    struct pose pose;
    double direction[3], reach;

    assert(count >= 2 && count <= CAMERA_PATH_MAX && u >= 0 && u <= count - 1);
    s.t = u - s.key;
    if (s.t <= 0)
        return keys[s.key];
    reach = between_numbers(&s, keys, &pose);
    between_vectors(&s, keys, offsetof(struct pose, eye), pose.eye);
    between_vectors(&s, keys, offsetof(struct pose, up), pose.up);
    if (!(vec3d_length(pose.up) > SAME)) /* between opposite ones */
        memcpy(pose.up, keys[s.key].up, sizeof pose.up);
    between_directions(&s, keys, direction);
    for (int k = 0; k < 3; k++)
        pose.at[k] = pose.eye[k] + reach * direction[k];
    return pose;
}
