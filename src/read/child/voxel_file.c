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
            memcmp(bytes, vdb_magic, sizeof vdb_magic) == 0);
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

/* Sets the coefficients by the grid's size and its largest value. */
static void set_density(const struct voxel_grid *g, const struct scene *scene,
                        struct smoke_numbers *n)
{
    uint64_t places = voxel_grid_place_count(g);
    double most = 0, extent = 0, density;

    for (uint64_t i = 0; i < places; i++)
        most = fmax(most, (double)g->majorants[i]);
    for (int a = 0; a < 3; a++)
        extent = fmax(extent, scene->bounds_hi[a] - scene->bounds_lo[a]);
    density = rounded(fmin(MODEL_DEPTH / (extent * most), 1e30));
    for (int k = 0; k < 3; k++) {
        n->scatter[k] = density;
        n->absorb[k] = rounded(density * MODEL_ABSORBED);
    }
}

bool voxel_scene_parse(struct scene *scene, const char *bytes,
                       size_t size_bytes, const char *path,
                       struct warnings *report, struct error *err)
{
    static const struct mesh_textures no_textures = {.count = 0};
    char empty[] = "";
    struct smoke smoke = {.grid = empty,
                          .temperature = empty,
                          .numbers = smoke_defaults};
    struct voxel_grid grid;
    bool ok;

    (void)bytes;
    (void)size_bytes;
    ok = voxel_file_read(&grid, path, NULL, scene->program, err) &&
         mesh_begin(scene, path, err);
    if (ok && grid.first[0] <= grid.last[0]) {
        find_bounds(&grid, scene->bounds_lo, scene->bounds_hi);
        set_density(&grid, scene, &smoke.numbers);
        smoke.path = scene->path;
        ok = smokes_add(&scene->smokes, &smoke) ||
             fail(err, "%s: out of memory for its smoke", path);
    }
    voxel_grid_free(&grid);
    return ok && mesh_finish(scene, NULL, &no_textures, report, err);
}
