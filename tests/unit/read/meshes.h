// SPDX-License-Identifier: MIT
/*
 * meshes.h - PLY and STL files in memory, loaded as scenes
 *
 * Threads:   one
 * Errors:    a failed check ends the test
 */
#ifndef TESTS_MESHES_H
#define TESTS_MESHES_H

#include <math.h>
#include <stdlib.h>

#include "engine/scene_load.h"
#include "tests/unit/check.h"

struct mesh_file {
    struct scene scene;
    struct warnings report;
    struct error err;
    bool ok;
};

/* Parses a copy of exactly this size, so that reads beyond it are found. The
 * scene is not finished. */
static inline struct mesh_file parse_bytes(const char *path, const void *bytes,
                                           size_t size_bytes)
{
    struct mesh_file m = {.ok = false};
    char *copy = malloc(size_bytes > 0 ? size_bytes : 1);

    assert_non_null(copy);
    memcpy(copy, bytes, size_bytes);
    m.ok = scene_format_of(path, copy, size_bytes)
               ->parse(&m.scene, copy, size_bytes, path, &m.report, &m.err);
    free(copy);
    return m;
}

static inline struct mesh_file parse_good(const char *path, const void *bytes,
                                          size_t size_bytes)
{
    struct mesh_file m = parse_bytes(path, bytes, size_bytes);

    check_or_say(m.ok, m.err.text);
    return m;
}

static inline void mesh_file_free(struct mesh_file *m)
{
    scene_free(&m->scene);
    warnings_free(&m->report);
}

/* Checks the message of a text that is refused. */
static inline void check_refused(const char *path, const char *text,
                                 const char *message)
{
    struct mesh_file m = parse_bytes(path, text, strlen(text));

    assert_false(m.ok);
    assert_string_equal(m.err.text, message);
    mesh_file_free(&m);
}

static inline void check_position(const struct scene *s, uint32_t v, double x,
                                  double y, double z)
{
    check_close(s->file_positions[3 * v], x, 0);
    check_close(s->file_positions[3 * v + 1], y, 0);
    check_close(s->file_positions[3 * v + 2], z, 0);
}

static inline void check_color(struct vec3 c, double r, double g, double b)
{
    check_close((double)c.x, r, 1e-6);
    check_close((double)c.y, g, 1e-6);
    check_close((double)c.z, b, 1e-6);
}

/* Returns the linear value of an sRGB channel: IEC 61966-2-1. */
static inline double linear(double x)
{
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

/* Bytes of a binary file that is being written. */
struct bytes {
    char data[4096];
    size_t size;
    bool is_big;
};

/* Appends the lowest bytes of a number in the file's order. */
static inline void add_bits(struct bytes *b, uint64_t bits, unsigned count)
{
    assert_true(b->size + count <= sizeof b->data);
    for (unsigned i = 0; i < count; i++) {
        unsigned shift = 8 * (b->is_big ? count - 1 - i : i);

        b->data[b->size++] = (char)(unsigned char)(bits >> shift);
    }
}

static inline void add_float(struct bytes *b, float x)
{
    uint32_t bits;

    memcpy(&bits, &x, sizeof bits);
    add_bits(b, bits, 4);
}

static inline void add_double(struct bytes *b, double x)
{
    uint64_t bits;

    memcpy(&bits, &x, sizeof bits);
    add_bits(b, bits, 8);
}

static inline void add_text(struct bytes *b, const char *text)
{
    assert_true(b->size + strlen(text) <= sizeof b->data);
    memcpy(b->data + b->size, text, strlen(text));
    b->size += strlen(text);
}

#endif
