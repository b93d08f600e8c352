// SPDX-License-Identifier: MIT
#include "render/projection.h"

#include "kernels/vec.h"

/* Distance of the near plane. The extent of a normalised scene is about 1. */
#define NEAR_PLANE 1e-4f

struct camera projection_camera(const struct camera *camera,
                                const struct projection_part *part)
{
    struct camera c = *camera;
    float x = (float)part->shown_width / (float)part->width;
    float y = (float)part->shown_height / (float)part->height;

    c.left = x * (c.left + (float)part->x);
    c.top = y * (c.top + (float)part->y);
    c.width *= x;
    c.height *= y;
    return c;
}

static float depth_of(const struct camera *c, struct vec3 p)
{
    return v3_dot(v3_sub(p, c->eye), c->forward);
}

bool projection_point(const struct camera *c, struct vec3 p,
                      struct projected *to)
{
    struct vec3 d = v3_sub(p, c->eye);
    double depth = depth_of(c, p);
    double right = v3_dot(d, c->right) / v3_dot(c->right, c->right);
    double up = v3_dot(d, c->up) / v3_dot(c->up, c->up);

    /* rounding may put a point of the near plane in front of it */
    if (!(depth >= 0.5 * NEAR_PLANE))
        return false;
    to->x = 0.5 * (1 + right / depth) * c->width - c->left;
    to->y = 0.5 * (1 - up / depth) * c->height - c->top;
    to->depth = depth;
    return true;
}

bool projection_line(const struct camera *c, struct vec3 a, struct vec3 b,
                     struct projected to[2])
{
    float at_a = depth_of(c, a);
    float at_b = depth_of(c, b);
    struct vec3 cut;

    if (at_a < NEAR_PLANE && at_b < NEAR_PLANE)
        return false;
    cut =
        v3_add(a, v3_scale(v3_sub(b, a), (NEAR_PLANE - at_a) / (at_b - at_a)));
    return projection_point(c, at_a < NEAR_PLANE ? cut : a, &to[0]) &&
           projection_point(c, at_b < NEAR_PLANE ? cut : b, &to[1]);
}
