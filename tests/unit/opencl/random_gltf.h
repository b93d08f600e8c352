// SPDX-License-Identifier: MIT
/*
 * random_gltf.h - writes glTF files with random materials of every extension,
 * textures, samplers, attributes of vertices, lights, and instances
 *
 * The files have these parts:
 *   random.gltf, random.view   the document, and its background
 *   data.bin                   a bumpy grid with all attributes
 *   0.png, 1.png               images, the second one with alpha
 *
 * Threads:   one
 * Errors:    a failed check ends the test
 */
#ifndef TESTS_RANDOM_GLTF_H
#define TESTS_RANDOM_GLTF_H

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "image/stb.h"
#include "tests/unit/files.h"

#define RANDOM_SIDE      33 /* vertices along each edge of the grid */
#define RANDOM_MATERIALS 12
#define RANDOM_TEXTURES  16
#define RANDOM_COPIES    160 /* of one mesh, enough to stay instances */

/* ---- the grid ---- */

/* Attributes in the order of their accessors. */
static const struct {
    const char *name, *type;
    int numbers;
} random_attributes[] = {
    {"POSITION", "VEC3", 3},   {"NORMAL", "VEC3", 3},
    {"TEXCOORD_0", "VEC2", 2}, {"TEXCOORD_1", "VEC2", 2},
    {"COLOR_0", "VEC4", 4},    {"TANGENT", "VEC4", 4},
};
#define RANDOM_ATTRIBUTES 6

static inline void random_vertex(int attribute, int x, int y, uint64_t *seed,
                                 float values[4])
{
    double u = (double)x / (RANDOM_SIDE - 1), v = (double)y / (RANDOM_SIDE - 1);

    for (int k = 0; k < 4; k++)
        values[k] = (float)check_random(seed);
    if (attribute == 0) {
        values[0] = (float)(u - 0.5);
        values[1] = (float)(v - 0.5);
        values[2] = (float)(0.1 * sin(9 * u) * cos(7 * v));
    } else if (attribute == 1 || attribute == 5) {
        double angle = 0.4 * sin(9 * u + 5 * v);

        values[attribute == 1 ? 2 : 0] = (float)cos(angle);
        values[attribute == 1 ? 0 : 2] =
            (float)(attribute == 1 ? sin(angle) : -sin(angle));
        values[1] = 0;
        values[3] = x % 2 == 0 ? 1.0f : -1.0f;
    } else if (attribute == 2 || attribute == 3) {
        values[0] = (float)(3 * u - v);
        values[1] = (float)(2 * v - 0.5);
    }
}

static inline void random_grid_write(const char *where, uint64_t *seed)
{
    char path[256];
    FILE *f;

    snprintf(path, sizeof path, "%s/data.bin", where);
    f = fopen(path, "wb");
    assert_non_null(f);
    for (int a = 0; a < RANDOM_ATTRIBUTES; a++)
        for (int i = 0; i < RANDOM_SIDE * RANDOM_SIDE; i++) {
            float values[4];

            random_vertex(a, i % RANDOM_SIDE, i / RANDOM_SIDE, seed, values);
            fwrite(values, sizeof values[0],
                   (size_t)random_attributes[a].numbers, f);
        }
    for (int y = 0; y + 1 < RANDOM_SIDE; y++)
        for (int x = 0; x + 1 < RANDOM_SIDE; x++) {
            uint16_t i = (uint16_t)(y * RANDOM_SIDE + x);
            const uint16_t corners[6] = {
                i,
                (uint16_t)(i + 1),
                (uint16_t)(i + RANDOM_SIDE),
                (uint16_t)(i + 1),
                (uint16_t)(i + RANDOM_SIDE + 1),
                (uint16_t)(i + RANDOM_SIDE),
            };

            fwrite(corners, sizeof corners[0], 6, f);
        }
    assert_int_equal(fclose(f), 0);
}

static inline void random_buffer_put(FILE *f)
{
    int vertices = RANDOM_SIDE * RANDOM_SIDE, first = 0;
    int indices = 6 * (RANDOM_SIDE - 1) * (RANDOM_SIDE - 1);

    fprintf(f, "\"accessors\": [\n");
    for (int a = 0; a < RANDOM_ATTRIBUTES; a++)
        fprintf(f,
                "{\"bufferView\": %d, \"componentType\": 5126, \"count\": %d,"
                " \"type\": \"%s\"},\n",
                a, vertices, random_attributes[a].type);
    fprintf(f,
            "{\"bufferView\": %d, \"componentType\": 5123, \"count\": %d,"
            " \"type\": \"SCALAR\"}],\n\"bufferViews\": [\n",
            RANDOM_ATTRIBUTES, indices);
    for (int a = 0; a < RANDOM_ATTRIBUTES; a++) {
        int bytes = 4 * random_attributes[a].numbers * vertices;

        fprintf(f, "{\"buffer\": 0, \"byteOffset\": %d, \"byteLength\": %d},\n",
                first, bytes);
        first += bytes;
    }
    fprintf(f,
            "{\"buffer\": 0, \"byteOffset\": %d, \"byteLength\": %d}],\n"
            "\"buffers\": [{\"uri\": \"data.bin\", \"byteLength\": %d}]\n",
            first, 2 * indices, first + 2 * indices);
}

/* ---- textures ---- */

static inline void random_append(void *file, void *bytes, int count)
{
    fwrite(bytes, 1, (size_t)count, file);
}

static inline void random_images_write(const char *where, uint64_t *seed)
{
    for (int i = 0; i < 2; i++) {
        uint8_t bytes[7 * 5 * 4];
        char path[256];
        FILE *f;
        int channels = 3 + i;

        for (size_t k = 0; k < sizeof bytes; k++)
            bytes[k] = (uint8_t)(255.99 * check_random(seed));
        snprintf(path, sizeof path, "%s/%d.png", where, i);
        f = fopen(path, "wb");
        assert_non_null(f);
        assert_int_not_equal(stbi_write_png_to_func(random_append, f, 7, 5,
                                                    channels, bytes,
                                                    7 * channels),
                             0);
        assert_int_equal(fclose(f), 0);
    }
}

static inline void random_textures_put(FILE *f, uint64_t *seed)
{
    static const int wraps[] = {33071, 33648, 10497};

    fprintf(f, "\"images\": [{\"uri\": \"0.png\"}, {\"uri\": \"1.png\"}],\n"
               "\"samplers\": [\n");
    for (int i = 0; i < 18; i++)
        fprintf(f, "{\"wrapS\": %d, \"wrapT\": %d, \"magFilter\": %d}%s\n",
                wraps[i % 3], wraps[i / 3 % 3], 9728 + i / 9,
                i < 17 ? "," : "],");
    fprintf(f, "\"textures\": [\n");
    for (int i = 0; i < RANDOM_TEXTURES; i++)
        fprintf(f, "{\"source\": %d, \"sampler\": %d}%s\n", i % 2,
                (int)(18 * check_random(seed)),
                i + 1 < RANDOM_TEXTURES ? "," : "],");
}

/* Writes a member that refers to a texture, in two of three cases. */
static inline void random_map_put(FILE *f, const char *key, uint64_t *seed)
{
    if (key == NULL || check_random(seed) < 1.0 / 3)
        return;
    fprintf(f, ", \"%s\": {\"index\": %d, \"texCoord\": %d", key,
            (int)(RANDOM_TEXTURES * check_random(seed)),
            (int)(2 * check_random(seed)));
    if (check_random(seed) < 0.5)
        fprintf(f,
                ", \"extensions\": {\"KHR_texture_transform\": {\"offset\": "
                "[%.3f, 0.25], \"rotation\": %.3f, \"scale\": [%.3f, -2]}}",
                check_random(seed), 6 * check_random(seed),
                3 * check_random(seed));
    fprintf(f, "}");
}

/* ---- materials ---- */

/* Extensions with numbers from 0 to 1, which the maps scale. */
static const struct {
    const char *name, *numbers[2], *maps[3], *more;
} random_extensions[] = {
    {"clearcoat",
     {"clearcoatFactor", "clearcoatRoughnessFactor"},
     {"clearcoatTexture", "clearcoatRoughnessTexture",
      "clearcoatNormalTexture"},
     ""},
    {"sheen",
     {"sheenRoughnessFactor", NULL},
     {"sheenColorTexture", "sheenRoughnessTexture", NULL},
     ", \"sheenColorFactor\": [0.9, 0.5, 0.3]"},
    {"iridescence",
     {"iridescenceFactor", NULL},
     {"iridescenceTexture", "iridescenceThicknessTexture", NULL},
     ", \"iridescenceThicknessMaximum\": 700"},
    {"anisotropy",
     {"anisotropyStrength", "anisotropyRotation"},
     {"anisotropyTexture", NULL, NULL},
     ""},
    {"transmission",
     {"transmissionFactor", NULL},
     {"transmissionTexture", NULL, NULL},
     ""},
    {"volume",
     {"thicknessFactor", "attenuationDistance"},
     {"thicknessTexture", NULL, NULL},
     ", \"attenuationColor\": [0.9, 0.5, 0.2]"},
    {"volume_scatter",
     {"scatterAnisotropy", NULL},
     {NULL, NULL, NULL},
     ", \"multiscatterColor\": [0.9, 0.4, 0.7]"},
    {"scatter",
     {"scatterStrengthFactor", NULL},
     {NULL, NULL, NULL},
     ", \"multiscatterColorFactor\": [0.9, 0.6, 0.2], "
     "\"scatterAnisotropy\": -0.5"},
    {"dispersion", {"dispersion", NULL}, {NULL, NULL, NULL}, ""},
    {"diffuse_transmission",
     {"diffuseTransmissionFactor", NULL},
     {"diffuseTransmissionTexture", "diffuseTransmissionColorTexture", NULL},
     ", \"diffuseTransmissionColorFactor\": [0.9, 0.6, 0.3]"},
    {"specular",
     {"specularFactor", NULL},
     {"specularTexture", "specularColorTexture", NULL},
     ", \"specularColorFactor\": [0.9, 1.5, 0.8]"},
};
#define RANDOM_EXTENSIONS 11

/* Writes an extension that is missing in most materials, so that each is in
 * some without the others. */
static inline void random_extensions_put(FILE *f, uint64_t *seed)
{
    fprintf(f, "\"extensions\": {\"KHR_materials_ior\": {\"ior\": %.3f}",
            1 + check_random(seed));
    for (int e = 0; e < RANDOM_EXTENSIONS; e++) {
        if (check_random(seed) < 0.6)
            continue;
        fprintf(f, ",\n \"KHR_materials_%s\": {\"extras\": 0%s",
                random_extensions[e].name, random_extensions[e].more);
        for (int k = 0; k < 2; k++)
            if (random_extensions[e].numbers[k] != NULL)
                fprintf(f, ", \"%s\": %.3f", random_extensions[e].numbers[k],
                        0.01 + check_random(seed));
        for (int k = 0; k < 3; k++)
            random_map_put(f, random_extensions[e].maps[k], seed);
        fprintf(f, "}");
    }
    fprintf(f, "}");
}

static inline void random_material_put(FILE *f, uint64_t *seed)
{
    static const char *const modes[] = {"OPAQUE", "MASK", "BLEND"};

    fprintf(f, "{\"alphaMode\": \"%s\", ",
            modes[(int)(3 * check_random(seed))]);
    random_extensions_put(f, seed);
    random_map_put(f, "normalTexture", seed);
    if (check_random(seed) < 0.2) {
        fprintf(f, ", \"emissiveFactor\": [1, %.3f, 0.5]", check_random(seed));
        random_map_put(f, "emissiveTexture", seed);
    }
    fprintf(f,
            ",\n \"pbrMetallicRoughness\": {\"metallicFactor\": %.3f,"
            " \"roughnessFactor\": %.3f, \"baseColorFactor\": "
            "[0.9, 0.8, %.3f, 0.8]",
            fmax(2 * check_random(seed) - 1, 0), check_random(seed),
            check_random(seed));
    random_map_put(f, "baseColorTexture", seed);
    random_map_put(f, "metallicRoughnessTexture", seed);
    fprintf(f, "}}");
}

/* ---- nodes ---- */

/* Writes a node whose matrix may shear and mirror. */
static inline void random_node_put(FILE *f, int mesh, double size,
                                   uint64_t *seed)
{
    fprintf(f, ",\n{\"mesh\": %d, \"matrix\": [", mesh);
    for (int i = 0; i < 16; i++) {
        double spread = i < 12 ? size : 4;

        fprintf(f, "%s%.4f", i > 0 ? ", " : "",
                i == 15      ? 1
                : i % 4 == 3 ? 0
                             : spread * (check_random(seed) - 0.5));
    }
    fprintf(f, "]}");
}

/* Writes meshes and nodes: one of each material, and copies of the first. */
static inline void random_nodes_put(FILE *f, bool has_instances, uint64_t *seed)
{
    int nodes = 3 + RANDOM_MATERIALS + (has_instances ? RANDOM_COPIES : 0);

    fprintf(f, "\"meshes\": [\n");
    for (int m = 0; m < RANDOM_MATERIALS; m++) {
        fprintf(f,
                "{\"primitives\": [{\"material\": %d, \"indices\": %d,"
                " \"attributes\": {\"POSITION\": 0",
                m, RANDOM_ATTRIBUTES);
        for (int a = 1; a < RANDOM_ATTRIBUTES; a++)
            if (a == 2 || check_random(seed) < 0.7)
                fprintf(f, ", \"%s\": %d", random_attributes[a].name, a);
        fprintf(f, "}}]}%s\n", m + 1 < RANDOM_MATERIALS ? "," : "],");
    }
    fprintf(f, "\"nodes\": [\n");
    for (int i = 0; i < 3; i++)
        fprintf(f,
                "%s{\"translation\": [%d, 3, 3], \"extensions\": "
                "{\"KHR_lights_punctual\": {\"light\": %d}}}",
                i > 0 ? ",\n" : "", i - 1, i);
    for (int i = 3; i < nodes; i++)
        random_node_put(f, i < 3 + RANDOM_MATERIALS ? i - 3 : 0,
                        has_instances ? 1.2 : 4, seed);
    fprintf(f, "],\n\"scenes\": [{\"nodes\": [0");
    for (int i = 1; i < nodes; i++)
        fprintf(f, ", %d", i);
    fprintf(f, "]}],\n");
}

/* Writes the files into the folder. Files of different seeds differ in all
 * random choices. */
static inline void random_gltf_write(const char *where, bool has_instances,
                                     uint64_t *seed)
{
    char path[256];
    FILE *f;

    random_grid_write(where, seed);
    random_images_write(where, seed);
    snprintf(path, sizeof path, "%s/random.view", where);
    put(path, "background 0.5 0.6 0.7\n");
    snprintf(path, sizeof path, "%s/random.gltf", where);
    f = fopen(path, "w");
    assert_non_null(f);
    fprintf(f, "{\"asset\": {\"version\": \"2.0\"},\n"
               "\"extensions\": {\"KHR_lights_punctual\": {\"lights\": [\n"
               "{\"type\": \"point\", \"intensity\": 300},\n"
               "{\"type\": \"spot\", \"intensity\": 300, \"spot\": {}},\n"
               "{\"type\": \"directional\", \"intensity\": 2}]}},\n"
               "\"materials\": [\n");
    for (int m = 0; m < RANDOM_MATERIALS; m++) {
        random_material_put(f, seed);
        fprintf(f, "%s\n", m + 1 < RANDOM_MATERIALS ? "," : "],");
    }
    random_textures_put(f, seed);
    random_nodes_put(f, has_instances, seed);
    random_buffer_put(f);
    fprintf(f, "}\n");
    assert_int_equal(fclose(f), 0);
}

#endif
