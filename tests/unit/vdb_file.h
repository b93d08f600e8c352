// SPDX-License-Identifier: MIT
/*
 * vdb_file.h - writes small OpenVDB files for tests
 *
 * A grid is a function of the voxel. It has leaves in its box, and tiles
 * elsewhere. Inactive values are stored as OpenVDB stores them: as the kind
 * that needs the fewest bytes.
 *
 * Units:     voxels, bytes
 * Ownership: vdb_file_end() returns memory for free()
 * Threads:   one
 * Errors:    a failed check ends the test
 */
#ifndef TESTS_VDB_FILE_H
#define TESTS_VDB_FILE_H

#include <math.h>
#include <zlib.h>

#include "base/library_child.h"
#include "read/vdb_bytes.h"
#include "tests/unit/check.h"

/* Returns the value of a voxel, and whether it is active. */
typedef float vdb_voxel(const void *context, const int32_t voxel[3],
                        bool *is_active);

/* A tile of 8, 128 or 4096 voxels on a side. */
struct vdb_tile {
    int32_t origin[3], side;
    float value;
    bool is_active;
};

struct vdb_grid {
    const char *name, *type; /* of type NULL: floats */
    const char *parent;      /* unique name of the grid whose tree it has */
    uint32_t flags;
    bool is_half;
    float background;
    vdb_voxel *voxel;
    const void *context;
    int32_t first[3], last[3]; /* box of the leaves; first > last: none */
    const struct vdb_tile *tiles;
    int tile_count;
    const char *class;  /* "level set", .., or NULL */
    bool is_of_blender; /* has what Blender's fluids add */
    const char *map;    /* NULL: a scale of 1 */
    const double *map_numbers;
    int map_count;
};

struct vdb_file {
    FILE *to;
    char *bytes;
    size_t size_bytes;
    const struct vdb_grid *grid;
};

/* ---- numbers ---- */

static inline void vdb_put_u32(struct vdb_file *f, uint32_t n)
{
    fwrite(&n, sizeof n, 1, f->to);
}

static inline void vdb_put_i64(struct vdb_file *f, int64_t n)
{
    fwrite(&n, sizeof n, 1, f->to);
}

static inline void vdb_put_float(struct vdb_file *f, float number)
{
    fwrite(&number, sizeof number, 1, f->to);
}

static inline void vdb_put_text(struct vdb_file *f, const char *text)
{
    vdb_put_u32(f, (uint32_t)strlen(text));
    fputs(text, f->to);
}

/* Returns the bits of a number that a half float has exactly. */
static inline uint16_t half_bits(float number)
{
    uint16_t sign = signbit(number) ? 0x8000 : 0;
    int exponent;
    float fraction = frexpf(fabsf(number), &exponent);

    if (isinf(number) || isnan(number))
        return sign | (isinf(number) ? 0x7c00 : 0x7e00);
    if (number == 0 || exponent < -13) /* below 2^-14 */
        return sign | (uint16_t)ldexpf(fabsf(number), 24);
    return sign | (uint16_t)((exponent + 14) << 10) |
           (uint16_t)(ldexpf(fraction, 11) - 1024);
}

/* ---- values ---- */

static inline size_t vdb_pack_blosc(const void *from, size_t size_bytes,
                                    size_t item_bytes, void *to, size_t room)
{
    struct {
        int (*compress)(int level, int shuffle, size_t item_bytes,
                        size_t size_bytes, const void *from, void *to,
                        size_t room, const char *by, size_t block_bytes,
                        int threads);
    } blosc;
    static const struct library_function f = {"blosc_compress_ctx", 0};
    const char *missing;
    int packed_bytes;

    assert_true(dynamic_library_load("libblosc.so.1", &f, 1, &blosc, &missing));
    packed_bytes = blosc.compress(9, 1, item_bytes, size_bytes, from, to, room,
                                  "lz4", size_bytes, 1);
    assert_true(packed_bytes >= 0);
    return (size_t)packed_bytes;
}

static inline void vdb_put_packed(struct vdb_file *f, const void *bytes,
                                  size_t size_bytes)
{
    uint32_t flags = f->grid->flags;
    size_t room = compressBound(size_bytes);
    unsigned char *packed = malloc(room + 64);
    size_t packed_bytes = 0;

    assert_non_null(packed);
    if ((flags & VDB_BLOSC) != 0) {
        packed_bytes = vdb_pack_blosc(bytes, size_bytes,
                                      f->grid->is_half ? 2 : 4, packed, room);
    } else if ((flags & VDB_ZIP) != 0) {
        uLongf length = room;

        assert_int_equal(compress(packed, &length, bytes, size_bytes), Z_OK);
        packed_bytes = length;
    }
    if (packed_bytes > 0 && packed_bytes < size_bytes) {
        vdb_put_i64(f, (int64_t)packed_bytes);
        fwrite(packed, 1, packed_bytes, f->to);
    } else {
        if ((flags & (VDB_ZIP | VDB_BLOSC)) != 0)
            vdb_put_i64(f, -(int64_t)size_bytes);
        fwrite(bytes, 1, size_bytes, f->to);
    }
    free(packed);
}

/* The kind of inactive values: up to two, and which of them the mask has. */
struct vdb_inactive {
    int kind, count;
    float values[2];
};

static inline struct vdb_inactive vdb_inactive_of(const float *values,
                                                  const bool *active,
                                                  uint32_t count, float bg)
{
    struct vdb_inactive k = {.kind = 0};

    for (uint32_t i = 0; i < count; i++) {
        bool is_known = active[i];

        for (int n = 0; n < k.count; n++)
            is_known |= values[i] == k.values[n];
        if (is_known)
            continue;
        if (k.count == 2)
            return (struct vdb_inactive){.kind = 6};
        k.values[k.count++] = values[i];
    }
    if (k.count == 2 && k.values[0] == bg) {
        k.values[0] = k.values[1];
        k.values[1] = bg;
    }
    if (k.count == 1)
        k.kind = k.values[0] == bg ? 0 : k.values[0] == -bg ? 1 : 2;
    else if (k.count == 2)
        k.kind = k.values[1] != bg ? 5 : k.values[0] == -bg ? 3 : 4;
    return k;
}

static inline void vdb_put_mask(struct vdb_file *f, const bool *bits,
                                uint32_t count)
{
    for (uint32_t i = 0; i < count; i += 8) {
        int byte = 0;

        for (uint32_t b = 0; b < 8; b++)
            byte |= bits[i + b] << b;
        fputc(byte, f->to);
    }
}

static inline void vdb_put_inactive(struct vdb_file *f,
                                    const struct vdb_inactive *k,
                                    const float *values, uint32_t count)
{
    bool *is_second = calloc(count, sizeof *is_second);

    assert_non_null(is_second);
    fputc(k->kind, f->to);
    if (k->kind == 2 || k->kind == 4 || k->kind == 5)
        vdb_put_float(f, k->values[0]);
    if (k->kind == 5)
        vdb_put_float(f, k->values[1]);
    for (uint32_t i = 0; i < count; i++)
        is_second[i] = values[i] == k->values[1];
    if (k->kind >= 3 && k->kind <= 5)
        vdb_put_mask(f, is_second, count);
    free(is_second);
}

static inline void vdb_put_values(struct vdb_file *f, const float *values,
                                  const bool *active, uint32_t count)
{
    bool has_mask = (f->grid->flags & VDB_ACTIVE_MASK) != 0;
    struct vdb_inactive k = {.kind = 6};
    float *floats = calloc(count, sizeof *floats);
    uint16_t *halves = calloc(count, sizeof *halves);
    uint32_t stored = 0;

    assert_true(floats != NULL && halves != NULL);
    if (has_mask)
        k = vdb_inactive_of(values, active, count, f->grid->background);
    vdb_put_inactive(f, &k, values, count);
    for (uint32_t i = 0; i < count; i++) {
        if (k.kind != 6 && !active[i])
            continue;
        floats[stored] = values[i];
        halves[stored++] = half_bits(values[i]);
    }
    if (!f->grid->is_half)
        vdb_put_packed(f, floats, stored * sizeof *floats);
    else if (stored > 0)
        vdb_put_packed(f, halves, stored * sizeof *halves);
    free(floats);
    free(halves);
}

/* ---- nodes ---- */

/* Returns true if a cube meets the box of the leaves, or has a smaller tile. */
static inline bool vdb_is_child(const struct vdb_grid *g,
                                const int32_t origin[3], int32_t side)
{
    bool is_in = true;

    for (int a = 0; a < 3; a++)
        is_in &= g->first[a] <= g->last[a] && origin[a] <= g->last[a] &&
                 origin[a] + side > g->first[a];
    for (int i = 0; !is_in && i < g->tile_count; i++) {
        is_in = g->tiles[i].side < side;
        for (int a = 0; a < 3; a++)
            is_in &= g->tiles[i].origin[a] >= origin[a] &&
                     g->tiles[i].origin[a] < origin[a] + side;
    }
    return is_in;
}

/* Returns the tile with this voxel, or NULL. */
static inline const struct vdb_tile *vdb_tile_at(const struct vdb_grid *g,
                                                 const int32_t voxel[3])
{
    for (int i = 0; i < g->tile_count; i++) {
        bool is_in = true;

        for (int a = 0; a < 3; a++)
            is_in &= voxel[a] >= g->tiles[i].origin[a] &&
                     voxel[a] < g->tiles[i].origin[a] + g->tiles[i].side;
        if (is_in)
            return &g->tiles[i];
    }
    return NULL;
}

/* Places of the children of a node with 2^log2 children on a side. */
static inline void vdb_child_at(const int32_t origin[3], int log2, int32_t side,
                                uint32_t i, int32_t to[3])
{
    for (int a = 0; a < 3; a++)
        to[a] = origin[a] +
                (int32_t)(i >> (2 - a) * log2 & ((1u << log2) - 1)) * side;
}

static inline void vdb_put_leaf(struct vdb_file *f, const int32_t origin[3],
                                bool has_values)
{
    float values[512];
    bool active[512];

    for (uint32_t i = 0; i < 512; i++) {
        int32_t voxel[3];

        vdb_child_at(origin, 3, 1, i, voxel);
        values[i] = f->grid->voxel(f->grid->context, voxel, &active[i]);
    }
    vdb_put_mask(f, active, 512);
    if (has_values)
        vdb_put_values(f, values, active, 512);
}

/* Writes the node of this side, without the values of leaves or these alone. */
static inline void vdb_put_node(struct vdb_file *f, const int32_t origin[3],
                                int32_t side, bool has_values)
{
    int log2 = side == 4096 ? 5 : 4;
    int32_t child_side = side >> log2, at[3];
    uint32_t count = 1u << 3 * log2;
    bool *children = calloc(count, sizeof *children);
    bool *active = calloc(count, sizeof *active);
    float *values = calloc(count, sizeof *values);

    assert_true(children != NULL && active != NULL && values != NULL);
    for (uint32_t i = 0; i < count; i++) {
        const struct vdb_tile *tile;

        vdb_child_at(origin, log2, child_side, i, at);
        tile = vdb_tile_at(f->grid, at);
        children[i] = vdb_is_child(f->grid, at, child_side);
        values[i] = tile != NULL ? tile->value : f->grid->background;
        active[i] = tile != NULL && tile->is_active && !children[i];
    }
    if (!has_values) {
        vdb_put_mask(f, children, count);
        vdb_put_mask(f, active, count);
        vdb_put_values(f, values, active, count);
    }
    for (uint32_t i = 0; i < count; i++) {
        vdb_child_at(origin, log2, child_side, i, at);
        if (!children[i])
            continue;
        if (child_side == 8)
            vdb_put_leaf(f, at, has_values);
        else
            vdb_put_node(f, at, child_side, has_values);
    }
    free(children);
    free(active);
    free(values);
}

/* Visits places of the root's children from -2 to 1 nodes around zero. Returns
 * how many there are. */
static inline uint32_t vdb_root_children(struct vdb_file *f, bool is_counted,
                                         bool has_values)
{
    uint32_t count = 0;

    for (uint32_t i = 0; i < 64; i++) {
        static const int32_t origin[3] = {-8192, -8192, -8192};
        int32_t at[3];

        vdb_child_at(origin, 2, 4096, i, at);
        if (!vdb_is_child(f->grid, at, 4096))
            continue;
        count++;
        if (is_counted)
            continue;
        if (!has_values)
            fwrite(at, sizeof at, 1, f->to);
        vdb_put_node(f, at, 4096, has_values);
    }
    return count;
}

static inline void vdb_put_tree(struct vdb_file *f)
{
    const struct vdb_grid *g = f->grid;
    uint32_t root_tiles = 0;

    for (int i = 0; i < g->tile_count; i++)
        root_tiles += g->tiles[i].side == 4096;
    vdb_put_u32(f, 1);
    vdb_put_float(f, g->background);
    vdb_put_u32(f, root_tiles);
    vdb_put_u32(f, vdb_root_children(f, true, false));
    for (int i = 0; i < g->tile_count; i++) {
        if (g->tiles[i].side != 4096)
            continue;
        fwrite(g->tiles[i].origin, sizeof g->tiles[i].origin, 1, f->to);
        vdb_put_float(f, g->tiles[i].value);
        fputc(g->tiles[i].is_active, f->to);
    }
    vdb_root_children(f, false, false);
}

/* ---- files ---- */

static inline void vdb_put_flag(struct vdb_file *f, const char *name,
                                const char *type)
{
    vdb_put_text(f, name);
    vdb_put_text(f, type);
    vdb_put_u32(f, 1);
    fputc(1, f->to);
}

static inline void vdb_put_string(struct vdb_file *f, const char *name,
                                  const char *value)
{
    vdb_put_text(f, name);
    vdb_put_text(f, "string");
    vdb_put_text(f, value);
}

/* OpenVDB reads half floats if the metadata of the grid say so, too. */
static inline void vdb_put_metadata(struct vdb_file *f)
{
    static const struct vdb_grid none = {.name = NULL};
    const struct vdb_grid *g = f->grid != NULL ? f->grid : &none;
    bool is_half = g->is_half;

    vdb_put_u32(f, 2 + is_half + (g->class != NULL) + g->is_of_blender);
    vdb_put_string(f, "creator", "a test");
    if (g->class != NULL)
        vdb_put_string(f, "class", g->class);
    if (g->is_of_blender)
        vdb_put_flag(f, "file_base_resolution", "a type of Blender");
    if (is_half)
        vdb_put_flag(f, "is_saved_as_half_float", "bool");
    vdb_put_flag(f, "flag", "a type of tomorrow");
}

static inline void vdb_put_map(struct vdb_file *f)
{
    static const double ones[15] = {1, 1, 1, 1, 1,  1,  1, 1,
                                    1, 1, 1, 1, .5, .5, .5};
    const struct vdb_grid *g = f->grid;

    vdb_put_text(f, g->map != NULL ? g->map : "UniformScaleMap");
    if (g->map != NULL)
        fwrite(g->map_numbers, sizeof(double), (size_t)g->map_count, f->to);
    else
        fwrite(ones, sizeof ones, 1, f->to);
}

/* Begins a file of so many grids. */
static inline void vdb_file_begin(struct vdb_file *f, uint32_t version,
                                  uint32_t grid_count)
{
    *f = (struct vdb_file){.grid = NULL};
    f->to = open_memstream(&f->bytes, &f->size_bytes);
    assert_non_null(f->to);
    vdb_put_i64(f, 0x56444220);
    vdb_put_u32(f, version);
    vdb_put_u32(f, 10);
    vdb_put_u32(f, 0);
    fputc(1, f->to);
    fputs("01234567-89ab-cdef-0123-456789abcdef", f->to);
    vdb_put_metadata(f);
    vdb_put_u32(f, grid_count);
}

static inline void vdb_file_add(struct vdb_file *f, const struct vdb_grid *g)
{
    long offsets_at, at[3];

    f->grid = g;
    vdb_put_text(f, g->name);
    vdb_put_text(f, g->type != NULL ? g->type
                    : g->is_half    ? "Tree_float_5_4_3_HalfFloat"
                                    : "Tree_float_5_4_3");
    vdb_put_text(f, g->parent != NULL ? g->parent : "");
    offsets_at = ftell(f->to);
    for (int i = 0; i < 3; i++)
        vdb_put_i64(f, 0);
    at[0] = ftell(f->to);
    vdb_put_u32(f, g->flags);
    vdb_put_metadata(f);
    vdb_put_map(f);
    if (g->parent == NULL)
        vdb_put_tree(f);
    at[1] = ftell(f->to);
    if (g->parent == NULL)
        vdb_root_children(f, false, true);
    at[2] = ftell(f->to);
    fseek(f->to, offsets_at, SEEK_SET);
    for (int i = 0; i < 3; i++)
        vdb_put_i64(f, at[i]);
    fseek(f->to, at[2], SEEK_SET);
}

static inline char *vdb_file_end(struct vdb_file *f, size_t *size_bytes)
{
    assert_int_equal(fclose(f->to), 0);
    *size_bytes = f->size_bytes;
    return f->bytes;
}

/* Writes a file of one grid. */
static inline char *vdb_file_of(const struct vdb_grid *g, size_t *size_bytes)
{
    struct vdb_file f;

    vdb_file_begin(&f, 224, 1);
    vdb_file_add(&f, g);
    return vdb_file_end(&f, size_bytes);
}

#endif
