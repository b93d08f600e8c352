// SPDX-License-Identifier: MIT
/*
 * test_vdb.c - OpenVDB files of known voxels, in all kinds of storage: values,
 * bounds, majorants against brute force, transforms, names; and broken files
 */
#include <limits.h>

#include "read/vdb.h"
#include "tests/unit/check.h"
#include "tests/unit/vdb_file.h"

static bool has_blosc(void)
{
    void *unused;
    static const struct library_function f = {"blosc_compress_ctx", 0};
    const char *missing;

    return dynamic_library_load("libblosc.so.1", &f, 1, &unused, &missing);
}

static void parse(struct voxel_grid *grid, const char *bytes, size_t size,
                  const char *name)
{
    struct error err;

    check_or_say(vdb_parse(grid, bytes, size, name, &err), err.text);
}

/* ---- grids ---- */

/* A number of a voxel, from 0 to 1023. */
static uint32_t hash_of(const int32_t v[3])
{
    uint32_t h = (uint32_t)v[0] * 0x8da6b343u ^ (uint32_t)v[1] * 0xd8163841u ^
                 (uint32_t)v[2] * 0xcb1ab31fu;

    return (h ^ h >> 13) * 0x9e3779b1u >> 22;
}

/* All voxels of the box -9 -4 2 to 11 7 12 are active. Half floats have these
 * values exactly. */
static float dense_voxel(const void *unused, const int32_t v[3], bool *active)
{
    (void)unused;
    *active = v[0] >= -9 && v[0] <= 11 && v[1] >= -4 && v[1] <= 7 &&
              v[2] >= 2 && v[2] <= 12;
    return *active ? (float)hash_of(v) / 64 - 3 : 0;
}

static const struct vdb_grid dense = {
    .name = "density",
    .voxel = dense_voxel,
    .first = {-9, -4, 2},
    .last = {11, 7, 12},
};

/* Inactive values of the leaves, at most four, by their place along x. */
struct sparse {
    float background;
    float inactive[4];
    int count;
};

static float sparse_voxel(const void *context, const int32_t v[3], bool *active)
{
    const struct sparse *s = context;
    uint32_t hash = hash_of(v);

    *active = hash % 3 == 0;
    return *active ? (float)hash / 8 : s->inactive[hash / 3 % s->count];
}

/* Tiles of each size, active and inactive ones, one of the background, and one
 * beside leaves. */
static const struct vdb_tile tiles[] = {
    {{-4096, 0, 0}, 4096, 2, false}, {{-128, -128, 128}, 128, 9, true},
    {{-8, -8, -8}, 8, 5, true},      {{16, 0, 0}, 8, 7, false},
    {{32, -8, 0}, 8, 2, true},
};

static const struct vdb_grid sparse_grid = {
    .name = "density",
    .background = 2,
    .voxel = sparse_voxel,
    .first = {-16, 3, -40},
    .last = {15, 20, -25},
    .tiles = tiles,
    .tile_count = 5,
};

/* Returns what the file says of a voxel. */
static float voxel_of(const struct vdb_grid *g, const int32_t v[3],
                      bool *active)
{
    const struct vdb_tile *tile = vdb_tile_at(g, v);
    const int32_t leaf[3] = {v[0] & ~7, v[1] & ~7, v[2] & ~7};

    *active = false;
    if (vdb_is_child(g, leaf, 8))
        return g->voxel(g->context, v, active);
    if (tile == NULL)
        return g->background;
    *active = tile->is_active;
    return tile->value;
}

/* ---- checks ---- */

/* Compares all voxels from first to last. */
static void check_values(const struct voxel_grid *grid,
                         const struct vdb_grid *g, const int32_t first[3],
                         const int32_t last[3])
{
    int32_t v[3];
    bool is_active;

    for (v[0] = first[0]; v[0] <= last[0]; v[0]++)
        for (v[1] = first[1]; v[1] <= last[1]; v[1]++)
            for (v[2] = first[2]; v[2] <= last[2]; v[2]++)
                check_close(voxel_grid_value(grid, v[0], v[1], v[2]),
                            voxel_of(g, v, &is_active), 0);
}

/* Returns the largest value from one voxel before a brick to one behind it. */
static float brute_largest(const struct voxel_grid *grid, const int64_t at[3])
{
    float most = -INFINITY;

    for (int x = -1; x <= 8; x++)
        for (int y = -1; y <= 8; y++)
            for (int z = -1; z <= 8; z++)
                most = fmaxf(most, voxel_grid_value(grid, at[0] + x, at[1] + y,
                                                    at[2] + z));
    return most;
}

static void check_majorants(const struct voxel_grid *grid)
{
    const uint32_t *n = grid->sides;

    for (uint32_t i = 0; i < voxel_grid_place_count(grid); i++) {
        const int64_t at[3] = {grid->origin[0] + 8 * (int64_t)(i / n[2] / n[1]),
                               grid->origin[1] + 8 * (int64_t)(i / n[2] % n[1]),
                               grid->origin[2] + 8 * (int64_t)(i % n[2])};
        float most = brute_largest(grid, at);

        check_close(grid->majorants[i], most + fabsf(most) * 0x1p-20f, 0);
    }
}

/* Compares interpolated values at random points with the formula in double, and
 * with the bound of their place. */
static void check_samples(const struct voxel_grid *grid)
{
    uint64_t state = 1;

    for (int i = 0; i < 20000; i++) {
        double p[3], want = 0;
        int64_t low[3], place = 0;
        bool is_in = true;
        float got;

        for (int a = 0; a < 3; a++) {
            double side = 8 * (double)grid->sides[a];

            p[a] = grid->origin[a] - 2 + check_random(&state) * (side + 4);
            low[a] = (int64_t)floor(p[a]);
            is_in &= low[a] >= grid->origin[a] &&
                     low[a] < grid->origin[a] + 8 * (int64_t)grid->sides[a];
            place = place * grid->sides[a] + (low[a] - grid->origin[a]) / 8;
        }
        for (int c = 0; c < 8; c++) {
            double weight = 1;

            for (int a = 0; a < 3; a++) {
                double t = p[a] - (double)low[a];

                weight *= (c >> a & 1) != 0 ? t : 1 - t;
            }
            want += weight * (double)voxel_grid_value(grid, low[0] + (c & 1),
                                                      low[1] + (c >> 1 & 1),
                                                      low[2] + (c >> 2));
        }
        got = voxel_grid_sample(grid, p);
        check_close(got, want, 1e-6 * (1 + fabs(want)) * 128);
        if (is_in)
            check_at_most(got, grid->majorants[place]);
        else
            check_close(got, grid->background, 0);
    }
}

static void check_bounds(const struct voxel_grid *grid, const int32_t first[3],
                         const int32_t last[3])
{
    for (int a = 0; a < 3; a++) {
        assert_int_equal(grid->first[a], first[a]);
        assert_int_equal(grid->last[a], last[a]);
    }
}

/* ---- values ---- */

static void dense_grids_keep_their_values(void **state)
{
    static const uint32_t flags[] = {0,
                                     VDB_ZIP,
                                     VDB_ACTIVE_MASK,
                                     VDB_ACTIVE_MASK | VDB_ZIP,
                                     VDB_BLOSC,
                                     VDB_ACTIVE_MASK | VDB_BLOSC};
    static const int32_t first[3] = {-40, -30, -20}, last[3] = {40, 30, 40};

    (void)state;
    for (int i = 0; i < 12; i++) {
        struct vdb_grid g = dense;
        struct voxel_grid grid;
        size_t size;
        char *bytes;

        g.flags = flags[i / 2];
        g.is_half = i % 2 != 0;
        if ((g.flags & VDB_BLOSC) != 0 && !has_blosc())
            continue;
        bytes = vdb_file_of(&g, &size);
        parse(&grid, bytes, size, NULL);
        check_values(&grid, &g, first, last);
        check_bounds(&grid, g.first, g.last);
        assert_int_equal(grid.replaced_count, 0);
        if (i == 0) {
            check_majorants(&grid);
            check_samples(&grid);
        }
        voxel_grid_free(&grid);
        free(bytes);
    }
}

/* Each kind of inactive values of a leaf: the background, its negative, another
 * value, pairs of these, and more. */
static const struct sparse kinds[] = {
    {2, {2}, 1},    {2, {-2}, 1},       {2, {4}, 1},          {2, {-2, 2}, 2},
    {2, {2, 4}, 2}, {2, {4.5f, -6}, 2}, {2, {1, 2, 3, 4}, 4},
};

static void sparse_grids_keep_values_and_tiles(void **state)
{
    static const int32_t first[3] = {-40, -30, -50}, last[3] = {40, 30, 20};
    static const int32_t far[][2][3] = {
        {{-4100, -2, -2}, {-4090, 3, 3}},
        {{-3, 4090, 4090}, {3, 4099, 4099}},
        {{-130, -129, 250}, {-120, -120, 260}},
    };

    (void)state;
    for (int i = 0; i < 28; i++) {
        struct vdb_grid g = sparse_grid;
        struct voxel_grid grid;
        size_t size;
        char *bytes;

        g.context = &kinds[i / 4];
        g.is_half = i % 2 != 0;
        g.flags = i / 2 % 2 != 0 ? VDB_ACTIVE_MASK | VDB_ZIP : VDB_ACTIVE_MASK;
        bytes = vdb_file_of(&g, &size);
        parse(&grid, bytes, size, "density");
        check_values(&grid, &g, first, last);
        for (int k = 0; k < 3; k++)
            check_values(&grid, &g, far[k][0], far[k][1]);
        if (i % 4 == 0) {
            check_majorants(&grid);
            check_samples(&grid);
        }
        voxel_grid_free(&grid);
        free(bytes);
    }
}

/* Bounds are those of active voxels, also of tiles; the box has only what
 * differs from the background. */
static void bounds_are_those_of_active_voxels(void **state)
{
    static const struct vdb_tile even[] = {
        {{-4096, 0, 4096}, 4096, 0, true},
        {{8, 8, 8}, 8, 3, false},
    };
    static const int32_t first[3] = {-4096, 0, 4096},
                         last[3] = {-1, 4095, 8191};
    struct vdb_grid g = {.name = "a",
                         .first = {1, 1, 1},
                         .tiles = even,
                         .tile_count = 2};
    struct voxel_grid grid;
    size_t size;
    char *bytes = vdb_file_of(&g, &size);

    (void)state;
    parse(&grid, bytes, size, NULL);
    check_bounds(&grid, first, last);
    for (int a = 0; a < 3; a++) {
        assert_int_equal(grid.origin[a], 0);
        assert_int_equal(grid.sides[a], 3);
    }
    assert_int_equal(grid.brick_count, 2);
    check_majorants(&grid);
    voxel_grid_free(&grid);
    free(bytes);
}

static void empty_grids_are_background(void **state)
{
    static const double p[3] = {.5, 1e30, -1};
    static const double not_one[3] = {NAN, 0, 0};
    struct vdb_grid g = {.name = "a", .first = {1, 1, 1}, .background = 3};
    struct voxel_grid grid;
    size_t size;
    char *bytes = vdb_file_of(&g, &size);

    (void)state;
    parse(&grid, bytes, size, NULL);
    assert_int_equal(voxel_grid_place_count(&grid), 0);
    assert_true(grid.first[0] > grid.last[0]);
    check_close(voxel_grid_value(&grid, 0, 0, 0), 3, 0);
    check_close(voxel_grid_value(&grid, INT64_MAX, INT64_MIN, 0), 3, 0);
    check_close(voxel_grid_sample(&grid, p), 3, 0);
    check_close(voxel_grid_sample(&grid, not_one), 3, 0);
    voxel_grid_free(&grid);
    free(bytes);
}

static void half_floats_are_exact(void **state)
{
    static const struct {
        uint16_t bits;
        float number;
    } known[] = {{0x0000, 0},           {0x3c00, 1},
                 {0xc000, -2},          {0x0001, 0x1p-24f},
                 {0x7bff, 65504},       {0x0400, 0x1p-14f},
                 {0x3555, .333251953f}, {0x7c00, INFINITY},
                 {0x03ff, 0x1.ff8p-15f}};

    (void)state;
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        const uint8_t bytes[2] = {known[i].bits & 255, known[i].bits >> 8};

        assert_true(vdb_half(bytes) == known[i].number);
    }
    for (uint32_t bits = 0; bits < 0x10000; bits++) {
        const uint8_t bytes[2] = {bits & 255, (uint8_t)(bits >> 8)};
        float number = vdb_half(bytes);

        if (!isnan(number))
            assert_int_equal(half_bits(number), bits);
        assert_int_equal(isnan(number),
                         (bits & 0x7c00) == 0x7c00 && (bits & 0x3ff) != 0);
    }
}

static float broken_voxel(const void *unused, const int32_t v[3], bool *active)
{
    (void)unused;
    *active = true;
    switch ((v[0] & 7) * 64 + (v[1] & 7) * 8 + (v[2] & 7)) {
    case 3: return NAN;
    case 100: return INFINITY;
    case 200: return -INFINITY;
    case 300: return 1;
    default: return 0;
    }
}

static void what_is_no_number_becomes_0(void **state)
{
    struct vdb_grid g = {.name = "a", .voxel = broken_voxel};
    struct voxel_grid grid;
    size_t size;

    (void)state;
    for (int i = 0; i < 2; i++) {
        char *bytes;

        g.is_half = i != 0;
        bytes = vdb_file_of(&g, &size);
        parse(&grid, bytes, size, NULL);
        assert_int_equal(grid.replaced_count, 3);
        check_close(voxel_grid_value(&grid, 0, 0, 3), 0, 0);
        check_close(voxel_grid_value(&grid, 1, 4, 4), 0, 0);
        check_close(voxel_grid_value(&grid, 4, 5, 4), 1, 0);
        voxel_grid_free(&grid);
        free(bytes);
    }
}

/* ---- transforms and names ---- */

static void transforms_lead_to_the_world(void **state)
{
    static const double uniform[15] = {.25, .25, .25}, scale[15] = {1, 2, 4},
                        move[3] = {5, 6, 7}, both[18] = {5, 6, 7, 1, 2, 4},
                        matrix[16] = {0, 2, 0, 0, -3, 0, 0, 0,
                                      1, 0, 4, 0, 5,  6, 7, 1};
    static const struct {
        const char *map;
        const double *numbers;
        int count;
        double want[3]; /* of the point 1 10 100 */
    } cases[] = {
        {"UniformScaleMap", uniform, 15, {.25, 2.5, 25}},
        {"ScaleMap", scale, 15, {1, 20, 400}},
        {"TranslationMap", move, 3, {6, 16, 107}},
        {"ScaleTranslateMap", both, 18, {6, 26, 407}},
        {"UniformScaleTranslateMap", both, 18, {6, 26, 407}},
        {"AffineMap", matrix, 16, {75, 8, 407}},
        {"UnitaryMap", matrix, 16, {75, 8, 407}},
    };
    static const double p[3] = {1, 10, 100};

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct vdb_grid g = dense;
        struct voxel_grid grid;
        double got[3];
        size_t size;
        char *bytes;

        g.flags = VDB_ACTIVE_MASK;
        g.map = cases[i].map;
        g.map_numbers = cases[i].numbers;
        g.map_count = cases[i].count;
        bytes = vdb_file_of(&g, &size);
        parse(&grid, bytes, size, NULL);
        affine_point(&grid.to_world, p, got);
        for (int a = 0; a < 3; a++)
            check_close(got[a], cases[i].want[a], 0);
        voxel_grid_free(&grid);
        free(bytes);
    }
}

/* A file of grids that are told apart by their backgrounds, from 1 on. The
 * last shows the tree of the second. */
static char *many_grids(size_t *size)
{
    static const struct {
        const char *name, *type, *parent;
    } cases[] = {
        {"velocity", "Tree_vec3s_5_4_3", NULL},
        {"heat", NULL, NULL},
        {"density\x1e"
         "0",
         NULL, NULL},
        {"density\x1e"
         "1",
         NULL, NULL},
        {"moved", NULL, "heat"},
    };
    static const double move[3] = {5, 6, 7};
    struct vdb_file f;

    vdb_file_begin(&f, 222, 5);
    for (int i = 0; i < 5; i++) {
        const struct vdb_grid g = {
            .name = cases[i].name,
            .type = cases[i].type,
            .parent = cases[i].parent,
            .first = {1, 1, 1},
            .background = (float)i + 1,
            .map = i == 4 ? "TranslationMap" : NULL,
            .map_numbers = move,
            .map_count = 3,
        };

        vdb_file_add(&f, &g);
    }
    return vdb_file_end(&f, size);
}

static void grids_are_chosen_by_name(void **state)
{
    static const struct {
        const char *name;
        float background;
    } cases[] = {{NULL, 3}, {"", 3}, {"heat", 2}, {"density", 3}, {"moved", 2}};
    struct voxel_grid grid;
    struct error err;
    size_t size;
    char *bytes = many_grids(&size);

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        parse(&grid, bytes, size, cases[i].name);
        check_close(grid.background, cases[i].background, 0);
        check_close(grid.to_world.m[1][3], i == 4 ? 6 : 0, 0);
        voxel_grid_free(&grid);
    }
    assert_false(vdb_parse(&grid, bytes, size, "smoke", &err));
    assert_string_equal(err.text,
                        "found no grid 'smoke', expected one of: velocity "
                        "(Tree_vec3s_5_4_3), heat, density, density, moved");
    voxel_grid_free(&grid);
    assert_false(vdb_parse(&grid, bytes, size, "velocity", &err));
    assert_string_equal(err.text,
                        "found grid 'velocity' of type 'Tree_vec3s_5_4_3', "
                        "expected Tree_float_5_4_3 or "
                        "Tree_float_5_4_3_HalfFloat");
    voxel_grid_free(&grid);
    free(bytes);
}

/* Without a grid of the name density it is the first that can be read. */
static void first_scalar_grid_is_the_default(void **state)
{
    struct vdb_grid g = {.name = "velocity",
                         .type = "Tree_vec3s_5_4_3",
                         .first = {1, 1, 1}};
    struct voxel_grid grid;
    struct error err;
    struct vdb_file f;
    size_t size;
    char *bytes;

    (void)state;
    for (int i = 0; i < 2; i++) {
        vdb_file_begin(&f, 224, i == 0 ? 3 : 1);
        vdb_file_add(&f, &g);
        if (i == 0) {
            g.type = NULL;
            for (int k = 0; k < 2; k++) {
                g.name = k == 0 ? "heat" : "flame";
                g.background = (float)k + 1;
                vdb_file_add(&f, &g);
            }
            g.type = "Tree_vec3s_5_4_3";
        }
        bytes = vdb_file_end(&f, &size);
        if (i == 0) {
            parse(&grid, bytes, size, NULL);
            check_close(grid.background, 1, 0);
        } else {
            assert_false(vdb_parse(&grid, bytes, size, NULL, &err));
            assert_string_equal(
                err.text,
                "found flame (Tree_vec3s_5_4_3), expected a grid of floats");
        }
        voxel_grid_free(&grid);
        free(bytes);
    }
}

/* ---- what a file says of its grids ---- */

static void fire_has_names(void **state)
{
    static const struct {
        const char *names[4];
        uint32_t grids, own; /* bits */
    } cases[] = {
        {{"density", "flame", "shadow", "temperature"}, 1 << 0 | 1 << 3, 0},
        {{"density_noise", "flame_noise"}, 1 << 2, 0},
        {{"flames", "heat"}, 1 << 1 | 1 << 4, 1 << 1},
        {{"flame\x1e"
          "0",
          "temperatures", "Heat"},
         1 << 0,
         1 << 0},
    };
    struct voxel_grid grid;

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *const *names = cases[i].names;
        struct vdb_file f;
        uint32_t count = 0;
        size_t size;
        char *bytes;

        while (count < 4 && names[count] != NULL)
            count++;
        vdb_file_begin(&f, 224, count + 1);
        for (uint32_t k = 0; k <= count; k++) {
            const struct vdb_grid g = {.name = k < count ? names[k] : "heat",
                                       .type = k < count ? NULL
                                                         : "Tree_vec3s_5_4_3",
                                       .first = {1, 1, 1}};

            vdb_file_add(&f, &g);
        }
        bytes = vdb_file_end(&f, &size);
        parse(&grid, bytes, size, NULL);
        assert_int_equal(grid.fire_grids, cases[i].grids);
        assert_int_equal(grid.own_fire, cases[i].own);
        voxel_grid_free(&grid);
        free(bytes);
    }
}

static void fluids_of_blender_have_z_up(void **state)
{
    struct voxel_grid grid;

    (void)state;
    for (int i = 0; i < 2; i++) {
        const struct vdb_grid g = {.name = "density",
                                   .class = "fog volume",
                                   .is_of_blender = i != 0,
                                   .first = {1, 1, 1}};
        size_t size;
        char *bytes = vdb_file_of(&g, &size);

        parse(&grid, bytes, size, NULL);
        assert_int_equal(grid.up_is_z, i);
        voxel_grid_free(&grid);
        free(bytes);
    }
}

/* Distance from a ball of radius 9 in a band of 3 voxels. */
static float ball_voxel(const void *unused, const int32_t v[3], bool *active)
{
    float d = sqrtf((float)(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])) - 9;

    (void)unused;
    *active = fabsf(d) < 3;
    return fminf(fmaxf(d, -3), 3);
}

static void level_sets_are_full_inside(void **state)
{
    struct vdb_grid g = {.name = "surface",
                         .class = "level set",
                         .background = 3,
                         .voxel = ball_voxel,
                         .first = {-12, -12, -12},
                         .last = {12, 12, 12}};
    struct voxel_grid grid;
    struct error err;
    size_t size;
    char *bytes = vdb_file_of(&g, &size);
    int32_t v[3];
    bool is_active;

    (void)state;
    parse(&grid, bytes, size, NULL);
    check_close(grid.background, 0, 0);
    for (v[0] = -20; v[0] <= 20; v[0]++)
        for (v[1] = -20; v[1] <= 20; v[1]++)
            for (v[2] = -20; v[2] <= 20; v[2]++) {
                float d = ball_voxel(NULL, v, &is_active);

                check_close(voxel_grid_value(&grid, v[0], v[1], v[2]),
                            d < 0 ? -d / 3 : 0, 1e-7);
            }
    check_majorants(&grid);
    voxel_grid_free(&grid);
    free(bytes);
    g.background = 0;
    bytes = vdb_file_of(&g, &size);
    assert_false(vdb_parse(&grid, bytes, size, NULL, &err));
    assert_string_equal(err.text, "found a level set with a background of 0, "
                                  "expected the width of its band");
    voxel_grid_free(&grid);
    free(bytes);
}

static void other_formats_have_a_message(void **state)
{
    static const char bytes[] = "NanoVDB0 and the rest";
    struct voxel_grid grid;
    struct error err;

    (void)state;
    assert_false(vdb_parse(&grid, bytes, sizeof bytes, NULL, &err));
    assert_string_equal(err.text,
                        "found a NanoVDB file, expected an OpenVDB file");
    voxel_grid_free(&grid);
}

/* ---- broken files ---- */

/* A file of 10 kB: two leaves. */
static char *small_file(size_t *size, uint32_t flags)
{
    static const struct sparse s = {2, {4.5f, -6}, 2};
    struct vdb_grid g = sparse_grid;

    g.context = &s;
    g.flags = flags;
    g.first[0] = g.first[1] = g.first[2] = 0;
    g.last[0] = 15;
    g.last[1] = g.last[2] = 7;
    g.tile_count = 0;
    return vdb_file_of(&g, size);
}

/* Checks that bytes, in memory of their own, give a grid or one line. */
static bool check_bytes(const char *bytes, size_t size, struct error *err)
{
    char *copy = malloc(size > 0 ? size : 1);
    struct voxel_grid grid;
    bool ok;

    assert_non_null(copy);
    memcpy(copy, bytes, size);
    err->text[0] = '\0';
    ok = vdb_parse(&grid, copy, size, NULL, err);
    if (ok) {
        for (uint64_t i = 0; i < voxel_grid_place_count(&grid); i++)
            assert_true(grid.index[i] < grid.brick_count);
    } else {
        assert_true(err->text[0] != '\0');
        assert_null(strchr(err->text, '\n'));
    }
    voxel_grid_free(&grid);
    free(copy);
    return ok;
}

static void files_that_end_early_have_a_message(void **state)
{
    struct error err;
    size_t size;
    char *bytes = small_file(&size, VDB_ACTIVE_MASK | VDB_ZIP);

    (void)state;
    assert_true(check_bytes(bytes, size, &err));
    for (size_t i = 0; i < size; i++) {
        assert_false(check_bytes(bytes, i, &err));
        if (i >= 8)
            assert_true(strstr(err.text, "expected") != NULL);
    }
    free(bytes);
}

/* Every bit of the head is turned, and a part of those of the nodes. */
static void turned_bits_do_no_harm(void **state)
{
    struct error err;
    size_t size;

    (void)state;
    for (uint32_t flags = 2; flags <= 3; flags++) {
        char *bytes = small_file(&size, flags);

        for (size_t i = 0; i < size; i++) {
            if (i > 600 && !check_is_due(24))
                continue;
            for (int b = 0; b < 8; b++) {
                bytes[i] = (char)(bytes[i] ^ 1 << b);
                check_bytes(bytes, size, &err);
                bytes[i] = (char)(bytes[i] ^ 1 << b);
            }
        }
        free(bytes);
    }
}

/* Returns the place of a text in the file. */
static size_t find(const char *bytes, size_t size, const char *text)
{
    const char *p = memmem(bytes, size, text, strlen(text));

    assert_non_null(p);
    return (size_t)(p - bytes);
}

static void broken_files_have_messages(void **state)
{
    /* numbers are put behind a text */
    static const struct {
        const char *behind;
        int offset, count;
        uint32_t number;
        const char *message;
    } cases[] = {
        {" BDV", 0, 4, 1, "found no OpenVDB file"},
        {" BDV", 4, 4, 221,
         "found version 221 of OpenVDB's files, expected 222 or later"},
        {" BDV", 16, 1, 0,
         "found a stream of OpenVDB, expected a file with the places of its "
         "grids"},
        {"456789abcdef", 0, 4, UINT32_MAX, "found its end at byte "},
        {"456789abcdef", 4, 4, UINT32_MAX, "found its end at byte "},
        {"tomorrow", 5, 4, 0, "found no grids, expected a grid of floats"},
        {"tomorrow", 5, 4, UINT32_MAX, "found its end at byte "},
        {"_5_4_3", 4, 4, 7, ": found a grid from byte 7 to "},
        {"_5_4_3", 4 + 16, 4, UINT32_MAX, ": found a grid from byte "},
        {"_5_4_3", 4 + 16, 4, 300, "found the grid's end at byte "},
        {"_5_4_3", 4 + 24, 4, 8, ": found compression 8, expected at most 7"},
        {"_5_4_3", 4 + 24, 4, 0, "found its end at byte "},
        {"ScaleMap", -4, 4, 0x70614d78,
         "found a transform of type 'UniformScalxMap', expected scale, "
         "translation or an affine map"},
        {"ScaleMap", 4, 4, 0x7ff80000, "found a transform without an inverse"},
        {"ScaleMap", 4, 4, 0, "found a transform without an inverse"},
        {"ScaleMap", 120, 4, 2, ": found a tree of 2 buffers, expected 1"},
        {"ScaleMap", 128, 4, UINT32_MAX, "expected a multiple of 4096"},
        {"ScaleMap", 132, 4, UINT32_MAX, "expected "},
        {"ScaleMap", 132, 4, 0, "found the grid's end at byte "},
        {"ScaleMap", 136, 4, 8,
         ": found 8 as place of a node, expected a "
         "multiple of 4096 from -2^30 to 2^30"},
        {"ScaleMap", 136, 4, 0x60000000, " as place of a node"},
        {"ScaleMap", 148 + 8192, 1, 7,
         ": found 7 as kind of inactive values, expected 0 to 6"},
        {"ScaleMap", 148 + 8193, 1, 1,
         ": found broken values, expected 0 bytes that zlib has packed"},
        {"ScaleMap", 148 + 8194, 4, 0x1000000, "found its end at byte "},
    };
    struct error err;
    size_t size;
    char *bytes = small_file(&size, VDB_ACTIVE_MASK | VDB_ZIP);

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        size_t at = find(bytes, size, cases[i].behind) +
                    strlen(cases[i].behind) + (size_t)cases[i].offset;
        char old[4];

        memcpy(old, bytes + at, 4);
        memcpy(bytes + at, &cases[i].number, (size_t)cases[i].count);
        check_or_say(!check_bytes(bytes, size, &err), cases[i].message);
        check_has(err.text, cases[i].message);
        memcpy(bytes + at, old, 4);
    }
    free(bytes);
}

/* Two leaves that are far apart would need a box of terabytes. */
static void far_voxels_do_not_take_memory(void **state)
{
    static const struct vdb_tile far[] = {{{-8192, 0, 0}, 8, 1, true},
                                          {{8184, 8184, 8184}, 8, 1, true}};
    static const struct vdb_tile large[] = {{{0, 0, 0}, 4096, 1, true}};
    static const struct vdb_tile twice[] = {{{0, 0, 0}, 4096, 1, true},
                                            {{0, 0, 0}, 4096, 1, true}};
    static const struct {
        const struct vdb_tile *tiles;
        int count;
        const char *message;
    } cases[] = {
        {far, 2,
         "found a box of 16384 x 8192 x 8192 voxels, expected at most "
         "2^33 in all"},
        {large, 1,
         "found a box of 4096 x 4096 x 4096 voxels, expected at most "
         "2^33 in all"},
        {twice, 2, "found two nodes at 0 0 0, expected one"},
    };
    struct error err;

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct vdb_grid g = {.name = "a",
                                   .first = {1, 1, 1},
                                   .flags = VDB_ACTIVE_MASK,
                                   .tiles = cases[i].tiles,
                                   .tile_count = cases[i].count};
        size_t size;
        char *bytes = vdb_file_of(&g, &size);

        assert_false(check_bytes(bytes, size, &err));
        assert_string_equal(err.text, cases[i].message);
        free(bytes);
    }
}

/* Packed values that end early, or are fewer or more than the node has. */
static void broken_packing_has_a_message(void **state)
{
    struct error err;

    (void)state;
    for (uint32_t flags = VDB_ZIP; flags <= VDB_BLOSC; flags += 3) {
        const struct vdb_grid g = {.name = "a",
                                   .voxel = broken_voxel,
                                   .flags = flags};
        size_t size, at;
        char *bytes;
        int64_t packed_bytes;

        if (flags == VDB_BLOSC && !has_blosc())
            continue;
        bytes = vdb_file_of(&g, &size);
        /* the sizes of the values of the node of 32^3 children */
        at = find(bytes, size, "ScaleMap") + 8 + 148 + 8192 + 1;
        memcpy(&packed_bytes, bytes + at, 8);
        assert_true(packed_bytes > 16 && packed_bytes < 4096);
        bytes[at + 8 + 4] ^= 1;
        assert_false(check_bytes(bytes, size, &err));
        check_has(err.text, ": found broken values, expected 131072 bytes that "
                            "");
        bytes[at + 8 + 4] ^= 1;
        packed_bytes = -5;
        memcpy(bytes + at, &packed_bytes, 8);
        assert_false(check_bytes(bytes, size, &err));
        check_has(err.text, ": found -5 as size of packed values, expected "
                            "-131072 or more than 0");
        packed_bytes = INT64_MIN;
        memcpy(bytes + at, &packed_bytes, 8);
        assert_false(check_bytes(bytes, size, &err));
        packed_bytes = INT64_MAX;
        memcpy(bytes + at, &packed_bytes, 8);
        assert_false(check_bytes(bytes, size, &err));
        free(bytes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dense_grids_keep_their_values),
        cmocka_unit_test(sparse_grids_keep_values_and_tiles),
        cmocka_unit_test(bounds_are_those_of_active_voxels),
        cmocka_unit_test(empty_grids_are_background),
        cmocka_unit_test(half_floats_are_exact),
        cmocka_unit_test(what_is_no_number_becomes_0),
        cmocka_unit_test(transforms_lead_to_the_world),
        cmocka_unit_test(grids_are_chosen_by_name),
        cmocka_unit_test(first_scalar_grid_is_the_default),
        cmocka_unit_test(fire_has_names),
        cmocka_unit_test(fluids_of_blender_have_z_up),
        cmocka_unit_test(level_sets_are_full_inside),
        cmocka_unit_test(other_formats_have_a_message),
        cmocka_unit_test(files_that_end_early_have_a_message),
        cmocka_unit_test(turned_bits_do_no_harm),
        cmocka_unit_test(broken_files_have_messages),
        cmocka_unit_test(far_voxels_do_not_take_memory),
        cmocka_unit_test(broken_packing_has_a_message),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
