// SPDX-License-Identifier: MIT
#include "tests/unit/instanced.h"
#include "world/world.h"
#include "world/world_materials.h"

#define PLACES 20

/* A triangle on its own, a mesh with normals, and one that is not placed. */
static const char faces[] = "v -3 0 0\nv 3 0 0\nv 0 3 0\nvn 0 0 1\n"
                            "f 1 2 3\n"
                            "o mesh\n"
                            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                            "vn 0 0 -1\nvn 0 -.6 -.8\n"
                            "f 4//2 6//2 5//3\nf 4 5 7\nf 4 7 6\nf 5 6 7\n"
                            "o mesh2\n"
                            "v 9 0 0\nv 9 1 0\nv 9 1 1\n"
                            "f 8 9 10\n";

static struct vec3 file_point(const struct scene *s, struct vec3 p)
{
    return v3((float)((double)p.x / s->scale + s->center[0]),
              (float)((double)p.y / s->scale + s->center[1]),
              (float)((double)p.z / s->scale + s->center[2]));
}

/* The corner of tetrahedron face f by the matrix, in double. */
static void want_corner(const struct affine *a, int face, int k, double p[3])
{
    static const int corners[4][3] = {{0, 2, 1},
                                      {0, 1, 3},
                                      {0, 3, 2},
                                      {1, 2, 3}};
    double from[3] = {0, 0, 0};

    if (corners[face][k] > 0)
        from[corners[face][k] - 1] = 1;
    affine_point(a, from, p);
}

/* Checks that the triangle has the corners of a face, in any order, and that
 * its normal points away from the tetrahedron. */
static void check_face(const struct scene *s, const struct tri *t,
                       const struct affine *a, int face)
{
    double middle[3] = {0.25, 0.25, 0.25}, inside[3], out[3] = {0, 0, 0};

    affine_point(a, middle, inside);
    for (int k = 0; k < 3; k++) {
        double want[3], nearest = INFINITY;

        want_corner(a, face, k, want);
        for (int i = 0; i < 3; i++) {
            struct vec3 p = file_point(s, s->positions[t->v[i]]);
            double d[3] = {(double)p.x, (double)p.y, (double)p.z};

            vec3d_sub(d, want, d);
            nearest = fmin(nearest, vec3d_length(d));
        }
        check_at_most(nearest, 1e-5);
        for (int i = 0; i < 3; i++)
            out[i] += want[i] / 3;
    }
    vec3d_sub(out, inside, out);
    assert_true(out[0] * (double)t->ng.x + out[1] * (double)t->ng.y +
                    out[2] * (double)t->ng.z >
                0);
}

/* The file's normal of the first face is that face's; it still is after the
 * mesh was moved. The other normal is still a unit vector. */
static void check_normals(const struct scene *s, const struct tri *t)
{
    int same = 0;

    for (int k = 0; k < 3; k++) {
        struct vec3 n = s->normals[t->vn[k]];

        check_close((double)v3_length(n), 1, 1e-6);
        same += (double)v3_dot(n, t->ng) > 1 - 1e-5;
    }
    assert_int_equal(same, 2);
}

static void instances_place_their_mesh(void **state)
{
    struct scene s = {.path = NULL};
    struct affine at[PLACES];
    struct warnings report = {0};
    struct error err;
    uint64_t seed = 5;

    (void)state;
    instanced_parse(&s, "", faces);
    s.instances.copied_tris = 1000;
    assert_int_equal(s.instances.mesh_count, 2);
    for (int i = 0; i < PLACES; i++) {
        at[i] = random_affine(&seed, 1, i % 2 == 0);
        assert_true(scene_add_instance(&s, 0, &at[i], (uint32_t)i % 2, &err));
    }
    check_or_say(scene_finish(&s, &report, &err), err.text);
    assert_int_equal(s.tri_count, 1 + 4 * PLACES);
    assert_int_equal(report.entry_count, 0);
    check_close(s.bounds_lo[0], -3, 0.5);
    for (int i = 0; i < 4 * PLACES; i++) {
        const struct tri *t = &s.tris[1 + i];

        assert_int_equal(s.tri_objects[1 + i], i / 4 % 2);
        check_face(&s, t, &at[i / 4], i % 4);
        if (i % 4 == 0)
            check_normals(&s, t);
    }
    scene_free(&s);
    warnings_free(&report);
}

/* Meshes that are used once, in any order, become the triangles of their
 * objects. */
static void meshes_used_once_are_moved(void **state)
{
    const char *meshes = strstr(faces, "o mesh\n");
    struct affine at;
    uint64_t seed = 6;

    (void)state;
    for (int i = 0; i < 8; i++) {
        bool is_in_order = i % 2 == 0;
        uint32_t first = is_in_order ? 0 : 1;
        struct scene s = {.path = NULL};
        struct warnings report = {0};
        struct error err;
        char text[400];

        snprintf(text, sizeof text, "v 0 0 0\nv 0 0 0\nv 0 0 0\nvn 0 0 1\n%s",
                 meshes);
        instanced_parse(&s, "", text);
        at = random_affine(&seed, 1, i % 4 < 2);
        for (uint32_t k = 0; k < 2; k++)
            assert_true(
                scene_add_instance(&s, k ^ first, &at, k ^ first, &err));
        check_or_say(scene_finish(&s, &report, &err), err.text);
        assert_int_equal(s.tri_count, 4 + 1);
        assert_int_equal(s.instances.mesh_count, 0);
        for (int face = 0; face < 4; face++) {
            const struct tri *t = &s.tris[face + (is_in_order ? 0 : 1)];

            check_face(&s, t, &at, face);
            if (face == 0)
                check_normals(&s, t);
            assert_int_equal(s.tri_objects[t - s.tris], 0);
        }
        assert_int_equal(s.tri_objects[is_in_order ? 4 : 0], 1);
        scene_free(&s);
        warnings_free(&report);
    }
}

/* A matrix that flattens the mesh leaves the faces that have an area. */
static void matrices_may_be_singular(void **state)
{
    const struct affine flat = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}};
    const struct affine nowhere = {{{NAN, 0, 0, 0}}};
    struct scene s = {.path = NULL};
    struct warnings report = {0};
    struct error err;

    (void)state;
    instanced_parse(&s, "", faces);
    s.instances.copied_tris = 1000;
    instanced_place(&s, 0, &flat);
    instanced_place(&s, 0, &nowhere);
    check_or_say(scene_finish(&s, &report, &err), err.text);
    assert_int_equal(s.tri_count, 1 + 2);
    assert_int_equal(s.dropped_count, 2 + 4);
    scene_free(&s);
    warnings_free(&report);
}

/* The triangles of all instances must have numbers. */
static void too_many_triangles_are_an_error(void **state)
{
    const struct affine same = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    struct scene s = {.path = NULL};
    struct warnings report = {0};
    struct error err;

    (void)state;
    instanced_parse(&s, "", faces);
    s.instances.copied_tris = 1000;
    s.instances.meshes[0].tri_count = 1u << 31; /* not read */
    for (int i = 0; i < 3; i++)
        instanced_place(&s, 0, &same);
    assert_false(scene_finish(&s, &report, &err));
    check_has(err.text, "triangles");
    scene_free(&s);
    warnings_free(&report);
}

/* Makes the world of a scene whose tetrahedra are instances, of a material that
 * is black or glows. */
static void open_tetrahedra(struct scene *s, struct host_world *host,
                            bool is_glowing)
{
    struct warnings report = {0};
    struct error err;
    uint64_t seed = 31;
    char text[sizeof faces + 20];
    int before = (int)(strstr(faces, "f 4//2") - faces);

    snprintf(text, sizeof text, "%.*susemtl m\n%s", before, faces,
             faces + before);
    instanced_parse(s,
                    is_glowing ? "newmtl m\nKe 4 3 2\n"
                               : "newmtl m\nKd 0 0 0\n",
                    text);
    for (int i = 0; i < PLACES; i++) {
        struct affine at = random_affine(&seed, 1, i % 2 == 0);

        instanced_place(s, 0, &at);
    }
    s->instances.copied_tris = 0;
    check_or_say(scene_finish(s, &report, &err) &&
                     world_init(host, s, 1, &report, &err),
                 err.text);
    assert_int_equal(s->placed_count, PLACES);
    warnings_free(&report);
}

static void set_material(struct host_world *host, const struct scene *s,
                         const struct scene *from)
{
    const uint32_t none[3] = {NO_INDEX, NO_INDEX, NO_INDEX};
    struct material_values sources[2];
    struct error err;

    assert_int_equal(s->material_count, 2);
    assert_int_equal(s->object_count, 3);
    for (int i = 0; i < 2; i++)
        sources[i] = from->material_origins[i].source;
    check_or_say(world_set_materials(host, s, 2, sources, none, &err),
                 err.text);
}

/* The power of the tetrahedra in file units: area times radiance, whose mean
 * over the channels is 3. */
static double tetrahedra_power(void)
{
    uint64_t seed = 31;
    double power = 0;

    for (int i = 0; i < PLACES; i++) {
        struct affine at = random_affine(&seed, 1, i % 2 == 0);

        for (int face = 0; face < 4; face++) {
            double p[3][3], n[3];

            for (int k = 0; k < 3; k++)
                want_corner(&at, face, k, p[k]);
            vec3d_sub(p[1], p[0], p[1]);
            vec3d_sub(p[2], p[0], p[2]);
            vec3d_cross(p[1], p[2], n);
            power += 3 * vec3d_length(n) / 2;
        }
    }
    return power;
}

/* An edit that makes a material glow gives the lights that its file would have,
 * and an edit back removes them. */
static void instances_glow_at_once(void **state)
{
    struct scene dark = {.path = NULL}, bright = {.path = NULL};
    struct host_world edited, loaded;
    const struct lights *a = &edited.lights, *b = &loaded.lights;

    (void)state;
    open_tetrahedra(&dark, &edited, false);
    open_tetrahedra(&bright, &loaded, true);
    assert_int_equal(a->light_count, 0);
    for (int round = 0; round < 2; round++) {
        set_material(&edited, &dark, &bright);
        assert_int_equal(a->light_count, 4 * PLACES);
        assert_int_equal(b->light_count, a->light_count);
        assert_int_equal(b->node_count, a->node_count);
        assert_memory_equal(a->lights, b->lights,
                            a->light_count * sizeof *a->lights);
        assert_memory_equal(a->nodes, b->nodes,
                            a->node_count * sizeof *a->nodes);
        assert_memory_equal(edited.materials, loaded.materials,
                            2 * sizeof *edited.materials);
        check_close(lights_power(a) / (dark.scale * dark.scale),
                    tetrahedra_power(), 1e-4);
        set_material(&edited, &dark, &dark);
        assert_int_equal(a->light_count, 0);
    }
    world_free(&edited);
    world_free(&loaded);
    scene_free(&dark);
    scene_free(&bright);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(instances_place_their_mesh),
        cmocka_unit_test(meshes_used_once_are_moved),
        cmocka_unit_test(matrices_may_be_singular),
        cmocka_unit_test(too_many_triangles_are_an_error),
        cmocka_unit_test(instances_glow_at_once),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
