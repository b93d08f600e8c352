// SPDX-License-Identifier: MIT
#include "read/child/voxel_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "read/child/vdb_read.h"
#include "read/mesh_finish.h"
#include "read/npy.h"

static const char vdb_magic[] = {' ', 'B', 'D', 'V', 0, 0, 0, 0};

bool voxel_file_matches(const char *bytes, size_t size_bytes)
{
    return npy_matches(bytes, size_bytes) ||
           (size_bytes >= sizeof vdb_magic &&
            (memcmp(bytes, vdb_magic, sizeof vdb_magic) == 0 ||
             memcmp(bytes, "NanoVDB", 7) == 0));
}

/* ---- grids ---- */

/* Returns true if the file begins as one of NumPy. */
static bool is_npy(const char *path)
{
    char bytes[8];
    FILE *from = fopen(path, "rb");
    size_t size_bytes = from != NULL ? fread(bytes, 1, sizeof bytes, from) : 0;

    if (from != NULL)
        fclose(from);
    return npy_matches(bytes, size_bytes);
}

static bool read_npy(struct voxel_grid *grid, const char *path,
                     const char *name, struct error *err)
{
    char *bytes = NULL;
    size_t size_bytes;
    struct error own;
    bool ok;

    if (name != NULL && name[0] != '\0')
        return fail(err,
                    "%s: found no grid '%s': a NumPy file is one grid without "
                    "a name",
                    path, name);
    if (!file_read(path, &bytes, &size_bytes, err))
        return false;
    ok = npy_parse(grid, bytes, size_bytes, &own) ||
         fail(err, "%s: %s", path, own.text);
    free(bytes);
    return ok;
}

bool voxel_file_read(struct voxel_grid *grid, const char *path,
                     const char *name, const char *program, struct error *err)
{
    memset(grid, 0, sizeof *grid);
    return is_npy(path) ? read_npy(grid, path, name, err)
                        : vdb_read(grid, path, name, program, err);
}

/* ---- scenes ---- */

/* Depth of smoke whose density is the largest value everywhere. */
#define MODEL_DEPTH 24

/* Part of it that is absorbed. */
#define MODEL_ABSORBED 0.02

/* Depth of a flame, which one sees through, and the luminance of its hottest
 * part, in the light of a studio whose white is 1. */
#define FLAME_DEPTH 3
#define FLAME_GLOW  8

/* Temperature of the hottest part of a flame: Blender's default. Its grids have
 * 3 there, those of others 1, or kelvins. */
#define FLAME_KELVIN 3000

/* Largest value from which a grid of temperatures has kelvins. */
#define KELVINS_FROM 500

static void find_bounds(const struct voxel_grid *g, double low[3],
                        double high[3])
{
    double first[3], last[3];

    for (int a = 0; a < 3; a++) {
        first[a] = g->first[a];
        last[a] = g->last[a];
    }
    voxel_box_bounds(first, last, &g->to_world, low, high);
}

/* Returns two digits of a number. */
static double rounded(double x)
{
    char text[32];

    snprintf(text, sizeof text, "%.2g", x);
    return strtod(text, NULL);
}

/* Returns the largest value, at least 0. */
static double largest(const struct voxel_grid *g)
{
    uint64_t places = voxel_grid_place_count(g);
    double most = 0;

    for (uint64_t i = 0; i < places; i++)
        most = fmax(most, (double)g->majorants[i]);
    return most;
}

/* Returns the coefficient of a density that has this depth across the scene. */
static double coefficient(const struct scene *scene, double depth,
                          double density)
{
    double extent = 0;

    for (int a = 0; a < 3; a++)
        extent = fmax(extent, scene->bounds_hi[a] - scene->bounds_lo[a]);
    return rounded(fmin(depth / (extent * density), 1e30));
}

static bool add_smoke(struct scene *scene, const char *grid,
                      const char *temperature, const struct smoke_numbers *n,
                      struct error *err)
{
    char names[2][VOXEL_NAME_BYTES];
    const struct smoke smoke = {.path = scene->path,
                                .grid = names[0],
                                .temperature = names[1],
                                .numbers = *n};

    snprintf(names[0], sizeof names[0], "%s", grid);
    snprintf(names[1], sizeof names[1], "%s", temperature);
    return smokes_add(&scene->smokes, &smoke) ||
           fail(err, "%s: out of memory for its smoke", scene->path);
}

/* A grid of fire, and its largest value: 0 if there is none. */
struct fire_grid {
    const char *name;
    double most;
};

/* Finds the first grid of the file with one of these names. */
static bool find_fire(const struct scene *scene, uint32_t names, int first,
                      int end, struct fire_grid *found, struct error *err)
{
    struct voxel_grid grid;
    bool ok;

    *found = (struct fire_grid){"", 0};
    while (first < end && (names >> first & 1) == 0)
        first++;
    if (first == end)
        return true;
    found->name = voxel_fire_names[first];
    ok = voxel_file_read(&grid, scene->path, found->name, scene->program, err);
    if (ok)
        found->most = largest(&grid);
    voxel_grid_free(&grid);
    return ok;
}

static void set_glow(const struct fire_grid *heat, struct smoke_numbers *n)
{
    n->kelvin = heat->most < KELVINS_FROM ? rounded(FLAME_KELVIN / heat->most)
                                          : smoke_defaults.kelvin;
    n->glow = FLAME_GLOW;
}

static bool add_flame(struct scene *scene, const struct fire_grid *flame,
                      const struct fire_grid *heat, struct error *err)
{
    struct smoke_numbers n = smoke_defaults;

    for (int k = 0; k < 3; k++)
        n.absorb[k] = coefficient(scene, FLAME_DEPTH, flame->most);
    set_glow(heat, &n);
    return add_smoke(scene, flame->name, heat->name, &n, err);
}

/* Adds white smoke. A temperature below kelvins only says how smoke rises.
 * Beside a flame a density that stays below 1 is thin. */
static bool add_density(struct scene *scene, double most, bool has_flame,
                        const struct fire_grid *heat, struct error *err)
{
    bool has_glow = !has_flame && heat->most >= KELVINS_FROM;
    struct smoke_numbers n = smoke_defaults;
    double density =
        coefficient(scene, MODEL_DEPTH, has_flame ? fmax(most, 1) : most);

    for (int k = 0; k < 3; k++) {
        n.scatter[k] = density;
        n.absorb[k] = rounded(density * MODEL_ABSORBED);
    }
    if (has_glow)
        set_glow(heat, &n);
    return add_smoke(scene, "", has_glow ? heat->name : "", &n, err);
}

static bool add_model(struct scene *scene, const struct voxel_grid *grid,
                      struct error *err)
{
    bool is_flame = grid->own_fire != 0 && grid->own_fire < 1u << FLAME_NAMES;
    struct fire_grid flame, heat;

    find_bounds(grid, scene->bounds_lo, scene->bounds_hi);
    if (!find_fire(scene, grid->fire_grids, 0, FLAME_NAMES, &flame, err) ||
        !find_fire(scene, grid->fire_grids, FLAME_NAMES, FIRE_NAMES, &heat,
                   err))
        return false;
    if (!is_flame &&
        !add_density(scene, largest(grid), flame.most > 0, &heat, err))
        return false;
    return !(flame.most > 0) ||
           add_flame(scene, &flame, heat.most > 0 ? &heat : &flame, err);
}

static bool is_empty(const struct voxel_grid *grid)
{
    return grid->first[0] > grid->last[0];
}

/* Reads the grid whose box the model has: the density or, if that is empty, the
 * flame. */
static bool read_model(struct voxel_grid *grid, const char *path,
                       const char *program, struct error *err)
{
    if (!voxel_file_read(grid, path, NULL, program, err))
        return false;
    for (int i = 0; i < FLAME_NAMES && is_empty(grid); i++) {
        if ((grid->fire_grids >> i & 1) == 0)
            continue;
        voxel_grid_free(grid);
        if (!voxel_file_read(grid, path, voxel_fire_names[i], program, err))
            return false;
    }
    return true;
}

bool voxel_scene_parse(struct scene *scene, const char *bytes,
                       size_t size_bytes, const char *path,
                       struct warnings *report, struct error *err)
{
    static const struct mesh_textures no_textures = {.count = 0};
    struct voxel_grid grid;
    bool ok;

    (void)bytes;
    (void)size_bytes;
    ok = read_model(&grid, path, scene->program, err) &&
         mesh_begin(scene, path, err);
    if (ok) {
        scene->up_is_z = grid.up_is_z != 0;
        ok = is_empty(&grid) || add_model(scene, &grid, err);
    }
    voxel_grid_free(&grid);
    return ok && mesh_finish(scene, NULL, &no_textures, report, err);
}
