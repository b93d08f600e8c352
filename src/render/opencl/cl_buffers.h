// SPDX-License-Identifier: MIT
/*
 * cl_buffers.h - the arrays of a world and of a film on an OpenCL device, and
 * transfers to the host's film
 *
 * A CPU device shares the host's memory, and pixels are stored from there
 * directly. For other devices rows are read into a struct cl_readback first.
 *
 * Units:     pixels, bytes
 * Ownership: cl_world_free(), cl_film_free() and cl_readback_free() release;
 *            zeroed structs are empty. A device that is a CPU reads the host's
 *            arrays in place; the host's film is borrowed
 * Threads:   one at a time
 * Errors:    too little memory, on the host or the device; an array that is
 *            larger than the device allows
 */
#ifndef GLIM_CL_BUFFERS_H
#define GLIM_CL_BUFFERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "film/film.h"
#include "render/backend.h"
#include "render/opencl/cl_device.h"
#include "kernels/cl_task.h"

/* ---- world ---- */

/* Buffers in the order of the arguments of trace_paths(): the settings, and the
 * arrays of world_list.h. */
#define CL_SETTINGS     0
#define CL_ARRAYS       1
#define CL_BUFFER_COUNT (CL_ARRAYS + WORLD_LIST_COUNT)

struct cl_world {
    cl_mem buffers[CL_BUFFER_COUNT];
    uint64_t versions[WORLD_LIST_COUNT]; /* of the arrays in the buffers */
};

/* Uploads the settings, and the arrays whose version differs from the buffer's.
 * Adds their number to *upload_count. The host has its tree. */
bool cl_world_update(struct cl_world *c, const struct cl_machine *m,
                     const struct backend_picture *picture,
                     uint64_t *upload_count, struct error *err);

/* Uploads the light cells of a pass. */
bool cl_world_set_cells(struct cl_world *c, const struct cl_machine *m,
                        const struct pass_light *light, struct error *err);

void cl_world_free(struct cl_world *c, const struct cl_machine *m);

/* ---- film ---- */

struct cl_film {
    struct film *film; /* the host's film */
    cl_mem sums, odd_sums, counts;
    cl_mem surfaces; /* NULL if the film has none */
    /* memory of these buffers on a CPU device, else NULL */
    struct sum *host_sums, *host_odd_sums;
    struct surface_sums *host_surfaces;
    uint64_t *host_counts;
    size_t pixel_capacity;
    uint32_t readback_rows; /* rows that a reading can hold */
};

/* Transfer of rows of a pass's grid to the host. */
struct cl_readback {
    uint32_t first, count;
    struct sum *sums, *odd_sums; /* whole rows of the film */
    struct surface_sums *surfaces;
    uint64_t *counts;
};

/* Allocates buffers of the film's size. Their contents are undefined. */
bool cl_film_begin(struct cl_film *f, const struct cl_machine *m,
                   struct film *film, struct error *err);

/* Writes the samples of the host's film to the buffers. */
bool cl_film_upload(const struct cl_film *f, const struct cl_machine *m,
                    struct error *err);
void cl_film_free(struct cl_film *f, const struct cl_machine *m);

/* Returns true if the host can access the device's buffers directly. */
static inline bool cl_film_is_shared(const struct cl_film *f)
{
    return f->host_sums != NULL;
}

/* Stores the pixels of a finished task from shared memory. The device does not
 * write to them before the next pass. */
void cl_film_store_points(struct cl_film *f, const struct task *t);

/* Allocates room for f->readback_rows rows unless memory is shared. */
bool cl_readback_begin(struct cl_readback *r, const struct cl_film *f,
                       struct error *err);
void cl_readback_free(struct cl_readback *r);

/* Enqueues the transfer of r->count rows of a grid from r->first on; `stride`
 * is the distance of grid rows in rows of the film. *done is signalled at its
 * end; NULL: none. */
bool cl_readback_enqueue(struct cl_readback *r, const struct cl_film *f,
                         const struct cl_machine *m, uint32_t stride,
                         cl_event *done, struct error *err);

/* Stores the rows that were read and empties the reading. */
void cl_readback_store(struct cl_readback *r, struct cl_film *f,
                       uint32_t stride);

#endif
