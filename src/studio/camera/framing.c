// SPDX-License-Identifier: MIT
#include "studio/camera/framing.h"

#include <math.h>
#include <string.h>

#include "base/geometry.h"
#include "studio/camera/camera_input.h"
#include "kernels/instance.h"

/* Turns of the camera that are tried, in degrees. */
static const double turns_deg[] = {0,   30,  -30,  60,  -60,  90,
                                   -90, 120, -120, 150, -150, 180};
static const double tilts_deg[] = {0, 25, -25, 50, -50};

/* Distances that are tried, relative to the one at which the object fills the
 * picture. */
static const double distances[] = {1, 0.75, 0.55, 0.4, 0.3, 0.2, 0.12};

/* Weights of a view: of one turned by half a turn, and of one that leaves the
 * room. */
#define TURNED_WEIGHT 0.6
#define LEAVES_WEIGHT 0.1

/* Least distance of the eye to surfaces, relative to its distance to the centre
 * of the object: something nearer would fill the picture. */
#define NEAR_MIN 0.04

/* End of a ray to a point, before the surface that the point is on. */
#define BEFORE_POINT 1e-3

#define SIZE(array) (sizeof(array) / sizeof *(array))

/* ---- points ---- */

/* Adds the points on a run of triangles. The object's triangles before it are
 * `before`, all of them `all`. Barycentrics follow the R2 sequence (Roberts
 * 2018, "The unreasonable effectiveness of quasirandom sequences"). */
static void add_points(struct framing *f, const struct tri_run *run,
                       uint64_t before, uint64_t all)
{
    const struct scene *s = f->surfaces->scene;
    const struct world w = scene_shape(s);

    while (f->point_count < FRAMING_POINTS) {
        int i = f->point_count;
        uint64_t k = (2 * (uint64_t)i + 1) * all / (2 * FRAMING_POINTS);
        double u = fmod(0.5 + 0.7548776662466927 * i, 1);
        double v = fmod(0.5 + 0.5698402909980532 * i, 1);
        struct placed_tri t;

        if (k >= before + run->count)
            return;
        t = tri_placed(&w, run->first + (uint32_t)(k - before));
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        struct vec3 p =
            v3_add(t.p[0], v3_add(v3_scale(v3_sub(t.p[1], t.p[0]), (float)u),
                                  v3_scale(v3_sub(t.p[2], t.p[0]), (float)v)));
        scene_file_point(s, p, f->points[i]);
        f->point_count++;
    }
}

static void choose_points(struct framing *f)
{
    const struct scene *s = f->surfaces->scene;
    uint64_t all = 0, before = 0;

    for (struct tri_run run = {0}; scene_next_run(s, f->object, &run);)
        all += run.count;
    for (struct tri_run run = {0}; scene_next_run(s, f->object, &run);) {
        add_points(f, &run, before, all);
        before += run.count;
    }
}

/* Joins a box, which is empty until *has_points is true, with the corners of a
 * triangle. */
static void join_tri(const struct scene *scene, const struct placed_tri *t,
                     double lo[3], double hi[3], bool *has_points)
{
    for (int c = 0; c < 3; c++) {
        double point[3];

        scene_file_point(scene, t->p[c], point);
        for (int k = 0; k < 3; k++) {
            lo[k] = *has_points ? fmin(lo[k], point[k]) : point[k];
            hi[k] = *has_points ? fmax(hi[k], point[k]) : point[k];
        }
        *has_points = true;
    }
}

/* Computes the bounding box of an object's triangles. */
static void find_box(const struct scene *scene, uint32_t object, double lo[3],
                     double hi[3])
{
    const struct world w = scene_shape(scene);
    struct tri_run run = {0};
    bool has_points = false;

    while (scene_next_run(scene, object, &run))
        for (uint32_t i = 0; i < run.count; i++) {
            struct placed_tri t = tri_placed(&w, run.first + i);

            join_tri(scene, &t, lo, hi, &has_points);
        }
}

void framing_init(struct framing *f, const struct surfaces *surfaces,
                  uint32_t object, double aspect)
{
    const struct scene *s = surfaces->scene;

    *f = (struct framing){.surfaces = surfaces,
                          .object = object,
                          .aspect = aspect};
    choose_points(f);
    if (f->point_count == 0)
        return;
    if (object != NO_INDEX) {
        find_box(s, object, f->lo, f->hi);
    } else {
        memcpy(f->lo, s->bounds_lo, sizeof f->lo);
        memcpy(f->hi, s->bounds_hi, sizeof f->hi);
    }
}

/* ---- views ---- */

enum sight { SEES_POINT, SEES_OBJECT, SEES_OTHER };

/* Returns what is first on the way from the eye to a point of the object: the
 * point, another part of the object, or something else. */
static enum sight look(const struct framing *f, const double eye[3],
                       const double point[3])
{
    struct surface_hit hit;
    double d[3], length;

    vec3d_sub(point, eye, d);
    length = vec3d_length(d);
    if (!vec3d_normalize(d) ||
        !surfaces_hit(f->surfaces, eye, d, length * (1 - BEFORE_POINT),
                      SURFACE_GLASS_PASSES, &hit))
        return SEES_POINT;
    return hit.object == f->object || f->object == NO_INDEX ? SEES_OBJECT
                                                            : SEES_OTHER;
}

/* Returns the share of points that are in the picture and not hidden. Points
 * that only the object itself hides do not count. */
static double seen_share(const struct framing *f, const struct pose *pose)
{
    int seen = 0, hidden = 0;

    for (int i = 0; i < f->point_count; i++) {
        const double *p = f->points[i];
        enum sight sight = camera_sees_box(pose, f->aspect, p, p)
                               ? look(f, pose->eye, p)
                               : SEES_OTHER;

        seen += sight == SEES_POINT ? 1 : 0;
        hidden += sight == SEES_OTHER ? 1 : 0;
    }
    return seen > 0 ? (double)seen / (seen + hidden) : 0;
}

/* Computes the view from the direction of `pose`, turned, at a share of the
 * distance at which the object fills the picture. */
static struct pose candidate(const struct framing *f, const struct pose *pose,
                             double turn_deg, double tilt_deg, double distance)
{
    struct pose p = *pose;

    camera_turn(&p, angle_rad(turn_deg), angle_rad(tilt_deg));
    camera_frame(&p, f->aspect, f->lo, f->hi);
    for (int k = 0; k < 3; k++)
        p.eye[k] = p.at[k] + distance * (p.eye[k] - p.at[k]);
    return p;
}

/* Returns the weight of the surfaces around the eye: 0 if one is too near. */
static double weight_of_place(const struct framing *f, const struct pose *pose,
                              bool is_enclosed)
{
    struct clearance c = surfaces_clearance(f->surfaces, pose->eye);

    if (c.nearest < NEAR_MIN * pose_reach(pose))
        return 0;
    return is_enclosed && c.hit_share < CLEARANCE_ENCLOSED ? LEAVES_WEIGHT : 1;
}

/* The best view so far; `value` is its share times its weights. */
struct choice {
    struct pose pose;
    double value, share;
};

/* Tries all distances in one direction. */
static void try_direction(const struct framing *f, const struct pose *pose,
                          double turn_deg, double tilt_deg, bool is_enclosed,
                          struct choice *best)
{
    double turned = fmin(hypot(turn_deg, tilt_deg) / 180, 1);
    double weight = 1 - (1 - TURNED_WEIGHT) * turned;

    for (size_t i = 0; i < SIZE(distances) && weight > best->value; i++) {
        struct pose p = candidate(f, pose, turn_deg, tilt_deg, distances[i]);
        double share = seen_share(f, &p);
        double value = share * weight;

        if (value > best->value)
            value *= weight_of_place(f, &p, is_enclosed);
        if (value > best->value)
            *best = (struct choice){p, value, share};
    }
}

double framing_find(const struct framing *f, struct pose *pose)
{
    bool is_enclosed = surfaces_clearance(f->surfaces, pose->eye).hit_share >=
                       CLEARANCE_ENCLOSED;
    struct choice best = {.pose = *pose};

    for (size_t i = 0; i < SIZE(turns_deg) && f->point_count > 0; i++)
        for (size_t k = 0; k < SIZE(tilts_deg); k++)
            try_direction(f, pose, turns_deg[i], tilts_deg[k], is_enclosed,
                          &best);
    *pose = best.pose;
    return best.share;
}
