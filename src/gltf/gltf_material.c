// SPDX-License-Identifier: MIT
#include "gltf/gltf_material.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "formats/mtl.h"
#include "formats/scene_lists.h"
#include "gltf/gltf_value.h"

/* Lines of statements only tell whether a file has them. */
#define LINE 1

/* Returns a name that no other material of the scene has, for free(). */
static char *unique_name(const struct scene *scene, const char *name, size_t i)
{
    char *text = *name != '\0' && mtl_find(scene, name) == NO_INDEX
                     ? strdup(name)
                     : format_text("%s#%zu", name, i);

    return text;
}

static bool read_material(const struct gltf_document *d, size_t i,
                          struct scene *scene, size_t *capacity,
                          struct warnings *report, struct error *err)
{
    struct material_origin origin = {mtl_source_empty(), 0};
    struct gltf_value v, pbr;
    double color[4] = {1, 1, 1, 1};
    const char *name = "";
    struct material m;
    char *unique;
    bool ok;

    if (!gltf_entry(d, "materials", i, &v, err) ||
        !gltf_string(&v, "name", &name, err) ||
        !gltf_object(&v, "pbrMetallicRoughness", &pbr, err) ||
        !gltf_numbers(&pbr, "baseColorFactor", 4, color, err))
        return false;
    origin.source.kd.line = LINE;
    memcpy(origin.source.kd.rgb, color, sizeof origin.source.kd.rgb);
    m = material_from_source(&origin.source, d->path, report);
    unique = unique_name(scene, name, i);
    ok = unique != NULL &&
         scene_add_material(scene, capacity, unique, &m, &origin);
    free(unique);
    return ok || fail(err, "%s: out of memory for the materials", d->path);
}

bool gltf_materials_read(const struct gltf_document *document,
                         struct scene *scene, struct warnings *report,
                         struct error *err)
{
    size_t capacity = scene->material_count;

    for (size_t i = 0; i < gltf_entry_count(document, "materials"); i++)
        if (!read_material(document, i, scene, &capacity, report, err))
            return false;
    return true;
}
