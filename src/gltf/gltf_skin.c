// SPDX-License-Identifier: MIT
#include "gltf/gltf_skin.h"

#include <inttypes.h>
#include <stdlib.h>

#include "base/memory.h"
#include "gltf/gltf_accessor.h"
#include "kernels/types.h"

/* Opens the inverse bind matrices. Without them all are the identity. */
static bool open_inverses(const struct gltf_value *skin, uint32_t joint_count,
                          struct gltf_accessor *a, bool *is_there,
                          struct error *err)
{
    uint32_t index;

    if (!gltf_index(skin, "inverseBindMatrices", "accessors", &index, err))
        return false;
    *is_there = index != NO_INDEX;
    if (!*is_there)
        return true;
    if (!gltf_accessor_open(skin->document, index, a, err))
        return false;
    return (a->component_count == 16 && a->dense.component == GLTF_FLOAT &&
            a->count >= joint_count) ||
           gltf_fail(skin, err,
                     "found inverseBindMatrices of %" PRIu32
                     " elements of %" PRIu32 " components, expected %" PRIu32
                     " of 16 floats",
                     a->count, a->component_count, joint_count);
}

static struct affine read_inverse(const struct gltf_accessor *a, uint32_t i)
{
    struct affine to;
    float columns[16];

    gltf_accessor_floats(a, i, 1, columns);
    for (int row = 0; row < 3; row++)
        for (int k = 0; k < 4; k++)
            to.m[row][k] = (double)columns[4 * k + row];
    return to;
}

static bool fill_joints(const struct gltf_value *list,
                        const struct gltf_nodes *nodes,
                        const struct gltf_accessor *inverses,
                        struct affine *joints, struct error *err)
{
    for (uint32_t i = 0; i < gltf_count(list); i++) {
        struct affine inverse;
        uint32_t node;

        if (!gltf_item_index(list, i, "nodes", &node, err))
            return false;
        joints[i] = nodes->items[node].world;
        if (inverses == NULL)
            continue;
        inverse = read_inverse(inverses, i);
        joints[i] = affine_join(&joints[i], &inverse);
    }
    return true;
}

bool gltf_skin_read(const struct gltf_document *document,
                    const struct gltf_nodes *nodes, uint32_t skin,
                    struct affine **joints, uint32_t *joint_count,
                    struct error *err)
{
    struct gltf_accessor inverses;
    struct gltf_value v, list;
    bool has_inverses;

    *joints = NULL;
    if (!gltf_entry(document, "skins", skin, &v, err) ||
        !gltf_array(&v, "joints", &list, err))
        return false;
    *joint_count = (uint32_t)gltf_count(&list);
    if (*joint_count == 0)
        return gltf_fail(&v, err, "found no joints, expected one or more");
    if (!open_inverses(&v, *joint_count, &inverses, &has_inverses, err))
        return false;
    if (!gltf_take(&v, *joint_count, sizeof **joints, "joints", err))
        return false;
    *joints = alloc_array(*joint_count, sizeof **joints);
    return *joints != NULL
               ? fill_joints(&list, nodes, has_inverses ? &inverses : NULL,
                             *joints, err)
               : gltf_fail(&v, err, "out of memory for its joints");
}
