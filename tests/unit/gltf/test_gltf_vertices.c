// SPDX-License-Identifier: MIT
/* test_gltf_vertices.c - tangents and alphas of the vertices of glTF files */
#include <string.h>

#include "base/memory.h"
#include "engine/scene_load.h"
#include "tests/unit/files.h"
#include "tests/unit/shared.h"

#include "kernels/bump.h"

struct loaded {
    struct scene scene;
    struct host_world host;
    struct world world;
    struct warnings report;
};

static void load(struct loaded *l, const char *path)
{
    struct error err;

    memset(l, 0, sizeof *l);
    check_or_say(scene_load(&l->scene, path, SCENE_UP_OF_FILE, &l->report,
                            &err) &&
                     world_init(&l->host, &l->scene, 1, &l->report, &err),
                 err.text);
    l->world = world_arrays(&l->host, &l->scene);
    l->world.settings.features = world_features(&l->host);
}

static void unload(struct loaded *l)
{
    world_free(&l->host);
    scene_free(&l->scene);
    warnings_free(&l->report);
}

/* Checks that the tangents of vertices agree with those that the texture
 * coordinates of the faces have. Returns the number of faces with them. */
static int check_tangents(const struct loaded *l)
{
    const struct world *w = &l->world;
    struct hit h = {.b0 = 0.3f, .b1 = 0.4f, .b2 = 0.3f};
    int count = 0;

    for (uint32_t i = 0; i < scene_tri_total(&l->scene); i++) {
        uint32_t instance = instance_of(w, i);
        struct tri t = tri_at(w, i, instance);
        struct vec3 u[2], v[2], n;

        if (t.vt[0] == NO_INDEX || t.vn[0] == NO_INDEX)
            continue;
        n = normal_at(w, t.vn[0], instance);
        if (!vertex_tangents(
                w, &(struct bump_place){.t = t, .instance = instance, .h = h},
                n, &u[0], &v[0]) ||
            !uv_tangents(w, w->uvs, t, instance, &u[1], &v[1]))
            continue;
        check_at_most(-(double)v3_dot(u[0], u[1]), -0.5);
        check_at_most(-(double)v3_dot(v[0], v[1]), -0.5);
        /* seen from behind they are the same */
        assert_true(vertex_tangents(
            w, &(struct bump_place){.t = t, .instance = instance, .h = h},
            v3_neg(n), &u[1], &v[1]));
        check_close((double)v3_dot(v[0], v[1]), 1, 1e-5);
        count++;
    }
    return count;
}

static void tangents_of_blender_follow_the_texture(void **state)
{
    char *path = shared_path("suites/gltf/blender-io/25_anisotropy/"
                             "25_anisotropy.gltf");
    struct loaded l;

    (void)state;
    load(&l, path);
    assert_true((l.world.settings.features & FEATURE_TANGENTS) != 0);
    assert_true(check_tangents(&l) > 100);
    unload(&l);
    free(path);
}

/* A triangle: 3 positions, normals, tangents with w, texture coordinates,
 * colours with alpha. glTF counts v from the top, so that along v is down the
 * first axis here. */
static const float vertices[3][16] = {
    {0, 0, 0, 0, 0, 1, 0, 1, 0, 1, 0, 1, 1, 1, 1, 0.2f},
    {1, 0, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 1, 0.6f},
    {0, 1, 0, 0, 0, 1, 0, 1, 0, 1, 1, 1, 1, 1, 1, 1},
};

/* Writes a file whose node is scaled and whose material has these members. */
static void write_file(float w, const char *nodes, const char *material)
{
    float data[3][16];
    char *text;

    memcpy(data, vertices, sizeof data);
    for (int i = 0; i < 3; i++)
        data[i][9] = w;
    put_bytes("a.bin", data, sizeof data);
    text = format_text(
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"a.bin\","
        "\"byteLength\":192}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":"
        "192,\"byteStride\":64}],\"accessors\":[{\"bufferView\":0,"
        "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
        "{\"bufferView\":0,\"byteOffset\":12,\"componentType\":5126,"
        "\"count\":3,\"type\":\"VEC3\"},{\"bufferView\":0,\"byteOffset\":24,"
        "\"componentType\":5126,\"count\":3,\"type\":\"VEC4\"},"
        "{\"bufferView\":0,\"byteOffset\":40,\"componentType\":5126,"
        "\"count\":3,\"type\":\"VEC2\"},{\"bufferView\":0,\"byteOffset\":48,"
        "\"componentType\":5126,\"count\":3,\"type\":\"VEC4\"}],\"materials\":"
        "[{%s}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,"
        "\"NORMAL\":1,\"TANGENT\":2,\"TEXCOORD_0\":3,\"COLOR_0\":4},"
        "\"material\":0}]}],\"nodes\":[%s],\"scenes\":[{\"nodes\":[0%s]}]}",
        material, nodes, strchr(nodes, '}')[1] != '\0' ? ",1" : "");
    put_bytes("a.gltf", text, strlen(text));
    free(text);
}

#define GRAIN                                                                 \
    "\"pbrMetallicRoughness\":{\"roughnessFactor\":0.5},"                     \
    "\"extensions\":{\"KHR_materials_anisotropy\":{\"anisotropyStrength\":0." \
    "5}}"

/* Nodes that mirror keep the tangents along the texture, also in two copies. */
static void tangents_move_with_nodes(void **state)
{
    static const char *const nodes[] = {
        "{\"mesh\":0}", "{\"mesh\":0,\"scale\":[-1,2,3]}",
        "{\"mesh\":0,\"rotation\":[0,0,0.6,0.8]}",
        "{\"mesh\":0},{\"mesh\":0,\"scale\":[1,-1,1]}"};
    struct loaded l;

    (void)state;
    for (size_t i = 0; i < sizeof nodes / sizeof nodes[0]; i++) {
        write_file(-1, nodes[i], GRAIN);
        load(&l, "a.gltf");
        assert_int_equal(check_tangents(&l), i == 3 ? 2 : 1);
        unload(&l);
    }
}

/* w turns along v, whatever the texture coordinates. */
static void the_sign_turns_along_v(void **state)
{
    struct hit h = {.b0 = 1};
    struct vec3 n = {0, 0, 1}, u = n, v = n;
    struct loaded l;

    (void)state;
    for (int w = -1; w <= 1; w += 2) {
        write_file((float)w, "{\"mesh\":0}", GRAIN);
        load(&l, "a.gltf");
        assert_true(vertex_tangents(&l.world,
                                    &(struct bump_place){.t = l.scene.tris[0],
                                                         .instance = NO_INDEX,
                                                         .h = h},
                                    n, &u, &v));
        check_close((double)u.y, 1, 1e-6);
        check_close((double)v.x, -w, 1e-6);
        unload(&l);
    }
}

static void tangents_that_nothing_uses_are_left_out(void **state)
{
    struct loaded l;

    (void)state;
    write_file(1, "{\"mesh\":0}", "");
    load(&l, "a.gltf");
    assert_null(l.scene.tangents);
    assert_int_equal(l.world.settings.features &
                         (FEATURE_TANGENTS | FEATURE_VERTEX_ALPHAS |
                          FEATURE_COVERAGE),
                     0);
    unload(&l);
}

/* Returns the coverage where two corners have these weights. */
static float coverage(const struct loaded *l, float b1, float b2)
{
    const struct tri *t = &l->scene.tris[0];
    struct hit h = {.tri = 0};
    const float want[3] = {1 - b1 - b2, b1, b2};
    float *b[3] = {&h.b0, &h.b1, &h.b2};

    for (int k = 0; k < 3; k++) /* corners are rotated at load */
        *b[k] = want[t->v[k]];
    return coverage_at(&l->world, h);
}

static void alphas_of_vertices_are_factors(void **state)
{
    struct loaded l;

    (void)state;
    write_file(1, "{\"mesh\":0}",
               "\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{"
               "\"baseColorFactor\":[1,1,1,0.5]}");
    load(&l, "a.gltf");
    assert_true((l.world.settings.features & FEATURE_VERTEX_ALPHAS) != 0);
    assert_true(has_coverage(&l.world));
    check_close((double)coverage(&l, 0, 0), 0.5 * 0.2, 1e-6);
    check_close((double)coverage(&l, 1, 0), 0.5 * 0.6, 1e-6);
    check_close((double)coverage(&l, 0, 1), 0.5, 1e-6);
    check_close((double)coverage(&l, 0.25f, 0.25f), 0.5 * (0.1 + 0.15 + 0.25),
                1e-6);
    unload(&l);
    write_file(1, "{\"mesh\":0}",
               "\"alphaMode\":\"MASK\",\"alphaCutoff\":0.61");
    load(&l, "a.gltf");
    check_close((double)coverage(&l, 1, 0), 0, 0);
    check_close((double)coverage(&l, 0.9f, 0.1f), 1, 0);
    unload(&l);
    write_file(1, "{\"mesh\":0}", "\"alphaMode\":\"OPAQUE\"");
    load(&l, "a.gltf");
    assert_null(l.scene.alphas);
    check_close((double)coverage(&l, 0, 0), 1, 0);
    unload(&l);
}

static int leave(void **state)
{
    unlink("a.gltf");
    unlink("a.bin");
    return leave_empty_folder(state);
}

int main(void)
{
    const struct CMUnitTest own[] = {
        cmocka_unit_test(tangents_move_with_nodes),
        cmocka_unit_test(the_sign_turns_along_v),
        cmocka_unit_test(tangents_that_nothing_uses_are_left_out),
        cmocka_unit_test(alphas_of_vertices_are_factors),
    };
    const struct CMUnitTest shared[] = {
        cmocka_unit_test(tangents_of_blender_follow_the_texture),
    };

    /* before the folder changes */
    return cmocka_run_group_tests(shared, NULL, NULL) +
           cmocka_run_group_tests(own, enter_folder, leave);
}
