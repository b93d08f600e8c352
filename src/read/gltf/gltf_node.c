// SPDX-License-Identifier: MIT
#include "read/gltf/gltf_node.h"

#include <float.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/print.h"
#include "kernels/types.h"

static bool out_of_memory(const struct gltf_document *d, struct error *err)
{
    return fail(err, "%s: out of memory for its nodes", d->path);
}

/* ---- matrices ---- */

struct affine gltf_matrix(const double translation[3], const double rotation[4],
                          const double scale[3])
{
    double x = rotation[0], y = rotation[1], z = rotation[2], w = rotation[3];
    double norm = x * x + y * y + z * z + w * w;
    double f = norm > 0 && norm <= DBL_MAX ? 2 / norm : 0;
    const double turn[3][3] = {
        {1 - f * (y * y + z * z), f * (x * y - z * w), f * (x * z + y * w)},
        {f * (x * y + z * w), 1 - f * (x * x + z * z), f * (y * z - x * w)},
        {f * (x * z - y * w), f * (y * z + x * w), 1 - f * (x * x + y * y)},
    };
    struct affine a;

    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            a.m[i][k] = turn[i][k] * scale[k];
        a.m[i][3] = translation[i];
    }
    return a;
}

/* ---- reading ---- */

static bool read_matrix(const struct gltf_value *v, struct gltf_node *n,
                        struct error *err)
{
    double columns[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

    n->has_matrix = json_object_get(v->json, "matrix") != NULL;
    if (!gltf_numbers(v, "matrix", 16, columns, err))
        return false;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 4; k++)
            n->matrix.m[i][k] = columns[4 * k + i];
    return true;
}

static bool read_extensions(const struct gltf_value *v, struct gltf_node *n,
                            struct error *err)
{
    struct gltf_value light, visibility;
    bool is_visible = true;

    if (!gltf_extension(v, "KHR_lights_punctual", &light, err) ||
        !gltf_index(&light, "light", "lights", &n->light, err) ||
        !gltf_extension(v, "KHR_node_visibility", &visibility, err) ||
        !gltf_flag(&visibility, "visible", &is_visible, err))
        return false;
    n->is_hidden = !is_visible;
    return true;
}

/* Links the children, which must not have a parent yet. */
static bool read_children(const struct gltf_value *v, struct gltf_nodes *nodes,
                          uint32_t parent, struct error *err)
{
    uint32_t *link = &nodes->items[parent].first_child;
    struct gltf_value children;

    if (!gltf_array(v, "children", &children, err))
        return false;
    for (size_t i = 0; i < gltf_count(&children); i++) {
        uint32_t child;

        if (!gltf_item_index(&children, i, "nodes", &child, err))
            return false;
        if (nodes->items[child].parent != NO_INDEX)
            return gltf_fail(&children, err,
                             "found node %" PRIu32 ", a child of node %" PRIu32
                             " as well, expected a tree",
                             child, nodes->items[child].parent);
        nodes->items[child].parent = parent;
        *link = child;
        link = &nodes->items[child].next_sibling;
    }
    return true;
}

static bool read_node(const struct gltf_document *d, struct gltf_nodes *nodes,
                      uint32_t i, struct error *err)
{
    struct gltf_node *n = &nodes->items[i];
    struct gltf_value v;

    return gltf_entry(d, "nodes", i, &v, err) && read_matrix(&v, n, err) &&
           gltf_numbers(&v, "translation", 3, n->translation, err) &&
           gltf_numbers(&v, "rotation", 4, n->rotation, err) &&
           gltf_numbers(&v, "scale", 3, n->scale, err) &&
           gltf_index(&v, "mesh", "meshes", &n->mesh, err) &&
           gltf_index(&v, "skin", "skins", &n->skin, err) &&
           gltf_index(&v, "camera", "cameras", &n->camera, err) &&
           read_extensions(&v, n, err) && read_children(&v, nodes, i, err);
}

bool gltf_nodes_read(const struct gltf_document *document,
                     struct gltf_nodes *nodes, struct error *err)
{
    size_t count = gltf_entry_count(document, "nodes");

    nodes->items = alloc_array(count, sizeof *nodes->items);
    nodes->visible = alloc_array(count, sizeof *nodes->visible);
    if (nodes->items == NULL || nodes->visible == NULL || count >= NO_INDEX)
        return out_of_memory(document, err);
    nodes->count = (uint32_t)count;
    for (uint32_t i = 0; i < nodes->count; i++)
        nodes->items[i] = (struct gltf_node){
            .rotation = {0, 0, 0, 1},
            .scale = {1, 1, 1},
            .parent = NO_INDEX,
            .first_child = NO_INDEX,
            .next_sibling = NO_INDEX,
        };
    for (uint32_t i = 0; i < nodes->count; i++)
        if (!read_node(document, nodes, i, err))
            return false;
    return true;
}

bool gltf_node_name(const struct gltf_value *node,
                    const struct gltf_value *shown, char cut[GLTF_NAME_BYTES],
                    const char **name, struct error *err)
{
    const char *of_shown = "";
    size_t length;

    *name = NULL;
    if (!gltf_string(shown, "name", &of_shown, err) ||
        !gltf_string(node, "name", name, err))
        return false;
    if (*name != NULL)
        return true;
    length = strnlen(of_shown, GLTF_NAME_BYTES - 1);
    while (length > 0 && (of_shown[length] & 0xc0) == 0x80)
        length--; /* no part of a character */
    memcpy(cut, of_shown, length);
    cut[length] = '\0';
    *name = cut;
    return true;
}

/* ---- placing ---- */

/* Returns the node that follows in the tree of `root`, after the descendants of
 * `node` if these are passed over; NO_INDEX at the end. */
static uint32_t next_node(const struct gltf_nodes *nodes, uint32_t root,
                          uint32_t node, bool passes_over)
{
    if (!passes_over && nodes->items[node].first_child != NO_INDEX)
        return nodes->items[node].first_child;
    while (node != root && nodes->items[node].next_sibling == NO_INDEX)
        node = nodes->items[node].parent;
    return node == root ? NO_INDEX : nodes->items[node].next_sibling;
}

static void place_node(struct gltf_nodes *nodes, uint32_t node)
{
    struct gltf_node *n = &nodes->items[node];
    const struct gltf_node *parent;

    n->world = n->has_matrix
                   ? n->matrix
                   : gltf_matrix(n->translation, n->rotation, n->scale);
    if (n->parent == NO_INDEX)
        return;
    parent = &nodes->items[n->parent];
    n->world = affine_join(&parent->world, &n->world);
    n->is_hidden |= parent->is_hidden;
}

/* Places all nodes. Those that no root leads to are in a cycle. */
static bool place_all(const struct gltf_document *d, struct gltf_nodes *nodes,
                      struct error *err)
{
    uint32_t placed_count = 0;

    for (uint32_t root = 0; root < nodes->count; root++) {
        if (nodes->items[root].parent != NO_INDEX)
            continue;
        for (uint32_t i = root; i != NO_INDEX;
             i = next_node(nodes, root, i, false)) {
            place_node(nodes, i);
            placed_count++;
        }
    }
    return placed_count == nodes->count ||
           fail(err,
                "%s: /nodes: found %" PRIu32
                " node%s in a cycle, expected trees",
                d->path, nodes->count - placed_count,
                print_plural(nodes->count - placed_count));
}

/* Lists the nodes of a tree that are not hidden and not listed yet. */
static void list_tree(struct gltf_nodes *nodes, uint32_t root, bool *is_listed)
{
    uint32_t i = root;

    while (i != NO_INDEX) {
        bool was_listed = is_listed[i];

        is_listed[i] = true;
        if (!was_listed && !nodes->items[i].is_hidden)
            nodes->visible[nodes->visible_count++] = i;
        i = next_node(nodes, root, i, was_listed);
    }
}

static bool list_scene(const struct gltf_document *d, uint32_t scene,
                       struct gltf_nodes *nodes, bool *is_listed,
                       struct error *err)
{
    struct gltf_value root = gltf_root(d), v, roots;

    if (scene == NO_INDEX && !gltf_index(&root, "scene", "scenes", &scene, err))
        return false;
    if (gltf_entry_count(d, "scenes") == 0) {
        for (uint32_t i = 0; i < nodes->count; i++)
            if (nodes->items[i].parent == NO_INDEX)
                list_tree(nodes, i, is_listed);
        return true;
    }
    if (!gltf_entry(d, "scenes", scene == NO_INDEX ? 0 : scene, &v, err) ||
        !gltf_array(&v, "nodes", &roots, err))
        return false;
    for (size_t i = 0; i < gltf_count(&roots); i++) {
        uint32_t node;

        if (!gltf_item_index(&roots, i, "nodes", &node, err))
            return false;
        list_tree(nodes, node, is_listed);
    }
    return true;
}

bool gltf_nodes_place(const struct gltf_document *document, uint32_t scene,
                      struct gltf_nodes *nodes, struct error *err)
{
    bool *is_listed = alloc_array(nodes->count, sizeof *is_listed);
    bool ok;

    if (is_listed == NULL)
        return out_of_memory(document, err);
    ok = place_all(document, nodes, err) &&
         list_scene(document, scene, nodes, is_listed, err);
    free(is_listed);
    return ok;
}

void gltf_nodes_free(struct gltf_nodes *nodes)
{
    for (uint32_t i = 0; i < nodes->count; i++)
        free(nodes->items[i].weights);
    free(nodes->items);
    free(nodes->visible);
    memset(nodes, 0, sizeof *nodes);
}
