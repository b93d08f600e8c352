// SPDX-License-Identifier: MIT
#include "gltf/gltf_instancing.h"

#include <inttypes.h>

#include "gltf/gltf_accessor.h"
#include "gltf/gltf_node.h"
#include "kernels/types.h"

enum { TRANSLATION, ROTATION, SCALE, KINDS };

static const char *const keys[KINDS] = {"TRANSLATION", "ROTATION", "SCALE"};
static const uint32_t component_counts[KINDS] = {3, 4, 3};

/* Memory of an instance when the tree is built; 545 was measured. */
#define INSTANCE_BYTES 600

struct instancing {
    struct gltf_accessor accessors[KINDS];
    bool is_there[KINDS];
    uint32_t count;
};

static bool open_all(const struct gltf_value *attributes, struct instancing *in,
                     struct error *err)
{
    in->count = NO_INDEX;
    for (int i = 0; i < KINDS; i++) {
        struct gltf_accessor *a = &in->accessors[i];
        uint32_t index;

        if (!gltf_index(attributes, keys[i], "accessors", &index, err))
            return false;
        in->is_there[i] = index != NO_INDEX;
        if (!in->is_there[i])
            continue;
        if (!gltf_accessor_open(attributes->document, index, a, err))
            return false;
        if (in->count == NO_INDEX)
            in->count = a->count;
        if (a->component_count != component_counts[i] || a->count != in->count)
            return gltf_fail(attributes, err,
                             "found %s of %" PRIu32 " elements of %" PRIu32
                             " components, expected %" PRIu32 " of %" PRIu32,
                             keys[i], a->count, a->component_count, in->count,
                             component_counts[i]);
    }
    return in->count != NO_INDEX ||
           gltf_fail(attributes, err,
                     "found no TRANSLATION, ROTATION or SCALE");
}

static struct affine matrix_of(const struct instancing *in, uint32_t i)
{
    double numbers[KINDS][4] = {{0}, {0, 0, 0, 1}, {1, 1, 1}};

    for (int k = 0; k < KINDS; k++) {
        float read[4];

        if (!in->is_there[k])
            continue;
        gltf_accessor_floats(&in->accessors[k], i, 1, read);
        for (uint32_t c = 0; c < component_counts[k]; c++)
            numbers[k][c] = (double)read[c];
    }
    return gltf_matrix(numbers[TRANSLATION], numbers[ROTATION], numbers[SCALE]);
}

bool gltf_instances_add(const struct gltf_value *node, struct scene *scene,
                        uint32_t mesh, const struct affine *matrix,
                        uint32_t object, struct error *err)
{
    struct gltf_value extension, attributes;
    struct instancing in;

    if (!gltf_extension(node, "EXT_mesh_gpu_instancing", &extension, err))
        return false;
    if (extension.json == NULL)
        return gltf_take(node, 1, INSTANCE_BYTES, "instance", err) &&
               scene_add_instance(scene, mesh, matrix, object, err);
    if (!gltf_object(&extension, "attributes", &attributes, err) ||
        !open_all(&attributes, &in, err) ||
        !gltf_take(node, in.count, INSTANCE_BYTES, "instances", err))
        return false;
    for (uint32_t i = 0; i < in.count; i++) {
        struct affine own = matrix_of(&in, i);

        own = affine_join(matrix, &own);
        if (!scene_add_instance(scene, mesh, &own, object, err))
            return false;
    }
    return true;
}
