// SPDX-License-Identifier: MIT
#include "read/gltf/gltf_packed.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "kernels/types.h"

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
