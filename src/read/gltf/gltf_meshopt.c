// SPDX-License-Identifier: MIT
#include "read/gltf/gltf_meshopt.h"

#include <inttypes.h>
#include <string.h>

#include <meshoptimizer.h>

#include "base/memory.h"
#include "read/gltf/gltf_buffer.h"

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
