// SPDX-License-Identifier: MIT
#include "tests/unit/check.h"
#include "tests/unit/mesh.h"

#include <math.h>

#include "world/bvh/ray_queries.h"

static float span(uint64_t *seed)
{
    return (float)(2 * check_random(seed) - 1);
}

static struct vec3 point(uint64_t *seed)
{
    float x = span(seed), y = span(seed), z = span(seed);

    return v3(x, y, z);
}

struct exact {
    long double t, u, v; /* weights of p1 and p2 */
};

/* The plane equation in long double (Moller and Trumbore 1997). */
static struct exact intersect(struct ray r, struct vec3 p0, struct vec3 p1,
                              struct vec3 p2)
{
    long double o[3] = {r.o.x, r.o.y, r.o.z}, d[3] = {r.d.x, r.d.y, r.d.z};
    long double a[3] = {p0.x, p0.y, p0.z};
    long double e[3] = {p1.x - a[0], p1.y - a[1], p1.z - a[2]};
    long double f[3] = {p2.x - a[0], p2.y - a[1], p2.z - a[2]};
    long double s[3] = {o[0] - a[0], o[1] - a[1], o[2] - a[2]};
    long double p[3] = {d[1] * f[2] - d[2] * f[1], d[2] * f[0] - d[0] * f[2],
                        d[0] * f[1] - d[1] * f[0]};
    long double q[3] = {s[1] * e[2] - s[2] * e[1], s[2] * e[0] - s[0] * e[2],
                        s[0] * e[1] - s[1] * e[0]};
    long double det = e[0] * p[0] + e[1] * p[1] + e[2] * p[2];
    struct exact x = {(f[0] * q[0] + f[1] * q[1] + f[2] * q[2]) / det,
                      (s[0] * p[0] + s[1] * p[1] + s[2] * p[2]) / det,
                      (d[0] * q[0] + d[1] * q[1] + d[2] * q[2]) / det};

    return x;
}

/* Clear hits have the right distance and weights, and clear misses are
 * misses. */
static void hits_agree_with_long_double(void **state)
{
    uint64_t seed = 1;
    int hits = 0, misses = 0;

    (void)state;
    for (int i = 0; i < 1000000; i++) {
        struct vec3 p0 = point(&seed), p1 = point(&seed), p2 = point(&seed);
        struct ray r = {point(&seed), v3_unit(point(&seed)), FLOAT_MAX, 0, 0};
        struct exact x = intersect(r, p0, p1, p2);
        struct hit h;
        bool found = triangle_hit(r, shear_of(r),
                                  (struct leaf_tri){p0, p1, p2, NO_INDEX},
                                  FLOAT_MAX, &h);
        const long double edge = 1e-3L;

        if (x.t > edge && x.u > edge && x.v > edge && x.u + x.v < 1 - edge) {
            struct vec3 n = v3_cross(v3_sub(p1, p0), v3_sub(p2, p0));
            double slope = fabs((double)v3_dot(v3_unit(n), r.d));

            assert_true(found);
            check_close(h.t, (double)x.t, 2e-6 / slope);
            check_close(h.b0 + h.b1 + h.b2, 1, 1e-6);
            check_close(h.b1 * p1.x + h.b2 * p2.x + h.b0 * p0.x,
                        (double)(r.o.x + x.t * r.d.x), 2e-6 / slope);
            hits++;
        } else if (x.t < -edge || x.u < -edge || x.v < -edge ||
                   x.u + x.v > 1 + edge) {
            assert_false(found);
            misses++;
        }
    }
    assert_true(hits > 20000 && misses > 500000);
}

/* Rays aimed at a triangle hit it, except at edges, at the exact distance of
 * triangle_hit() and never behind the origin. */
static void aimed_rays_end_at_the_triangle(void **state)
{
    uint64_t seed = 9;
    int missed = 0;

    (void)state;
    for (int i = 0; i < 200000; i++) {
        struct vec3 p0 = point(&seed), p1 = point(&seed), p2 = point(&seed);
        float u = (float)check_random(&seed), v = (float)check_random(&seed);
        struct hit h = {0.0f, 1.0f - f_max(u, v), f_min(u, v), 0.0f, 0};
        struct vec3 o = point(&seed), error;
        struct ray r = {o, o, FLOAT_MAX, 0, 0};
        float t;

        h.b2 = f_max(u, v) - f_min(u, v);
        if (i % 2 == 0)
            p1.y = p2.y = p0.y;
        r.d = v3_sub(hit_point(h, p0, p1, p2, &error), r.o);
        t = aimed_distance(r, p0, p1, p2);
        check_close(t, (double)intersect(r, p0, p1, p2).t, 1e-3);
        if (triangle_hit(r, shear_of(r),
                         (struct leaf_tri){p0, p1, p2, NO_INDEX}, FLOAT_MAX,
                         &h))
            assert_true(h.t == t);
        else
            missed++;
        r.d = v3_neg(r.d);
        assert_true(!(aimed_distance(r, p0, p1, p2) > 0.0f));
    }
    check_at_most(missed, 20);
}

/* STRESS G4: hits of needles are on the needle, whatever the weights are. */
static void needles_are_hit_where_they_are(void **state)
{
    uint64_t seed = 6;
    int hits = 0;

    (void)state;
    for (int i = 0; i < 300000; i++) {
        float width = powf(10.0f, -4.0f - 3.0f * (float)check_random(&seed));
        struct vec3 a = point(&seed), b = point(&seed);
        struct vec3 c = v3_add(a, v3_scale(point(&seed), width));
        struct vec3 at = v3_lerp(a, b, (float)check_random(&seed));
        struct ray r = {point(&seed), {0, 0, 0}, FLOAT_MAX, 0, 0};
        struct hit h;

        if (i % 3 == 0) /* nearly along the needle */
            r.o =
                v3_add(v3_add(a, v3_sub(a, b)), v3_scale(point(&seed), width));
        r.d = v3_unit(v3_sub(at, r.o));
        if (!triangle_hit(r, shear_of(r), (struct leaf_tri){a, b, c, NO_INDEX},
                          FLOAT_MAX, &h))
            continue;
        at = v3_add(r.o, v3_scale(r.d, h.t));
        hits++;
        for (uint32_t k = 0; k < 3; k++) {
            float lo =
                f_min(v3_axis(a, k), f_min(v3_axis(b, k), v3_axis(c, k)));
            float hi =
                f_max(v3_axis(a, k), f_max(v3_axis(b, k), v3_axis(c, k)));

            check_at_most(v3_axis(at, k), (double)hi + 1e-4);
            check_at_most(lo, (double)v3_axis(at, k) + 1e-4);
        }
    }
    assert_true(hits > 50000);
}

/* STRESS G6, M12: overlapping faces in one plane across an axis have equal
 * distances. */
static void faces_in_one_plane_have_equal_distances(void **state)
{
    uint64_t seed = 7;
    int hits = 0;

    (void)state;
    for (int i = 0; i < 300000; i++) {
        struct vec3 p[6];
        struct ray r = {point(&seed), {0, 0, 0}, FLOAT_MAX, 0, 0};
        float plane = span(&seed);
        struct hit one, other;

        for (int k = 0; k < 6; k++) {
            p[k] = point(&seed);
            *(i % 3 == 0 ? &p[k].x : i % 3 == 1 ? &p[k].y : &p[k].z) = plane;
        }
        r.d = v3_add(p[0], v3_add(p[1], p[2]));
        r.d = v3_unit(v3_sub(v3_scale(r.d, 1 / 3.0f), r.o));
        if (!triangle_hit(r, shear_of(r),
                          (struct leaf_tri){p[0], p[1], p[2], NO_INDEX},
                          FLOAT_MAX, &one) ||
            !triangle_hit(r, shear_of(r),
                          (struct leaf_tri){p[3], p[4], p[5], NO_INDEX},
                          FLOAT_MAX, &other))
            continue;
        hits++;
        assert_true(one.t == other.t);
    }
    assert_true(hits > 1000);
}

/* A face and its copy of the opposite winding have equal distances. */
static void both_windings_have_equal_distances(void **state)
{
    uint64_t seed = 8;
    int hits = 0;

    (void)state;
    for (int i = 0; i < 300000; i++) {
        /* Every other triangle is a needle, with equal distances in pairs of
         * floats. */
        struct vec3 a = point(&seed), b = point(&seed);
        struct vec3 c = i % 2 == 0 ? point(&seed)
                                   : v3_add(a, v3_scale(point(&seed), 1e-5f));
        struct ray r = {point(&seed), {0, 0, 0}, FLOAT_MAX, 0, 0};
        struct hit one, other;

        r.d = v3_unit(v3_sub(v3_lerp(v3_lerp(a, b, 0.4f), c, 0.3f), r.o));
        if (!triangle_hit(r, shear_of(r), (struct leaf_tri){a, b, c, NO_INDEX},
                          FLOAT_MAX, &one))
            continue;
        hits++;
        assert_true(triangle_hit(r, shear_of(r),
                                 (struct leaf_tri){a, c, b, NO_INDEX},
                                 FLOAT_MAX, &other));
        assert_true(one.t == other.t && one.b0 == other.b0 &&
                    one.b1 == other.b2 && one.b2 == other.b1);
    }
    assert_true(hits > 200000);
}

/* STRESS G12: no ray leaves a closed mesh from inside, whether aimed at
 * vertices, at edges or anywhere. */
static void closed_meshes_do_not_leak(void **state)
{
    struct mesh m = {0};
    uint64_t seed = 2;
    struct hit h;

    (void)state;
    mesh_add_sphere(&m, v3(0.01f, 0.02f, -0.03f), 0.9f, 20, 30, 0);
    mesh_finish(&m);
    for (int i = 0; i < 1000000; i++) {
        struct tri t = m.tris[(uint32_t)(check_random(&seed) * m.tri_count)];
        struct vec3 a = m.positions[t.v[0]], b = m.positions[t.v[1]];
        float s = i % 3 == 0 ? 0.0f : (float)check_random(&seed);
        struct ray r = {
            v3_scale(point(&seed), 0.45f), {0, 0, 0}, FLOAT_MAX, 0, 0};
        struct vec3 at = i % 7 == 0 ? point(&seed) : v3_lerp(a, b, s);

        r.d = v3_unit(v3_sub(at, r.o));
        assert_true(hit_closest(&m.world, r, &h));
    }
    mesh_free(&m);
}

/* A ray that continues inwards from an edge or a corner of a box stays
 * inside. */
static void edges_are_left_inwards(void **state)
{
    struct mesh m = {0};
    uint64_t seed = 6;

    (void)state;
    mesh_add_box(&m, v3(-0.7f, -0.7f, -0.7f), v3(0.7f, 0.7f, 0.7f), 0);
    mesh_finish(&m);
    for (int i = 0; i < 300000; i++) {
        struct tri t = m.tris[(uint32_t)(check_random(&seed) * m.tri_count)];
        struct vec3 at =
            v3_lerp(m.positions[t.v[0]], m.positions[t.v[1]],
                    i % 3 == 0 ? 0.0f : (float)check_random(&seed));
        struct ray r = {
            v3_scale(point(&seed), 0.69f), {0, 0, 0}, FLOAT_MAX, 0, 0};
        struct vec3 p, ng, error;
        struct hit h;

        r.d = v3_unit(v3_sub(at, r.o));
        assert_true(hit_closest(&m.world, r, &h));
        t = m.tris[h.tri];
        p = hit_point_inset(h, m.positions[t.v[0]], m.positions[t.v[1]],
                            m.positions[t.v[2]], &error);
        assert_true(triangle_normal(m.positions[t.v[0]], m.positions[t.v[1]],
                                    m.positions[t.v[2]], &ng));
        ng = v3_neg(ng); /* a box is wound outwards */
        r.d = v3_unit(point(&seed));
        r.d = v3_dot(r.d, ng) < 0 ? v3_neg(r.d) : r.d;
        r.o = offset_ray_origin(p, error, ng);
        assert_true(hit_closest(&m.world, r, &h));
    }
    mesh_free(&m);
}

/* A normal does not depend on the triangle's size, down to the smallest floats,
 * nor on the ratio of its edges as long as that is a float. */
static void normals_do_not_depend_on_size(void **state)
{
    uint64_t seed = 9;

    (void)state;
    for (int k = 40; k >= -149; k--)
        for (int j = k; j >= -149 && j > k - 149; j -= 7) {
            float a = ldexpf(1, k), b = ldexpf(1, j);
            const struct vec3 o = {0, 0, 0}, z = {0, 0, b};
            struct vec3 ng = o;

            assert_true(triangle_normal(v3(a, 0, 0), o, z, &ng));
            assert_true(ng.x == 0 && ng.y == 1 && ng.z == 0);
            assert_true(triangle_normal(o, z, v3(a, 0, 0), &ng));
            assert_true(ng.x == 0 && ng.y == 1 && ng.z == 0);
        }
    for (int i = 0; i < 1000; i++) {
        struct vec3 p[3], ng, small;

        for (int k = 0; k < 3;
             k++) /* few digits, so that small triangles are exact */
            p[k] = v3(roundf(point(&seed).x * 64), roundf(point(&seed).y * 64),
                      roundf(point(&seed).z * 64));
        if (!triangle_normal(p[0], p[1], p[2], &ng))
            continue;
        for (int k = 0; k < 3; k++)
            p[k] = v3_scale(p[k], 0x1p-149f);
        assert_true(triangle_normal(p[0], p[1], p[2], &small));
        assert_memory_equal(&ng, &small, sizeof ng);
    }
}

static void nothing_else_has_a_normal(void **state)
{
    const struct vec3 o = {0, 0, 0}, x = {1, 0, 0}, y = {0, 1, 0};
    const float wrong[] = {NAN, INFINITY, -INFINITY};
    struct vec3 ng;

    (void)state;
    assert_false(triangle_normal(o, o, o, &ng));
    assert_false(triangle_normal(o, x, x, &ng));
    assert_false(triangle_normal(o, x, v3_scale(x, 0x1p-149f), &ng));
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        for (int k = 0; k < 9; k++) {
            struct vec3 p[3] = {o, x, y};

            (&p[0].x)[k] = wrong[i];
            assert_false(triangle_normal(p[0], p[1], p[2], &ng));
        }
}

/* A ray that leaves a face does not hit it again, and hits the opposite face,
 * for all angles, sizes and places. */
static void no_ray_hits_its_own_face(void **state)
{
    uint64_t seed = 3;

    (void)state;
    for (int i = 0; i < 2000000; i++) {
        float size = powf(10.0f, -5.0f + 5.0f * (float)check_random(&seed));
        struct vec3 base = v3_scale(point(&seed), 1 - size);
        struct vec3 p0 = v3_add(base, v3_scale(point(&seed), size));
        struct vec3 p1 = v3_add(base, v3_scale(point(&seed), size));
        struct vec3 p2 = v3_add(base, v3_scale(point(&seed), size));
        struct ray in, out;
        struct vec3 ng, error, p, t, b;
        struct hit h, again;
        double angle = 2 * M_PI * check_random(&seed);
        /* Half of the directions are within a thousandth of the plane. */
        double z = i % 2 ? check_random(&seed) : 1e-3 * check_random(&seed);
        double rest = sqrt(1 - z * z);
        float u = (float)check_random(&seed), v = (float)check_random(&seed);
        struct vec3 aim;

        if (!triangle_normal(p0, p1, p2, &ng))
            continue;
        if (u + v > 1)
            u = 1 - u, v = 1 - v;
        aim = v3_add(v3_scale(p0, 1 - u - v),
                     v3_add(v3_scale(p1, u), v3_scale(p2, v)));
        in.o = v3_scale(point(&seed), 1.5f);
        in.d = v3_unit(v3_sub(aim, in.o));
        if (!triangle_hit(in, shear_of(in),
                          (struct leaf_tri){p0, p1, p2, NO_INDEX}, FLOAT_MAX,
                          &h))
            continue;
        p = hit_point_inset(h, p0, p1, p2, &error);
        frame_around(ng, &t, &b);
        out.d = v3_add(v3_add(v3_scale(t, (float)(rest * cos(angle))),
                              v3_scale(b, (float)(rest * sin(angle)))),
                       v3_scale(ng, (float)z));
        out.d = v3_unit(out.d);
        if (!(v3_dot(out.d, ng) > 0))
            continue;
        out.o = offset_ray_origin(p, error, ng);
        assert_false(triangle_hit(out, shear_of(out),
                                  (struct leaf_tri){p0, p1, p2, NO_INDEX},
                                  FLOAT_MAX, &again));
    }
}

/* STRESS G17: rays that leave a sheet hit another one 1e-5 above it. */
static void near_sheets_are_both_hit(void **state)
{
    uint64_t seed = 4;

    (void)state;
    for (int i = 0; i < 200000; i++) {
        struct vec3 p0 = point(&seed), p1 = point(&seed), p2 = point(&seed);
        struct vec3 ng, error, p, t, b;
        struct vec3 q0, q1, q2;
        struct ray in, out;
        struct hit h;
        double angle = 2 * M_PI * check_random(&seed);
        double z = 0.05 + 0.95 * check_random(&seed);
        double rest = sqrt(1 - z * z);

        if (!triangle_normal(p0, p1, p2, &ng) ||
            v3_length(v3_cross(v3_sub(p1, p0), v3_sub(p2, p0))) < 0.1f)
            continue;
        in.o = v3_scale(point(&seed), 1.5f);
        in.d = v3_unit(
            v3_sub(v3_scale(v3_add(p0, v3_add(p1, p2)), 1 / 3.0f), in.o));
        if (!triangle_hit(in, shear_of(in),
                          (struct leaf_tri){p0, p1, p2, NO_INDEX}, FLOAT_MAX,
                          &h))
            continue;
        p = hit_point_inset(h, p0, p1, p2, &error);
        q0 = v3_add(p0, v3_scale(ng, 1e-5f));
        q1 = v3_add(p1, v3_scale(ng, 1e-5f));
        q2 = v3_add(p2, v3_scale(ng, 1e-5f));
        frame_around(ng, &t, &b);
        out.o = offset_ray_origin(p, error, ng);
        out.d = v3_unit(v3_add(v3_add(v3_scale(t, (float)(rest * cos(angle))),
                                      v3_scale(b, (float)(rest * sin(angle)))),
                               v3_scale(ng, (float)z)));
        assert_true(triangle_hit(out, shear_of(out),
                                 (struct leaf_tri){q0, q1, q2, NO_INDEX},
                                 FLOAT_MAX, &h));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hits_agree_with_long_double),
        cmocka_unit_test(aimed_rays_end_at_the_triangle),
        cmocka_unit_test(needles_are_hit_where_they_are),
        cmocka_unit_test(faces_in_one_plane_have_equal_distances),
        cmocka_unit_test(both_windings_have_equal_distances),
        cmocka_unit_test(closed_meshes_do_not_leak),
        cmocka_unit_test(edges_are_left_inwards),
        cmocka_unit_test(normals_do_not_depend_on_size),
        cmocka_unit_test(nothing_else_has_a_normal),
        cmocka_unit_test(no_ray_hits_its_own_face),
        cmocka_unit_test(near_sheets_are_both_hit),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
