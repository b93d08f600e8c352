// SPDX-License-Identifier: MIT
#include "render/opencl/cl_buffers.h"

#include <stdlib.h>

#include "base/error.h"
#include "base/memory.h"

/* ---- world ---- */

static bool upload(cl_mem *buffer, const struct cl_machine *m, const void *data,
                   size_t size_bytes, bool shared, struct error *err)
{
    cl_machine_drop(m, buffer);
    *buffer = cl_machine_buffer(m, data, size_bytes, shared, err);
    return *buffer != NULL;
}

bool cl_world_update(struct cl_world *c, const struct cl_machine *m,
                     const struct backend_picture *p, uint64_t *upload_count,
                     struct error *err)
{
    const struct bvh8 *tree = world_tree(p->host);
    struct world_array list[WORLD_LIST_COUNT];

    world_list(p->world, list);
    list[WORLD_LIST_nodes].size_bytes = tree->size_bytes;
    list[WORLD_LIST_roots].size_bytes = tree->root_count * sizeof *tree->roots;
    if (!upload(&c->buffers[CL_SETTINGS], m, &p->world->settings,
                sizeof p->world->settings, false, err))
        return false;
    ++*upload_count;
    for (int i = 0; i < WORLD_LIST_COUNT; i++) {
        uint64_t version = p->host->versions[list[i].part];
        cl_mem *buffer = &c->buffers[CL_ARRAYS + i];

        if (*buffer != NULL && c->versions[i] == version)
            continue;
        if (!upload(buffer, m, list[i].data, list[i].size_bytes, true, err))
            return false;
        c->versions[i] = version;
        ++*upload_count;
    }
    return true;
}

bool cl_world_set_cells(struct cl_world *c, const struct cl_machine *m,
                        const struct pass_light *l, struct error *err)
{
    return upload(&c->buffers[CL_ARRAYS + WORLD_LIST_light_grids], m, l->grids,
                  CELL_GRIDS * sizeof *l->grids, false, err) &&
           upload(&c->buffers[CL_ARRAYS + WORLD_LIST_light_cells], m, l->cells,
                  l->cell_count * sizeof *l->cells, false, err);
}

void cl_world_free(struct cl_world *c, const struct cl_machine *m)
{
    for (int i = 0; i < CL_BUFFER_COUNT; i++)
        cl_machine_drop(m, &c->buffers[i]);
    *c = (struct cl_world){0};
}

/* ---- film ---- */

/* Size of a transfer. */
#define READ_BYTES (4u << 20)

#define PIXEL_SUMS_BYTES (3 * sizeof(struct sum))

/* ---- device buffers ---- */

void cl_film_free(struct cl_film *f, const struct cl_machine *m)
{
    cl_machine_drop(m, &f->sums);
    cl_machine_drop(m, &f->odd_sums);
    cl_machine_drop(m, &f->surfaces);
    cl_machine_drop(m, &f->counts);
    free(f->host_sums);
    free(f->host_odd_sums);
    free(f->host_surfaces);
    free(f->host_counts);
    f->host_sums = NULL;
    f->host_odd_sums = NULL;
    f->host_surfaces = NULL;
    f->host_counts = NULL;
    f->pixel_capacity = 0;
}

static bool make_film(struct cl_film *f, const struct cl_machine *m,
                      size_t pixel_count, struct error *err)
{
    cl_film_free(f, m);
    if (m->device->is_cpu) {
        f->host_sums = alloc_array(pixel_count, PIXEL_SUMS_BYTES);
        f->host_odd_sums = alloc_array(pixel_count, PIXEL_SUMS_BYTES);
        f->host_counts = alloc_array(pixel_count, sizeof *f->host_counts);
        if (f->host_sums == NULL || f->host_odd_sums == NULL ||
            f->host_counts == NULL)
            return fail(err, "out of memory for a picture of %zu pixels",
                        pixel_count);
    }
    f->sums = cl_machine_buffer(m, f->host_sums, pixel_count * PIXEL_SUMS_BYTES,
                                true, err);
    if (f->sums != NULL)
        f->odd_sums =
            cl_machine_buffer(m, f->host_odd_sums,
                              pixel_count * PIXEL_SUMS_BYTES, true, err);
    if (f->odd_sums != NULL)
        f->counts =
            cl_machine_buffer(m, f->host_counts, pixel_count * sizeof(uint64_t),
                              true, err);
    if (f->counts == NULL)
        return false;
    f->pixel_capacity = pixel_count;
    return true;
}

/* Allocates the surfaces if the film has some, and frees them otherwise. */
static bool make_surfaces(struct cl_film *f, const struct cl_machine *m,
                          const struct film *film, struct error *err)
{
    cl_machine_drop(m, &f->surfaces);
    free(f->host_surfaces);
    f->host_surfaces = NULL;
    if (film->surfaces == NULL)
        return true;
    if (m->device->is_cpu) {
        f->host_surfaces =
            alloc_array(f->pixel_capacity, sizeof *f->host_surfaces);
        if (f->host_surfaces == NULL)
            return fail(err, "out of memory for a picture of %zu pixels",
                        f->pixel_capacity);
    }
    f->surfaces =
        cl_machine_buffer(m, f->host_surfaces,
                          f->pixel_capacity * sizeof *f->host_surfaces, true,
                          err);
    return f->surfaces != NULL;
}

bool cl_film_begin(struct cl_film *f, const struct cl_machine *m,
                   struct film *film, struct error *err)
{
    size_t pixel_count = (size_t)film->width * (size_t)film->height;
    size_t row_bytes =
        (size_t)film->width * (2 * PIXEL_SUMS_BYTES + sizeof(uint64_t));

    if (film->surfaces != NULL)
        row_bytes += (size_t)film->width * sizeof *film->surfaces;
    if ((pixel_count > f->pixel_capacity &&
         !make_film(f, m, pixel_count, err)) ||
        !make_surfaces(f, m, film, err))
        return false;
    f->film = film;
    f->readback_rows = (uint32_t)(READ_BYTES / row_bytes) + 1;
    return true;
}

static bool write_buffer(const struct cl_machine *m, cl_mem buffer,
                         const void *from, size_t size_bytes, struct error *err)
{
    return cl_machine_check(m,
                            m->api->EnqueueWriteBuffer(m->queue, buffer,
                                                       CL_TRUE, 0, size_bytes,
                                                       from, 0, NULL, NULL),
                            "clEnqueueWriteBuffer", err);
}

bool cl_film_upload(const struct cl_film *f, const struct cl_machine *m,
                    struct error *err)
{
    const struct film *film = f->film;
    size_t pixels = (size_t)film->width * (size_t)film->height;

    return write_buffer(m, f->sums, film->sums, pixels * PIXEL_SUMS_BYTES,
                        err) &&
           write_buffer(m, f->odd_sums, film->odd_sums,
                        pixels * PIXEL_SUMS_BYTES, err) &&
           (f->surfaces == NULL ||
            write_buffer(m, f->surfaces, film->surfaces,
                         pixels * sizeof *film->surfaces, err)) &&
           write_buffer(m, f->counts, film->counts,
                        pixels * sizeof *film->counts, err);
}

/* Returns the address of an item of an array, or NULL if there is none. */
static const struct surface_sums *surfaces_at(const struct surface_sums *sums,
                                              size_t at)
{
    return sums != NULL ? sums + at : NULL;
}

void cl_film_store_points(struct cl_film *f, const struct task *t)
{
    uint32_t end = t->first + t->count;

    for (uint32_t point = t->first; point < end;) {
        uint32_t row = point / t->columns;
        uint32_t next_row = (row + 1) * t->columns;
        uint32_t row_end = end < next_row ? end : next_row;
        size_t at = (size_t)row * t->stride * t->width;

        film_store_row(
            f->film,
            (struct film_pixels){(int)(point % t->columns * t->stride),
                                 (int)(row * t->stride), (int)t->stride,
                                 (int)(row_end - point)},
            f->host_sums + 3 * at, f->host_odd_sums + 3 * at,
            surfaces_at(f->host_surfaces, at), f->host_counts + at);
        point = row_end;
    }
}

/* ---- transfers ---- */

bool cl_readback_begin(struct cl_readback *r, const struct cl_film *f,
                       struct error *err)
{
    size_t pixels = (size_t)f->film->width * f->readback_rows;

    if (cl_film_is_shared(f))
        return true;
    cl_readback_free(r);
    r->sums = alloc_array(pixels, PIXEL_SUMS_BYTES);
    r->odd_sums = alloc_array(pixels, PIXEL_SUMS_BYTES);
    if (f->surfaces != NULL)
        r->surfaces = alloc_array(pixels, sizeof *r->surfaces);
    r->counts = alloc_array(pixels, sizeof *r->counts);
    if (r->sums == NULL || r->odd_sums == NULL || r->counts == NULL ||
        (f->surfaces != NULL && r->surfaces == NULL))
        return fail(err, "out of memory for %u rows of the picture",
                    f->readback_rows);
    return true;
}

void cl_readback_free(struct cl_readback *r)
{
    free(r->sums);
    free(r->odd_sums);
    free(r->surfaces);
    free(r->counts);
    *r = (struct cl_readback){0};
}

/* Every stride-th row of a film's buffers. */
struct grid_rows {
    const struct cl_machine *machine;
    size_t width, first, count, stride;
};

/* Enqueues a read of rows of a device buffer. The last row is read by itself,
 * as NVIDIA's driver refuses a rectangle whose last row pitch ends beyond the
 * buffer. `done` may be NULL. */
static bool read_rows(const struct grid_rows *r, cl_mem buffer,
                      size_t pixel_bytes, void *to, cl_event *done,
                      struct error *err)
{
    const struct cl_machine *m = r->machine;
    size_t row_bytes = r->width * pixel_bytes;
    size_t last = r->count - 1;
    const size_t from[3] = {0, r->first, 0};
    const size_t origin[3] = {0, 0, 0};
    const size_t region[3] = {row_bytes, last, 1};

    return (last == 0 ||
            cl_machine_check(m,
                             m->api->EnqueueReadBufferRect(
                                 m->queue, buffer, CL_FALSE, from, origin,
                                 region, row_bytes * r->stride, 0, row_bytes, 0,
                                 to, 0, NULL, NULL),
                             "clEnqueueReadBufferRect", err)) &&
           cl_machine_check(m,
                            m->api->EnqueueReadBuffer(
                                m->queue, buffer, CL_FALSE,
                                (r->first + last) * r->stride * row_bytes,
                                row_bytes, (char *)to + last * row_bytes, 0,
                                NULL, done),
                            "clEnqueueReadBuffer", err);
}

bool cl_readback_enqueue(struct cl_readback *r, const struct cl_film *f,
                         const struct cl_machine *m, uint32_t stride,
                         cl_event *done, struct error *err)
{
    const struct grid_rows rows = {m, (size_t)f->film->width, r->first,
                                   r->count, stride};

    return read_rows(&rows, f->sums, PIXEL_SUMS_BYTES, r->sums, NULL, err) &&
           read_rows(&rows, f->odd_sums, PIXEL_SUMS_BYTES, r->odd_sums, NULL,
                     err) &&
           (f->surfaces == NULL ||
            read_rows(&rows, f->surfaces, sizeof *r->surfaces, r->surfaces,
                      NULL, err)) &&
           read_rows(&rows, f->counts, sizeof *r->counts, r->counts, done, err);
}

void cl_readback_store(struct cl_readback *r, struct cl_film *f,
                       uint32_t stride)
{
    size_t width = (size_t)f->film->width;

    for (uint32_t i = 0; i < r->count; i++)
        film_store_row(f->film,
                       (struct film_pixels){0, (int)((r->first + i) * stride),
                                            1, f->film->width},
                       r->sums + 3 * width * i, r->odd_sums + 3 * width * i,
                       surfaces_at(r->surfaces, width * i),
                       r->counts + width * i);
    r->count = 0;
}
