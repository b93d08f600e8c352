// SPDX-License-Identifier: MIT
/*
 * The JSON is read by jansson. libcjson is 3 times as fast (150 instead of 45
 * MB/s), with the same memory, 9 times the text. But it names neither place nor
 * reason of an error, takes broken UTF-8, and its arrays and objects are lists,
 * so that a file of 100,000 nodes takes time of the square of their number.
 */
#include "read/gltf/gltf_document.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/lexer.h"
#include "base/memory.h"
#include "base/print.h"
#include "read/gltf/gltf_buffer.h"
#include "read/gltf/gltf_draco.h"
#include "read/gltf/gltf_texture.h"
#include "read/gltf/gltf_value.h"

/* Bytes of the headers of a .glb file and of a chunk. */
#define GLB_HEADER_BYTES   12
#define CHUNK_HEADER_BYTES 8

/* Types of chunks: "JSON" and "BIN". */
#define CHUNK_JSON 0x4e4f534au
#define CHUNK_BIN  0x004e4942u

/* Most that a value of the JSON takes, and an object with the node, camera,
 * light, image or mesh that is made of it; 70 and 520 were measured. */
#define VALUE_BYTES  100
#define OBJECT_BYTES 600

static bool is_glb(const char *bytes, size_t size_bytes)
{
    return size_bytes >= 4 && memcmp(bytes, "glTF", 4) == 0;
}

bool gltf_matches(const char *bytes, size_t size_bytes)
{
    size_t i = 0;

    lexer_trim(&bytes, &size_bytes);
    while (i < size_bytes && strchr(" \t\r\n", bytes[i]) != NULL &&
           bytes[i] != '\0')
        i++;
    return is_glb(bytes, size_bytes) || (i < size_bytes && bytes[i] == '{');
}

/* ---- extensions ---- */

static const char *const known[] = {
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    GLTF_DRACO,
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_scatter",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_materials_volume_scatter",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    GLTF_BASISU,
    "KHR_texture_transform",
};

static bool is_known(const char *name)
{
    if (strcmp(name, GLTF_DRACO) == 0 && gltf_draco_missing() != NULL)
        return false;
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
        if (strcmp(name, known[i]) == 0)
            return true;
    return false;
}

/* Reads a list of names. */
static bool read_names(const struct gltf_document *d, const char *key,
                       struct gltf_value *names, struct error *err)
{
    struct gltf_value root = gltf_root(d);

    if (!gltf_array(&root, key, names, err))
        return false;
    names->parent = NULL;
    for (size_t i = 0; i < gltf_count(names); i++)
        if (!json_is_string(json_array_get(names->json, i)))
            return gltf_fail(names, err,
                             "found an item that is no string, expected names "
                             "of extensions");
    return true;
}

/* Refuses unknown extensions that are required. Those that are only used are a
 * warning. */
static bool gltf_extensions_check(const struct gltf_document *document,
                                  struct warnings *report, struct error *err)
{
    struct gltf_value required, used;

    if (!read_names(document, "extensionsRequired", &required, err) ||
        !read_names(document, "extensionsUsed", &used, err))
        return false;
    for (size_t i = 0; i < gltf_count(&required); i++) {
        const char *name = json_string_value(json_array_get(required.json, i));

        if (strcmp(name, GLTF_DRACO) == 0 && gltf_draco_missing() != NULL)
            return fail(err,
                        "%s: found the required extension '" GLTF_DRACO
                        "', which needs " GLTF_DRACO_NEEDS,
                        document->path);
        if (strcmp(name, GLTF_BASISU) == 0 &&
            !gltf_textures_are_readable(document))
            return fail(err,
                        "%s: found the required extension '" GLTF_BASISU
                        "', expected " GLTF_BASISU_EXPECTED,
                        document->path);
        if (!is_known(name))
            return fail(err,
                        "%s: found the required extension '%.80s', expected "
                        "one that glim knows",
                        document->path, name);
    }
    for (size_t i = 0; i < gltf_count(&used); i++) {
        const char *name = json_string_value(json_array_get(used.json, i));

        if (!is_known(name))
            warnings_add_named(report, "extensions that glim does not know",
                               name,
                               "%s: found the extension '%.80s', which glim "
                               "does not know: ignored",
                               document->path, name);
    }
    return true;
}

/* ---- the container ---- */

static uint32_t read_u32(const char *p)
{
    const unsigned char *b = (const unsigned char *)p;

    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 |
           (uint32_t)b[3] << 24;
}

/* A .glb file, and the place in it. */
struct container {
    const char *path, *bytes;
    size_t size_bytes, at;
};

/* Reads the chunk at the place, if there is one, and moves behind it. */
static bool read_chunk(struct container *c, uint32_t *type,
                       struct gltf_bytes *chunk, struct error *err)
{
    size_t length, left = c->size_bytes - c->at;

    if (left < CHUNK_HEADER_BYTES)
        return fail(err,
                    "%s: found %zu byte%s at byte %zu, expected a chunk of %d "
                    "bytes or more",
                    c->path, left, print_plural(left), c->at,
                    CHUNK_HEADER_BYTES);
    left -= CHUNK_HEADER_BYTES;
    length = read_u32(c->bytes + c->at);
    if (length > left)
        return fail(err,
                    "%s: found a chunk of %zu bytes at byte %zu, expected at "
                    "most %zu",
                    c->path, length, c->at, left);
    *type = read_u32(c->bytes + c->at + 4);
    c->at += CHUNK_HEADER_BYTES;
    chunk->bytes = (const unsigned char *)c->bytes + c->at;
    chunk->size_bytes = length;
    c->at += length;
    return true;
}

/* Finds the chunks of a .glb file. Unknown ones are skipped. */
static bool read_container(struct gltf_document *d, const char *bytes,
                           size_t size_bytes, struct gltf_bytes *json,
                           struct error *err)
{
    struct container c = {d->path, bytes, size_bytes, GLB_HEADER_BYTES};
    uint32_t type = 0;
    size_t left;

    if (size_bytes < GLB_HEADER_BYTES)
        return fail(err, "%s: found %zu byte%s, expected a .glb file", d->path,
                    size_bytes, print_plural(size_bytes));
    if (read_u32(bytes + 4) != 2)
        return fail(err, "%s: found glTF %" PRIu32 ".0, expected glTF 2.0",
                    d->path, read_u32(bytes + 4));
    if (read_u32(bytes + 8) < size_bytes)
        c.size_bytes = read_u32(bytes + 8);
    if (c.size_bytes < GLB_HEADER_BYTES)
        c.size_bytes = GLB_HEADER_BYTES;
    if (!read_chunk(&c, &type, json, err))
        return false;
    if (type != CHUNK_JSON)
        return fail(err,
                    "%s: found a chunk of type 0x%08" PRIx32
                    " first, expected JSON",
                    d->path, type);
    while (c.size_bytes - c.at >= CHUNK_HEADER_BYTES) {
        struct gltf_bytes chunk = {NULL, 0, NULL};

        if (!read_chunk(&c, &type, &chunk, err))
            return false;
        if (type == CHUNK_BIN && d->chunk.bytes == NULL)
            d->chunk = chunk;
    }
    left = c.size_bytes - c.at;
    return left == 0 ||
           fail(err, "%s: found %zu byte%s at byte %zu, expected a chunk",
                d->path, left, print_plural(left), c.at);
}

/* ---- the JSON ---- */

/* Takes the memory of the JSON and of what is made of its objects. Each value
 * follows one of [{,: in the text. */
static bool take_json(const struct gltf_document *d, struct gltf_bytes json,
                      struct error *err)
{
    struct gltf_value root = gltf_root(d);
    uint64_t object_count = 0, value_count = 0;

    for (size_t i = 0; i < json.size_bytes; i++) {
        unsigned char c = json.bytes[i];

        object_count += c == '{';
        value_count += c == '[' || c == ',' || c == ':';
    }
    return gltf_take(&root, json.size_bytes, 1, "bytes of JSON", err) &&
           gltf_take(&root, value_count, VALUE_BYTES, "values", err) &&
           gltf_take(&root, object_count, OBJECT_BYTES, "objects", err);
}

/* Whether an allocation of the JSON library has failed in this thread, which
 * then reports that it has read a wrong token. */
static _Thread_local bool lacks_memory;

static void *json_memory(size_t size_bytes)
{
    void *p = malloc(size_bytes);

    lacks_memory = lacks_memory || p == NULL;
    return p;
}

static void watch_json_memory(void)
{
    json_set_alloc_funcs(json_memory, free);
}

static bool read_json(struct gltf_document *d, struct gltf_bytes json,
                      struct error *err)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    const char *text = (const char *)json.bytes;
    json_error_t e = {.text = ""};
    size_t at = 0;

    lexer_trim(&text, &json.size_bytes);
    while (at < json.size_bytes && memchr(" \t\r\n", text[at], 4) != NULL)
        at++;
    if (at < json.size_bytes && text[at] != '{' && text[at] != '[')
        return fail(err, "%s: found no glTF, expected '{' or a GLB header",
                    d->path);
    if (!take_json(d, json, err))
        return false;
    pthread_once(&once, watch_json_memory);
    lacks_memory = false;
    d->root = json_loadb(text, json.size_bytes, 0, &e);
    if (d->root == NULL && lacks_memory)
        return fail(err, "%s: out of memory for its JSON", d->path);
    if (d->root == NULL)
        return fail(err, "%s:%d:%d: found JSON that cannot be read: %s",
                    d->path, e.line, e.column, e.text);
    return json_is_object(d->root) ||
           fail(err, "%s: found JSON that is no object, expected glTF",
                d->path);
}

/* Returns true for "2", "2.0" and "2.1". */
static bool is_version_2(const char *version)
{
    return version[0] == '2' && (version[1] == '.' || version[1] == '\0');
}

static bool check_version(const struct gltf_document *d, struct error *err)
{
    struct gltf_value root = gltf_root(d), asset;
    const char *version = "", *least = "2.0";

    if (!gltf_object(&root, "asset", &asset, err))
        return false;
    if (asset.json == NULL)
        return gltf_fail(&root, err, "found no asset, expected glTF 2.0");
    if (!gltf_string(&asset, "version", &version, err) ||
        !gltf_string(&asset, "minVersion", &least, err))
        return false;
    if (!is_version_2(version))
        return gltf_fail(&asset, err, "found glTF \"%.20s\", expected glTF 2.0",
                         version);
    return strcmp(least, "2.0") == 0 || strcmp(least, "2") == 0 ||
           gltf_fail(&asset, err,
                     "found minVersion \"%.20s\", expected glTF 2.0", least);
}

/* The arrays that gltf_entry() reads are checked here. */
static bool check_collections(const struct gltf_document *d, struct error *err)
{
    static const char *const names[] = {
        "accessors", "animations", "bufferViews", "buffers", "cameras",
        "images",    "materials",  "meshes",      "nodes",   "samplers",
        "scenes",    "skins",      "textures",
    };
    static const char *const lists[][2] = {
        {"KHR_lights_punctual", "lights"},
        {"KHR_materials_variants", "variants"},
    };
    struct gltf_value root = gltf_root(d), array, extension;

    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (!gltf_array(&root, names[i], &array, err))
            return false;
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++)
        if (!gltf_extension(&root, lists[i][0], &extension, err) ||
            !gltf_array(&extension, lists[i][1], &array, err))
            return false;
    return true;
}

bool gltf_document_open(struct gltf_document *document, const char *bytes,
                        size_t size_bytes, const char *path,
                        struct warnings *report, struct error *err)
{
    struct gltf_bytes json = {(const unsigned char *)bytes, size_bytes, NULL};

    document->path = path;
    if (document->memory != NULL)
        memory_budget_add_file(document->memory, size_bytes);
    return (!is_glb(bytes, size_bytes) ||
            read_container(document, bytes, size_bytes, &json, err)) &&
           read_json(document, json, err) && check_version(document, err) &&
           check_collections(document, err) &&
           gltf_extensions_check(document, report, err) &&
           gltf_buffers_read(document, err) && gltf_views_read(document, err);
}

void gltf_document_close(struct gltf_document *document)
{
    for (size_t i = 0; i < document->buffer_count; i++)
        free(document->buffers[i].owned);
    for (size_t i = 0; i < document->file_count; i++) {
        free(document->files[i].path);
        free(document->files[i].data.owned);
    }
    for (size_t i = 0; i < document->view_count; i++)
        free(document->views[i].data.owned);
    free(document->buffers);
    free(document->files);
    free(document->views);
    free(document->unpacked);
    json_decref(document->root);
    memset(document, 0, sizeof *document);
}
