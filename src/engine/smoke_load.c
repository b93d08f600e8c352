// SPDX-License-Identifier: MIT
#include "engine/smoke_load.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/file.h"
#include "read/child/vdb_read.h"
#include "read/npy.h"
#include "world/world_smoke.h"

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

    if (name[0] != '\0')
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

static bool read_grid(struct host_world *host, const struct scene *scene,
                      const char *path, const char *name,
                      struct warnings *report, struct error *err)
{
    struct voxel_grid grid = {.index = NULL};
    bool ok;

    if (world_has_grid(host, path, name))
        return true;
    ok = (is_npy(path) ? read_npy(&grid, path, name, err)
                       : vdb_read(&grid, path, name, scene->program, err)) &&
         world_add_grid(host, path, name, &grid, err);
    if (ok && grid.replaced_count > 0)
        warnings_add_named(report, "voxels that are no numbers", path,
                           "%s: found %" PRIu32 " voxels that are no numbers: "
                           "took 0 for them",
                           path, grid.replaced_count);
    voxel_grid_free(&grid);
    return ok;
}

bool smoke_load(struct host_world *host, const struct scene *scene,
                const struct view *view, struct warnings *report,
                struct error *err)
{
    for (uint32_t i = 0; i < view->smokes.count; i++) {
        const struct smoke *s = &view->smokes.items[i];

        if (!read_grid(host, scene, s->path, s->grid, report, err) ||
            (s->temperature[0] != '\0' &&
             !read_grid(host, scene, s->path, s->temperature, report, err)))
            return false;
    }
    return world_set_smokes(host, scene, &view->smokes, err);
}
