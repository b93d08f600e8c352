// SPDX-License-Identifier: MIT
#include "read/gltf/gltf_buffer.h"

#include <ctype.h>
#include <inttypes.h>
#include <meshoptimizer.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/print.h"
#include "read/asset_path.h"
#include "kernels/types.h"

/* ---- EXT_meshopt_compression ---- */

enum mode { MODE_ATTRIBUTES, MODE_TRIANGLES, MODE_INDICES, MODES };
enum filter {
    FILTER_NONE,
    FILTER_OCTAHEDRAL,
    FILTER_QUATERNION,
    FILTER_EXPONENTIAL,
    FILTERS
};

static const char *const modes[MODES] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
static const char *const filters[FILTERS] = {"NONE", "OCTAHEDRAL", "QUATERNION",
                                             "EXPONENTIAL"};

/* Most bytes that a packed byte stands for: 2 bits for a group of 16 bytes. */
#define RATIO 64u

struct packed {
    struct gltf_bytes data;
    uint64_t stride, count;
    int mode, filter;
};

static bool read_name(const struct gltf_value *extension, const char *key,
                      const char *const *names, int count, int *to,
                      struct error *err)
{
    const char *name = NULL;

    if (!gltf_string(extension, key, &name, err))
        return false;
    if (name == NULL)
        return true;
    for (*to = 0; *to < count; ++*to)
        if (strcmp(name, names[*to]) == 0)
            return true;
    return gltf_fail(extension, err, "found the %s \"%.20s\", which is unknown",
                     key, name);
}

/* Returns true if the decoders accept the size of elements: they check it by
 * assertions at most. */
static bool is_stride(const struct packed *p)
{
    if (p->mode != MODE_ATTRIBUTES)
        return (p->stride == 2 || p->stride == 4) && p->filter == FILTER_NONE;
    if (p->filter == FILTER_OCTAHEDRAL)
        return p->stride == 4 || p->stride == 8;
    if (p->filter == FILTER_QUATERNION)
        return p->stride == 8;
    return p->stride > 0 && p->stride <= 256 && p->stride % 4 == 0;
}

static bool read_packed(const struct gltf_value *extension, struct packed *p,
                        struct error *err)
{
    p->mode = MODES;
    if (!gltf_buffer_part(extension, &p->data, err) ||
        !gltf_integer(extension, "byteStride", 256, &p->stride, err) ||
        !gltf_integer(extension, "count", UINT32_MAX, &p->count, err) ||
        !read_name(extension, "mode", modes, MODES, &p->mode, err) ||
        !read_name(extension, "filter", filters, FILTERS, &p->filter, err))
        return false;
    if (p->mode == MODES)
        return gltf_fail(extension, err,
                         "found no mode, expected ATTRIBUTES, "
                         "TRIANGLES or INDICES");
    if (!is_stride(p))
        return gltf_fail(extension, err,
                         "found a byteStride of %" PRIu64
                         ", which mode and filter do not have",
                         p->stride);
    return p->mode != MODE_TRIANGLES || p->count % 3 == 0 ||
           gltf_fail(extension, err,
                     "found a count of %" PRIu64 ", expected whole triangles",
                     p->count);
}

/* Returns false if the packed bytes are broken. */
static bool decode(const struct packed *p, void *to)
{
    const unsigned char *bytes = p->data.bytes;
    size_t count = (size_t)p->count, stride = (size_t)p->stride;
    size_t size_bytes = p->data.size_bytes;

    if (p->mode == MODE_TRIANGLES)
        return meshopt_decodeIndexBuffer(to, count, stride, bytes,
                                         size_bytes) == 0;
    if (p->mode == MODE_INDICES)
        return meshopt_decodeIndexSequence(to, count, stride, bytes,
                                           size_bytes) == 0;
    if (meshopt_decodeVertexBuffer(to, count, stride, bytes, size_bytes) != 0)
        return false;
    if (p->filter == FILTER_OCTAHEDRAL)
        meshopt_decodeFilterOct(to, count, stride);
    if (p->filter == FILTER_QUATERNION)
        meshopt_decodeFilterQuat(to, count, stride);
    if (p->filter == FILTER_EXPONENTIAL)
        meshopt_decodeFilterExp(to, count, stride);
    return true;
}

bool gltf_meshopt_unpack(const struct gltf_value *extension,
                         struct gltf_view *view, struct error *err)
{
    struct packed p = {.stride = 0};
    uint64_t size_bytes, most;

    if (!read_packed(extension, &p, err))
        return false;
    size_bytes = p.count * p.stride;
    /* a block of vertices is at least as long as its header */
    most = RATIO * (uint64_t)p.data.size_bytes + 256 * p.stride;
    if (size_bytes > most)
        return gltf_fail(extension, err,
                         "found %" PRIu64 " bytes packed into %zu, expected "
                         "at most %" PRIu64,
                         size_bytes, p.data.size_bytes, most);
    if (!gltf_take(extension, size_bytes, 1, "unpacked bytes", err))
        return false;
    view->data.owned = alloc_array((size_t)size_bytes, 1);
    view->data.bytes = view->data.owned;
    view->data.size_bytes = (size_t)size_bytes;
    view->stride_bytes = (size_t)p.stride;
    if (view->data.owned == NULL)
        return gltf_fail(extension, err, "out of memory for its bytes");
    return decode(&p, view->data.owned) ||
           gltf_fail(extension, err,
                     "found bytes that meshoptimizer cannot unpack");
}

/* ---- buffers ---- */

/* Strides of the specification; vertices of meshopt have the same limit. */
#define STRIDE_MAX 252

static bool out_of_memory(const struct gltf_value *v, struct error *err)
{
    return gltf_fail(v, err, "out of memory for its bytes");
}

/* ---- URIs ---- */

static int hex_digit(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* Decodes %20 and its like. Other text stays, for files that are not encoded.
 * The result is for free(), with a NUL behind its *size_bytes. */
static char *decode_percents(const char *text, size_t *size_bytes)
{
    char *to = alloc_array(strlen(text) + 1, 1);
    size_t n = 0;

    for (const char *p = text; to != NULL && *p != '\0'; p++) {
        int high = *p == '%' ? hex_digit(p[1]) : -1;
        int low = high >= 0 ? hex_digit(p[2]) : -1;

        to[n++] = low >= 0 ? (char)(16 * high + low) : *p;
        p += low >= 0 ? 2 : 0;
    }
    *size_bytes = n;
    return to;
}

static int base64_digit(char c)
{
    return c >= 'A' && c <= 'Z'   ? c - 'A'
           : c >= 'a' && c <= 'z' ? c - 'a' + 26
           : c >= '0' && c <= '9' ? c - '0' + 52
           : c == '+' || c == '-' ? 62
           : c == '/' || c == '_' ? 63
                                  : -1;
}

/* Decodes base64 with or without = at its end. Returns false at another
 * character. */
static bool decode_base64(const char *text, unsigned char *to,
                          size_t *size_bytes)
{
    uint32_t bits = 0;
    int bit_count = 0;
    size_t n = 0;

    for (; *text != '\0' && *text != '='; text++) {
        int digit = base64_digit(*text);

        if (digit < 0)
            return false;
        bits = (bits << 6 | (uint32_t)digit) & 0xffffff;
        bit_count += 6;
        if (bit_count >= 8) {
            bit_count -= 8;
            to[n++] = (unsigned char)(bits >> bit_count);
        }
    }
    *size_bytes = n;
    return text[strspn(text, "=")] == '\0' && bit_count < 6;
}

bool gltf_uri_is_data(const char *uri)
{
    return strncasecmp(uri, "data:", 5) == 0;
}

bool gltf_uri_read(const struct gltf_value *v, const char *uri,
                   struct gltf_bytes *to, struct error *err)
{
    const char *comma = strchr(uri, ',');
    unsigned char *bytes;
    bool is_base64;

    memset(to, 0, sizeof *to);
    if (comma == NULL)
        return gltf_fail(v, err,
                         "found a data URI without a comma, expected data");
    if (!gltf_take(v, strlen(comma), 1, "bytes of data", err))
        return false;
    is_base64 = comma - uri >= 7 && strncasecmp(comma - 7, ";base64", 7) == 0;
    if (!is_base64) {
        to->owned = decode_percents(comma + 1, &to->size_bytes);
        to->bytes = to->owned;
        return to->owned != NULL || out_of_memory(v, err);
    }
    bytes = alloc_array(strlen(comma) / 4 * 3 + 3, 1);
    to->owned = bytes;
    to->bytes = bytes;
    if (bytes == NULL)
        return out_of_memory(v, err);
    return decode_base64(comma + 1, bytes, &to->size_bytes) ||
           gltf_fail(v, err, "found a data URI that is no base64");
}

/* Returns true for "http:" and its like, but not for a drive such as "C:". */
static bool has_scheme(const char *uri)
{
    size_t n = 0;

    while (isalnum((unsigned char)uri[n]) ||
           (uri[n] != '\0' && strchr("+-.", uri[n]) != NULL))
        n++;
    return n > 1 && uri[n] == ':';
}

bool gltf_uri_find(const struct gltf_value *value, const char *uri, char **path,
                   struct error *err)
{
    size_t size_bytes;
    char *name;
    bool ok;

    *path = NULL;
    if (has_scheme(uri))
        return gltf_fail(value, err,
                         "found \"%.80s\", expected data or the name of a file",
                         uri);
    name = decode_percents(uri, &size_bytes);
    if (name == NULL)
        return out_of_memory(value, err);
    if (strlen(name) != size_bytes) {
        free(name);
        return gltf_fail(value, err, "found \"%.80s\", a name with a NUL", uri);
    }
    ok = asset_path_find(value->document->path, name, path) &&
         (*path != NULL || asset_path_find(value->document->path, uri, path));
    free(name);
    if (!ok)
        return out_of_memory(value, err);
    return *path != NULL ||
           gltf_fail(value, err, "found no file \"%.200s\"", uri);
}

/* ---- buffers ---- */

/* Reads a file into *data. The budget grows by it. */
static bool read_new_file(struct gltf_document *d, const struct gltf_value *v,
                          const char *path, const struct file_identity *file,
                          struct gltf_bytes *data, struct error *err)
{
    struct error own;
    char *bytes;

    if (d->memory != NULL)
        memory_budget_add_file(d->memory, (uint64_t)file->size_bytes);
    if (!gltf_take(v, (uint64_t)file->size_bytes, 1, "bytes of a buffer", err))
        return false;
    if (!file_read(path, &bytes, &data->size_bytes, &own))
        return gltf_fail(v, err, "%s", own.text);
    data->owned = bytes;
    data->bytes = data->owned;
    return true;
}

/* Finds the bytes of a file, which is read once however many buffers name
 * it. */
static bool read_file(struct gltf_document *d, const struct gltf_value *v,
                      const char *path, struct gltf_bytes *to,
                      struct error *err)
{
    struct file_identity identity = file_identify(path);
    struct gltf_file *file = d->files;
    struct gltf_file *end = file + d->file_count;

    while (file < end && !file_is_same(&file->identity, &identity))
        file++;
    if (file == end) {
        file->identity = identity;
        file->path = strdup(path);
        d->file_count++;
        if (file->path == NULL)
            return fail(err, "%s: out of memory for its buffers", d->path);
        if (!read_new_file(d, v, path, &identity, &file->data, err))
            return false;
    }
    *to = file->data;
    to->owned = NULL;
    return true;
}

static bool read_uri(struct gltf_document *d, const struct gltf_value *v,
                     const char *uri, struct gltf_bytes *to, struct error *err)
{
    char *path;
    bool ok;

    if (gltf_uri_is_data(uri))
        return gltf_uri_read(v, uri, to, err);
    if (!gltf_uri_find(v, uri, &path, err))
        return false;
    ok = read_file(d, v, path, to, err);
    free(path);
    return ok;
}

/* A buffer without bytes is allowed: it may be one that meshopt's views name
 * for other readers. */
static bool read_buffer(struct gltf_document *d, size_t i, struct error *err)
{
    struct gltf_value v;
    struct gltf_bytes *b = &d->buffers[i];
    uint64_t length = 0;
    const char *uri = NULL;

    if (!gltf_entry(d, "buffers", i, &v, err) ||
        !gltf_string(&v, "uri", &uri, err) ||
        !gltf_integer(&v, "byteLength", INT64_MAX, &length, err))
        return false;
    if (uri != NULL && !read_uri(d, &v, uri, b, err))
        return false;
    if (uri == NULL && i == 0)
        *b = d->chunk;
    if (b->bytes == NULL)
        return true;
    if (b->size_bytes < length)
        return gltf_fail(
            &v, err, "found %zu byte%s, expected the byteLength of %" PRIu64,
            b->size_bytes, print_plural(b->size_bytes), length);
    b->size_bytes = (size_t)length;
    d->buffer_bytes += length;
    return true;
}

bool gltf_buffers_read(struct gltf_document *document, struct error *err)
{
    size_t count = gltf_entry_count(document, "buffers");

    document->buffers = alloc_array(count, sizeof *document->buffers);
    document->files = alloc_array(count, sizeof *document->files);
    if (document->buffers == NULL || document->files == NULL)
        return fail(err, "%s: out of memory for its buffers", document->path);
    document->buffer_count = count;
    for (size_t i = 0; i < count; i++)
        if (!read_buffer(document, i, err))
            return false;
    return true;
}

/* ---- views ---- */

bool gltf_buffer_part(const struct gltf_value *value, struct gltf_bytes *to,
                      struct error *err)
{
    const struct gltf_document *d = value->document;
    uint64_t offset = 0, length = 0;
    uint32_t buffer;

    if (!gltf_index(value, "buffer", "buffers", &buffer, err) ||
        !gltf_integer(value, "byteOffset", INT64_MAX, &offset, err) ||
        !gltf_integer(value, "byteLength", INT64_MAX, &length, err))
        return false;
    if (buffer == NO_INDEX)
        return gltf_fail(value, err, "found no buffer, expected its number");
    *to = d->buffers[buffer];
    to->owned = NULL;
    if (to->bytes == NULL)
        return gltf_fail(value, err,
                         "found buffer %" PRIu32
                         " without a uri, expected one with data",
                         buffer);
    if (offset > to->size_bytes || length > to->size_bytes - offset)
        return gltf_fail(
            value, err,
            "found bytes %" PRIu64 " to %" PRIu64
            ", expected a part of the %zu bytes of buffer %" PRIu32,
            offset, offset + length, to->size_bytes, buffer);
    to->bytes += offset;
    to->size_bytes = (size_t)length;
    return true;
}

static bool read_view(struct gltf_document *d, size_t i, struct error *err)
{
    struct gltf_view *view = &d->views[i];
    struct gltf_value v, meshopt;
    uint64_t stride = 0;

    if (!gltf_entry(d, "bufferViews", i, &v, err) ||
        !gltf_integer(&v, "byteStride", STRIDE_MAX, &stride, err) ||
        !gltf_extension(&v, "EXT_meshopt_compression", &meshopt, err))
        return false;
    view->stride_bytes = (size_t)stride;
    return meshopt.json == NULL ? gltf_buffer_part(&v, &view->data, err)
                                : gltf_meshopt_unpack(&meshopt, view, err);
}

bool gltf_views_read(struct gltf_document *document, struct error *err)
{
    size_t count = gltf_entry_count(document, "bufferViews");

    document->views = alloc_array(count, sizeof *document->views);
    if (document->views == NULL)
        return fail(err, "%s: out of memory for its views", document->path);
    document->view_count = count;
    for (size_t i = 0; i < count; i++)
        if (!read_view(document, i, err))
            return false;
    return true;
}
