// SPDX-License-Identifier: MIT
#include "read/npy.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "read/vdb_bytes.h"

static const char magic[] = "\x93NUMPY";

#define MAGIC_BYTES 6

/* Longest side of an array. */
#define SIDE_MAX 2048

/* Types of numbers; an array has one of them. */
enum npy_type { NPY_HALF, NPY_FLOAT, NPY_DOUBLE, NPY_BYTE, NPY_WORD };

static const struct {
    const char *name;
    uint32_t size_bytes;
} types[] = {{"f2", 2}, {"f4", 4}, {"f8", 8}, {"u1", 1}, {"u2", 2}};

enum { TYPES = sizeof types / sizeof types[0] };

struct npy {
    const uint8_t *numbers;
    enum npy_type type;
    bool is_big;      /* the first byte of a number is the highest */
    uint32_t size[3]; /* of x, y and z */
    size_t step[3];   /* numbers between neighbours along each */
    uint32_t replaced_count;
};

bool npy_matches(const char *bytes, size_t size_bytes)
{
    return size_bytes >= MAGIC_BYTES && memcmp(bytes, magic, MAGIC_BYTES) == 0;
}

/* ---- the header ---- */

/* Returns what follows a key of the header, before its end, or NULL. */
static const char *value_of(const char *header, const char *end,
                            const char *key)
{
    size_t length = strlen(key);

    for (const char *p = header; p + length <= end; p++) {
        if (memcmp(p, key, length) != 0)
            continue;
        p += length;
        while (p < end && (*p == ' ' || *p == ':'))
            p++;
        return p;
    }
    return NULL;
}

/* Reads a type such as '<f4'. */
static bool read_type(struct npy *n, const char *p, const char *end,
                      struct error *err)
{
    if (p != NULL && end - p >= 5 && (*p == '\'' || *p == '"'))
        for (int i = 0; i < TYPES; i++) {
            if (memchr("<>|=", p[1], 4) == NULL ||
                memcmp(p + 2, types[i].name, 2) != 0 || p[4] != p[0])
                continue;
            n->type = (enum npy_type)i;
            n->is_big = p[1] == '>';
            return true;
        }
    return fail(err, "found an array of other numbers, expected f2, f4, f8, "
                     "u1 or u2");
}

/* Reads a side from 1 to SIDE_MAX, of digits before the end. */
static bool read_side(const char **p, const char *end, uint32_t *side)
{
    *side = 0;
    while (*p < end && **p >= '0' && **p <= '9' && *side <= SIDE_MAX)
        *side = 10 * *side + (uint32_t)(*(*p)++ - '0');
    return *side >= 1 && *side <= SIDE_MAX;
}

static const char *skip_blanks(const char *p, const char *end)
{
    while (p < end && (*p == ' ' || *p == ','))
        p++;
    return p;
}

/* Reads a shape such as (16, 16, 8), whose last number is that of x. */
static bool read_shape(struct npy *n, const char *p, const char *end,
                       struct error *err)
{
    int count = 0;

    if (p != NULL && p < end && *p++ == '(')
        for (p = skip_blanks(p, end);
             count < 3 && read_side(&p, end, &n->size[2 - count]); count++)
            p = skip_blanks(p, end);
    return (count == 3 && p < end && *p == ')') ||
           fail(err,
                "found an array of another shape, expected 3 axes of 1 to "
                "%d numbers",
                SIDE_MAX);
}

static bool read_order(struct npy *n, const char *p, const char *end,
                       struct error *err)
{
    bool x_is_first = p != NULL && end - p >= 4 && memcmp(p, "True", 4) == 0;
    size_t step = 1;

    if (!x_is_first &&
        !(p != NULL && end - p >= 5 && memcmp(p, "False", 5) == 0))
        return fail(err, "found no order of axes in its header, expected "
                         "'fortran_order': True or False");
    for (int i = 0; i < 3; i++) {
        int axis = x_is_first ? 2 - i : i;

        n->step[axis] = step;
        step *= n->size[axis];
    }
    return true;
}

static bool read_header(struct npy *n, const char *bytes, size_t size_bytes,
                        struct error *err)
{
    const uint8_t *b = (const uint8_t *)bytes;
    size_t begin = MAGIC_BYTES + 4, length, have, want;
    const char *end;

    if (!npy_matches(bytes, size_bytes) || size_bytes < MAGIC_BYTES + 6 ||
        b[MAGIC_BYTES] < 1 || b[MAGIC_BYTES] > 3)
        return fail(err, "found no header of a NumPy file of version 1 to 3");
    length = b[8] | (size_t)b[9] << 8;
    if (b[MAGIC_BYTES] > 1) {
        begin += 2;
        length |= (size_t)b[10] << 16 | (size_t)b[11] << 24;
    }
    if (length > size_bytes - begin)
        return fail(err, "found the end of the file in its header");
    bytes += begin;
    end = bytes + length;
    if (!read_type(n, value_of(bytes, end, "'descr'"), end, err) ||
        !read_shape(n, value_of(bytes, end, "'shape'"), end, err) ||
        !read_order(n, value_of(bytes, end, "'fortran_order'"), end, err))
        return false;
    n->numbers = b + begin + length;
    have = size_bytes - begin - length;
    want = (size_t)n->size[0] * n->size[1] * n->size[2] *
           types[n->type].size_bytes;
    return have == want ||
           fail(err, "found %zu bytes of numbers, expected %zu by its shape",
                have, want);
}

/* ---- numbers ---- */

static double number_of(enum npy_type type, const uint8_t *b)
{
    float f;
    double d;

    switch (type) {
    case NPY_HALF: return (double)vdb_half(b);
    case NPY_BYTE: return b[0];
    case NPY_WORD: return b[0] | b[1] << 8;
    case NPY_FLOAT: memcpy(&f, b, sizeof f); return (double)f;
    case NPY_DOUBLE: break;
    }
    memcpy(&d, b, sizeof d);
    return d;
}

/* Returns a number of the array. */
static float number_at(struct npy *n, const uint32_t at[3])
{
    uint32_t size = types[n->type].size_bytes;
    const uint8_t *p =
        n->numbers +
        (at[0] * n->step[0] + at[1] * n->step[1] + at[2] * n->step[2]) * size;
    uint8_t b[8];
    double value;

    for (uint32_t i = 0; i < size; i++)
        b[i] = p[n->is_big ? size - 1 - i : i];
    value = number_of(n->type, b);
    if (isfinite(value))
        return (float)fmin(fmax(value, -(double)VOXEL_VALUE_MAX),
                           (double)VOXEL_VALUE_MAX);
    n->replaced_count++;
    return 0;
}

/* Reads the brick at a place. Returns false if all of it is 0. */
static bool read_brick(struct npy *n, const uint32_t place[3],
                       float values[BRICK_VOXELS])
{
    bool is_there = false;

    for (uint32_t i = 0; i < BRICK_VOXELS; i++) {
        uint32_t at[3] = {place[0] * BRICK_SIDE + i / 64,
                          place[1] * BRICK_SIDE + i / 8 % 8,
                          place[2] * BRICK_SIDE + i % 8};

        values[i] =
            at[0] < n->size[0] && at[1] < n->size[1] && at[2] < n->size[2]
                ? number_at(n, at)
                : 0;
        is_there = is_there || values[i] < 0 || values[i] > 0;
    }
    return is_there;
}

/* Fills index and values. Brick 0 is that of empty places. */
static bool read_bricks(struct npy *n, struct voxel_grid *g)
{
    uint64_t places = voxel_grid_place_count(g), room = 1;

    g->index = alloc_array(places, sizeof *g->index);
    g->values = alloc_array(BRICK_VOXELS, sizeof *g->values);
    g->brick_count = 1;
    for (uint64_t i = 0; i < places; i++) {
        uint32_t place[3] = {(uint32_t)(i / g->sides[2] / g->sides[1]),
                             (uint32_t)(i / g->sides[2] % g->sides[1]),
                             (uint32_t)(i % g->sides[2])};

        if (g->index == NULL || g->values == NULL)
            return false;
        if (g->brick_count == room) {
            float *grown;

            room = room * 2 < places + 1 ? room * 2 : places + 1;
            grown = realloc(g->values, room * BRICK_VOXELS * sizeof *grown);
            if (grown == NULL)
                return false;
            g->values = grown;
        }
        if (read_brick(n, place,
                       g->values + (size_t)g->brick_count * BRICK_VOXELS))
            g->index[i] = g->brick_count++;
    }
    return true;
}

bool npy_parse(struct voxel_grid *grid, const char *bytes, size_t size_bytes,
               struct error *err)
{
    struct npy n = {.numbers = NULL};

    memset(grid, 0, sizeof *grid);
    if (!read_header(&n, bytes, size_bytes, err))
        return false;
    for (int a = 0; a < 3; a++) {
        grid->last[a] = (int32_t)n.size[a] - 1;
        grid->sides[a] = (n.size[a] + BRICK_SIDE - 1) / BRICK_SIDE;
        grid->to_world.m[a][a] = 1;
        grid->to_world.m[a][3] = 0.5;
    }
    if (!read_bricks(&n, grid) || !voxel_grid_bound(grid))
        return fail(err, "out of memory for its voxels");
    grid->replaced_count = n.replaced_count;
    return true;
}
