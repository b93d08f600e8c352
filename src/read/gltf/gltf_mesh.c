// SPDX-License-Identifier: MIT
#include "read/gltf/gltf_mesh.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/geometry.h"
#include "base/memory.h"
#include "base/name_table.h"
#include "read/gltf/gltf_accessor.h"
#include "read/gltf/gltf_material.h"
#include "read/gltf/gltf_node.h"
#include "read/gltf/gltf_primitive.h"
#include "read/gltf/gltf_value.h"
#include "scene/material.h"
#include "scene/scene.h"
#include "kernels/types.h"
#include "kernels/vec.h"

/* Meshes of the scene that were made of a mesh of the document. */
struct made {
    uint32_t first, count; /* first is NO_INDEX: none yet */
    uint32_t skin;         /* which bends them, or NO_INDEX */
};

struct builder {
    const struct gltf_document *document;
    const struct gltf_nodes *nodes;
    struct scene *scene;
    struct warnings *report;
    struct error *err;
    struct pool *pool;
    uint32_t variant;  /* of materials, or NO_INDEX */
    struct made *made; /* for each mesh of the document */
    struct name_table objects;
    size_t position_capacity, normal_capacity, color_capacity;
    size_t alpha_capacity, tangent_capacity;
    size_t uv_capacity, uv2_capacity;
    size_t tri_capacity, face_capacity, object_capacity;
};

static bool out_of_memory(const struct builder *b)
{
    return fail(b->err, "%s: out of memory for the scene", b->document->path);
}

/* ---- joints of a skin ---- */

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

/* Computes the matrix of each joint, from the mesh to the scene, after
 * gltf_nodes_place(). */
static bool gltf_skin_read(const struct gltf_document *document,
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

/* ---- instances ---- */

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

/* Places a mesh of the scene by the matrix, once or for each instance that the
 * node lists. */
static bool gltf_instances_add(const struct gltf_value *node,
                               struct scene *scene, uint32_t mesh,
                               const struct affine *matrix, uint32_t object,
                               struct error *err)
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

/* ---- arrays ---- */

/* Gives the vertices so far the colour white. */
static bool begin_colors(struct builder *b)
{
    struct scene *s = b->scene;

    s->colors = alloc_array(s->position_count, sizeof *s->colors);
    b->color_capacity = s->position_count;
    for (uint32_t i = 0; s->colors != NULL && i < s->position_count; i++)
        s->colors[i] = v3(1, 1, 1);
    return s->colors != NULL;
}

/* Gives the vertices so far the alpha 1. */
static bool begin_alphas(struct builder *b)
{
    struct scene *s = b->scene;

    s->alphas = alloc_array(s->position_count, sizeof *s->alphas);
    b->alpha_capacity = s->position_count;
    for (uint32_t i = 0; s->alphas != NULL && i < s->position_count; i++)
        s->alphas[i] = 1;
    return s->alphas != NULL;
}

/* Gives the normals so far no tangents. */
static bool begin_tangents(struct builder *b)
{
    struct scene *s = b->scene;

    s->tangents = alloc_array(s->normal_count, sizeof *s->tangents);
    b->tangent_capacity = s->normal_count;
    return s->tangents != NULL;
}

/* Makes room for the arrays that few files have. Each begins with the first
 * primitive that needs it. */
static bool grow_rare(struct builder *b, const struct gltf_primitive *p,
                      size_t positions, size_t normals)
{
    struct scene *s = b->scene;
    void *array;

    if ((p->has_colors && s->colors == NULL && !begin_colors(b)) ||
        (p->has_alphas && s->alphas == NULL && !begin_alphas(b)) ||
        (p->has_tangents && s->tangents == NULL && !begin_tangents(b)))
        return false;
    array = s->colors;
    if (s->colors != NULL &&
        !grow_array(&array, &b->color_capacity, positions, sizeof *s->colors))
        return false;
    s->colors = array;
    array = s->alphas;
    if (s->alphas != NULL &&
        !grow_array(&array, &b->alpha_capacity, positions, sizeof *s->alphas))
        return false;
    s->alphas = array;
    array = s->tangents;
    if (s->tangents != NULL &&
        !grow_array(&array, &b->tangent_capacity, normals, sizeof *s->tangents))
        return false;
    s->tangents = array;
    return true;
}

/* Makes room for texture coordinates. The second set begins with the first
 * primitive that has one. */
static bool grow_uvs(struct builder *b, const struct gltf_primitive *p)
{
    struct scene *s = b->scene;
    size_t n = s->uv_count + (p->has_uvs ? p->vertex_count : 0);
    bool has_second = s->uvs2 != NULL || p->has_uv_set[1];
    void *array = s->uvs;

    if (!grow_array(&array, &b->uv_capacity, n, sizeof *s->uvs))
        return false;
    s->uvs = array;
    array = s->uvs2;
    if (!has_second)
        return true;
    if (!grow_array(&array, &b->uv2_capacity, n, sizeof *s->uvs2))
        return false;
    if (s->uvs2 == NULL)
        memset(array, 0, s->uv_count * sizeof *s->uvs2);
    s->uvs2 = array;
    return true;
}

static bool grow_vertices(struct builder *b, const struct gltf_primitive *p)
{
    struct scene *s = b->scene;
    size_t n = (size_t)s->position_count + p->vertex_count;
    size_t normals = s->normal_count + (p->has_normals ? p->vertex_count : 0);
    void *array;

    array = s->file_positions;
    if (!grow_array(&array, &b->position_capacity, n,
                    3 * sizeof *s->file_positions))
        return false;
    s->file_positions = array;
    array = s->normals;
    if (!grow_array(&array, &b->normal_capacity, normals, sizeof *s->normals))
        return false;
    s->normals = array;
    return grow_uvs(b, p) && grow_rare(b, p, n, normals);
}

static bool grow_tris(struct builder *b, const struct gltf_primitive *p)
{
    struct scene *s = b->scene;
    size_t n = (size_t)s->tri_count + p->tri_count;
    void *array = s->tris;

    if (!grow_array(&array, &b->tri_capacity, n, sizeof *s->tris))
        return false;
    s->tris = array;
    array = s->tri_faces;
    if (!grow_array(&array, &b->face_capacity, n, sizeof *s->tri_faces))
        return false;
    s->tri_faces = array;
    array = s->tri_objects;
    if (!grow_array(&array, &b->object_capacity, n, sizeof *s->tri_objects))
        return false;
    s->tri_objects = array;
    return true;
}

/* Returns the memory of a vertex in all arrays, and in those of the targets
 * that move it. */
static uint64_t vertex_bytes(const struct scene *s,
                             const struct gltf_primitive *p)
{
    return 3 * sizeof *s->file_positions +
           (p->has_normals ? sizeof *s->normals : 0) +
           (p->has_uvs ? sizeof *s->uvs : 0) +
           (p->has_uv_set[1] ? sizeof *s->uvs2 : 0) +
           (p->has_colors ? sizeof *s->colors : 0) +
           (p->has_alphas ? sizeof *s->alphas : 0) +
           (p->has_tangents ? sizeof *s->tangents : 0) +
           3 * sizeof(float) * (uint64_t)p->target_count;
}

/* Makes room for the primitive. */
static bool reserve(struct builder *b, const struct gltf_value *value,
                    const struct gltf_primitive *p)
{
    const struct scene *s = b->scene;
    uint64_t tri_bytes =
        sizeof *s->tris + sizeof *s->tri_faces + sizeof *s->tri_objects;

    if (!gltf_take(value, p->vertex_count, SCENE_FINISH * vertex_bytes(s, p),
                   "vertices", b->err) ||
        !gltf_take(value, p->tri_count, SCENE_FINISH * tri_bytes, "triangles",
                   b->err))
        return false;
    if ((uint64_t)s->position_count + p->vertex_count >= NO_INDEX ||
        (uint64_t)s->tri_count + p->tri_count >= NO_INDEX)
        return gltf_fail(value, b->err,
                         "found more than 2^32 vertices or triangles");
    return (grow_vertices(b, p) && grow_tris(b, p)) || out_of_memory(b);
}

/* ---- meshes ---- */

/* Vertices whose colours are read at once. */
#define CHUNK 128u

static bool has_low_alpha(const struct gltf_accessor *colors)
{
    struct gltf_accessor a = *colors;
    float numbers[4 * CHUNK];

    a.is_normalized = true;
    for (uint32_t first = 0; first < a.count; first += CHUNK) {
        uint32_t n = a.count - first < CHUNK ? a.count - first : CHUNK;

        gltf_accessor_floats(&a, first, n, numbers);
        for (uint32_t i = 0; i < n; i++)
            if (numbers[4 * i + 3] < 1)
                return true;
    }
    return false;
}

/* Leaves out what the material of the primitive does not use: the alpha of
 * opaque surfaces, and tangents. */
static bool leave_out(const struct builder *b, struct gltf_primitive *p)
{
    const struct material *m = &b->scene->materials[p->material];

    p->has_tangents =
        p->has_tangents &&
        features_use_tangents(material_features(m, b->scene->textures));
    if (!p->has_alphas || !has_low_alpha(&p->colors)) {
        p->has_alphas = false;
        return true;
    }
    p->has_alphas = false;
    return p->material > gltf_entry_count(b->document, "materials") ||
           gltf_material_has_alpha(b->document, p->material - 1, &p->has_alphas,
                                   b->err);
}

static bool add_primitive(struct builder *b, const struct gltf_value *value,
                          const struct gltf_shape *shape)
{
    struct gltf_primitive p = {.mode = 0};
    bool ok = gltf_primitive_open(value, shape, &p, b->report, b->err) &&
              leave_out(b, &p);

    if (ok && p.tri_count > 0) {
        ok = reserve(b, value, &p) && scene_begin_mesh(b->scene, b->err) &&
             gltf_primitive_add(value, &p, shape, b->scene, b->pool, b->err);
        if (ok)
            scene_end_mesh(b->scene);
    }
    gltf_primitive_free(&p);
    return ok;
}

/* Adds the primitives of a mesh. */
static bool add_mesh(struct builder *b, const struct gltf_value *mesh,
                     const struct gltf_shape *shape, struct made *made)
{
    struct gltf_value list, v;

    if (!gltf_array(mesh, "primitives", &list, b->err))
        return false;
    made->first = b->scene->instances.mesh_count;
    for (size_t i = 0; i < gltf_count(&list); i++)
        if (!gltf_item_object(&list, i, &v, b->err) ||
            !add_primitive(b, &v, shape))
            return false;
    made->count = b->scene->instances.mesh_count - made->first;
    return true;
}

/* Reads the weights of morph targets, for free(). */
static bool read_weights(const struct gltf_value *of, double **weights,
                         uint32_t *count, struct error *err)
{
    struct gltf_value list;

    if (!gltf_array(of, "weights", &list, err))
        return false;
    *count = (uint32_t)gltf_count(&list);
    if (!gltf_take(of, *count, sizeof **weights, "weights", err))
        return false;
    *weights = alloc_array(*count, sizeof **weights);
    if (*weights == NULL)
        return gltf_fail(of, err, "out of memory for its weights");
    return gltf_numbers(of, "weights", *count, *weights, err);
}

/* Makes the meshes of a node's mesh, whose weights are those of `weighted`. */
static bool make(struct builder *b, uint32_t node,
                 const struct gltf_value *mesh,
                 const struct gltf_value *weighted, struct made *made)
{
    const struct gltf_node *n = &b->nodes->items[node];
    struct gltf_shape shape = {.variant = b->variant,
                               .weights = n->weights,
                               .weight_count = n->weight_count};
    struct affine *joints = NULL;
    double *weights = NULL;
    bool ok = true;

    if (n->weights == NULL) {
        ok = read_weights(weighted, &weights, &shape.weight_count, b->err);
        shape.weights = weights;
    }
    if (ok && n->skin != NO_INDEX) {
        ok = gltf_skin_read(b->document, b->nodes, n->skin, &joints,
                            &shape.joint_count, b->err);
        shape.joints = joints;
    }
    ok = ok && add_mesh(b, mesh, &shape, made);
    free(joints);
    free(weights);
    return ok;
}

/* ---- nodes ---- */

/* Adds the object of a node. Names that are taken get the node's number. */
static uint32_t add_object(struct builder *b, uint32_t node, const char *name)
{
    char *other = NULL;
    uint32_t object;

    if (*name == '\0' || name_table_find(&b->objects, name) != NO_NAME) {
        other = format_text("%s#%" PRIu32, *name != '\0' ? name : "node", node);
        if (other == NULL)
            return NO_NAME;
        name = other;
    }
    object = name_table_add(&b->objects, name);
    free(other);
    return object;
}

static bool add_instances(struct builder *b, uint32_t node,
                          const struct gltf_value *value,
                          const struct made *made, uint32_t object)
{
    static const struct affine identity = {
        {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    const struct gltf_node *n = &b->nodes->items[node];
    const struct affine *matrix =
        made->skin != NO_INDEX ? &identity : &n->world;

    for (uint32_t i = 0; i < made->count; i++)
        if (!gltf_instances_add(value, b->scene, made->first + i, matrix,
                                object, b->err))
            return false;
    return true;
}

static bool add_node(struct builder *b, uint32_t node)
{
    const struct gltf_node *n = &b->nodes->items[node];
    struct made *shared = &b->made[n->mesh], own = {NO_INDEX, 0, n->skin};
    struct gltf_value value, mesh;
    char cut[GLTF_NAME_BYTES];
    const char *name;
    bool has_weights;
    uint32_t object;

    if (!gltf_entry(b->document, "nodes", node, &value, b->err) ||
        !gltf_entry(b->document, "meshes", n->mesh, &mesh, b->err) ||
        !gltf_node_name(&value, &mesh, cut, &name, b->err))
        return false;
    object = add_object(b, node, name);
    if (object == NO_NAME)
        return out_of_memory(b);
    has_weights = json_object_get(value.json, "weights") != NULL;
    if (has_weights || n->weights != NULL) {
        if (!make(b, node, &mesh, &value, &own))
            return false;
        shared = &own;
    } else if (shared->first == NO_INDEX || shared->skin != n->skin) {
        shared->skin = n->skin;
        if (!make(b, node, &mesh, &mesh, shared))
            return false;
    }
    return add_instances(b, node, &value, shared, object);
}

static void take_names(struct builder *b)
{
    struct scene *s = b->scene;

    free(s->object_names[0]);
    free(s->object_names);
    s->object_names = b->objects.items;
    s->object_count = b->objects.count;
    b->objects.items = NULL; /* the scene owns it now */
    b->objects.count = 0;
}

static bool begin(struct builder *b)
{
    size_t count = gltf_entry_count(b->document, "meshes");

    b->variant = NO_INDEX;
    if (b->scene->choice.variant != NULL &&
        !gltf_find(b->document, "variants", "variant of materials",
                   b->scene->choice.variant, &b->variant, b->err))
        return false;
    b->made = alloc_array(count, sizeof *b->made);
    if (b->made == NULL || name_table_add(&b->objects, "") == NO_NAME)
        return out_of_memory(b);
    for (size_t i = 0; i < count; i++)
        b->made[i].first = NO_INDEX;
    return true;
}

bool gltf_meshes_add(const struct gltf_document *document,
                     const struct gltf_nodes *nodes, struct scene *scene,
                     struct warnings *report, struct error *err)
{
    struct builder b = {.document = document,
                        .nodes = nodes,
                        .scene = scene,
                        .report = report,
                        .err = err};
    bool ok = begin(&b);

    /* the counts of triangles are not known yet: those of bytes are */
    b.pool = scene_pool(scene, document->buffer_bytes < NO_INDEX
                                   ? (uint32_t)(document->buffer_bytes / 32)
                                   : NO_INDEX);
    for (uint32_t i = 0; ok && i < nodes->visible_count; i++)
        if (nodes->items[nodes->visible[i]].mesh != NO_INDEX)
            ok = add_node(&b, nodes->visible[i]);
    if (b.objects.count > 0)
        take_names(&b);
    pool_destroy(b.pool);
    name_table_free(&b.objects);
    free(b.made);
    return ok;
}
