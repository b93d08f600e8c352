// SPDX-License-Identifier: MIT
#include "read/vdb.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "read/vdb_bytes.h"
#include "read/vdb_tree.h"

#define MAGIC "\x20\x42\x44\x56\0\0\0\0"

/* Beginning of files of another format, which hold the same grids. */
#define NANOVDB "NanoVDB"

/* First version whose nodes say which inactive values they have. */
#define VERSION_MIN 222

/* Bytes of the number that identifies a file. */
#define UUID_BYTES 36

/* Type of a grid of floats, and what follows it if halves are saved. */
#define TYPE "Tree_float_5_4_3"
#define HALF "_HalfFloat"

/* Parts a grid's name from a number that makes it unique. */
#define SEPARATOR '\x1e'

/* A grid, as the list of grids says it. */
struct description {
    struct word name, type;
    struct word unique; /* the name with its number */
    struct word parent; /* grid whose tree it shows; of length 0: its own */
    int64_t grid_at, end_at;
};

static bool word_equals(struct word a, const char *text)
{
    return a.length == strlen(text) && memcmp(a.start, text, a.length) == 0;
}

static bool words_equal(struct word a, struct word b)
{
    return a.length == b.length && memcmp(a.start, b.start, a.length) == 0;
}

/* ---- the head ---- */

/* What metadata say of a grid. */
struct metadata {
    bool is_level_set; /* distances from a surface, below 0 inside */
    bool is_of_blender;
};

/* Reads metadata, whose values have sizes whatever their types are. The fluids
 * of Blender alone write a base resolution. */
static bool take_metadata(struct vdb_reader *r, struct metadata *m)
{
    uint32_t count;

    *m = (struct metadata){.is_level_set = false};
    if (!vdb_take_u32(r, &count))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        struct word name, type, value;

        if (!vdb_take_text(r, &name) || !vdb_take_text(r, &type) ||
            !vdb_take_text(r, &value))
            return false;
        if (word_equals(name, "class"))
            m->is_level_set = word_equals(value, "level set");
        if (word_equals(name, "file_base_resolution"))
            m->is_of_blender = true;
    }
    return true;
}

/* Reads up to the list of grids. */
static bool take_head(struct vdb_reader *r)
{
    const uint8_t *magic = vdb_take(r, 8);
    uint32_t version, major, minor, has_offsets;
    struct metadata unused;

    if (magic == NULL)
        return false;
    if (memcmp(magic, NANOVDB, strlen(NANOVDB)) == 0)
        return fail(r->err, "found a NanoVDB file, expected an OpenVDB file");
    if (memcmp(magic, MAGIC, 8) != 0)
        return fail(r->err, "found no OpenVDB file");
    if (!vdb_take_u32(r, &version))
        return false;
    if (version < VERSION_MIN)
        return fail(r->err,
                    "found version %" PRIu32
                    " of OpenVDB's files, expected %d or later",
                    version, VERSION_MIN);
    if (!vdb_take_u32(r, &major) || !vdb_take_u32(r, &minor) ||
        !vdb_take_u8(r, &has_offsets))
        return false;
    if (has_offsets == 0)
        return fail(r->err, "found a stream of OpenVDB, expected a file with "
                            "the places of its grids");
    return vdb_take(r, UUID_BYTES) != NULL && take_metadata(r, &unused);
}

/* ---- the list of grids ---- */

/* Reads a description and moves behind its grid, where the next one is. */
static bool take_description(struct vdb_reader *r, struct description *d)
{
    uint64_t at = r->at;
    int64_t blocks_at;
    const char *end;

    if (!vdb_take_text(r, &d->unique) || !vdb_take_text(r, &d->type) ||
        !vdb_take_text(r, &d->parent) || !vdb_take_i64(r, &d->grid_at) ||
        !vdb_take_i64(r, &blocks_at) || !vdb_take_i64(r, &d->end_at))
        return false;
    if (d->grid_at < (int64_t)r->at || d->end_at < d->grid_at ||
        (uint64_t)d->end_at > r->size)
        return fail(r->err,
                    "byte %" PRIu64 ": found a grid from byte %" PRId64
                    " to %" PRId64 ", expected it between %" PRIu64
                    " and the file's end at %" PRIu64,
                    at, d->grid_at, d->end_at, r->at, r->size);
    r->at = (uint64_t)d->end_at;
    d->name = d->unique;
    end = memchr(d->name.start, SEPARATOR, d->name.length);
    if (end != NULL)
        d->name.length = (size_t)(end - d->name.start);
    return true;
}

static bool is_readable(const struct description *d)
{
    return word_equals(d->type, TYPE) || word_equals(d->type, TYPE HALF);
}

/* Returns the bit of a grid in fire_grids, or 0. */
static uint32_t fire_bit(const struct description *d)
{
    for (uint32_t i = 0; i < FIRE_NAMES; i++)
        if (is_readable(d) && word_equals(d->name, voxel_fire_names[i]))
            return 1u << i;
    return 0;
}

/* Names of grids for a message, which is cut. */
struct names {
    char text[200];
    size_t length;
};

/* Returns the length of a text for a message, which is cut. */
static int cut_length(struct word text)
{
    return text.length < 60 ? (int)text.length : 60;
}

/* Adds the name of a grid, with its type if it cannot be read. */
static void add_name(struct names *names, const struct description *d)
{
    bool has_type = !is_readable(d);
    int length = snprintf(names->text + names->length,
                          sizeof names->text - names->length, "%s%.*s%s%.*s%s",
                          names->length > 0 ? ", " : "", cut_length(d->name),
                          d->name.start, has_type ? " (" : "",
                          has_type ? cut_length(d->type) : 0, d->type.start,
                          has_type ? ")" : "");

    names->length += (size_t)length;
    if (names->length >= sizeof names->text)
        names->length = sizeof names->text - 1;
}

/* Finds the grid of this name or, with "", the default. *d has length 0 as its
 * type if there is none. Sets the grids of fire that the file has. */
static bool find_grid(struct vdb_reader *r, const char *name,
                      struct description *d, struct names *names,
                      uint32_t *fire_grids)
{
    bool has_name = name[0] != '\0', is_found = false;
    uint32_t count;

    *d = (struct description){.type = {"", 0}};
    if (!vdb_take_u32(r, &count))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        struct description next;
        bool is_named;

        if (!take_description(r, &next))
            return false;
        add_name(names, &next);
        *fire_grids |= fire_bit(&next);
        is_named = word_equals(next.name, has_name ? name : "density") &&
                   (has_name || is_readable(&next));
        if (is_found || !(is_named || (!has_name && d->type.length == 0 &&
                                       is_readable(&next))))
            continue;
        *d = next;
        is_found = is_named;
    }
    return true;
}

static bool choose_grid(struct vdb_reader *r, const char *name,
                        struct description *d, uint32_t *fire_grids)
{
    struct names names = {.length = 0};

    if (!find_grid(r, name, d, &names, fire_grids))
        return false;
    if (d->type.length == 0 && name[0] == '\0')
        return fail(r->err, "found %s, expected a grid of floats",
                    names.length > 0 ? names.text : "no grids");
    if (d->type.length == 0)
        return fail(r->err, "found no grid '%s', expected one of: %s", name,
                    names.length > 0 ? names.text : "no grids");
    if (!is_readable(d))
        return fail(r->err,
                    "found grid '%s' of type '%.*s', expected " TYPE
                    " or " TYPE HALF,
                    name, cut_length(d->type), d->type.start);
    return true;
}

/* Replaces an instance by the grid whose tree it shows. */
static bool find_parent(struct vdb_reader *r, uint64_t list_at,
                        struct description *d)
{
    struct word name = d->parent;
    uint32_t count;

    r->at = list_at;
    if (!vdb_take_u32(r, &count))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        if (!take_description(r, d))
            return false;
        if (words_equal(d->unique, name) && d->parent.length == 0 &&
            is_readable(d))
            return true;
    }
    return fail(r->err,
                "found an instance of grid '%.*s', expected this grid with "
                "floats",
                cut_length(name), name.start);
}

/* ---- transforms ---- */

/* Kinds of transforms: how many numbers they have, and where among these
 * translation and scale are. Other numbers follow from the scale. */
static const struct map_kind {
    const char *name;
    int count, translation, scale; /* -1: none */
} map_kinds[] = {
    {"UniformScaleMap", 15, -1, 0},
    {"ScaleMap", 15, -1, 0},
    {"UniformScaleTranslateMap", 18, 0, 3},
    {"ScaleTranslateMap", 18, 0, 3},
    {"TranslationMap", 3, 0, -1},
    {"AffineMap", 16, -1, -1},
    {"UnitaryMap", 16, -1, -1},
};

#define MAP_KINDS       (sizeof map_kinds / sizeof map_kinds[0])
#define MAP_NUMBERS_MAX 18

/* Numbers of a matrix, whose rows are multiplied from the left. */
#define MATRIX_NUMBERS 16

static struct affine map_of(const struct map_kind *kind, const double *numbers)
{
    struct affine a = {.m = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

    for (int i = 0; i < 3; i++) {
        if (kind->scale >= 0)
            a.m[i][i] = numbers[kind->scale + i];
        if (kind->translation >= 0)
            a.m[i][3] = numbers[kind->translation + i];
        for (int k = 0; kind->count == MATRIX_NUMBERS && k < 4; k++)
            a.m[i][k] = numbers[4 * k + i];
    }
    return a;
}

/* Returns true if the map has an inverse, and numbers of a sane size. */
static bool is_sane(const struct affine *a)
{
    double normal[3], volume;

    for (int i = 0; i < 12; i++)
        if (!(fabs(a->m[i / 4][i % 4]) <= (double)VOXEL_VALUE_MAX))
            return false;
    vec3d_cross(a->m[1], a->m[2], normal);
    volume = vec3d_dot(a->m[0], normal);
    return volume != 0 && isfinite(volume);
}

static bool take_transform(struct vdb_reader *r, struct affine *to)
{
    double numbers[MAP_NUMBERS_MAX];
    struct word name;
    size_t i = 0;

    if (!vdb_take_text(r, &name))
        return false;
    while (i < MAP_KINDS && !word_equals(name, map_kinds[i].name))
        i++;
    if (i == MAP_KINDS)
        return fail(r->err,
                    "found a transform of type '%.*s', expected scale, "
                    "translation or an affine map",
                    cut_length(name), name.start);
    if (!vdb_take_doubles(r, numbers, map_kinds[i].count))
        return false;
    *to = map_of(&map_kinds[i], numbers);
    return is_sane(to) ||
           fail(r->err, "found a transform without an inverse, expected one "
                        "with numbers up to 1e30");
}

/* ---- grids ---- */

/* Reads compression, metadata and transform at the beginning of a grid. */
static bool take_grid_head(struct vdb_reader *r, const struct description *d,
                           uint32_t *flags, struct metadata *metadata,
                           struct affine *to_world)
{
    r->at = (uint64_t)d->grid_at;
    if (!vdb_take_u32(r, flags))
        return false;
    if (*flags > VDB_FLAGS)
        return fail(r->err,
                    "byte %" PRId64 ": found compression %" PRIu32
                    ", expected at most %d",
                    d->grid_at, *flags, VDB_FLAGS);
    return take_metadata(r, metadata) && take_transform(r, to_world);
}

static bool take_grid(struct vdb_reader *r, const struct description *d,
                      struct voxel_grid *grid)
{
    struct vdb_storage storage = {
        .is_half = word_equals(d->type, TYPE HALF),
    };
    struct metadata metadata;

    if (!take_grid_head(r, d, &storage.flags, &metadata, &grid->to_world) ||
        !vdb_tree_read(grid, r, storage))
        return false;
    if (r->at != (uint64_t)d->end_at)
        return fail(r->err,
                    "found the grid's end at byte %" PRIu64
                    ", expected %" PRId64,
                    r->at, d->end_at);
    grid->up_is_z = metadata.is_of_blender;
    if (!metadata.is_level_set)
        return true;
    if (!(grid->background > 0))
        return fail(r->err,
                    "found a level set with a background of %g, expected the "
                    "width of its band",
                    (double)grid->background);
    return voxel_grid_fill_level_set(grid) ||
           fail(r->err, "out of memory for its voxels");
}

bool vdb_parse(struct voxel_grid *grid, const void *bytes, size_t size_bytes,
               const char *name, struct error *err)
{
    struct vdb_reader r = {.bytes = bytes, .size = size_bytes, .err = err};
    struct metadata metadata;
    struct affine to_world;
    struct description d;
    uint64_t list_at;
    uint32_t flags;

    memset(grid, 0, sizeof *grid);
    if (!take_head(&r))
        return false;
    list_at = r.at;
    if (!choose_grid(&r, name != NULL ? name : "", &d, &grid->fire_grids))
        return false;
    grid->own_fire = fire_bit(&d);
    if (d.parent.length == 0)
        return take_grid(&r, &d, grid);
    if (!take_grid_head(&r, &d, &flags, &metadata, &to_world) ||
        !find_parent(&r, list_at, &d) || !take_grid(&r, &d, grid))
        return false;
    grid->to_world = to_world;
    return true;
}
