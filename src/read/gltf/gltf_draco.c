// SPDX-License-Identifier: MIT
#include "read/gltf/gltf_draco.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "base/library_child.h"
#include "base/memory.h"
#include "base/text_stream.h"
#include "read/gltf/gltf_accessor.h"
#include "kernels/types.h"

/* ---- packed primitives ---- */

/* Value of mode. */
enum { MODE_TRIANGLES = 4 };

/* Copies of packed bytes: in the requests, twice while these grow, as the input
 * of the child, and there. */
#define COPIES 4

/* ---- visits ---- */

/* Points and lines are not drawn. */
static bool has_faces(const struct gltf_value *primitive)
{
    const json_t *mode = json_object_get(primitive->json, "mode");

    return mode == NULL || json_integer_value(mode) >= MODE_TRIANGLES;
}

static bool visit_primitive(const struct gltf_value *v, gltf_packed_take *take,
                            void *context, struct error *err)
{
    struct gltf_packed p = {.primitive = v};

    if (!gltf_extension(v, GLTF_DRACO, &p.extension, err))
        return false;
    if (p.extension.json == NULL || !has_faces(v))
        return true;
    return gltf_object(v, "attributes", &p.attributes, err) &&
           gltf_object(&p.extension, "attributes", &p.ids, err) &&
           take(context, &p, err);
}

bool gltf_packed_visit(const struct gltf_document *document,
                       gltf_packed_take *take, void *context, struct error *err)
{
    struct gltf_value mesh, list, v;

    for (size_t i = 0; i < gltf_entry_count(document, "meshes"); i++) {
        if (!gltf_entry(document, "meshes", i, &mesh, err) ||
            !gltf_array(&mesh, "primitives", &list, err))
            return false;
        for (size_t k = 0; k < gltf_count(&list); k++)
            if (!gltf_item_object(&list, k, &v, err) ||
                !visit_primitive(&v, take, context, err))
                return false;
    }
    return true;
}

bool gltf_packed_wants(const struct gltf_packed *p, const char *name)
{
    return json_object_get(p->attributes.json, name) != NULL;
}

/* ---- the list ---- */

static bool out_of_memory(const struct gltf_value *v, struct error *err)
{
    return gltf_fail(v, err, "out of memory for its vertices");
}

static bool add_part(struct gltf_packed_list *list, uint32_t request,
                     uint32_t id)
{
    void *parts = list->parts;

    if (!grow_array(&parts, &list->part_capacity, list->part_count + 1,
                    sizeof *list->parts))
        return false;
    list->parts = parts;
    list->parts[list->part_count++] =
        (struct gltf_packed_part){.request = request, .id = id};
    return true;
}

/* Adds a request for the bytes of a view. */
static bool add_request(struct gltf_packed_list *list, uint32_t view)
{
    void *requests = list->requests;

    if (!grow_array(&requests, &list->request_capacity,
                    (size_t)list->request_count + 1, sizeof *list->requests))
        return false;
    list->requests = requests;
    list->requests[list->request_count] =
        (struct gltf_packed_request){.view = view};
    list->view_requests[view] = list->request_count++;
    return true;
}

/* Lists what the primitive wants of its view. */
static bool list_primitive(void *context, const struct gltf_packed *p,
                           struct error *err)
{
    struct gltf_packed_list *list = context;
    const char *name;
    json_t *unused;
    uint32_t view;

    if (!gltf_index(&p->extension, "bufferView", "bufferViews", &view, err))
        return false;
    if (view == NO_INDEX)
        return gltf_fail(&p->extension, err,
                         "found no bufferView, expected its number");
    if (list->view_requests[view] == NO_INDEX &&
        (!gltf_take(&p->extension,
                    p->extension.document->views[view].data.size_bytes, COPIES,
                    "bytes packed by Draco", err) ||
         (!add_request(list, view) && !out_of_memory(&p->extension, err))))
        return false;
    json_object_foreach (p->ids.json, name, unused) {
        uint64_t id = 0;

        if (!gltf_integer(&p->ids, name, UINT32_MAX, &id, err))
            return false;
        if (gltf_packed_wants(p, name) &&
            !add_part(list, list->view_requests[view], (uint32_t)id))
            return out_of_memory(&p->extension, err);
    }
    return true;
}

static int compare_parts(const void *a, const void *b)
{
    const struct gltf_packed_part *x = a, *y = b;

    if (x->request != y->request)
        return x->request < y->request ? -1 : 1;
    return x->id < y->id ? -1 : x->id > y->id;
}

/* Sorts the parts, leaves out those that are there twice, and gives them to
 * their requests. */
static void sort_parts(struct gltf_packed_list *list)
{
    size_t count = 0;

    if (list->part_count > 0)
        qsort(list->parts, list->part_count, sizeof *list->parts,
              compare_parts);
    for (size_t i = 0; i < list->part_count; i++) {
        struct gltf_packed_request *r = &list->requests[list->parts[i].request];

        if (count > 0 &&
            compare_parts(&list->parts[i], &list->parts[count - 1]) == 0)
            continue;
        if (r->part_count++ == 0)
            r->first_part = (uint32_t)count;
        list->parts[count++] = list->parts[i];
    }
    list->part_count = count;
}

bool gltf_packed_read(const struct gltf_document *document,
                      struct gltf_packed_list *list, struct error *err)
{
    size_t count = document->view_count;

    list->view_requests = alloc_array(count, sizeof *list->view_requests);
    if (list->view_requests == NULL)
        return fail(err, "%s: out of memory for its meshes", document->path);
    for (size_t i = 0; i < count; i++)
        list->view_requests[i] = NO_INDEX;
    if (!gltf_packed_visit(document, list_primitive, list, err))
        return false;
    sort_parts(list);
    return true;
}

struct gltf_packed_request *
gltf_packed_request_of(const struct gltf_packed_list *list,
                       const struct gltf_packed *p)
{
    const json_t *view = json_object_get(p->extension.json, "bufferView");

    return &list->requests[list->view_requests[(uint32_t)json_number_value(
        view)]];
}

const struct gltf_packed_part *
gltf_packed_find(const struct gltf_packed_list *list,
                 const struct gltf_packed_request *request, uint32_t id)
{
    const struct gltf_packed_part wanted = {
        .request = (uint32_t)(request - list->requests), .id = id};

    return bsearch(&wanted, list->parts, list->part_count, sizeof *list->parts,
                   compare_parts);
}

void gltf_packed_free(struct gltf_packed_list *list)
{
    free(list->view_requests);
    free(list->requests);
    free(list->parts);
    memset(list, 0, sizeof *list);
}

/* ---- unpacking ---- */

/* A smooth grid of a million triangles, 181 kB packed, takes the copy .16 s and
 * 80 MB. */
#define BYTES_A_SECOND   100000
#define MEMORY_OF_A_BYTE 2000

/* A walk through the answers to all requests. */
struct walk {
    struct gltf_document *document;
    struct gltf_packed_list list;
    uint32_t taken_count; /* requests whose answers were taken */
    const char *answers, *failure;
    size_t left_bytes;
    size_t view_capacity;
};

/* Writes all requests into memory, for free(). Returns false without
 * memory. */
static bool write_requests(const struct walk *walk, char **bytes,
                           size_t *size_bytes, struct error *err)
{
    struct text_stream s;
    bool ok = text_stream_open(&s);

    for (uint32_t i = 0; ok && i < walk->list.request_count; i++) {
        const struct gltf_packed_request *r = &walk->list.requests[i];
        const struct gltf_bytes *data = &walk->document->views[r->view].data;
        const struct draco_request head = {.size_bytes = data->size_bytes,
                                           .attribute_count = r->part_count};

        fwrite(&head, sizeof head, 1, s.to);
        for (uint32_t k = 0; k < r->part_count; k++)
            fwrite(&walk->list.parts[r->first_part + k].id, sizeof(uint32_t), 1,
                   s.to);
        fwrite(data->bytes, 1, data->size_bytes, s.to);
    }
    *bytes = text_stream_close(&s, size_bytes);
    return *bytes != NULL ||
           fail(err, "%s: out of memory for its meshes", walk->document->path);
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

/* A view with what was unpacked. */
struct unpacked {
    const struct draco_attribute *attribute;
    uint32_t view, count;
};

/* Appends an accessor of a view, and makes it the one that `object` has under
 * this key. The old one, if any, has its other members. */
static bool add_accessor(struct walk *walk, const struct gltf_value *object,
                         const char *key, struct unpacked u, struct error *err)
{
    const struct draco_attribute *a = u.attribute;
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
    made = json_pack("{sIsIsIsssbsO*}", "bufferView", (json_int_t)u.view,
                     "componentType", (json_int_t)a->component, "count",
                     (json_int_t)u.count, "type", types[a->component_count - 1],
                     "normalized",
                     json_is_true(json_object_get(old.json, "normalized")),
                     "sparse", sparse);
    return (json_array_append_new(list, made) == 0 &&
            json_object_set_new(object->json, key,
                                json_integer((json_int_t)json_array_size(list) -
                                             1)) == 0) ||
           out_of_memory(object, err);
}

/* Takes what was unpacked of an attribute. */
static bool take_part(struct walk *walk, const struct gltf_packed *p,
                      struct gltf_packed_part *part, uint32_t vertex_count,
                      struct error *err)
{
    struct draco_attribute *a = &part->attribute;
    const void *bytes = next(walk, &p->ids, sizeof *a, err);
    uint64_t size_bytes;

    if (bytes == NULL)
        return false;
    memcpy(a, bytes, sizeof *a);
    if (a->component_count < 1 || a->component_count > 4 ||
        gltf_component_bytes(a->component) == 0)
        return gltf_fail(&p->ids, err,
                         "found %" PRIu32 " numbers of type %" PRIu32
                         " in attribute %" PRIu32
                         ", expected what accessors have",
                         a->component_count, a->component, part->id);
    size_bytes = (uint64_t)vertex_count * a->component_count *
                 gltf_component_bytes(a->component);
    bytes = next(walk, &p->ids, (size_bytes + 3) / 4 * 4, err);
    part->view = (uint32_t)walk->document->view_count;
    return bytes != NULL &&
           (add_view(walk, bytes, size_bytes) || out_of_memory(&p->ids, err));
}

/* Takes the answer to a request. */
static bool take_answer(struct walk *walk, const struct gltf_packed *p,
                        struct gltf_packed_request *r, struct error *err)
{
    const void *bytes =
        next(walk, &p->extension, sizeof(struct draco_answer), err);
    struct draco_answer answer;
    uint64_t index_bytes;

    if (bytes == NULL)
        return false;
    memcpy(&answer, bytes, sizeof answer);
    answer.failure[sizeof answer.failure - 1] = '\0';
    if (answer.failure[0] != '\0')
        return gltf_fail(&p->extension, err, "libdraco: %s", answer.failure);
    r->vertex_count = answer.vertex_count;
    r->tri_count = answer.tri_count;
    for (uint32_t i = 0; i < r->part_count; i++)
        if (!take_part(walk, p, &walk->list.parts[r->first_part + i],
                       r->vertex_count, err))
            return false;
    index_bytes = (uint64_t)r->tri_count * 3 * sizeof(uint32_t);
    bytes = next(walk, &p->extension, index_bytes, err);
    if (bytes == NULL)
        return false;
    if (r->tri_count > NO_INDEX / 3)
        return gltf_fail(&p->extension, err,
                         "found %" PRIu32 " triangles, expected at most 2^32/3",
                         r->tri_count);
    r->index_view = (uint32_t)walk->document->view_count;
    return add_view(walk, bytes, index_bytes) ||
           out_of_memory(&p->extension, err);
}

/* Makes a plain primitive of a packed one. A strip becomes triangles. */
static bool take_primitive(struct walk *walk, const struct gltf_packed *p,
                           const struct gltf_packed_request *r,
                           struct error *err)
{
    static const struct draco_attribute index = {.component = GLTF_U32,
                                                 .component_count = 1};
    const char *name;
    json_t *id;

    json_object_foreach (p->ids.json, name, id) {
        const struct gltf_packed_part *part;

        if (!gltf_packed_wants(p, name))
            continue;
        part =
            gltf_packed_find(&walk->list, r, (uint32_t)json_number_value(id));
        if (!add_accessor(walk, &p->attributes, name,
                          (struct unpacked){&part->attribute, part->view,
                                            r->vertex_count},
                          err))
            return false;
    }
    return (json_object_set_new(p->primitive->json, "mode",
                                json_integer(MODE_TRIANGLES)) == 0 ||
            out_of_memory(&p->extension, err)) &&
           add_accessor(walk, p->primitive, "indices",
                        (struct unpacked){&index, r->index_view,
                                          3 * r->tri_count},
                        err);
}

/* Requests are answered in the order of the primitives that show them first. */
static bool take_packed(void *context, const struct gltf_packed *p,
                        struct error *err)
{
    struct walk *walk = context;
    struct gltf_packed_request *r = gltf_packed_request_of(&walk->list, p);

    if (r == &walk->list.requests[walk->taken_count]) {
        walk->taken_count++;
        if (!take_answer(walk, p, r, err))
            return false;
    }
    return take_primitive(walk, p, r, err);
}

/* Makes plain primitives of the answers. */
static bool take_all(struct walk *walk, const char *answers, size_t size_bytes,
                     const char *failure, struct error *err)
{
    walk->answers = answers;
    walk->left_bytes = size_bytes;
    walk->failure = failure;
    walk->view_capacity = walk->document->view_count;
    return gltf_packed_visit(walk->document, take_packed, walk, err);
}

bool gltf_draco_take(struct gltf_document *document, const char *answers,
                     size_t size_bytes, const char *failure, struct error *err)
{
    struct walk walk = {.document = document};
    bool ok = gltf_packed_read(document, &walk.list, err) &&
              take_all(&walk, answers, size_bytes, failure, err);

    gltf_packed_free(&walk.list);
    return ok;
}

/* ---- the document ---- */

/* Returns true if the primitive has positions of its own. */
static bool check_copy(void *unused, const struct gltf_packed *p,
                       struct error *err)
{
    struct gltf_value accessor;
    uint32_t number;

    (void)unused;
    if (!gltf_index(&p->attributes, "POSITION", "accessors", &number, err) ||
        (number != NO_INDEX && !gltf_entry(p->extension.document, "accessors",
                                           number, &accessor, err)))
        return false;
    return number == NO_INDEX ||
           json_object_get(accessor.json, "bufferView") != NULL ||
           gltf_fail(&p->extension, err,
                     "found a packed mesh, which needs " GLTF_DRACO_NEEDS);
}

/* Lets a copy of the program answer the requests. */
static bool unpack(struct walk *walk, const char *program, struct error *err)
{
    struct gltf_document *d = walk->document;
    struct library_task task = {
        .library = "libdraco",
        .program = program,
        .option = "--unpack",
        .bytes_a_second = BYTES_A_SECOND,
        .memory_of_a_byte = MEMORY_OF_A_BYTE,
        .memory_most =
            d->memory != NULL ? memory_budget_left(d->memory) : UINT64_MAX,
    };
    struct gltf_value root = gltf_root(d);
    struct child_result result = {.output = NULL};
    struct error own = {"found another end in what libdraco unpacked"};
    char *requests = NULL;
    bool ok = write_requests(walk, &requests, &task.size_bytes, err);

    if (ok) {
        task.input = requests;
        ok = library_child_run(&task, &result, &own);
        d->unpacked = result.output;
        /* the answers before a crash tell which mesh was its reason */
        ok = (ok || (result.output != NULL && WIFSIGNALED(result.status)))
                 ? gltf_take(&root, result.size_bytes, 1,
                             "bytes that Draco unpacked", err) &&
                       take_all(walk, result.output, result.size_bytes,
                                own.text, err)
                 : fail(err, "%s: %s", d->path, own.text);
    }
    free(requests);
    return ok;
}

bool gltf_draco_unpack(struct gltf_document *document, const char *program,
                       struct error *err)
{
    struct walk walk = {.document = document};
    bool ok;

    if (gltf_draco_missing() != NULL)
        return gltf_packed_visit(document, check_copy, NULL, err);
    ok = gltf_packed_read(document, &walk.list, err);
    if (ok && walk.list.request_count > 0)
        ok = program != NULL ? unpack(&walk, program, err)
                             : fail(err,
                                    "%s: found meshes of " GLTF_DRACO
                                    ", which only the program glim reads",
                                    document->path);
    gltf_packed_free(&walk.list);
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
