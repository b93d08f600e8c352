// SPDX-License-Identifier: MIT
/*
 * rays - properties of rays, for more rays than unit tests have time for
 *
 * No ray may leak, hit the face it leaves, or find another triangle than brute
 * force. These rows have no false alarms. The seeds are fixed.
 *
 * usage: rays [FACTOR]
 *
 * Closed meshes get 1e8 rays times the factor.
 */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/thread_pool.h"
#include "rows.h"
#include "tests/unit/brute.h"
#include "tests/unit/mesh.h"

#include "world/bvh/ray_queries.h"
#include "kernels/surface_point.h"

/* An item of work is this many rays with a seed of its own. */
#define CHUNK 100000

struct shots {
    const struct world *world;
    struct vec3 center;
    float size; /* size of the target, around the centre */
    atomic_uint_least64_t shot;
    atomic_uint_least64_t bad;
};

static struct pool *pool;
static uint32_t factor = 1;

/* Counts rays, and rays that fail, over `chunks` items. */
static void shoot(struct shots *s, pool_job *job, uint32_t chunks)
{
    struct cancel none = {0};

    atomic_store(&s->shot, 0);
    atomic_store(&s->bad, 0);
    pool_run(pool, chunks, job, s, &none);
}

static unsigned long long count_of(atomic_uint_least64_t *n)
{
    return (unsigned long long)atomic_load(n);
}

/* Returns a unit vector that is uniform on the sphere. */
static struct vec3 direction(uint64_t *seed)
{
    double z = 2 * check_random(seed) - 1;
    double angle = 2 * M_PI * check_random(seed);
    double rest = sqrt(1 - z * z);

    return v3_unit(
        v3((float)(rest * cos(angle)), (float)(rest * sin(angle)), (float)z));
}

/* Returns whether the tree finds the hit of brute force. */
static bool agrees(const struct world *w, struct ray r)
{
    struct hit a, b;
    bool found = brute_force(w, r, &a);

    if (hit_closest(w, r, &b) != found || hit_any(w, r, NO_INDEX) != found)
        return false;
    return !found || (a.tri == b.tri && a.t == b.t && a.b0 == b.b0);
}

/* Returns a ray from inside to a vertex, along an edge, or to a point of an
 * edge. */
static struct ray ray_to_edge(const struct shots *s, int i, uint64_t *seed)
{
    const struct world *w = s->world;
    struct tri t =
        w->tris[(uint32_t)(check_random(seed) * w->settings.tri_count)];
    struct vec3 a = w->positions[t.v[0]], b = w->positions[t.v[1]];
    struct vec3 c = w->positions[t.v[2]];
    float f = i % 3 == 0 ? 0.0f : (float)check_random(seed);
    struct vec3 at = i % 2 ? v3_lerp(a, b, f) : v3_lerp(b, c, f);
    struct ray r = {{0, 0, 0}, {0, 0, 0}, FLOAT_MAX, 0, 0};

    r.o = v3_add(s->center, random_point(seed, s->size));
    r.d = v3_unit(v3_sub(at, r.o));
    return r;
}

/* G12: rays at edges and vertices hit something. */
static void aim_at_edges(void *context, uint32_t item, int worker)
{
    struct shots *s = context;
    uint64_t seed = item;
    uint64_t bad = 0;

    (void)worker;
    for (int i = 0; i < CHUNK; i++) {
        struct hit h;

        bad += !hit_closest(s->world, ray_to_edge(s, i, &seed), &h);
    }
    atomic_fetch_add(&s->shot, CHUNK);
    atomic_fetch_add(&s->bad, bad);
}

/* G12: a ray that leaves an edge or a vertex inwards hits something. */
static void leave_edges(void *context, uint32_t item, int worker)
{
    struct shots *s = context;
    const struct material m = material_default();
    uint64_t seed = item;
    uint64_t shot = 0, bad = 0;

    (void)worker;
    for (int i = 0; i < CHUNK; i++) {
        struct ray r = ray_to_edge(s, i, &seed);
        struct surface_point v;
        struct hit h;

        if (!hit_closest(s->world, r, &h) ||
            !surface_at(s->world, &m, r, h, &v))
            continue;
        r.d = direction(&seed);
        if (v3_dot(r.d, v.ng) < 0)
            r.d = v3_neg(r.d);
        r.o = surface_ray_origin(&v, 1);
        shot++;
        bad += !hit_closest(s->world, r, &h);
    }
    atomic_fetch_add(&s->shot, shot);
    atomic_fetch_add(&s->bad, bad);
}

/* Adds a star like an octahedron, whose spikes are 100 times as long as
 * wide. */
static void add_star(struct mesh *m)
{
    const int rows = 40, columns = 60;
    struct mesh ball = {0};

    mesh_add_sphere(&ball, v3(0, 0, 0), 1.0f, rows, columns, 0);
    for (uint32_t i = 0; i < ball.tri_count; i++) {
        struct vec3 p[3];

        for (int k = 0; k < 3; k++) {
            struct vec3 unit = ball.positions[ball.tris[i].v[k]];
            /* This is a function of the vertex, so that neighbours agree. */
            uint32_t hash = hash_u32(
                float_bits(unit.x) ^
                hash_u32(float_bits(unit.y) ^ hash_u32(float_bits(unit.z))));

            p[k] = v3_scale(unit, hash % 4 == 0 ? 0.9f : 0.02f);
        }
        mesh_add(m, p[0], p[1], p[2], 0);
    }
    mesh_free(&ball);
}

/* Points on edges with a dihedral angle of a few degrees, like the star's, may
 * be outside by rounding. Rays from those are left out. */
static void closed_mesh(const char *name, struct mesh *m, struct vec3 center,
                        float inside, bool has_knife_edges)
{
    struct shots s = {.world = &m->world, .center = center, .size = inside};

    mesh_finish(m);
    shoot(&s, aim_at_edges, 200 * factor);
    row(atomic_load(&s.bad) == 0, name,
        "%llu rays from within to edges and vertices, leaks: %llu, want 0",
        count_of(&s.shot), count_of(&s.bad));
    if (!has_knife_edges) {
        shoot(&s, leave_edges, 30 * factor);
        row(atomic_load(&s.bad) == 0, name,
            "%llu rays that go on from there, leaks: %llu, want 0",
            count_of(&s.shot), count_of(&s.bad));
    }
    mesh_free(m);
}

/* Adds a box around the origin that is parallel to no axis. */
static void add_turned_box(struct mesh *m, float half)
{
    struct vec3 t, b, n = v3_unit(v3(0.3f, 0.5f, 0.9f));

    frame_around(n, &t, &b);
    mesh_add_box(m, v3(-half, -half, -half), v3(half, half, half), 0);
    for (uint32_t i = 0; i < 3 * m->tri_count; i++) {
        struct vec3 p = m->positions[i];

        m->positions[i] = v3_add(v3_add(v3_scale(t, p.x), v3_scale(b, p.y)),
                                 v3_scale(n, p.z));
    }
}

static void closed_meshes(void)
{
    struct mesh box = {0}, turned = {0}, ball = {0}, fine = {0}, star = {0};
    struct mesh slab = {0}, speck = {0};
    const struct vec3 origin = {0, 0, 0}, aside = {0.7f, -0.3f, 0.5f};
    const struct vec3 half = {1e-5f, 1e-5f, 1e-5f};

    mesh_add_box(&box, v3(-0.7f, -0.7f, -0.7f), v3(0.7f, 0.7f, 0.7f), 0);
    closed_mesh("G12 box", &box, origin, 0.69f, false);
    add_turned_box(&turned, 0.5f);
    closed_mesh("G12 turned box", &turned, origin, 0.25f, false);
    mesh_add_sphere(&ball, v3(0.01f, 0.02f, -0.03f), 0.9f, 20, 30, 0);
    closed_mesh("G12 ball", &ball, origin, 0.45f, false);
    mesh_add_sphere(&fine, v3(0.01f, 0.02f, -0.03f), 0.9f, 300, 500, 0);
    closed_mesh("G12 fine ball", &fine, origin, 0.45f, false);
    add_star(&star);
    closed_mesh("G12 star of needles", &star, origin, 0.005f, true);
    mesh_add_box(&slab, v3(-1, -1e-5f, -1), v3(1, 1e-5f, 1), 0);
    closed_mesh("G12 G18 slab of 1e-5", &slab, origin, 0.9e-5f, false);
    mesh_add_box(&speck, v3_sub(aside, half), v3_add(aside, half), 0);
    closed_mesh("G12 G15 box of 1e-5", &speck, aside, 0.9e-5f, false);
}

/* A triangle, a hit point on it, and the point's error. */
struct place {
    struct vec3 p[3];
    struct vec3 ng, at, error;
};

static bool land(uint64_t *seed, float size, struct place *x)
{
    struct vec3 base = random_point(seed, 1.0f);
    float u = (float)check_random(seed), v = (float)check_random(seed);
    struct ray r = {
        v3_scale(random_point(seed, 1.5f), size), {0, 0, 0}, FLOAT_MAX, 0, 0};
    float part = powf(10.0f, -5.0f * (float)check_random(seed));
    struct vec3 aim;
    struct hit h;

    for (int k = 0; k < 3; k++)
        x->p[k] =
            v3_scale(v3_add(v3_scale(base, 1 - part), random_point(seed, part)),
                     size);
    if (!triangle_normal(x->p[0], x->p[1], x->p[2], &x->ng))
        return false;
    if (u + v > 1)
        u = 1 - u, v = 1 - v;
    aim = v3_add(v3_scale(x->p[0], 1 - u - v),
                 v3_add(v3_scale(x->p[1], u), v3_scale(x->p[2], v)));
    r.d = v3_unit(v3_sub(aim, r.o));
    if (!triangle_hit(r, shear_of(r),
                      (struct leaf_tri){x->p[0], x->p[1], x->p[2], NO_INDEX},
                      FLOAT_MAX, &h))
        return false;
    x->at = hit_point_inset(h, x->p[0], x->p[1], x->p[2], &x->error);
    return true;
}

/* Half of the directions are within a thousandth of the face's plane. */
static void leave_faces(void *context, uint32_t item, int worker)
{
    struct shots *s = context;
    uint64_t seed = item;
    uint64_t shot = 0, bad = 0;

    (void)worker;
    for (int i = 0; i < CHUNK; i++) {
        struct place x;
        struct hit h;
        struct ray r = {{0, 0, 0}, {0, 0, 0}, FLOAT_MAX, 0, 0};
        float nearness = i % 2 ? 1.0f : 1e-3f;

        if (!land(&seed, s->size, &x))
            continue;
        r.d = direction(&seed);
        r.d = v3_unit(
            v3_sub(r.d, v3_scale(x.ng, (1 - nearness) * v3_dot(r.d, x.ng))));
        if (v3_dot(r.d, x.ng) == 0.0f)
            continue;
        r.o = offset_ray_origin(x.at, x.error,
                                v3_dot(r.d, x.ng) > 0 ? x.ng : v3_neg(x.ng));
        shot++;
        bad += triangle_hit(r, shear_of(r),
                            (struct leaf_tri){x.p[0], x.p[1], x.p[2], NO_INDEX},
                            FLOAT_MAX, &h);
    }
    atomic_fetch_add(&s->shot, shot);
    atomic_fetch_add(&s->bad, bad);
}

static void self_hits(void)
{
    for (int exponent = -5; exponent <= 5; exponent++) {
        struct shots s = {.size = powf(10.0f, (float)exponent)};

        shoot(&s, leave_faces, 40);
        row(atomic_load(&s.bad) == 0, "G15 G16 self-hits",
            "scale 1e%+d, %llu rays that leave a face, self-hits: %llu, want 0",
            exponent, count_of(&s.shot), count_of(&s.bad));
    }
}

/* Returns the distance of p from the box around the triangle. */
static double outside(struct vec3 p, const struct vec3 t[3])
{
    double worst = 0;

    for (uint32_t k = 0; k < 3; k++) {
        float a = v3_axis(t[0], k), b = v3_axis(t[1], k), c = v3_axis(t[2], k);
        float x = v3_axis(p, k);

        worst = fmax(worst, (double)(f_min(a, f_min(b, c)) - x));
        worst = fmax(worst, (double)(x - f_max(a, f_max(b, c))));
    }
    return worst;
}

/* G4: aspect ratios of 1e4 to 1e7; a third of the rays are nearly along the
 * needle. */
static void hit_needles(void *context, uint32_t item, int worker)
{
    struct shots *s = context;
    uint64_t seed = item;
    uint64_t shot = 0, bad = 0;

    (void)worker;
    for (int i = 0; i < CHUNK; i++) {
        float width = powf(10.0f, -4.0f - 3.0f * (float)check_random(&seed));
        struct vec3 a = random_point(&seed, 0.9f),
                    b = random_point(&seed, 0.9f);
        struct vec3 t[3] = {a, b, v3_add(a, random_point(&seed, width))};
        struct vec3 at = v3_lerp(a, b, (float)check_random(&seed));
        struct ray r = {random_point(&seed, 1.5f), {0, 0, 0}, FLOAT_MAX, 0, 0};
        struct hit h;

        if (i % 3 == 0)
            r.o = v3_add(v3_add(a, v3_sub(a, b)), random_point(&seed, width));
        r.d = v3_unit(v3_sub(at, r.o));
        if (!triangle_hit(r, shear_of(r),
                          (struct leaf_tri){t[0], t[1], t[2], NO_INDEX},
                          FLOAT_MAX, &h))
            continue;
        shot++;
        bad += outside(v3_add(r.o, v3_scale(r.d, h.t)), t) > 1e-4;
    }
    atomic_fetch_add(&s->shot, shot);
    atomic_fetch_add(&s->bad, bad);
}

static void needles(void)
{
    struct shots s = {.size = 1};

    shoot(&s, hit_needles, 100);
    row(atomic_load(&s.bad) == 0 && atomic_load(&s.shot) > 10000, "G4 needles",
        "%llu hits of aspects 1e4 to 1e7, further than 1e-4 from the box: "
        "%llu, want 0",
        count_of(&s.shot), count_of(&s.bad));
}

/* G17: rays go from one sheet to another 1e-5 above it. */
static void cross_gaps(void *context, uint32_t item, int worker)
{
    struct shots *s = context;
    uint64_t seed = item;
    uint64_t shot = 0, bad = 0;

    (void)worker;
    for (int i = 0; i < CHUNK; i++) {
        struct vec3 p[3] = {random_point(&seed, 1), random_point(&seed, 1),
                            random_point(&seed, 1)};
        struct vec3 middle =
            v3_scale(v3_add(p[0], v3_add(p[1], p[2])), 1 / 3.0f);
        struct ray r = {random_point(&seed, 1.5f), {0, 0, 0}, FLOAT_MAX, 0, 0};
        struct vec3 ng, error, at, lift;
        struct hit h;

        if (!triangle_normal(p[0], p[1], p[2], &ng) ||
            v3_length(v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]))) < 0.1f)
            continue;
        r.d = v3_unit(v3_sub(middle, r.o));
        if (!triangle_hit(r, shear_of(r),
                          (struct leaf_tri){p[0], p[1], p[2], NO_INDEX},
                          FLOAT_MAX, &h))
            continue;
        at = hit_point_inset(h, p[0], p[1], p[2], &error);
        r.o = offset_ray_origin(at, error, ng);
        r.d = direction(&seed);
        if (v3_dot(r.d, ng) < 0.05f) /* shallower ones may miss the border */
            continue;
        lift = v3_scale(ng, 1e-5f);
        shot++;
        bad += !triangle_hit(r, shear_of(r),
                             (struct leaf_tri){v3_add(p[0], lift),
                                               v3_add(p[1], lift),
                                               v3_add(p[2], lift), NO_INDEX},
                             FLOAT_MAX, &h);
    }
    atomic_fetch_add(&s->shot, shot);
    atomic_fetch_add(&s->bad, bad);
}

static void near_sheets(void)
{
    struct shots s = {.size = 1};

    shoot(&s, cross_gaps, 100);
    row(atomic_load(&s.bad) == 0, "G17 near sheets",
        "%llu rays over a gap of 1e-5, missed: %llu, want 0", count_of(&s.shot),
        count_of(&s.bad));
}

/* Compares random rays, of which every fourth begins at a vertex. */
static void compare(const char *name, const char *what, struct mesh *m,
                    int rays)
{
    uint64_t seed = 1;
    int bad = 0;

    mesh_finish(m);
    for (int i = 0; i < rays; i++) {
        struct ray r = {random_point(&seed, 1.5f), {0, 0, 0}, FLOAT_MAX, 0, 0};
        struct vec3 at = random_point(&seed, 0.7f);

        if (i % 4 == 0)
            at = m->positions[(uint32_t)(check_random(&seed) * 3 *
                                         m->tri_count)];
        r.d = v3_unit(v3_sub(at, r.o));
        bad += !agrees(&m->world, r);
    }
    row(bad == 0 && !m->tree.lacks_copies, name,
        "%s: %d rays unlike brute force: %d, want 0", what, rays, bad);
    mesh_free(m);
}

/* G13: rays along an axis, with zeros of both signs, begin in the planes of
 * boxes. */
static void axis_rays(void)
{
    struct mesh m = {0};
    uint64_t seed = 7;
    int bad = 0;
    const int rays = 1000000;

    for (int i = 0; i < 64; i++) {
        float x = (float)(i % 4) * 0.25f - 0.5f;
        float y = (float)(i / 4 % 4) * 0.25f - 0.5f;
        float z = (float)(i / 16) * 0.25f - 0.5f;

        mesh_add_box(&m, v3(x, y, z), v3(x + 0.125f, y + 0.25f, z + 0.125f), 0);
    }
    mesh_finish(&m);
    for (int i = 0; i < rays; i++) {
        struct vec3 o = random_point(&seed, 1.0f);
        float zero = i & 1 ? -0.0f : 0.0f, one = i & 2 ? -1.0f : 1.0f;
        struct ray r = {o, {0, 0, 0}, FLOAT_MAX, 0, 0};

        if (i & 4) /* in a plane of the grid */
            r.o = v3(roundf(o.x * 8) / 8, roundf(o.y * 8) / 8, o.z);
        r.d = i % 3 == 0   ? v3(one, zero, -zero)
              : i % 3 == 1 ? v3(zero, one, zero)
                           : v3(-zero, zero, one);
        bad += !agrees(&m.world, r);
    }
    row(bad == 0, "G13 rays along axes",
        "%d rays with zeros of both signs, unlike brute force: %d, want 0",
        rays, bad);
    mesh_free(&m);
}

static void add_needle(struct mesh *m, uint64_t *seed)
{
    struct vec3 a = random_point(seed, 0.9f), b = random_point(seed, 0.9f);

    mesh_add(m, a, b, v3_add(a, random_point(seed, 1e-3f)), 0);
}

static void hard_trees(void)
{
    struct mesh hair = {0}, nest = {0}, same = {0}, chain = {0}, slivers = {0};
    uint64_t seed = 3;

    for (int i = 0; i < 100000; i++)
        add_needle(&hair, &seed);
    compare("G19 hair ball", "100000 long needles", &hair, 1000);
    for (int i = 0; i < 1000; i++)
        add_needle(&slivers, &seed);
    compare("G4 slivers", "1000 needles", &slivers, 30000);
    for (int i = 1; i <= 1000; i++) {
        float s = (float)i * 1e-3f;

        mesh_add_box(&nest, v3(-s, -s, -s), v3(s, s, s), 0);
    }
    compare("G7 nest", "1000 boxes around one point", &nest, 1000);
    for (int i = 0; i < 70000; i++)
        mesh_add(&same, v3(-0.9f, -0.9f, 0), v3(0.9f, -0.9f, 0), v3(0, 0.9f, 0),
                 0);
    compare("G8 copies", "70000 times one triangle", &same, 1000);
    for (int k = 0; k < 140; k++) {
        float x = ldexpf(1.0f, -k);

        mesh_add(&chain, v3(x, 0, 0), v3(x, x, 0), v3(x, 0, x), 0);
    }
    compare("G9 chain", "140 triangles, each half as large", &chain, 100000);
}

/* G11: more than 2^24 triangles are in a plane and are found by their place. */
static void many_triangles(void)
{
    const uint32_t side = 2900; /* twice its square is 16.8 million triangles */
    struct mesh m = {.tri_count = 2 * side * side};
    uint64_t seed = 5;
    int bad = 0;
    const int rays = 100000;

    m.positions = malloc((size_t)(side + 1) * (side + 1) * sizeof *m.positions);
    m.tris = malloc((size_t)m.tri_count * sizeof *m.tris);
    assert_non_null(m.positions);
    assert_non_null(m.tris);
    for (uint32_t i = 0; i < (side + 1) * (side + 1); i++)
        m.positions[i] = v3((float)(i % (side + 1)) / (float)side - 0.5f,
                            (float)(i / (side + 1)) / (float)side - 0.5f, 0);
    for (uint32_t i = 0; i < m.tri_count; i++) {
        uint32_t a = i / 2 / side * (side + 1) + i / 2 % side;
        uint32_t c = a + side + 2;

        m.tris[i] = (struct tri){.v = {a, i % 2 ? c : a + 1, i % 2 ? c - 1 : c},
                                 .vn = {NO_INDEX, NO_INDEX, NO_INDEX},
                                 .vt = {NO_INDEX, NO_INDEX, NO_INDEX}};
    }
    mesh_finish(&m);
    for (int i = 0; i < rays; i++) {
        uint32_t want = i == 0 ? m.tri_count - 1
                               : (uint32_t)(check_random(&seed) * m.tri_count);
        struct tri t = m.tris[want];
        struct vec3 p = v3_add(v3_add(m.positions[t.v[0]], m.positions[t.v[1]]),
                               m.positions[t.v[2]]);
        struct ray r = {v3_scale(p, 1 / 3.0f), {0, 0, -1}, FLOAT_MAX, 0, 0};
        struct hit h;

        r.o.z = 1;
        bad += !hit_closest(&m.world, r, &h) || h.tri != want;
    }
    row(bad == 0, "G11 16.8 million triangles",
        "%d looked at, the last one first, others found: %d, want 0", rays,
        bad);
    mesh_free(&m);
}

int main(int argc, char **argv)
{
    struct error err;

    if (argc > 1)
        factor = (uint32_t)strtoul(argv[1], NULL, 10);
    pool = pool_create((int)sysconf(_SC_NPROCESSORS_ONLN), &err);
    if (pool == NULL) {
        fprintf(stderr, "rays: %s\n", err.text);
        return 1;
    }
    needles();
    near_sheets();
    axis_rays();
    hard_trees();
    self_hits();
    many_triangles();
    closed_meshes();
    pool_destroy(pool);
    return rows_status();
}
