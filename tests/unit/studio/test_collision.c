// SPDX-License-Identifier: MIT
/*
 * test_collision.c - walls stop the camera at every scale, orbits stay on one
 * side of them, and framed objects are seen
 *
 * What the eye has crossed is found by closed forms, or by counting triangles
 * one by one, never by the tree.
 */
#include <math.h>
#include <string.h>

#include "base/geometry.h"
#include "studio/camera/camera_input.h"
#include "studio/camera/framing.h"
#include "studio/camera/surfaces.h"
#include "tests/unit/folder.h"
#include "tests/unit/room.h"

#define ASPECT 1.6

/* Opens a closed box from -1 to 1, times `scale`. */
static void open_box(struct room *r, double scale)
{
    static const double lo[3] = {-1, -1, -1}, hi[3] = {1, 1, 1};

    room_open_box(r, lo, hi, scale);
}

static double any(uint64_t *seed, double most)
{
    return most * (2 * check_random(seed) - 1);
}

static bool is_within(const double p[3], double half)
{
    return fabs(p[0]) < half && fabs(p[1]) < half && fabs(p[2]) < half;
}

/* Walks of random steps, some of them much longer than the box, never leave
 * it. */
static void walks_stay_in_their_room(void **state)
{
    uint64_t seed = 1;

    (void)state;
    for (double scale = 1e-3; scale < 1e7; scale *= 1e3) {
        double at[3] = {0, 0, 0};
        struct room r;

        open_box(&r, scale);
        for (int i = 0; i < 10000; i++) {
            double size = scale * pow(10, any(&seed, 2) - 1);
            double to[3];
            uint32_t object;

            for (int k = 0; k < 3; k++)
                to[k] = at[k] + any(&seed, size);
            collision_slide(&r.surfaces, at, to, &object);
            assert_true(is_within(to, scale));
            memcpy(at, to, sizeof at);
        }
        room_close(&r);
    }
}

/* Along a wall the eye goes on, towards it at an angle it slides, and straight
 * at it it stops, with the wall as the reason. */
static void walls_take_the_motion_towards_them(void **state)
{
    double from[3] = {0.5, 0, 0}, to[3] = {1.5, 0.8, 0}, on[3] = {3, 0.01, 0};
    uint32_t object = NO_INDEX;
    struct room r;

    (void)state;
    open_box(&r, 1);
    collision_slide(&r.surfaces, from, to, &object);
    check_close(to[1], 0.8, 1e-3);
    check_close(to[0], 1, 4e-3);
    assert_true(to[0] < 1);
    assert_true(collision_slide(&r.surfaces, from, on, &object));
    assert_true(on[0] < 1 && object != NO_INDEX);
    room_close(&r);
}

/* An eye that touches a wall, or is outside the room, is not held. */
static void nobody_is_trapped(void **state)
{
    static const double starts[][3] = {{1 - 1e-7, 0, 0},
                                       {1 + 1e-7, 0, 0},
                                       {1, 1, 1},
                                       {3, 0, 0}};
    struct room r;

    (void)state;
    open_box(&r, 1);
    for (int i = 0; i < 4; i++) {
        double way = i == 0 ? -0.5 : 0.5;
        double to[3] = {starts[i][0] + way, starts[i][1], starts[i][2]};
        uint32_t object;

        assert_false(collision_slide(&r.surfaces, starts[i], to, &object));
        check_close(to[0], starts[i][0] + way, 1e-2);
    }
    room_close(&r);
}

/* An orbit around a point near the wall keeps to the room and comes back to its
 * distance. */
static void orbits_stay_in_their_room(void **state)
{
    uint64_t seed = 2;

    (void)state;
    for (double scale = 1e-3; scale < 1e7; scale *= 1e3) {
        struct room r;

        open_box(&r, scale);
        for (int i = 0; i < 200; i++) {
            double pivot[3], eye[3], offset[3], distance;

            for (int k = 0; k < 3; k++) {
                pivot[k] = any(&seed, 0.9 * scale);
                eye[k] = any(&seed, 0.9 * scale);
            }
            vec3d_sub(eye, pivot, offset);
            distance = vec3d_length(offset);
            for (int step = 0; step < 100; step++) {
                double angle = any(&seed, 0.08), to[3];

                vec3d_sub(eye, pivot, offset);
                to[0] =
                    pivot[0] + cos(angle) * offset[0] + sin(angle) * offset[2];
                to[1] = eye[1];
                to[2] =
                    pivot[2] - sin(angle) * offset[0] + cos(angle) * offset[2];
                if (collision_orbit(&r.surfaces, pivot, distance, eye, to))
                    memcpy(eye, to, sizeof eye);
                assert_true(is_within(eye, scale));
            }
        }
        room_close(&r);
    }
}

/* Held keys at any speed do not leave a shipped room; with walls that let pass
 * they do. */
static void held_keys_stop_at_walls(void **state)
{
    (void)state;
    for (int passes = 0; passes < 2; passes++) {
        struct pose v = {.eye = {0, 0, 0.5},
                         .at = {0, 0, -1},
                         .up = {0, 1, 0},
                         .fovy_deg = 40};
        struct camera_input s;
        struct room r;

        open_box(&r, 1);
        camera_input_init(&s, r.scene.bounds_lo, r.scene.bounds_hi);
        camera_input_change_speed(&s, 20);
        s.walls = passes ? (struct surfaces){0} : r.surfaces;
        for (uint64_t i = 1; i < 200; i++) {
            uint64_t next, at_ns = i * UINT64_C(100000000);

            camera_input_begin(&s, at_ns);
            held_keys_press(&s.motion, HELD_KEYS_FORWARD, 1, at_ns);
            while ((next = held_keys_next_ns(&s.motion)) != UINT64_MAX)
                camera_input_step(&s, &v, next);
        }
        assert_true(is_within(v.eye, 1) == !passes);
        assert_true(s.is_stopped == !passes);
        room_close(&r);
    }
}

/* Returns the object of the first triangle between two points, or NO_INDEX: all
 * are tried. */
static uint32_t object_between(const struct room *r, const double from[3],
                               const double to[3])
{
    const struct scene *s = &r->scene;
    uint32_t object = NO_INDEX;
    double nearest = 0.999;

    for (uint32_t i = 0; i < s->tri_count; i++) {
        double p[3][3], e1[3], e2[3], d[3], n[3], o[3], q[3], det, u, v, t;

        for (int c = 0; c < 3; c++) {
            struct vec3 x = s->positions[s->tris[i].v[c]];
            const float xyz[3] = {x.x, x.y, x.z};

            for (int k = 0; k < 3; k++)
                p[c][k] = (double)xyz[k] / s->scale + s->center[k];
        }
        vec3d_sub(p[1], p[0], e1);
        vec3d_sub(p[2], p[0], e2);
        vec3d_sub(to, from, d);
        vec3d_sub(from, p[0], o);
        vec3d_cross(d, e2, n);
        det = vec3d_dot(e1, n);
        vec3d_cross(o, e1, q);
        u = vec3d_dot(o, n) / det;
        v = vec3d_dot(d, q) / det;
        t = vec3d_dot(e2, q) / det;
        if (u > 0 && v > 0 && u + v < 1 && t > 0 && t < nearest) {
            object = s->tri_objects[i];
            nearest = t;
        }
    }
    return object;
}

/* Returns the share of points that are seen, without those that only the object
 * itself hides. */
static double seen_share(const struct room *r, const struct framing *f,
                         const struct pose *pose)
{
    int seen = 0, hidden = 0;

    for (int i = 0; i < f->point_count; i++) {
        const double *p = f->points[i];
        uint32_t first = object_between(r, pose->eye, p);

        if (!camera_sees_box(pose, ASPECT, p, p))
            hidden++;
        else if (first == NO_INDEX)
            seen++;
        else if (first != f->object)
            hidden++;
    }
    return seen > 0 ? (double)seen / (seen + hidden) : 0;
}

/* Every object of rooms without glass is framed so that it is seen, and as much
 * of it as is said, by brute force. */
static void framed_objects_are_seen(void **state)
{
    static const char *const scenes[] = {"scenes/cornell.obj",
                                         "scenes/interior.obj"};

    (void)state;
    for (int k = 0; k < 2; k++) {
        struct room r;
        int hidden = 0;

        room_open(&r, scenes[k]);
        for (uint32_t object = 1; object < r.scene.object_count; object++) {
            struct pose pose = r.view.pose;
            struct framing f;
            double share;

            framing_init(&f, &r.surfaces, object, ASPECT);
            if (f.point_count == 0)
                continue;
            share = framing_find(&f, &pose);
            if (!(share > 0)) {
                hidden++;
                assert_memory_equal(&pose, &r.view.pose, sizeof pose);
                continue;
            }
            check_close(seen_share(&r, &f, &pose), share, 1e-9);
            if (k == 1) /* the camera of the room stays in it */
                assert_true(
                    surfaces_clearance(&r.surfaces, pose.eye).hit_share >=
                    CLEARANCE_ENCLOSED);
        }
        check_at_most(hidden, 0);
        room_close(&r);
    }
}

static char home[512];

static int set_up(void **state)
{
    return getcwd(home, sizeof home) != NULL && make_folder(state) == 0 ? 0
                                                                        : -1;
}

/* The tests that write files run in the folder. */
static int enter(void **state)
{
    (void)state;
    return chdir(folder);
}

static int leave(void **state)
{
    (void)state;
    return chdir(home);
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, enter, leave)

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_FOLDER(walks_stay_in_their_room),
        IN_FOLDER(walls_take_the_motion_towards_them),
        IN_FOLDER(nobody_is_trapped),
        IN_FOLDER(orbits_stay_in_their_room),
        IN_FOLDER(held_keys_stop_at_walls),
        cmocka_unit_test(framed_objects_are_seen),
    };

    return cmocka_run_group_tests(tests, set_up, remove_folder);
}
