// SPDX-License-Identifier: MIT
#include "gltf/gltf_draco.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "base/library_child.h"
#include "base/memory.h"
#include "gltf/draco_stream.h"
#include "gltf/gltf_accessor.h"
#include "kernels/types.h"

/* Value of mode. */
enum { MODE_TRIANGLES = 4 };

/* A smooth grid of a million triangles, 181 kB packed, takes the copy .16 s and
 * 80 MB. */
#define BYTES_A_SECOND   100000
#define MEMORY_OF_A_BYTE 2000

/* A primitive that is packed. */
struct packed {
    const struct gltf_value *primitive;
    struct gltf_value attributes; /* of the primitive: numbers of accessors */
    struct gltf_value extension;
    struct gltf_value ids; /* of the extension: numbers of Draco's attributes */
};

struct walk;
typedef bool take_primitive(struct walk *walk, const struct packed *p,
                            struct error *err);

/* A walk through all packed primitives, in the order of the file. */
struct walk {
    struct gltf_document *document;
    take_primitive *take;
    FILE *requests;
    uint64_t count; /* of requests */
    const char *answers, *failure;
    size_t left_bytes;
    size_t view_capacity;
};

/* ---- walks ---- */

/* Points and lines are not drawn. */
static bool has_faces(const struct gltf_value *primitive)
{
    const json_t *mode = json_object_get(primitive->json, "mode");

    return mode == NULL || json_integer_value(mode) >= MODE_TRIANGLES;
}

static bool visit_primitive(struct walk *walk, const struct gltf_value *v,
                            struct error *err)
{
    struct packed p = {.primitive = v};

    if (!gltf_extension(v, GLTF_DRACO, &p.extension, err))
        return false;
    if (p.extension.json == NULL || !has_faces(v))
        return true;
    return gltf_object(v, "attributes", &p.attributes, err) &&
           gltf_object(&p.extension, "attributes", &p.ids, err) &&
           walk->take(walk, &p, err);
}

static bool visit_all(struct walk *walk, take_primitive *take,
                      struct error *err)
{
    const struct gltf_document *d = walk->document;
    struct gltf_value mesh, list, v;

    walk->take = take;
    for (size_t i = 0; i < gltf_entry_count(d, "meshes"); i++) {
        if (!gltf_entry(d, "meshes", i, &mesh, err) ||
            !gltf_array(&mesh, "primitives", &list, err))
            return false;
        for (size_t k = 0; k < gltf_count(&list); k++)
            if (!gltf_item_object(&list, k, &v, err) ||
                !visit_primitive(walk, &v, err))
                return false;
    }
    return true;
}

/* Returns true if the primitive has the attribute of this name, too. */
static bool is_wanted(const struct packed *p, const char *name)
{
    return json_object_get(p->attributes.json, name) != NULL;
}

/* ---- requests ---- */

static bool send_primitive(struct walk *walk, const struct packed *p,
                           struct error *err)
{
    struct draco_request request = {.attribute_count = 0};
    const struct gltf_bytes *data;
    const char *name;
    json_t *unused;
    uint32_t view;

    if (!gltf_index(&p->extension, "bufferView", "bufferViews", &view, err))
        return false;
    if (view == NO_INDEX)
        return gltf_fail(&p->extension, err,
                         "found no bufferView, expected its number");
    data = &walk->document->views[view].data;
    request.size_bytes = data->size_bytes;
    json_object_foreach (p->ids.json, name, unused) {
        request.attribute_count += is_wanted(p, name);
    }
    fwrite(&request, sizeof request, 1, walk->requests);
    json_object_foreach (p->ids.json, name, unused) {
        uint64_t id = 0;

        if (!gltf_integer(&p->ids, name, UINT32_MAX, &id, err))
            return false;
        if (is_wanted(p, name))
            fwrite(&(uint32_t){(uint32_t)id}, sizeof(uint32_t), 1,
                   walk->requests);
    }
    fwrite(data->bytes, 1, data->size_bytes, walk->requests);
    walk->count++;
    return true;
}

/* Writes all requests into memory, for free(). */
static bool make_requests(struct walk *walk, char **bytes, size_t *size_bytes,
                          struct error *err)
{
    bool ok, is_complete;

    walk->requests = open_memstream(bytes, size_bytes);
    if (walk->requests == NULL)
        return fail(err, "%s: out of memory for its meshes",
                    walk->document->path);
    ok = visit_all(walk, send_primitive, err);
    is_complete = !ferror(walk->requests);
    is_complete = fclose(walk->requests) == 0 && is_complete;
    return ok && (is_complete || fail(err, "%s: out of memory for its meshes",
                                      walk->document->path));
}

/* ---- answers ---- */

/* Returns the next bytes of the answers, or NULL and the reason of their
 * end. */
static const void *next(struct walk *walk, const struct gltf_value *place,
                        uint64_t size_bytes, struct error *err)
{
    const char *bytes = walk->answers;

    if (size_bytes > walk->left_bytes) {
        gltf_fail(place, err, "%s", walk->failure);
        return NULL;
    }
    walk->answers += size_bytes;
    walk->left_bytes -= size_bytes;
    return bytes;
}

static bool out_of_memory(const struct gltf_value *v, struct error *err)
{
    return gltf_fail(v, err, "out of memory for its vertices");
}

/* Appends a view of these bytes. */
static bool add_view(struct walk *walk, const void *bytes, size_t size_bytes)
{
    struct gltf_document *d = walk->document;
    void *views = d->views;

    if (!grow_array(&views, &walk->view_capacity, d->view_count + 1,
                    sizeof *d->views))
        return false;
    d->views = views;
    d->views[d->view_count++] =
        (struct gltf_view){.data = {bytes, size_bytes, NULL}};
    return json_array_append_new(json_object_get(d->root, "bufferViews"),
                                 json_object()) == 0;
}

/* Appends an accessor of the last view, and makes it the one that `object` has
 * under this key. The old one, if any, has its other members. */
static bool add_accessor(struct walk *walk, const struct gltf_value *object,
                         const char *key, const struct draco_attribute *a,
                         uint32_t count, struct error *err)
{
    static const char *const types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    const struct gltf_document *d = walk->document;
    json_t *list = json_object_get(d->root, "accessors");
    struct gltf_value old = {.json = NULL};
    const json_t *sparse;
    uint32_t number;
    json_t *made;

    if (!gltf_index(object, key, "accessors", &number, err) ||
        (number != NO_INDEX && !gltf_entry(d, "accessors", number, &old, err)))
        return false;
    sparse = json_object_get(old.json, "sparse");
    if (sparse != NULL &&
        json_integer_value(json_object_get(old.json, "componentType")) !=
            a->component)
        return gltf_fail(&old, err,
                         "found sparse values of another componentType than "
                         "%" PRIu32 ", which Draco's have",
                         a->component);
    made = json_pack("{sIsIsIsssbsO*}", "bufferView",
                     (json_int_t)(d->view_count - 1), "componentType",
                     (json_int_t)a->component, "count", (json_int_t)count,
                     "type", types[a->component_count - 1], "normalized",
                     a->is_normalized != 0 ||
                         json_is_true(json_object_get(old.json, "normalized")),
                     "sparse", sparse);
    return (json_array_append_new(list, made) == 0 &&
            json_object_set_new(object->json, key,
                                json_integer((json_int_t)json_array_size(list) -
                                             1)) == 0) ||
           out_of_memory(object, err);
}

static bool take_attribute(struct walk *walk, const struct packed *p,
                           const char *name, uint32_t vertex_count,
                           struct error *err)
{
    const void *bytes =
        next(walk, &p->ids, sizeof(struct draco_attribute), err);
    struct draco_attribute a;
    uint64_t size_bytes;

    if (bytes == NULL)
        return false;
    memcpy(&a, bytes, sizeof a);
    if (a.component_count < 1 || a.component_count > 4 ||
        gltf_component_bytes(a.component) == 0)
        return gltf_fail(&p->ids, err,
                         "found %" PRIu32 " numbers of type %" PRIu32
                         " in %s, expected what accessors have",
                         a.component_count, a.component, name);
    size_bytes = (uint64_t)vertex_count * a.component_count *
                 gltf_component_bytes(a.component);
    bytes = next(walk, &p->ids, (size_bytes + 3) / 4 * 4, err);
    return bytes != NULL &&
           (add_view(walk, bytes, size_bytes) || out_of_memory(&p->ids, err)) &&
           add_accessor(walk, &p->attributes, name, &a, vertex_count, err);
}

/* A strip comes back as triangles. */
static bool take_indices(struct walk *walk, const struct packed *p,
                         uint32_t tri_count, struct error *err)
{
    const struct draco_attribute index = {.component = GLTF_U32,
                                          .component_count = 1};
    uint64_t size_bytes = (uint64_t)tri_count * 3 * sizeof(uint32_t);
    const void *bytes = next(walk, &p->extension, size_bytes, err);

    if (bytes == NULL)
        return false;
    if (tri_count > NO_INDEX / 3)
        return gltf_fail(&p->extension, err,
                         "found %" PRIu32 " triangles, expected at most 2^32/3",
                         tri_count);
    if (!add_view(walk, bytes, size_bytes) ||
        json_object_set_new(p->primitive->json, "mode",
                            json_integer(MODE_TRIANGLES)) != 0)
        return out_of_memory(&p->extension, err);
    return add_accessor(walk, p->primitive, "indices", &index, 3 * tri_count,
                        err);
}

static bool take_answer(struct walk *walk, const struct packed *p,
                        struct error *err)
{
    const void *bytes =
        next(walk, &p->extension, sizeof(struct draco_answer), err);
    struct draco_answer answer;
    const char *name;
    json_t *unused;

    if (bytes == NULL)
        return false;
    memcpy(&answer, bytes, sizeof answer);
    answer.failure[sizeof answer.failure - 1] = '\0';
    if (answer.failure[0] != '\0')
        return gltf_fail(&p->extension, err, "libdraco: %s", answer.failure);
    json_object_foreach (p->ids.json, name, unused) {
        if (is_wanted(p, name) &&
            !take_attribute(walk, p, name, answer.vertex_count, err))
            return false;
    }
    return take_indices(walk, p, answer.tri_count, err);
}

bool gltf_draco_take(struct gltf_document *document, const char *answers,
                     size_t size_bytes, const char *failure, struct error *err)
{
    struct walk walk = {.document = document,
                        .answers = answers,
                        .failure = failure,
                        .left_bytes = size_bytes,
                        .view_capacity = document->view_count};

    return visit_all(&walk, take_answer, err);
}

/* ---- the document ---- */

/* Returns true if the primitive has positions of its own. */
static bool check_copy(struct walk *walk, const struct packed *p,
                       struct error *err)
{
    struct gltf_value accessor;
    uint32_t number;

    if (!gltf_index(&p->attributes, "POSITION", "accessors", &number, err) ||
        (number != NO_INDEX &&
         !gltf_entry(walk->document, "accessors", number, &accessor, err)))
        return false;
    return number == NO_INDEX ||
           json_object_get(accessor.json, "bufferView") != NULL ||
           gltf_fail(&p->extension, err,
                     "found a packed mesh, which needs " GLTF_DRACO_NEEDS);
}

bool gltf_draco_unpack(struct gltf_document *document, const char *program,
                       struct error *err)
{
    struct walk walk = {.document = document};
    struct library_task task = {
        .library = "libdraco",
        .program = program,
        .option = "--unpack",
        .bytes_a_second = BYTES_A_SECOND,
        .memory_of_a_byte = MEMORY_OF_A_BYTE,
    };
    struct child_result result = {.output = NULL};
    struct error own = {"found another end in what libdraco unpacked"};
    char *requests = NULL;
    bool ok;

    if (gltf_draco_missing() != NULL)
        return visit_all(&walk, check_copy, err);
    ok = make_requests(&walk, &requests, &task.size_bytes, err);
    if (ok && walk.count > 0 && program == NULL)
        ok = fail(err,
                  "%s: found meshes of " GLTF_DRACO
                  ", which only the program glim reads",
                  document->path);
    if (ok && walk.count > 0) {
        task.input = requests;
        ok = library_child_run(&task, &result, &own);
        document->unpacked = result.output;
        /* the answers before a crash tell which mesh was its reason */
        ok = (ok || (result.output != NULL && WIFSIGNALED(result.status)))
                 ? gltf_draco_take(document, result.output, result.size_bytes,
                                   own.text, err)
                 : fail(err, "%s: %s", document->path, own.text);
    }
    free(requests);
    return ok;
}

const char *gltf_draco_missing(void)
{
#ifdef HAS_DRACO
    return NULL;
#else
    return "Draco, which needs " GLTF_DRACO_NEEDS;
#endif
}
