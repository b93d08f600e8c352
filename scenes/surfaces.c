// SPDX-License-Identifier: MIT
#include "surfaces.h"

#include <math.h>
#include <stdlib.h>

static double limited(int i, int count, const double (*points)[2], int axis)
{
    return points[i < 0 ? 0 : i >= count ? count - 1 : i][axis];
}

/* Returns the value of the spline, whose ends are those of the points. */
static double spline(const struct profile *p, double t, int axis)
{
    double at = fmin(fmax(t, 0), 1) * (p->count + 1) - 1;
    int i = (int)floor(at);
    double x = at - i, y = 1 - x;
    const double weights[4] = {y * y * y / 6,
                               (3 * x * x * x - 6 * x * x + 4) / 6,
                               (3 * y * y * y - 6 * y * y + 4) / 6,
                               x * x * x / 6};
    double sum = 0;

    for (int k = 0; k < 4; k++)
        sum += weights[k] * limited(i - 1 + k, p->count, p->points, axis);
    return sum;
}

struct point surface_lathe(const void *context, double u, double v)
{
    const struct profile *p = context;
    double angle = 2 * PI * u;
    double radius = spline(p, v, 0) * (1 + p->star * cos(9 * angle));

    return (struct point){radius * cos(angle), spline(p, v, 1),
                          -radius * sin(angle)};
}

struct point surface_plane(const void *context, double u, double v)
{
    const struct plane *p = context;

    return (struct point){p->corner.x + u * p->u.x + v * p->v.x,
                          p->corner.y + u * p->u.y + v * p->v.y,
                          p->corner.z + u * p->u.z + v * p->v.z};
}

struct point surface_ball(const void *context, double u, double v)
{
    double angle = 2 * PI * u, height = PI * (v - .5);

    (void)context;
    return (struct point){cos(height) * cos(angle), sin(height),
                          -cos(height) * sin(angle)};
}

uint32_t surface_lamp(struct glb *g, const char *color, double strength)
{
    glb_use(g, "KHR_materials_emissive_strength");
    return glb_add(&g->materials,
                   "{\"name\":\"lamp\",\"pbrMetallicRoughness\":"
                   "{\"baseColorFactor\":[0,0,0,1],\"metallicFactor\":0},"
                   "\"emissiveFactor\":%s,\"extensions\":"
                   "{\"KHR_materials_emissive_strength\":"
                   "{\"emissiveStrength\":%g}}}",
                   color, strength);
}

void surface_softbox(struct glb *g, struct point center, struct point at,
                     double width, double height, uint32_t lamp)
{
    double x = at.x - center.x, y = at.y - center.y, z = at.z - center.z;
    double flat = sqrt(x * x + z * z), length = sqrt(flat * flat + y * y);
    struct point u = {-width * z / flat, 0, width * x / flat};
    /* n = u x v is the direction to `at` */
    struct point v = {-height * y * x / flat / length, height * flat / length,
                      -height * y * z / flat / length};
    struct plane p = {{center.x - (u.x + v.x) / 2, center.y - (u.y + v.y) / 2,
                       center.z - (u.z + v.z) / 2},
                      u,
                      v};
    struct glb_grid grid = {1, 1, surface_plane, .context = &p};

    glb_root(g, "\"name\":\"softbox\",\"mesh\":%u", glb_mesh(g, &grid, lamp));
}
