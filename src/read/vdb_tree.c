// SPDX-License-Identifier: MIT
#include "read/vdb_tree.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Children on a side of the nodes below the root, and voxels on a side of a
 * child, for each level from the root on. */
static const struct level {
    int side_log2, child_log2;
} levels[2] = {{5, 7}, {4, 3}};

/* Voxels on a side of a child of the root. */
#define ROOT_CHILD 4096

/* Values of the largest node. */
#define NODE_VALUES_MAX 32768

/* Bytes of the mask of a leaf's active voxels. */
#define LEAF_MASK_BYTES (BRICK_VOXELS / 8)

/* Largest coordinate of a child of the root, so that a box around it has
 * coordinates of 32 bits. */
#define COORDINATE_MAX (1 << 30)

/* Bricks of one value that are found again. */
#define EVEN_BRICKS 4096

struct leaf {
    int32_t origin[3];
    uint32_t brick;
    const uint8_t *mask; /* of active voxels */
};

struct tile {
    int32_t origin[3];
    int32_t side; /* in voxels */
    float value;
};

/* Child or tile of the root. */
struct branch {
    int32_t origin[3];
    size_t first_leaf, leaf_count;
};

struct tree {
    struct voxel_grid *grid;
    struct vdb_reader *r;
    struct vdb_storage storage;
    struct memory_budget memory;
    struct branch *branches;
    size_t branch_count, branch_capacity;
    struct leaf *leaves;
    size_t leaf_count, leaf_capacity;
    struct tile *tiles; /* those that are not of the background */
    size_t tile_count, tile_capacity;
    size_t brick_capacity;
    int64_t low[3], high[3];    /* voxels that differ from the background */
    int64_t first[3], last[3];  /* active voxels */
    uint32_t even[EVEN_BRICKS]; /* bricks of one value, by their hash */
    uint8_t packed[4 * NODE_VALUES_MAX];
    float values[NODE_VALUES_MAX];
};

static bool out_of_memory(const struct tree *t)
{
    return fail(t->r->err, "out of memory for its voxels");
}

/* Grows an array by one item, which is taken from the budget. */
static bool grow_list(struct tree *t, void *list, size_t *capacity,
                      size_t count, size_t item_bytes)
{
    void *items;

    if (!memory_budget_take(&t->memory, 1, item_bytes))
        return fail(t->r->err,
                    "found voxels that take more than %.1f GiB, expected less "
                    "%s",
                    (double)t->memory.size_bytes / (1 << 30), t->memory.place);
    memcpy(&items, list, sizeof items);
    if (!grow_array(&items, capacity, count + 1, item_bytes))
        return out_of_memory(t);
    memcpy(list, &items, sizeof items);
    return true;
}

/* ---- values ---- */

static bool is_on(const uint8_t *mask, uint32_t i)
{
    return (mask[i / 8] >> i % 8 & 1) != 0;
}

static uint32_t count_on(const uint8_t *mask, uint32_t count)
{
    uint32_t on = 0;

    for (uint32_t i = 0; i < count / 8; i++)
        on += (uint32_t)__builtin_popcount(mask[i]);
    return on;
}

/* Returns the value, or 0 for what is no number. */
static float checked(struct tree *t, float value)
{
    if (fabsf(value) <= VOXEL_VALUE_MAX)
        return value;
    t->grid->replaced_count += t->grid->replaced_count < UINT32_MAX;
    return 0;
}

static bool take_value(struct tree *t, float *to)
{
    if (!vdb_take_float(t->r, to))
        return false;
    *to = checked(t, *to);
    return true;
}

/* Which inactive values a node has, and how a second mask selects them. */
enum inactive {
    BACKGROUND_ONLY,
    MINUS_BACKGROUND,
    ONE_VALUE,
    MASK_OF_BACKGROUNDS,
    MASK_OF_VALUE_AND_BACKGROUND,
    MASK_OF_TWO_VALUES,
    ALL_ARE_STORED,
    INACTIVE_KINDS
};

/* Inactive values of a node. */
struct inactive_values {
    uint32_t kind;
    float off, on;       /* by the bit of the mask */
    const uint8_t *mask; /* NULL: all are `off` */
};

static bool take_inactive(struct tree *t, uint32_t count,
                          struct inactive_values *v)
{
    uint64_t at = t->r->at;

    v->mask = NULL;
    if (!vdb_take_u8(t->r, &v->kind))
        return false;
    if (v->kind >= INACTIVE_KINDS)
        return fail(t->r->err,
                    "byte %" PRIu64 ": found %" PRIu32
                    " as kind of inactive values, expected 0 to %d",
                    at, v->kind, INACTIVE_KINDS - 1);
    v->on = t->grid->background;
    v->off = v->kind == BACKGROUND_ONLY ? v->on : -v->on;
    if ((v->kind == ONE_VALUE || v->kind == MASK_OF_VALUE_AND_BACKGROUND ||
         v->kind == MASK_OF_TWO_VALUES) &&
        !take_value(t, &v->off))
        return false;
    if (v->kind == MASK_OF_TWO_VALUES && !take_value(t, &v->on))
        return false;
    if (v->kind < MASK_OF_BACKGROUNDS || v->kind > MASK_OF_TWO_VALUES)
        return true;
    v->mask = vdb_take(t->r, count / 8);
    return v->mask != NULL;
}

/* Reads the values of a node with this mask of active ones. Half floats of no
 * values have no bytes at all, not even a size. */
static bool take_values(struct tree *t, const uint8_t *active, uint32_t count,
                        float *to)
{
    struct inactive_values inactive;
    uint32_t item_bytes = t->storage.is_half ? 2 : 4;
    uint32_t stored = count;
    const uint8_t *p = t->packed;

    if (!take_inactive(t, count, &inactive))
        return false;
    if ((t->storage.flags & VDB_ACTIVE_MASK) != 0 &&
        inactive.kind != ALL_ARE_STORED)
        stored = count_on(active, count);
    if ((stored > 0 || !t->storage.is_half) &&
        !vdb_take_packed(t->r, t->storage.flags, t->packed,
                         stored * item_bytes))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        if (stored == count || is_on(active, i)) {
            to[i] = checked(t, item_bytes == 2 ? vdb_half(p) : vdb_float(p));
            p += item_bytes;
        } else {
            to[i] = inactive.mask != NULL && is_on(inactive.mask, i)
                        ? inactive.on
                        : inactive.off;
        }
    }
    return true;
}

/* ---- bounds ---- */

static void include(int64_t low[3], int64_t high[3], const int32_t origin[3],
                    int64_t side)
{
    for (int a = 0; a < 3; a++) {
        low[a] = origin[a] < low[a] ? origin[a] : low[a];
        high[a] =
            origin[a] + side - 1 > high[a] ? origin[a] + side - 1 : high[a];
    }
}

/* ---- topology ---- */

static bool add_tile(struct tree *t, const int32_t origin[3], int32_t side,
                     float value, bool is_active)
{
    if (is_active)
        include(t->first, t->last, origin, side);
    if (value == t->grid->background)
        return true;
    include(t->low, t->high, origin, side);
    if (!grow_list(t, &t->tiles, &t->tile_capacity, t->tile_count,
                   sizeof *t->tiles))
        return false;
    t->tiles[t->tile_count] = (struct tile){.side = side, .value = value};
    memcpy(t->tiles[t->tile_count++].origin, origin, 3 * sizeof *origin);
    return true;
}

static bool take_leaf(struct tree *t, const int32_t origin[3])
{
    const uint8_t *mask = vdb_take(t->r, LEAF_MASK_BYTES);

    if (mask == NULL || !grow_list(t, &t->leaves, &t->leaf_capacity,
                                   t->leaf_count, sizeof *t->leaves))
        return false;
    t->leaves[t->leaf_count] = (struct leaf){.mask = mask};
    memcpy(t->leaves[t->leaf_count++].origin, origin, 3 * sizeof *origin);
    return true;
}

static void child_origin(const struct level *l, uint32_t i,
                         const int32_t origin[3], int32_t to[3])
{
    uint32_t last = (1u << l->side_log2) - 1;
    int log2 = l->side_log2;

    to[0] = origin[0] + (int32_t)((i >> 2 * log2) << l->child_log2);
    to[1] = origin[1] + (int32_t)((i >> log2 & last) << l->child_log2);
    to[2] = origin[2] + (int32_t)((i & last) << l->child_log2);
}

/* Reads a node below the root: its tiles, then its children. */
static bool take_node(struct tree *t, int depth, const int32_t origin[3])
{
    const struct level *l = &levels[depth];
    uint32_t count = 1u << 3 * l->side_log2;
    const uint8_t *children = vdb_take(t->r, count / 8);
    const uint8_t *active = children != NULL ? vdb_take(t->r, count / 8) : NULL;
    const float *values = t->values;
    int32_t place[3];

    if (active == NULL || !take_values(t, active, count, t->values))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        child_origin(l, i, origin, place);
        if (!is_on(children, i) && !add_tile(t, place, 1 << l->child_log2,
                                             values[i], is_on(active, i)))
            return false;
    }
    for (uint32_t i = 0; i < count; i++) {
        child_origin(l, i, origin, place);
        if (is_on(children, i) &&
            !(depth == 0 ? take_node(t, 1, place) : take_leaf(t, place)))
            return false;
    }
    return true;
}

/* Reads the place of a child or tile of the root. */
static bool take_branch(struct tree *t)
{
    uint64_t at = t->r->at;
    struct branch b = {.first_leaf = t->leaf_count};

    if (!vdb_take_ints(t->r, b.origin))
        return false;
    for (int a = 0; a < 3; a++)
        if (b.origin[a] % ROOT_CHILD != 0 || b.origin[a] < -COORDINATE_MAX ||
            b.origin[a] > COORDINATE_MAX)
            return fail(t->r->err,
                        "byte %" PRIu64 ": found %" PRId32
                        " as place of a node, expected a multiple of %d "
                        "from -2^30 to 2^30",
                        at, b.origin[a], ROOT_CHILD);
    if (!grow_list(t, &t->branches, &t->branch_capacity, t->branch_count,
                   sizeof *t->branches))
        return false;
    t->branches[t->branch_count++] = b;
    return true;
}

static bool take_root_tile(struct tree *t)
{
    uint32_t is_active;
    float value;

    return take_branch(t) && take_value(t, &value) &&
           vdb_take_u8(t->r, &is_active) &&
           add_tile(t, t->branches[t->branch_count - 1].origin, ROOT_CHILD,
                    value, is_active != 0);
}

static bool take_root_child(struct tree *t)
{
    struct branch *b;

    if (!take_branch(t))
        return false;
    b = &t->branches[t->branch_count - 1];
    if (!take_node(t, 0, b->origin))
        return false;
    b->leaf_count = t->leaf_count - b->first_leaf;
    return true;
}

static int compare_branches(const void *a, const void *b)
{
    const struct branch *x = a, *y = b;

    for (int i = 0; i < 3; i++)
        if (x->origin[i] != y->origin[i])
            return x->origin[i] < y->origin[i] ? -1 : 1;
    return 0;
}

/* Sorts the branches, since the values of leaves follow in the order of
 * places. */
static bool sort_branches(struct tree *t)
{
    const struct branch *b = t->branches;

    if (t->branch_count > 0)
        qsort(t->branches, t->branch_count, sizeof *b, compare_branches);
    for (size_t i = 1; i < t->branch_count; i++)
        if (compare_branches(&b[i - 1], &b[i]) == 0)
            return fail(t->r->err,
                        "found two nodes at %" PRId32 " %" PRId32 " %" PRId32
                        ", expected one",
                        b[i].origin[0], b[i].origin[1], b[i].origin[2]);
    return true;
}

static bool take_topology(struct tree *t)
{
    uint32_t buffer_count, tile_count, child_count;
    uint64_t at = t->r->at;

    if (!vdb_take_u32(t->r, &buffer_count))
        return false;
    if (buffer_count != 1)
        return fail(t->r->err,
                    "byte %" PRIu64 ": found a tree of %" PRIu32
                    " buffers, expected 1",
                    at, buffer_count);
    if (!take_value(t, &t->grid->background) ||
        !vdb_take_u32(t->r, &tile_count) || !vdb_take_u32(t->r, &child_count))
        return false;
    for (uint32_t i = 0; i < tile_count; i++)
        if (!take_root_tile(t))
            return false;
    for (uint32_t i = 0; i < child_count; i++)
        if (!take_root_child(t))
            return false;
    return sort_branches(t);
}

/* ---- bricks ---- */

/* Appends a brick, whose values the caller fills. */
static bool add_brick(struct tree *t, uint32_t *brick)
{
    if (!grow_list(t, &t->grid->values, &t->brick_capacity,
                   t->grid->brick_count, BRICK_VOXELS * sizeof(float)))
        return false;
    *brick = t->grid->brick_count++;
    return true;
}

static float *values_of(const struct tree *t, uint32_t brick)
{
    return t->grid->values + (size_t)brick * BRICK_VOXELS;
}

/* Returns a brick of one value: that of the background, one that was made
 * before, or a new one. */
static bool even_brick(struct tree *t, float value, uint32_t *brick)
{
    uint32_t bits, *slot;

    memcpy(&bits, &value, sizeof bits);
    slot = &t->even[bits * 0x9e3779b1u / (UINT32_MAX / EVEN_BRICKS + 1)];
    *brick = BRICK_EMPTY;
    if (t->grid->brick_count > 0 && value == t->grid->background)
        return true;
    *brick = *slot;
    if (*slot != BRICK_EMPTY && values_of(t, *slot)[0] == value)
        return true;
    if (!add_brick(t, brick))
        return false;
    for (int i = 0; i < BRICK_VOXELS; i++)
        values_of(t, *brick)[i] = value;
    *slot = *brick;
    return true;
}

/* Includes the voxels of a leaf that are active, and those that differ from the
 * background. */
static void include_leaf(struct tree *t, const struct leaf *leaf,
                         const float *values)
{
    for (int i = 0; i < BRICK_VOXELS; i++) {
        const int32_t voxel[3] = {leaf->origin[0] + i / 64,
                                  leaf->origin[1] + i / 8 % 8,
                                  leaf->origin[2] + i % 8};

        if (is_on(leaf->mask, (uint32_t)i))
            include(t->first, t->last, voxel, 1);
        if (values[i] != t->grid->background)
            include(t->low, t->high, voxel, 1);
    }
}

static bool is_even(const float *values)
{
    for (int i = 1; i < BRICK_VOXELS; i++)
        if (values[i] != values[0])
            return false;
    return true;
}

/* Reads the values of a leaf, behind a second copy of its mask. */
static bool take_leaf_values(struct tree *t, struct leaf *leaf)
{
    float *values = t->values;

    if (vdb_take(t->r, LEAF_MASK_BYTES) == NULL ||
        !take_values(t, leaf->mask, BRICK_VOXELS, values))
        return false;
    include_leaf(t, leaf, values);
    if (is_even(values))
        return even_brick(t, values[0], &leaf->brick);
    if (!add_brick(t, &leaf->brick))
        return false;
    memcpy(values_of(t, leaf->brick), values, BRICK_VOXELS * sizeof *values);
    return true;
}

static bool take_buffers(struct tree *t)
{
    for (size_t i = 0; i < t->branch_count; i++) {
        const struct branch *b = &t->branches[i];

        for (size_t k = 0; k < b->leaf_count; k++)
            if (!take_leaf_values(t, &t->leaves[b->first_leaf + k]))
                return false;
    }
    return true;
}

/* ---- the box ---- */

/* Rounds down to a multiple of a brick's side. */
static int64_t brick_floor(int64_t voxel)
{
    return voxel & ~(int64_t)(BRICK_SIDE - 1);
}

/* Sets the box: the interpolated values reach one voxel further than the
 * voxels. */
static bool set_box(struct tree *t)
{
    struct voxel_grid *g = t->grid;
    uint64_t places = 1;

    for (int a = 0; a < 3; a++) {
        int64_t first, sides;

        g->first[a] = (int32_t)t->first[a];
        g->last[a] = (int32_t)t->last[a];
        if (t->low[a] > t->high[a])
            continue;
        first = brick_floor(t->low[a] - 1);
        sides = (brick_floor(t->high[a] + 1) - first) / BRICK_SIDE + 1;
        g->origin[a] = (int32_t)first;
        g->sides[a] = (uint32_t)sides;
        if (places <= BRICK_PLACES_MAX)
            places *= (uint64_t)sides;
    }
    if (places <= BRICK_PLACES_MAX)
        return true;
    return fail(t->r->err,
                "found a box of %" PRId64 " x %" PRId64 " x %" PRId64
                " voxels, expected at most 2^33 in all",
                t->high[0] - t->low[0] + 1, t->high[1] - t->low[1] + 1,
                t->high[2] - t->low[2] + 1);
}

/* Puts a brick at the places of a cube. */
static void put_brick(const struct voxel_grid *g, const int32_t origin[3],
                      int32_t side, uint32_t brick)
{
    uint64_t first[3];
    uint64_t count = (uint64_t)(side / BRICK_SIDE);

    for (int a = 0; a < 3; a++)
        first[a] = (uint64_t)(((int64_t)origin[a] - g->origin[a]) / BRICK_SIDE);
    for (uint64_t x = 0; x < count; x++)
        for (uint64_t y = 0; y < count; y++)
            for (uint64_t z = 0; z < count; z++)
                g->index[((first[0] + x) * g->sides[1] + first[1] + y) *
                             g->sides[2] +
                         first[2] + z] = brick;
}

static bool fill_box(struct tree *t)
{
    struct voxel_grid *g = t->grid;

    g->index = alloc_array(voxel_grid_place_count(g), sizeof *g->index);
    if (g->index == NULL)
        return out_of_memory(t);
    for (size_t i = 0; i < t->tile_count; i++) {
        const struct tile *tile = &t->tiles[i];
        uint32_t brick;

        if (!even_brick(t, tile->value, &brick))
            return false;
        put_brick(g, tile->origin, tile->side, brick);
    }
    for (size_t i = 0; i < t->leaf_count; i++)
        if (t->leaves[i].brick != BRICK_EMPTY)
            put_brick(g, t->leaves[i].origin, BRICK_SIDE, t->leaves[i].brick);
    return voxel_grid_bound(g) || out_of_memory(t);
}

/* Reads all with the tree's lists in place. */
static bool read_tree(struct tree *t)
{
    uint32_t empty;

    memory_budget_add_file(&t->memory, t->r->size);
    for (int a = 0; a < 3; a++) {
        t->low[a] = t->first[a] = INT32_MAX;
        t->high[a] = t->last[a] = INT32_MIN;
    }
    return take_topology(t) && even_brick(t, t->grid->background, &empty) &&
           take_buffers(t) && set_box(t) && fill_box(t);
}

bool vdb_tree_read(struct voxel_grid *grid, struct vdb_reader *reader,
                   struct vdb_storage storage)
{
    struct tree *t = alloc_array(1, sizeof *t);
    bool ok;

    if (t == NULL)
        return fail(reader->err, "out of memory for its voxels");
    t->grid = grid;
    t->r = reader;
    t->storage = storage;
    ok = read_tree(t);
    free(t->branches);
    free(t->leaves);
    free(t->tiles);
    free(t);
    return ok;
}
