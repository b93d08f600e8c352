// SPDX-License-Identifier: MIT
#include "read/gltf/gltf_primitive.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/print.h"
#include "read/gltf/gltf_vertices.h"

/* Values of mode. */
enum { MODE_TRIANGLES = 4, MODE_STRIP, MODE_FAN };

/* Triangles that a thread takes at once, and those whose indices it reads at
 * once. */
#define BLOCK_TRIS 16384u
#define CHUNK_TRIS 128u

/* ---- opening ---- */

/* Reads an attribute; *is_there is false if the primitive does not have it. */
static bool open_attribute(const struct gltf_value *attributes, const char *key,
                           struct gltf_accessor *a, bool *is_there,
                           struct error *err)
{
    uint32_t index;

    if (!gltf_index(attributes, key, "accessors", &index, err))
        return false;
    *is_there = index != NO_INDEX;
    return !*is_there ||
           gltf_accessor_open(attributes->document, index, a, err);
}

/* An attribute, and the numbers of components that it may have. */
struct attribute {
    const char *key;
    uint32_t least, most;
};

/* Checks the numbers of components and elements. */
static bool check_attribute(const struct gltf_value *attributes,
                            struct attribute kind,
                            const struct gltf_accessor *a, uint32_t count,
                            struct error *err)
{
    if (a->component_count < kind.least || a->component_count > kind.most)
        return gltf_fail(attributes, err,
                         "found %s of %" PRIu32
                         " components, expected %" PRIu32,
                         kind.key, a->component_count, kind.most);
    return a->count == count ||
           gltf_fail(attributes, err,
                     "found %" PRIu32 " element%s in %s, expected %" PRIu32
                     " as in POSITION",
                     a->count, print_plural(a->count), kind.key, count);
}

static bool open_optional(const struct gltf_value *attributes,
                          struct attribute kind, uint32_t count,
                          struct gltf_accessor *a, bool *is_there,
                          struct error *err)
{
    return open_attribute(attributes, kind.key, a, is_there, err) &&
           (!*is_there || check_attribute(attributes, kind, a, count, err));
}

static bool open_joints(const struct gltf_value *attributes,
                        struct gltf_primitive *p, struct error *err)
{
    static const char *const joints[] = {"JOINTS_0", "JOINTS_1"};
    static const char *const weights[] = {"WEIGHTS_0", "WEIGHTS_1"};

    for (uint32_t i = 0; i < GLTF_JOINT_SETS; i++) {
        bool has_joints, has_weights;

        if (!open_optional(attributes, (struct attribute){joints[i], 4, 4},
                           p->vertex_count, &p->joints[i], &has_joints, err) ||
            !open_optional(attributes, (struct attribute){weights[i], 4, 4},
                           p->vertex_count, &p->weights[i], &has_weights, err))
            return false;
        if (!has_joints || !has_weights)
            break;
        p->joint_set_count = i + 1;
    }
    return true;
}

static bool open_targets(const struct gltf_value *value,
                         const struct gltf_shape *shape,
                         struct gltf_primitive *p, struct error *err)
{
    struct gltf_value list, v;
    size_t count;

    if (!gltf_array(value, "targets", &list, err))
        return false;
    count = gltf_count(&list);
    count = count < shape->weight_count ? count : shape->weight_count;
    if (!gltf_take(value, count, sizeof *p->targets, "targets", err))
        return false;
    p->targets = alloc_array(count, sizeof *p->targets);
    if (p->targets == NULL)
        return gltf_fail(value, err, "out of memory for its targets");
    for (size_t i = 0; i < count; i++) {
        struct gltf_target *t = &p->targets[p->target_count];

        if (shape->weights[i] == 0)
            continue;
        t->weight = shape->weights[i];
        if (!gltf_item_object(&list, i, &v, err) ||
            !open_optional(&v, (struct attribute){"POSITION", 3, 3},
                           p->vertex_count, &t->positions, &t->has_positions,
                           err) ||
            !open_optional(&v, (struct attribute){"NORMAL", 3, 3},
                           p->vertex_count, &t->normals, &t->has_normals,
                           err) ||
            !open_optional(&v, (struct attribute){"TANGENT", 3, 3},
                           p->vertex_count, &t->tangents, &t->has_tangents,
                           err))
            return false;
        p->target_count++;
    }
    return true;
}

static bool open_indices(const struct gltf_value *value,
                         struct gltf_primitive *p, struct error *err)
{
    const struct gltf_accessor *a = &p->indices;
    uint32_t component;

    if (!open_attribute(value, "indices", &p->indices, &p->has_indices, err))
        return false;
    component = a->dense.component;
    return !p->has_indices ||
           (a->component_count == 1 &&
            (component == GLTF_U8 || component == GLTF_U16 ||
             component == GLTF_U32)) ||
           gltf_fail(value, err,
                     "found indices of %" PRIu32 " components of type %" PRIu32
                     ", expected SCALAR of 5121, 5123 or 5125",
                     a->component_count, component);
}

/* Returns true if the mapping of KHR_materials_variants lists the variant. */
static bool maps_variant(const struct gltf_value *mapping, uint32_t variant,
                         bool *does, struct error *err)
{
    struct gltf_value list;
    uint32_t number;

    if (!gltf_array(mapping, "variants", &list, err))
        return false;
    for (size_t i = 0; i < gltf_count(&list) && !*does; i++) {
        if (!gltf_item_index(&list, i, "variants", &number, err))
            return false;
        *does = number == variant;
    }
    return true;
}

/* Replaces the material by that of the variant, if the primitive has one. */
static bool read_variant(const struct gltf_value *value, uint32_t variant,
                         uint32_t *material, struct error *err)
{
    struct gltf_value extension, list, mapping;
    bool does = false;

    if (!gltf_extension(value, "KHR_materials_variants", &extension, err) ||
        !gltf_array(&extension, "mappings", &list, err))
        return false;
    for (size_t i = 0; i < gltf_count(&list) && !does; i++)
        if (!gltf_item_object(&list, i, &mapping, err) ||
            !maps_variant(&mapping, variant, &does, err))
            return false;
    return !does ||
           gltf_index(&mapping, "material", "materials", material, err);
}

static bool read_mode(const struct gltf_value *value, uint32_t variant,
                      struct gltf_primitive *p, struct error *err)
{
    uint64_t mode = MODE_TRIANGLES;

    if (!gltf_integer(value, "mode", MODE_FAN, &mode, err) ||
        !gltf_index(value, "material", "materials", &p->material, err) ||
        (variant != NO_INDEX &&
         !read_variant(value, variant, &p->material, err)))
        return false;
    /* the default material is behind the others */
    if (p->material == NO_INDEX)
        p->material = (uint32_t)gltf_entry_count(value->document, "materials");
    p->material++;
    p->mode = (uint32_t)mode;
    return true;
}

static bool open_attributes(const struct gltf_value *v,
                            struct gltf_primitive *p, struct error *err)
{
    uint32_t n = p->vertex_count;

    return check_attribute(v, (struct attribute){"POSITION", 3, 3},
                           &p->positions, n, err) &&
           open_optional(v, (struct attribute){"NORMAL", 3, 3}, n, &p->normals,
                         &p->has_normals, err) &&
           open_optional(v, (struct attribute){"TANGENT", 4, 4}, n,
                         &p->tangents, &p->has_tangents, err) &&
           open_optional(v, (struct attribute){"TEXCOORD_0", 2, 2}, n,
                         &p->uvs[0], &p->has_uv_set[0], err) &&
           open_optional(v, (struct attribute){"TEXCOORD_1", 2, 2}, n,
                         &p->uvs[1], &p->has_uv_set[1], err) &&
           open_optional(v, (struct attribute){"COLOR_0", 3, 4}, n, &p->colors,
                         &p->has_colors, err) &&
           open_joints(v, p, err);
}

bool gltf_primitive_open(const struct gltf_value *value,
                         const struct gltf_shape *shape,
                         struct gltf_primitive *p, struct warnings *report,
                         struct error *err)
{
    const char *path = value->document->path;
    struct gltf_value attributes;
    bool has_positions;
    uint32_t count;

    if (!read_mode(value, shape->variant, p, err) ||
        !gltf_object(value, "attributes", &attributes, err) ||
        !open_attribute(&attributes, "POSITION", &p->positions, &has_positions,
                        err))
        return false;
    if (p->mode < MODE_TRIANGLES || !has_positions) {
        warnings_add(report, "primitives without faces",
                     "%s: found a primitive of %s: not drawn", path,
                     has_positions ? "points or lines" : "no positions");
        return true;
    }
    p->vertex_count = p->positions.count;
    if (!open_attributes(&attributes, p, err) || !open_indices(value, p, err) ||
        !open_targets(value, shape, p, err))
        return false;
    p->has_uvs = p->has_uv_set[0] || p->has_uv_set[1];
    p->has_tangents = p->has_tangents && p->has_normals;
    p->has_alphas = p->has_colors && p->colors.component_count == 4;
    count = p->has_indices ? p->indices.count : p->vertex_count;
    if (p->mode == MODE_TRIANGLES && count % 3 != 0)
        warnings_add(report, "primitives with vertices left over",
                     "%s: found %" PRIu32 " vertices in a primitive, expected "
                     "three for each triangle: the last are ignored",
                     path, count);
    p->tri_count = p->mode == MODE_TRIANGLES ? count / 3
                   : count > 2               ? count - 2
                                             : 0;
    return true;
}

void gltf_primitive_free(struct gltf_primitive *p)
{
    free(p->targets);
    memset(p, 0, sizeof *p);
}

/* ---- triangles ---- */

struct job {
    const struct gltf_primitive *primitive;
    struct scene *scene;
    uint32_t first_position, first_normal, first_uv, first_tri;
    atomic_bool has_failed;
};

static uint32_t vertex_of(const struct gltf_primitive *p, uint32_t i)
{
    uint32_t v = i;

    if (p->has_indices)
        gltf_accessor_integers(&p->indices, i, 1, &v);
    return v;
}

/* Fills the three places of a triangle in the list of vertices. */
static void places_of(uint32_t mode, uint32_t i, uint32_t places[3])
{
    if (mode == MODE_TRIANGLES) {
        for (uint32_t k = 0; k < 3; k++)
            places[k] = 3 * i + k;
    } else if (mode == MODE_STRIP) {
        places[0] = i;
        places[1] = i + 1 + i % 2;
        places[2] = i + 2 - i % 2;
    } else {
        places[0] = i + 1;
        places[1] = i + 2;
        places[2] = 0;
    }
}

/* Consecutive triangles and the vertices at their places in the list. */
struct chunk {
    uint32_t first, count;
    uint32_t first_place, place_count;
    uint32_t vertices[3 * CHUNK_TRIS];
};

static void read_chunk(const struct gltf_primitive *p, struct chunk *c)
{
    bool is_list = p->mode == MODE_TRIANGLES;

    c->first_place = is_list ? 3 * c->first : c->first;
    c->place_count = is_list ? 3 * c->count : c->count + 2;
    if (p->has_indices)
        gltf_accessor_integers(&p->indices, c->first_place, c->place_count,
                               c->vertices);
    for (uint32_t i = 0; !p->has_indices && i < c->place_count; i++)
        c->vertices[i] = c->first_place + i;
}

/* The first place of a fan is in its first chunk only. */
static uint32_t chunk_vertex(const struct gltf_primitive *p,
                             const struct chunk *c, uint32_t place)
{
    uint32_t i = place - c->first_place;

    return i < c->place_count ? c->vertices[i] : vertex_of(p, place);
}

static bool has_normal(const struct scene *s, uint32_t n)
{
    return s->normals[n].x != 0 || s->normals[n].y != 0 || s->normals[n].z != 0;
}

/* Fills triangle i of the primitive. Returns false if an index is out of range.
 */
static bool fill_tri(const struct job *j, const struct chunk *c, uint32_t i,
                     struct tri *t)
{
    const struct gltf_primitive *p = j->primitive;
    uint32_t places[3], v[3];
    bool has_normals = p->has_normals;

    places_of(p->mode, i, places);
    for (int k = 0; k < 3; k++) {
        v[k] = chunk_vertex(p, c, places[k]);
        if (v[k] >= p->vertex_count)
            return false;
        has_normals =
            has_normals && has_normal(j->scene, j->first_normal + v[k]);
        t->v[k] = j->first_position + v[k];
        t->vt[k] = p->has_uvs ? j->first_uv + v[k] : NO_INDEX;
    }
    for (int k = 0; k < 3; k++)
        t->vn[k] = has_normals ? j->first_normal + v[k] : NO_INDEX;
    t->material = p->material;
    return true;
}

static void fill_chunk(struct job *j, const struct chunk *c)
{
    struct scene *s = j->scene;

    for (uint32_t i = c->first; i < c->first + c->count; i++) {
        uint32_t t = j->first_tri + i;

        if (!fill_tri(j, c, i, &s->tris[t]))
            atomic_store(&j->has_failed, true);
        s->tri_faces[t] = t;
        s->tri_objects[t] = 0;
    }
}

static void fill_block(void *context, uint32_t block, int worker)
{
    struct job *j = context;
    uint32_t begin = block * BLOCK_TRIS, count = j->primitive->tri_count;
    uint32_t end = count - begin < BLOCK_TRIS ? count : begin + BLOCK_TRIS;
    struct chunk c;

    (void)worker;
    for (c.first = begin; c.first < end; c.first += CHUNK_TRIS) {
        c.count = end - c.first < CHUNK_TRIS ? end - c.first : CHUNK_TRIS;
        read_chunk(j->primitive, &c);
        fill_chunk(j, &c);
    }
}

/* Names the first index out of range. */
static bool fail_index(const struct gltf_value *value,
                       const struct gltf_primitive *p, struct error *err)
{
    uint32_t i = 0;

    while (vertex_of(p, i) < p->vertex_count)
        i++;
    return gltf_fail(value, err,
                     "found vertex %" PRIu32 " at place %" PRIu32
                     " of the indices, expected one of %" PRIu32 " vertices",
                     vertex_of(p, i), i, p->vertex_count);
}

bool gltf_primitive_add(const struct gltf_value *value,
                        const struct gltf_primitive *p,
                        const struct gltf_shape *shape, struct scene *scene,
                        struct pool *pool, struct error *err)
{
    struct job job = {.primitive = p,
                      .scene = scene,
                      .first_position = scene->position_count,
                      .first_normal = scene->normal_count,
                      .first_uv = scene->uv_count,
                      .first_tri = scene->tri_count};

    if (!gltf_vertices_add(value, p, shape, scene, pool, err))
        return false;
    pool_each(pool, p->tri_count / BLOCK_TRIS + (p->tri_count % BLOCK_TRIS > 0),
              fill_block, &job);
    if (atomic_load(&job.has_failed))
        return fail_index(value, p, err);
    scene->tri_count += p->tri_count;
    return true;
}
