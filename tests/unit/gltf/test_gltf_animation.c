// SPDX-License-Identifier: MIT
/*
 * test_gltf_animation.c - poses against closed forms
 */
#include "read/gltf/gltf_animation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "tests/unit/check.h"

/* A document of one node and one animated path. */
struct animated {
    struct gltf_document document;
    struct gltf_nodes nodes;
    char *text;
};

/* Appends the bytes of floats as a URI has them. */
static char *percents(const float *numbers, size_t count)
{
    const unsigned char *bytes = (const unsigned char *)numbers;
    char *text = alloc_array(3 * sizeof *numbers * count + 1, 1);

    assert_non_null(text);
    for (size_t i = 0; i < sizeof *numbers * count; i++)
        sprintf(text + 3 * i, "%%%02X", bytes[i]);
    return text;
}

/* Poses a node of which `path` is animated by keys at 0, 1 and 3 seconds. */
static void pose(struct animated *a, const char *path, const char *type,
                 const char *interpolation, const float *values, size_t count,
                 size_t components, double time_s)
{
    static const float times[3] = {0, 1, 3};
    char *inputs = percents(times, 3), *outputs = percents(values, count);
    struct warnings report = {0};
    struct error err;

    *a = (struct animated){.text = NULL};
    a->text = format_text(
        "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{}],"
        "\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":"
        "{\"node\":0,\"path\":\"%s\"}}],\"samplers\":[{\"input\":0,"
        "\"output\":1,\"interpolation\":\"%s\"}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
        "\"type\":\"SCALAR\"},{\"bufferView\":1,\"componentType\":5126,"
        "\"count\":%zu,\"type\":\"%s\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":12},"
        "{\"buffer\":1,\"byteLength\":%zu}],"
        "\"buffers\":[{\"byteLength\":12,\"uri\":\"data:,%s\"},"
        "{\"byteLength\":%zu,\"uri\":\"data:,%s\"}]}",
        path, interpolation, count / components, type, 4 * count, inputs,
        4 * count, outputs);
    assert_non_null(a->text);
    check_or_say(gltf_document_open(&a->document, a->text, strlen(a->text),
                                    "test.gltf", &report, &err) &&
                     gltf_nodes_read(&a->document, &a->nodes, &err) &&
                     gltf_animation_pose(&a->document, 0, time_s, &a->nodes,
                                         &err),
                 err.text);
    assert_int_equal(report.entry_count, 0);
    free(inputs);
    free(outputs);
}

static void end(struct animated *a)
{
    gltf_nodes_free(&a->nodes);
    gltf_document_close(&a->document);
    free(a->text);
}

static void translations_are_linear_between_keys(void **state)
{
    static const float values[] = {0, 0, 0, 2, 4, 6, 2, 0, -2};
    static const double cases[][4] = {
        {-1, 0, 0, 0}, {0.25, 0.5, 1, 1.5}, {1, 2, 4, 6},
        {2, 2, 2, 2},  {3, 2, 0, -2},       {9, 2, 0, -2},
    };
    struct animated a;

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        pose(&a, "translation", "VEC3", "LINEAR", values, 9, 3, cases[i][0]);
        for (int k = 0; k < 3; k++)
            check_close(a.nodes.items[0].translation[k], cases[i][1 + k],
                        1e-12);
        end(&a);
    }
}

static void steps_keep_the_key_before(void **state)
{
    static const float values[] = {1, 1, 1, 2, 2, 2, 3, 3, 3};
    static const double cases[][2] = {{0.999, 1}, {1, 2}, {2.999, 2}, {3, 3}};
    struct animated a;

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        pose(&a, "scale", "VEC3", "STEP", values, 9, 3, cases[i][0]);
        check_close(a.nodes.items[0].scale[1], cases[i][1], 0);
        end(&a);
    }
}

static double polynomial(double t)
{
    return ((t - 2) * t + 1) * t + 1;
}

static double slope(double t)
{
    return (3 * t - 4) * t + 1;
}

/* A spline with the slopes of a polynomial of degree 3 is this polynomial. */
static void splines_reproduce_polynomials(void **state)
{
    static const double times[3] = {0, 1, 3};
    float values[27];
    struct animated a;

    (void)state;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            values[9 * i + k] = (float)slope(times[i]);
            values[9 * i + 3 + k] = (float)polynomial(times[i]);
            values[9 * i + 6 + k] = (float)slope(times[i]);
        }
    for (double t = 0; t <= 3; t += 0.375) {
        pose(&a, "translation", "VEC3", "CUBICSPLINE", values, 27, 3, t);
        check_close(a.nodes.items[0].translation[2], polynomial(t), 1e-12);
        end(&a);
    }
}

/* From no turn to one of 90 degrees about z, whose quaternion is negated, and
 * on to one of 180: the shorter way at a steady rate. */
static void rotations_take_the_shorter_way(void **state)
{
    static const float half = 0.70710678f;
    const float values[] = {0, 0, 0, 1, 0, 0, -half, -half, 0, 0, 1, 0};
    static const double cases[][2] = {
        {0.5, 45}, {0.25, 22.5}, {1, 90}, {2, 135}, {2.5, 157.5}};
    static const double none[3] = {0, 0, 0}, ones[3] = {1, 1, 1};
    struct animated a;

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct affine m;

        pose(&a, "rotation", "VEC4", "LINEAR", values, 12, 4, cases[i][0]);
        m = gltf_matrix(none, a.nodes.items[0].rotation, ones);
        check_close(m.m[0][0], cos(cases[i][1] * M_PI / 180), 1e-7);
        check_close(m.m[1][0], sin(cases[i][1] * M_PI / 180), 1e-7);
        check_close(m.m[2][2], 1, 1e-7);
        end(&a);
    }
}

static void weights_are_of_all_targets(void **state)
{
    static const float values[] = {0, 1, 0.5f, 0, 1, 1};
    struct animated a;

    (void)state;
    pose(&a, "weights", "SCALAR", "LINEAR", values, 6, 1, 0.5);
    assert_int_equal(a.nodes.items[0].weight_count, 2);
    check_close(a.nodes.items[0].weights[0], 0.25, 1e-12);
    check_close(a.nodes.items[0].weights[1], 0.5, 1e-12);
    end(&a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(translations_are_linear_between_keys),
        cmocka_unit_test(steps_keep_the_key_before),
        cmocka_unit_test(splines_reproduce_polynomials),
        cmocka_unit_test(rotations_take_the_shorter_way),
        cmocka_unit_test(weights_are_of_all_targets),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
