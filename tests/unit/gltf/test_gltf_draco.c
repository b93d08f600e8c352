// SPDX-License-Identifier: MIT
/*
 * test_gltf_draco.c - meshes that libdraco packs are those that were packed
 *
 * The same mesh is written plain and packed; both scenes must have the same
 * triangles, bit for bit. This test is the program of the copies that unpack:
 * see main().
 */
#include "read/gltf/gltf_draco.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "engine/scene_load.h"
#include "read/child/draco_child.h"
#include "read/gltf/draco_stream.h"
#include "tests/unit/files.h"
#include "tests/unit/gltf/draco_encode.h"

#ifdef HAS_DRACO

/* ---- the mesh ---- */

#define SIDE       13 /* vertices along each edge of a grid */
#define VERTICES   (SIDE * SIDE)
#define TRIS       (2 * (SIDE - 1) * (SIDE - 1))
#define STRIP_TRIS (2 * (SIDE - 1)) /* those of the first row */

static struct {
    float positions[VERTICES][3], normals[VERTICES][3], tangents[VERTICES][4];
    float uvs[VERTICES][2], temperatures[VERTICES];
    uint16_t uvs2[VERTICES][2];
    uint8_t colors[VERTICES][4];
    uint16_t joints[VERTICES][4];
    float weights[VERTICES][4];
    uint32_t indices[TRIS][3];
    uint32_t strip[2 * SIDE];
} mesh;

static const struct draco_source_attribute attributes[] = {
    {"POSITION", 4, 5126, 3, false, mesh.positions},
    {"NORMAL", 9, 5126, 3, false, mesh.normals},
    {"TANGENT", 7, 5126, 4, false, mesh.tangents},
    {"TEXCOORD_0", 3, 5126, 2, false, mesh.uvs},
    {"TEXCOORD_1", 12, 5123, 2, true, mesh.uvs2},
    {"COLOR_0", 0, 5121, 4, true, mesh.colors},
    {"JOINTS_0", 5, 5123, 4, false, mesh.joints},
    {"WEIGHTS_0", 6, 5126, 4, false, mesh.weights},
    {"_TEMPERATURE", 8, 5126, 1, false, mesh.temperatures},
};
enum { ATTRIBUTES = sizeof attributes / sizeof attributes[0] };

static void fill_vertex(int i, uint64_t *seed)
{
    float w = (float)check_random(seed);

    mesh.positions[i][0] = (float)(i % SIDE);
    mesh.positions[i][1] = (float)(i / SIDE);
    mesh.positions[i][2] = (float)check_random(seed);
    mesh.normals[i][0] = w - 0.5f;
    mesh.normals[i][2] = 1;
    mesh.tangents[i][1] = 1;
    mesh.tangents[i][3] = i % 2 == 0 ? 1 : -1;
    for (int k = 0; k < 2; k++) {
        mesh.uvs[i][k] = (float)(3 * check_random(seed) - 1);
        mesh.uvs2[i][k] = (uint16_t)(65535 * check_random(seed));
    }
    for (int k = 0; k < 4; k++)
        mesh.colors[i][k] = (uint8_t)(255 * check_random(seed));
    mesh.joints[i][0] = (uint16_t)(i % 2);
    mesh.joints[i][1] = (uint16_t)(1 - i % 2);
    mesh.weights[i][0] = w;
    mesh.weights[i][1] = 1 - w;
    mesh.temperatures[i] = (float)i;
}

static void fill_mesh(void)
{
    uint64_t seed = 1;
    int n = 0;

    for (int i = 0; i < VERTICES; i++)
        fill_vertex(i, &seed);
    for (uint32_t i = 0; i < SIDE; i++) {
        mesh.strip[2 * i] = i + SIDE;
        mesh.strip[2 * i + 1] = i;
    }
    for (uint32_t y = 0; y + 1 < SIDE; y++)
        for (uint32_t x = 0; x + 1 < SIDE; x++) {
            uint32_t i = y * SIDE + x;
            const uint32_t corners[6] = {i + SIDE,     i, i + SIDE + 1,
                                         i + SIDE + 1, i, i + 1};

            memcpy(mesh.indices[n], corners, sizeof corners);
            n += 2;
        }
}

/* ---- files ---- */

static size_t element_bytes(const struct draco_source_attribute *a)
{
    return a->component_count * (a->component == 5126   ? 4u
                                 : a->component == 5123 ? 2u
                                                        : 1u);
}

/* What a file is like. */
struct kind {
    bool is_packed, is_sequential, is_strip;
    bool is_optional; /* has plain data, too */
    bool is_cloud;
    int copies;       /* primitives; 0 is 1 */
    bool shares_view; /* all of them show the packed bytes of one view */
};

/* Numbers of the views: those of the attributes, indices, packed bytes of each
 * primitive. */
enum { VIEW_INDICES = ATTRIBUTES, VIEW_PACKED };

/* Writes data.bin and the views. */
static void put_views(FILE *f, const struct kind *k)
{
    const struct draco_source source = {
        .vertex_count = VERTICES,
        .tri_count = k->is_strip ? STRIP_TRIS : TRIS,
        .attribute_count = ATTRIBUTES,
        .indices = mesh.indices[0],
        .attributes = attributes,
        .is_cloud = k->is_cloud,
        .is_sequential = k->is_sequential,
    };
    const void *indices = k->is_strip ? mesh.strip : mesh.indices[0];
    size_t index_bytes = k->is_strip ? sizeof mesh.strip : sizeof mesh.indices;
    size_t packed_bytes, at = 0;
    void *packed = draco_encode(&source, &packed_bytes);
    FILE *bin = fopen("data.bin", "wb");

    assert_true(packed != NULL && bin != NULL);
    fprintf(f, "\"bufferViews\":[");
    for (int i = 0; i < ATTRIBUTES; i++) {
        size_t n = VERTICES * element_bytes(&attributes[i]);

        fprintf(f, "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu},", at,
                n);
        /* the copy for other readers has all corners at one place */
        for (size_t j = 0; j < n; j++)
            fputc(k->is_packed ? 0 : ((const char *)attributes[i].data)[j],
                  bin);
        for (at += n; at % 4 != 0; at++)
            fputc(0, bin);
    }
    fwrite(indices, 1, index_bytes, bin);
    fwrite(packed, 1, packed_bytes, bin);
    assert_int_equal(fclose(bin), 0);
    free(packed);
    fprintf(f, "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", at,
            index_bytes);
    for (int i = 0; i < (k->copies > 0 ? k->copies : 1); i++)
        fprintf(f, ",{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}",
                at + index_bytes, packed_bytes);
    fprintf(f, "],\"buffers\":[{\"byteLength\":%zu,\"uri\":\"data.bin\"}],",
            at + index_bytes + packed_bytes);
}

/* Accessors of packed meshes have no views, unless they are for others. */
static void put_accessors(FILE *f, const struct kind *k)
{
    static const char *const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    bool has_views = !k->is_packed || k->is_optional;

    fprintf(f, "\"accessors\":[");
    for (int i = 0; i < ATTRIBUTES; i++) {
        const struct draco_source_attribute *a = &attributes[i];

        fprintf(f, "{\"componentType\":%u,\"count\":%d,\"type\":\"%s\"",
                a->component, VERTICES, types[a->component_count]);
        if (a->is_normalized)
            fprintf(f, ",\"normalized\":true");
        if (has_views)
            fprintf(f, ",\"bufferView\":%d", i);
        fprintf(f, "},");
    }
    fprintf(f, "{\"componentType\":5125,\"count\":%d,\"type\":\"SCALAR\"",
            k->is_strip ? 2 * SIDE : 3 * TRIS);
    if (has_views)
        fprintf(f, ",\"bufferView\":%d", VIEW_INDICES);
    fprintf(f, "}],");
}

static void put_attributes(FILE *f, bool is_of_draco)
{
    fprintf(f, "\"attributes\":{");
    for (int i = 0; i < ATTRIBUTES; i++)
        fprintf(f, "%s\"%s\":%d", i > 0 ? "," : "", attributes[i].name,
                is_of_draco ? (int)attributes[i].id : i);
    fprintf(f, "}");
}

static void put_primitive(FILE *f, const struct kind *k, int number)
{
    fprintf(f, "{\"mode\":%d,\"indices\":%d,\"material\":0,",
            k->is_strip ? 5 : 4, ATTRIBUTES);
    put_attributes(f, false);
    if (k->is_packed) {
        fprintf(f, ",\"extensions\":{\"" GLTF_DRACO "\":{\"bufferView\":%d,",
                VIEW_PACKED + (k->shares_view ? 0 : number));
        put_attributes(f, true);
        fprintf(f, "}}");
    }
    fprintf(f, "}");
}

/* Writes model.gltf: a bent mesh whose material needs tangents and alpha. */
static void put_model(struct kind k)
{
    FILE *f = fopen("model.gltf", "w");

    assert_non_null(f);
    fprintf(f, "{\"asset\":{\"version\":\"2.0\"},");
    if (k.is_packed)
        fprintf(f, "\"extensions%s\":[\"" GLTF_DRACO "\"],",
                k.is_optional ? "Used" : "Required");
    put_views(f, &k);
    put_accessors(f, &k);
    fprintf(f, "\"meshes\":[{\"primitives\":[");
    for (int i = 0; i < (k.copies > 0 ? k.copies : 1); i++) {
        fprintf(f, i > 0 ? "," : "");
        put_primitive(f, &k, i);
    }
    fprintf(f,
            "]}],\"materials\":[{\"alphaMode\":\"BLEND\","
            "\"pbrMetallicRoughness\":{\"roughnessFactor\":0.4},\"extensions\":"
            "{\"KHR_materials_anisotropy\":{\"anisotropyStrength\":0.5}}}],"
            "\"skins\":[{\"joints\":[1,2]}],\"nodes\":[{\"mesh\":0,"
            "\"skin\":0},{},{\"translation\":[0,0,5]}],"
            "\"scenes\":[{\"nodes\":[0,1,2]}]}");
    assert_int_equal(fclose(f), 0);
}

/* ---- scenes ---- */

#define CORNER_NUMBERS 18

struct flat_tri {
    float corners[3][CORNER_NUMBERS];
};

/* All triangles with everything that their corners have, sorted. */
struct flat {
    struct flat_tri *tris;
    uint32_t count;
};

static int compare_corners(const float *a, const float *b)
{
    return memcmp(a, b, CORNER_NUMBERS * sizeof *a);
}

static int compare_tris(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(struct flat_tri));
}

static void flatten_corner(const struct scene *s, const struct tri *t, int k,
                           float to[CORNER_NUMBERS])
{
    const struct vec3 vectors[] = {s->positions[t->v[k]], s->normals[t->vn[k]],
                                   s->colors[t->v[k]], s->tangents[t->vn[k]].d};
    const float others[] = {s->uvs[t->vt[k]].x,         s->uvs[t->vt[k]].y,
                            s->uvs2[t->vt[k]].x,        s->uvs2[t->vt[k]].y,
                            s->tangents[t->vn[k]].sign, s->alphas[t->v[k]]};

    memcpy(to, vectors, sizeof vectors);
    memcpy(to + 12, others, sizeof others);
}

static void flatten_tri(const struct scene *s, const struct tri *t,
                        struct flat_tri *to)
{
    float corners[3][CORNER_NUMBERS];
    int first = 0;

    for (int k = 0; k < 3; k++) {
        flatten_corner(s, t, k, corners[k]);
        if (compare_corners(corners[k], corners[first]) < 0)
            first = k;
    }
    for (int k = 0; k < 3; k++)
        memcpy(to->corners[k], corners[(first + k) % 3], sizeof corners[0]);
}

static bool load_with(const char *program, struct scene *scene,
                      struct error *err)
{
    struct warnings report = {0};
    bool ok;

    *scene = (struct scene){.program = program};
    ok = scene_load(scene, "model.gltf", SCENE_UP_OF_FILE, &report, err);
    warnings_free(&report);
    if (!ok)
        scene_free(scene);
    return ok;
}

/* Loads model.gltf. */
static struct flat load(void)
{
    struct scene scene;
    struct error err;
    struct flat f;

    check_or_say(load_with("/proc/self/exe", &scene, &err), err.text);
    assert_true(scene.normals != NULL && scene.uvs != NULL &&
                scene.uvs2 != NULL && scene.colors != NULL &&
                scene.alphas != NULL && scene.tangents != NULL);
    f.count = scene.tri_count;
    f.tris = calloc(f.count, sizeof *f.tris);
    assert_non_null(f.tris);
    for (uint32_t i = 0; i < f.count; i++)
        flatten_tri(&scene, &scene.tris[i], &f.tris[i]);
    qsort(f.tris, f.count, sizeof *f.tris, compare_tris);
    scene_free(&scene);
    return f;
}

/* ---- tests ---- */

static void packed_meshes_are_those_that_were_packed(void **state)
{
    static const struct kind kinds[] = {
        {.is_packed = true},
        {.is_packed = true, .is_sequential = true},
        {.is_packed = true, .is_strip = true},
        {.is_packed = true, .is_optional = true},
        {.is_packed = true, .copies = 3},
        {.is_packed = true, .copies = 3, .shares_view = true},
    };

    (void)state;
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        struct kind plain = kinds[i];
        struct flat a, b;

        put_model(kinds[i]);
        a = load();
        plain.is_packed = false;
        put_model(plain);
        b = load();
        assert_int_equal(a.count, b.count);
        assert_memory_equal(a.tris, b.tris, a.count * sizeof *a.tris);
        assert_int_equal(a.count,
                         (uint32_t)(plain.is_strip ? STRIP_TRIS : TRIS) *
                             (plain.copies > 0 ? 3 : 1));
        free(a.tris);
        free(b.tris);
    }
}

static void fail_with(const char *program, const char *message)
{
    struct scene scene;
    struct error err;

    assert_false(load_with(program, &scene, &err));
    check_has(err.text, message);
    assert_true(strncmp(err.text, "model.gltf: ", 12) == 0);
    assert_null(strchr(err.text, '\n'));
}

#define PLACE "model.gltf: /meshes/0/primitives/1/extensions/" GLTF_DRACO ": "

/* Copies that answer for the first of two meshes, or not at all. */
static void failures_name_their_mesh(void **state)
{
    static const struct {
        const char *script, *message;
    } cases[] = {
        {"kill -SEGV $$", PLACE "libdraco crashed (Segmentation fault)"},
        {"kill -XCPU $$", PLACE "libdraco does not end"},
        {":", PLACE "found another end in what libdraco unpacked"},
        {"exit 3", "model.gltf: libdraco ended with status 3"},
    };
    const struct draco_answer head = {.vertex_count = 3, .tri_count = 1};
    struct draco_attribute a = {.component = 5126};
    static const char zeros[3 * 4 * 4];
    FILE *f = fopen("answer", "wb");

    (void)state;
    assert_non_null(f);
    fwrite(&head, sizeof head, 1, f);
    for (int i = 0; i < ATTRIBUTES; i++) {
        a.component_count = attributes[i].component_count;
        fwrite(&a, sizeof a, 1, f);
        fwrite(zeros, 4, (size_t)3 * a.component_count, f);
    }
    fwrite((const uint32_t[]){0, 1, 2}, sizeof(uint32_t), 3, f);
    assert_int_equal(fclose(f), 0);
    put_model((struct kind){.is_packed = true, .copies = 2});
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[256];

        snprintf(text, sizeof text, "#!/bin/sh\ncat answer\n%s\n",
                 cases[i].script);
        if (strstr(cases[i].script, "exit") != NULL)
            snprintf(text, sizeof text, "#!/bin/sh\n%s\n", cases[i].script);
        put("child", text);
        chmod("child", 0700);
        fail_with("./child", cases[i].message);
    }
    fail_with("/nowhere/glim", "libdraco could not be run: No such file");
    fail_with(NULL, "which only the program glim reads");
}

/* Returns the bytes that a copy gets for model.gltf. */
static long request_bytes(void)
{
    struct scene scene;
    struct error err;
    char *text;
    size_t size_bytes;
    long n;

    put("child", "#!/bin/sh\nwc -c >size\nexit 3\n");
    chmod("child", 0700);
    assert_false(load_with("./child", &scene, &err));
    check_has(err.text, "libdraco ended with status 3");
    check_or_say(file_read("size", &text, &size_bytes, &err), err.text);
    n = strtol(text, NULL, 10);
    free(text);
    return n;
}

/* Each copy of packed bytes has its own request, but those of one view have one
 * together. */
static void views_are_unpacked_once(void **state)
{
    long one;

    (void)state;
    put_model((struct kind){.is_packed = true});
    one = request_bytes();
    assert_true(one > 16 + 4 * ATTRIBUTES);
    put_model((struct kind){.is_packed = true, .copies = 3});
    assert_int_equal(request_bytes(), 3 * one);
    put_model(
        (struct kind){.is_packed = true, .copies = 3, .shares_view = true});
    assert_int_equal(request_bytes(), one);
}

static void clouds_are_refused(void **state)
{
    (void)state;
    put_model((struct kind){.is_packed = true, .is_cloud = true});
    fail_with("/proc/self/exe", "libdraco: found points, expected triangles");
}

/* Packed bytes of any content give a scene or one line. */
static void broken_bytes_cost_a_line(void **state)
{
    uint64_t seed = 7;
    int refused = 0;
    char *bytes;
    size_t size_bytes, first;
    struct error err;

    (void)state;
    put_model((struct kind){.is_packed = true});
    check_or_say(file_read("data.bin", &bytes, &size_bytes, &err), err.text);
    for (first = size_bytes; memcmp(bytes + first - 5, "DRACO", 5) != 0;)
        first--;
    first -= 5;
    for (int i = 0; i < 40; i++) {
        struct scene scene;
        size_t at = first + (size_t)(check_random(&seed) *
                                     (double)(size_bytes - first) *
                                     (i % 2 == 0 ? 1 : 0.02));
        char old = bytes[at];

        bytes[at] = (char)(uint8_t)(256 * check_random(&seed));
        put_bytes("data.bin", bytes, size_bytes);
        bytes[at] = old;
        if (load_with("/proc/self/exe", &scene, &err)) {
            scene_free(&scene);
            continue;
        }
        assert_true(strncmp(err.text, "model.gltf: ", 12) == 0);
        assert_null(strchr(err.text, '\n'));
        refused++;
    }
    assert_true(refused > 5);
    free(bytes);
}

static int begin(void **state)
{
    fill_mesh();
    return enter_folder(state);
}

int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(packed_meshes_are_those_that_were_packed),
        cmocka_unit_test(failures_name_their_mesh),
        cmocka_unit_test(views_are_unpacked_once),
        cmocka_unit_test(clouds_are_refused),
        cmocka_unit_test(broken_bytes_cost_a_line),
    };
    const struct library_limits limits = {20, (uint64_t)1 << 30};

    if (count == 3 && strcmp(arguments[1], "--unpack") == 0)
        _Exit(draco_child(limits, stdout) ? 0 : 1);
    return cmocka_run_group_tests(tests, begin, remove_folder);
}

#else

int main(void)
{
    print_message("skipped: %s\n", gltf_draco_missing());
    return 0;
}

#endif
