// SPDX-License-Identifier: MIT
#include "read/gltf/gltf_animation.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "read/gltf/gltf_accessor.h"
#include "kernels/types.h"

enum interpolation { LINEAR, STEP, CUBICSPLINE, INTERPOLATIONS };

static const char *const interpolations[INTERPOLATIONS] = {"LINEAR", "STEP",
                                                           "CUBICSPLINE"};

struct sampler {
    struct gltf_accessor times, values;
    int interpolation;
    uint32_t width; /* numbers of a key */
};

/* Memory of a weight: its own, and four of keys while it is computed. */
#define WEIGHT_BYTES (sizeof(double) + 4 * sizeof(float))

/* Position of the time between two keys. */
struct span {
    uint32_t key;     /* the one before */
    double part;      /* 0 at that key, 1 at the next one */
    double seconds;   /* between the two */
    uint32_t next_by; /* 1; 0 if there is no other key */
};

/* ---- samplers ---- */

static bool read_interpolation(const struct gltf_value *v, int *to,
                               struct error *err)
{
    const char *name = interpolations[LINEAR];

    if (!gltf_string(v, "interpolation", &name, err))
        return false;
    for (*to = 0; *to < INTERPOLATIONS; ++*to)
        if (strcmp(name, interpolations[*to]) == 0)
            return true;
    return gltf_fail(v, err,
                     "found the interpolation \"%.20s\", expected LINEAR, "
                     "STEP or CUBICSPLINE",
                     name);
}

/* Opens a sampler whose keys have `component_count` numbers, or for 0 as many
 * weights as the values give each key. */
static bool open_sampler(const struct gltf_value *v, uint32_t component_count,
                         struct sampler *s, struct error *err)
{
    uint32_t input, output, keys;
    uint64_t numbers;

    if (!gltf_index(v, "input", "accessors", &input, err) ||
        !gltf_index(v, "output", "accessors", &output, err) ||
        !read_interpolation(v, &s->interpolation, err))
        return false;
    if (input == NO_INDEX || output == NO_INDEX)
        return gltf_fail(v, err, "found no input or no output");
    if (!gltf_accessor_open(v->document, input, &s->times, err) ||
        !gltf_accessor_open(v->document, output, &s->values, err))
        return false;
    keys = s->times.count;
    numbers = (uint64_t)s->values.count * s->values.component_count;
    if (s->interpolation == CUBICSPLINE)
        numbers /= 3;
    s->width = component_count > 0 ? component_count
               : keys > 0          ? (uint32_t)(numbers / keys)
                                   : 0;
    return (keys > 0 && s->times.component_count == 1 &&
            s->values.component_count ==
                (component_count > 0 ? component_count : 1) &&
            numbers >= (uint64_t)keys * s->width) ||
           gltf_fail(v, err,
                     "found %" PRIu32 " keys for %" PRIu32 " values of %" PRIu32
                     " components, which do not fit",
                     keys, s->values.count, s->values.component_count);
}

static double time_of(const struct sampler *s, uint32_t key)
{
    float time;

    gltf_accessor_floats(&s->times, key, 1, &time);
    return (double)time;
}

static struct span find_span(const struct sampler *s, double time_s)
{
    uint32_t begin = 0, end = s->times.count - 1;
    struct span span = {0, 0, 0, 0};

    while (begin < end) {
        uint32_t middle = begin + (end - begin + 1) / 2;

        if (time_of(s, middle) <= time_s)
            begin = middle;
        else
            end = middle - 1;
    }
    span.key = begin;
    if (begin + 1 == s->times.count || !(time_of(s, begin) < time_s))
        return span;
    span.seconds = time_of(s, begin + 1) - time_of(s, begin);
    if (!(span.seconds > 0 && span.seconds < INFINITY))
        return span; /* times that do not rise */
    span.next_by = 1;
    span.part = (time_s - time_of(s, begin)) / span.seconds;
    return span;
}

/* Reads the numbers of a key: those of its value, or with CUBICSPLINE of its
 * in-tangent (0), value (1) or out-tangent (2). */
static void read_key(const struct sampler *s, uint32_t key, uint32_t kind,
                     float *to)
{
    uint32_t elements = s->width / s->values.component_count;
    uint32_t row = s->interpolation == CUBICSPLINE ? 3 * key + kind : key;

    gltf_accessor_floats(&s->values, row * elements, elements, to);
}

/* Turns from quaternion a to b by the shorter way, at a steady rate. */
static void slerp(const float *a, const float *b, double part, double *to)
{
    double cosine = 0, angle, weight_a = 1 - part, weight_b = part, sign;

    for (int i = 0; i < 4; i++)
        cosine += (double)a[i] * (double)b[i];
    sign = cosine < 0 ? -1 : 1;
    cosine = fmin(fabs(cosine), 1);
    angle = acos(cosine);
    if (angle > 1e-4) {
        weight_a = sin((1 - part) * angle) / sin(angle);
        weight_b = sin(part * angle) / sin(angle);
    }
    for (int i = 0; i < 4; i++)
        to[i] = weight_a * (double)a[i] + sign * weight_b * (double)b[i];
}

/* Hermite's spline with the tangents of the keys. `buffer` begins with their
 * values. */
static void spline(const struct sampler *s, struct span p, float *buffer,
                   double *to)
{
    const float *a = buffer, *b = buffer + s->width;
    float *out = buffer + 2 * (size_t)s->width;
    float *in = buffer + 3 * (size_t)s->width;
    double t = p.part, t2 = t * t, t3 = t2 * t;

    read_key(s, p.key, 2, out);
    read_key(s, p.key + p.next_by, 0, in);
    for (uint32_t i = 0; i < s->width; i++)
        to[i] = (2 * t3 - 3 * t2 + 1) * (double)a[i] +
                p.seconds * (t3 - 2 * t2 + t) * (double)out[i] +
                (3 * t2 - 2 * t3) * (double)b[i] +
                p.seconds * (t3 - t2) * (double)in[i];
}

/* Computes the numbers at the time. `buffer` has room for four keys. */
static void sample(const struct sampler *s, double time_s, bool is_rotation,
                   float *buffer, double *to)
{
    struct span p = find_span(s, time_s);
    float *a = buffer, *b = buffer + s->width;

    read_key(s, p.key, 1, a);
    read_key(s, p.key + p.next_by, 1, b);
    if (p.next_by == 0 || s->interpolation == STEP) {
        for (uint32_t i = 0; i < s->width; i++)
            to[i] = (double)a[i];
    } else if (s->interpolation == CUBICSPLINE) {
        spline(s, p, buffer, to);
    } else if (is_rotation) {
        slerp(a, b, p.part, to);
    } else {
        for (uint32_t i = 0; i < s->width; i++)
            to[i] = (1 - p.part) * (double)a[i] + p.part * (double)b[i];
    }
}

/* ---- channels ---- */

static bool pose_weights(const struct gltf_value *sampler, double time_s,
                         struct gltf_node *node, struct error *err)
{
    struct sampler s;
    float *buffer;

    if (!open_sampler(sampler, 0, &s, err) ||
        !gltf_take(sampler, s.width, WEIGHT_BYTES, "weights", err))
        return false;
    free(node->weights);
    node->weights = alloc_array(s.width, sizeof *node->weights);
    buffer = alloc_array(4 * (size_t)s.width, sizeof *buffer);
    if (node->weights != NULL && buffer != NULL)
        sample(&s, time_s, false, buffer, node->weights);
    node->weight_count = s.width;
    free(buffer);
    return (node->weights != NULL && buffer != NULL) ||
           gltf_fail(sampler, err, "out of memory for its weights");
}

static bool pose_numbers(const struct gltf_value *sampler, double time_s,
                         uint32_t count, double *to, struct error *err)
{
    struct sampler s;
    float buffer[16];

    if (!open_sampler(sampler, count, &s, err))
        return false;
    sample(&s, time_s, count == 4, buffer, to);
    return true;
}

/* Channels without a node, and those of paths that extensions add, have no
 * effect. */
static bool pose_channel(const struct gltf_value *channel,
                         const struct gltf_value *samplers, double time_s,
                         struct gltf_nodes *nodes, struct error *err)
{
    struct gltf_value target, sampler;
    uint64_t number = UINT64_MAX;
    struct gltf_node *n;
    const char *path = "";
    uint32_t node;

    if (!gltf_object(channel, "target", &target, err) ||
        !gltf_index(&target, "node", "nodes", &node, err) ||
        !gltf_string(&target, "path", &path, err) ||
        !gltf_integer(channel, "sampler", INT64_MAX, &number, err))
        return false;
    if (node == NO_INDEX)
        return true;
    if (number >= gltf_count(samplers))
        return gltf_fail(channel, err, "found no sampler, expected one of %zu",
                         gltf_count(samplers));
    if (!gltf_item_object(samplers, (size_t)number, &sampler, err))
        return false;
    n = &nodes->items[node];
    if (strcmp(path, "translation") == 0)
        return pose_numbers(&sampler, time_s, 3, n->translation, err);
    if (strcmp(path, "rotation") == 0)
        return pose_numbers(&sampler, time_s, 4, n->rotation, err);
    if (strcmp(path, "scale") == 0)
        return pose_numbers(&sampler, time_s, 3, n->scale, err);
    return strcmp(path, "weights") != 0 ||
           pose_weights(&sampler, time_s, n, err);
}

bool gltf_animation_pose(const struct gltf_document *document,
                         uint32_t animation, double time_s,
                         struct gltf_nodes *nodes, struct error *err)
{
    struct gltf_value v, channels, samplers, channel;

    if (!gltf_entry(document, "animations", animation, &v, err) ||
        !gltf_array(&v, "channels", &channels, err) ||
        !gltf_array(&v, "samplers", &samplers, err))
        return false;
    for (size_t i = 0; i < gltf_count(&channels); i++)
        if (!gltf_item_object(&channels, i, &channel, err) ||
            !pose_channel(&channel, &samplers, time_s, nodes, err))
            return false;
    return true;
}
