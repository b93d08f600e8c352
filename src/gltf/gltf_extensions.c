// SPDX-License-Identifier: MIT
#include "gltf/gltf_extensions.h"

#include <string.h>

#include "gltf/gltf_draco.h"
#include "gltf/gltf_texture.h"

static const char *const known[] = {
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    GLTF_DRACO,
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    GLTF_BASISU,
    "KHR_texture_transform",
};

static bool is_known(const char *name)
{
    if (strcmp(name, GLTF_DRACO) == 0 && gltf_draco_missing() != NULL)
        return false;
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
        if (strcmp(name, known[i]) == 0)
            return true;
    return false;
}

/* Reads a list of names. */
static bool read_names(const struct gltf_document *d, const char *key,
                       struct gltf_value *names, struct error *err)
{
    struct gltf_value root = gltf_root(d);

    if (!gltf_array(&root, key, names, err))
        return false;
    names->parent = NULL;
    for (size_t i = 0; i < gltf_count(names); i++)
        if (!json_is_string(json_array_get(names->json, i)))
            return gltf_fail(names, err,
                             "found an item that is no string, expected names "
                             "of extensions");
    return true;
}

bool gltf_extensions_check(const struct gltf_document *document,
                           struct warnings *report, struct error *err)
{
    struct gltf_value required, used;

    if (!read_names(document, "extensionsRequired", &required, err) ||
        !read_names(document, "extensionsUsed", &used, err))
        return false;
    for (size_t i = 0; i < gltf_count(&required); i++) {
        const char *name = json_string_value(json_array_get(required.json, i));

        if (strcmp(name, GLTF_DRACO) == 0 && gltf_draco_missing() != NULL)
            return fail(err,
                        "%s: found the required extension '" GLTF_DRACO
                        "', which needs " GLTF_DRACO_NEEDS,
                        document->path);
        if (strcmp(name, GLTF_BASISU) == 0 &&
            !gltf_textures_are_readable(document))
            return fail(err,
                        "%s: found the required extension '" GLTF_BASISU
                        "', expected " GLTF_BASISU_EXPECTED,
                        document->path);
        if (!is_known(name))
            return fail(err,
                        "%s: found the required extension '%.80s', expected "
                        "one that glim knows",
                        document->path, name);
    }
    for (size_t i = 0; i < gltf_count(&used); i++) {
        const char *name = json_string_value(json_array_get(used.json, i));

        if (!is_known(name))
            warnings_add_named(report, "extensions that glim does not know",
                               name,
                               "%s: found the extension '%.80s', which glim "
                               "does not know: ignored",
                               document->path, name);
    }
    return true;
}
