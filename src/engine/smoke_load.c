// SPDX-License-Identifier: MIT
#include "engine/smoke_load.h"

#include <inttypes.h>

#include "read/child/voxel_file.h"
#include "world/world_smoke.h"

static bool read_grid(struct host_world *host, const struct scene *scene,
                      const char *path, const char *name,
                      struct warnings *report, struct error *err)
{
    struct voxel_grid grid = {.index = NULL};
    bool ok;

    if (world_has_grid(host, path, name))
        return true;
    ok = voxel_file_read(&grid, path, name, scene->program, err) &&
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
