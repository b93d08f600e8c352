// SPDX-License-Identifier: MIT
#include "read/gltf/gltf_accessor.h"

#include <inttypes.h>
#include <string.h>

#include "base/print.h"
#include "kernels/types.h"

/* Elements without data that a file may have beside the bytes of its buffers.
 */
#define ZEROS_MAX 65536u

static const struct {
    const char *name;
    uint32_t component_count;
} types[] = {
    {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3},  {"VEC4", 4},
    {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16},
};

/* ---- opening ---- */

static bool read_component(const struct gltf_value *v, uint32_t *component,
                           struct error *err)
{
    uint64_t number = 0;

    if (!gltf_integer(v, "componentType", INT64_MAX, &number, err))
        return false;
    *component = (uint32_t)number;
    return gltf_component_bytes(number) > 0 ||
           gltf_fail(v, err,
                     "found componentType %" PRIu64
                     ", expected one of 5120 to 5123, 5125 or 5126",
                     number);
}

static bool read_type(const struct gltf_value *v, uint32_t *component_count,
                      struct error *err)
{
    const char *name = "";

    if (!gltf_string(v, "type", &name, err))
        return false;
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        *component_count = types[i].component_count;
        if (strcmp(name, types[i].name) == 0)
            return true;
    }
    return gltf_fail(v, err,
                     "found the type \"%.20s\", expected SCALAR to MAT4", name);
}

/* Finds the bytes of `count` elements in the view that the value names. */
static bool find_elements(const struct gltf_value *v, uint64_t count,
                          size_t element_bytes, struct gltf_elements *e,
                          struct error *err)
{
    uint64_t offset = 0, size_bytes;
    uint32_t index, align = gltf_component_bytes(e->component);
    const struct gltf_view *view;

    if (!gltf_index(v, "bufferView", "bufferViews", &index, err) ||
        !gltf_integer(v, "byteOffset", INT64_MAX, &offset, err))
        return false;
    e->bytes = NULL;
    if (index == NO_INDEX)
        return true;
    view = &v->document->views[index];
    e->stride_bytes =
        view->stride_bytes != 0 ? view->stride_bytes : element_bytes;
    if (e->stride_bytes < element_bytes)
        return gltf_fail(v, err,
                         "found a byteStride of %zu, expected %zu or more",
                         e->stride_bytes, element_bytes);
    if (offset % align != 0 || e->stride_bytes % align != 0)
        return gltf_fail(v, err,
                         "found a byteOffset of %" PRIu64
                         " and a byteStride of %zu, expected multiples of "
                         "%" PRIu32,
                         offset, e->stride_bytes, align);
    size_bytes = view->data.size_bytes;
    if (count == 0 ||
        (offset <= size_bytes && size_bytes - offset >= element_bytes &&
         count - 1 <=
             (size_bytes - offset - element_bytes) / e->stride_bytes)) {
        e->bytes = count > 0 ? view->data.bytes + offset : NULL;
        return true;
    }
    return gltf_fail(v, err,
                     "found %" PRIu64 " element%s from byte %" PRIu64
                     " on, expected a part of the %" PRIu64
                     " bytes of view %" PRIu32,
                     count, print_plural(count), offset, size_bytes, index);
}

static uint32_t read_unsigned(const struct gltf_elements *e, uint32_t i)
{
    const unsigned char *p = e->bytes + i * e->stride_bytes;

    if (e->component == GLTF_U8)
        return p[0];
    if (e->component == GLTF_U16)
        return p[0] | (uint32_t)p[1] << 8;
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 |
           (uint32_t)p[3] << 24;
}

static bool check_sparse_indices(const struct gltf_value *v,
                                 const struct gltf_accessor *a,
                                 struct error *err)
{
    uint32_t least = 0;

    for (uint32_t i = 0; i < a->sparse_count; i++) {
        uint32_t index = read_unsigned(&a->sparse_indices, i);

        if (index < least || index >= a->count)
            return gltf_fail(v, err,
                             "found %" PRIu32 ", expected rising numbers "
                             "of the %" PRIu32 " elements",
                             index, a->count);
        least = index + 1;
    }
    return true;
}

static bool open_sparse(const struct gltf_value *accessor, size_t element_bytes,
                        struct gltf_accessor *a, struct error *err)
{
    struct gltf_value v, indices, values;
    uint64_t count = 0;

    if (!gltf_object(accessor, "sparse", &v, err))
        return false;
    if (v.json == NULL)
        return true;
    a->sparse_values.component = a->dense.component;
    if (!gltf_integer(&v, "count", a->count, &count, err) ||
        !gltf_object(&v, "indices", &indices, err) ||
        !gltf_object(&v, "values", &values, err) ||
        !read_component(&indices, &a->sparse_indices.component, err) ||
        !find_elements(&indices, count,
                       gltf_component_bytes(a->sparse_indices.component),
                       &a->sparse_indices, err) ||
        !find_elements(&values, count, element_bytes, &a->sparse_values, err))
        return false;
    a->sparse_count = (uint32_t)count;
    if (count > 0 &&
        (a->sparse_indices.bytes == NULL || a->sparse_values.bytes == NULL))
        return gltf_fail(&v, err,
                         "found no bufferView of its indices or values");
    return check_sparse_indices(&indices, a, err);
}

bool gltf_accessor_open(const struct gltf_document *document, uint32_t index,
                        struct gltf_accessor *a, struct error *err)
{
    struct gltf_value v;
    uint64_t count = 0, most;
    size_t element_bytes;

    memset(a, 0, sizeof *a);
    if (!gltf_entry(document, "accessors", index, &v, err) ||
        !gltf_integer(&v, "count", NO_INDEX - 1, &count, err) ||
        !gltf_flag(&v, "normalized", &a->is_normalized, err) ||
        !read_component(&v, &a->dense.component, err) ||
        !read_type(&v, &a->component_count, err))
        return false;
    element_bytes =
        (size_t)a->component_count * gltf_component_bytes(a->dense.component);
    a->count = (uint32_t)count;
    if (!find_elements(&v, count, element_bytes, &a->dense, err) ||
        !open_sparse(&v, element_bytes, a, err))
        return false;
    /* zeros cost nothing in the file: they shall not fill the memory */
    most = document->buffer_bytes + ZEROS_MAX;
    return a->dense.bytes != NULL || count <= most ||
           gltf_fail(&v, err,
                     "found %" PRIu64 " elements without data, expected at "
                     "most %" PRIu64 " in a file of its size",
                     count, most);
}

/* ---- reading ---- */

static float signed_unit(float value)
{
    return value < -1 ? -1 : value;
}

/* Returns the number at these bytes. */
static inline float number_at(const unsigned char *p, uint32_t component,
                              bool is_normalized)
{
    struct gltf_elements one = {p, 0, component};
    uint32_t bits;
    float x;

    switch (component) {
    case GLTF_I8:
        x = (float)(int8_t)*p;
        return is_normalized ? signed_unit(x / 127) : x;
    case GLTF_U8: x = (float)*p; return is_normalized ? x / 255 : x;
    case GLTF_I16:
        one.component = GLTF_U16;
        x = (float)(int16_t)read_unsigned(&one, 0);
        return is_normalized ? signed_unit(x / 32767) : x;
    case GLTF_U16:
        x = (float)read_unsigned(&one, 0);
        return is_normalized ? x / 65535 : x;
    case GLTF_U32: return (float)read_unsigned(&one, 0);
    default:
        bits = read_unsigned(&one, 0);
        memcpy(&x, &bits, sizeof x);
        return x;
    }
}

/* Elements to read, of `n` components each. */
struct range {
    uint32_t first, count, n;
};

/* The compiler makes a loop without branches where the component is a constant.
 */
static inline void floats_as(uint32_t component, const struct gltf_elements *e,
                             struct range r, bool is_normalized, float *to)
{
    uint32_t size = gltf_component_bytes(component);

    for (uint32_t i = 0; i < r.count; i++) {
        const unsigned char *p = e->bytes + (r.first + i) * e->stride_bytes;

        for (uint32_t k = 0; k < r.n; k++)
            *to++ = number_at(p + k * size, component, is_normalized);
    }
}

static void read_floats(const struct gltf_elements *e, struct range r,
                        bool is_normalized, float *to)
{
    if (e->component == GLTF_FLOAT)
        floats_as(GLTF_FLOAT, e, r, false, to);
    else
        floats_as(e->component, e, r, is_normalized, to);
}

static inline void integers_as(uint32_t component,
                               const struct gltf_elements *e, struct range r,
                               uint32_t *to)
{
    uint32_t size = gltf_component_bytes(component);

    for (uint32_t i = 0; i < r.count; i++) {
        struct gltf_elements one = {e->bytes + (r.first + i) * e->stride_bytes,
                                    size, component};

        for (uint32_t k = 0; k < r.n; k++)
            *to++ = read_unsigned(&one, k);
    }
}

static void read_integers(const struct gltf_elements *e, struct range r,
                          uint32_t *to)
{
    if (e->component == GLTF_U16)
        integers_as(GLTF_U16, e, r, to);
    else if (e->component == GLTF_U32)
        integers_as(GLTF_U32, e, r, to);
    else
        integers_as(e->component, e, r, to);
}

/* Returns the first sparse element whose number is not below `index`. */
static uint32_t find_sparse(const struct gltf_accessor *a, uint32_t index)
{
    uint32_t begin = 0, end = a->sparse_count;

    while (begin < end) {
        uint32_t middle = begin + (end - begin) / 2;

        if (read_unsigned(&a->sparse_indices, middle) < index)
            begin = middle + 1;
        else
            end = middle;
    }
    return begin;
}

void gltf_accessor_floats(const struct gltf_accessor *a, uint32_t first,
                          uint32_t count, float *to)
{
    uint32_t n = a->component_count;

    if (a->dense.bytes != NULL)
        read_floats(&a->dense, (struct range){first, count, n},
                    a->is_normalized, to);
    else
        memset(to, 0, (size_t)count * n * sizeof *to);
    for (uint32_t s = find_sparse(a, first); s < a->sparse_count; s++) {
        uint32_t index = read_unsigned(&a->sparse_indices, s);

        if (index - first >= count)
            break;
        read_floats(&a->sparse_values, (struct range){s, 1, n},
                    a->is_normalized, to + (size_t)n * (index - first));
    }
}

void gltf_accessor_integers(const struct gltf_accessor *a, uint32_t first,
                            uint32_t count, uint32_t *to)
{
    uint32_t n = a->component_count;

    if (a->dense.bytes != NULL)
        read_integers(&a->dense, (struct range){first, count, n}, to);
    else
        memset(to, 0, (size_t)count * n * sizeof *to);
    for (uint32_t s = find_sparse(a, first); s < a->sparse_count; s++) {
        uint32_t index = read_unsigned(&a->sparse_indices, s);

        if (index - first >= count)
            break;
        read_integers(&a->sparse_values, (struct range){s, 1, n},
                      to + (size_t)n * (index - first));
    }
}
