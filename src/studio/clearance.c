// SPDX-License-Identifier: MIT
#include "studio/clearance.h"

#include <math.h>
#include <string.h>

#include "base/geometry.h"
#include "bvh/bvh8_traverse.h"
#include "studio/camera_moves.h"

#define RAYS 64

/* Rank of the ray whose length is `near`: the seventh shortest of 64, a tenth.
 * Fewer rays hit leaves and wires. Above a floor at height h it is 1.28 h
 * long. */
#define NEAR_RAY 6

/* Turns between successive directions: 1 / golden ratio. */
#define TURN 0.61803398874989485

static struct vec3 stored(const struct scene *scene, const double p[3])
{
    return v3((float)((p[0] - scene->center[0]) * scene->scale),
              (float)((p[1] - scene->center[1]) * scene->scale),
              (float)((p[2] - scene->center[2]) * scene->scale));
}

/* Returns direction i of a spiral from pole to pole with equal areas (Swinbank
 * and Purser 2006, "Fibonacci grids"). */
static struct vec3 direction(int i)
{
    double y = 1 - (2 * i + 1) / (double)RAYS;
    double angle = 2 * M_PI * TURN * i;
    double r = sqrt(1 - y * y);

    return v3((float)(r * cos(angle)), (float)y, (float)(r * sin(angle)));
}

/* Inserts x into the sorted numbers and drops the greatest. */
static void insert(double *sorted, int count, double x)
{
    for (int i = 0; i < count; i++) {
        if (x < sorted[i]) {
            double other = sorted[i];

            sorted[i] = x;
            x = other;
        }
    }
}

static bool trace(const struct scene *scene, const struct host_world *host,
                  struct ray ray, struct hit *hit)
{
    struct bvh8_world w = {.world = world_arrays(host, scene),
                           .tree = world_tree(host)};

    return w.tree != NULL && isfinite(ray.o.x + ray.o.y + ray.o.z) &&
           hit_closest(&w.world, ray, hit);
}

static double distance_to_box(const struct scene *s, const double eye[3])
{
    double off[3];

    for (int k = 0; k < 3; k++)
        off[k] =
            fmax(0, fmax(s->bounds_lo[k] - eye[k], eye[k] - s->bounds_hi[k]));
    return vec3d_length(off);
}

static void trace_around(struct clearance *c, const struct scene *scene,
                         const struct host_world *host)
{
    double nearest[NEAR_RAY + 1];
    struct ray ray = {.o = stored(scene, c->eye), .t_max = FLOAT_MAX};
    int hits = 0, within = 0;

    for (int i = 0; i <= NEAR_RAY; i++)
        nearest[i] = INFINITY;
    for (int i = 0; i < RAYS; i++) {
        struct hit hit;

        ray.d = direction(i);
        if (!trace(scene, host, ray, &hit))
            continue;
        hits++;
        within += scene_tri_object(scene, hit.tri) == c->passed ? 1 : 0;
        insert(nearest, NEAR_RAY + 1, (double)hit.t / scene->scale);
    }
    c->near = nearest[NEAR_RAY];
    c->hit_share = (double)hits / RAYS;
    c->passed_share = (double)within / RAYS;
}

/* Returns the object of the first surface between two points, or NO_INDEX. */
static uint32_t object_between(const struct scene *scene,
                               const struct host_world *host,
                               const double from[3], const double to[3])
{
    struct vec3 o = stored(scene, from);
    struct vec3 way = v3_sub(stored(scene, to), o);
    float length = sqrtf(v3_dot(way, way));
    struct hit hit;

    if (!(length > 0.0f) || !isfinite(length))
        return NO_INDEX;
    struct ray ray = {.o = o,
                      .d = v3_scale(way, 1.0f / length),
                      .t_max = length};
    return trace(scene, host, ray, &hit) ? scene_tri_object(scene, hit.tri)
                                         : NO_INDEX;
}

/* Returns the state after crossing a surface. An enclosed place is a solid if
 * most directions hit the crossed object itself, and a room if they hit others.
 * The limit of a half allows for furniture that shares a face with floor or
 * wall. */
static enum clearance_state state_after_crossing(const struct clearance *before,
                                                 const struct clearance *now,
                                                 const struct scene *scene)
{
    /* the object of faces before the first o line always exists */
    bool has_objects = scene->object_count > 2;

    if (before->state == CLEARANCE_INSIDE_SOLID)
        return CLEARANCE_IN_SCENE;
    if (now->hit_share < CLEARANCE_ENCLOSED)
        return before->hit_share >= CLEARANCE_ENCLOSED ? CLEARANCE_OUTSIDE_ROOM
                                                       : CLEARANCE_IN_SCENE;
    return has_objects && before->state != CLEARANCE_OUTSIDE_ROOM &&
                   now->hit_share >= 1 && now->passed_share > 0.5
               ? CLEARANCE_INSIDE_SOLID
               : CLEARANCE_IN_SCENE;
}

static enum clearance_state
state_without_crossing(const struct clearance *before,
                       const struct clearance *now)
{
    if (before->state == CLEARANCE_INSIDE_SOLID)
        return CLEARANCE_INSIDE_SOLID;
    /* the eye may return through a window without crossing a surface */
    if (before->state == CLEARANCE_OUTSIDE_ROOM &&
        now->hit_share < CLEARANCE_ENCLOSED)
        return CLEARANCE_OUTSIDE_ROOM;
    return CLEARANCE_IN_SCENE;
}

/* Updates all members except the view test for a new position of the eye. */
static void move(struct clearance *c, const struct scene *scene,
                 const struct host_world *host, const double eye[3])
{
    struct clearance before = *c;
    uint32_t passed =
        c->is_known ? object_between(scene, host, c->eye, eye) : NO_INDEX;

    c->is_known = true;
    memcpy(c->eye, eye, sizeof c->eye);
    c->box_distance = distance_to_box(scene, c->eye);
    if (passed != NO_INDEX)
        c->passed = passed;
    trace_around(c, scene, host);
    c->state = passed != NO_INDEX ? state_after_crossing(&before, c, scene)
                                  : state_without_crossing(&before, c);
}

void clearance_update(struct clearance *c, const struct scene *scene,
                      const struct host_world *host, const struct pose *pose,
                      double aspect)
{
    if (!c->is_known || memcmp(c->eye, pose->eye, sizeof c->eye) != 0)
        move(c, scene, host, pose->eye);
    if (c->state != CLEARANCE_IN_SCENE && c->state != CLEARANCE_OUT_OF_VIEW)
        return;
    c->state =
        scene->tri_count == 0 || camera_sees_box(pose, aspect, scene->bounds_lo,
                                                 scene->bounds_hi)
            ? CLEARANCE_IN_SCENE
            : CLEARANCE_OUT_OF_VIEW;
}

void clearance_reset(struct clearance *c)
{
    *c = (struct clearance){.is_known = false};
}
