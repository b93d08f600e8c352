// SPDX-License-Identifier: MIT
/*
 * cl_film.h - a picture on an OpenCL device, and its way to the host's film
 *
 * The memory of a device that is a CPU is the host's own: its points are stored
 * as they come. Others' rows are read into a reading, and stored from there.
 *
 * Units:     pixels, bytes
 * Ownership: cl_film_free() and cl_reading_free() release; zeroed structs have
 *            nothing. The host's film is borrowed
 * Threads:   one at a time
 * Errors:    too little memory, here or there
 */
#ifndef GLIM_CL_FILM_H
#define GLIM_CL_FILM_H

#include "picture/film.h"
#include "opencl/cl_machine.h"
#include "kernels/cl_task.h"

struct cl_film {
    struct film *film; /* the host's */
    cl_mem sums, counts;
    struct sum *host_sums; /* a CPU device: the memory of these buffers; */
    uint64_t *host_counts; /* others: NULL */
    size_t pixel_capacity;
    uint32_t reading_rows; /* that a reading has room for */
};

/* Rows of a pass's grid that are on their way to the host. */
struct cl_reading {
    uint32_t first, count;
    struct sum *sums; /* of whole rows of the film */
    uint64_t *counts;
};

/* Makes room for a picture of the film's size. What is in it is not defined. */
bool cl_film_begin(struct cl_film *f, const struct cl_machine *m,
                   struct film *film, struct error *err);
void cl_film_free(struct cl_film *f, const struct cl_machine *m);

/* Has the host the device's picture without reading? */
static inline bool cl_film_is_shared(const struct cl_film *f)
{
    return f->host_sums != NULL;
}

/* Stores the points of a task that is done, where memory is shared. Nothing
 * writes to them before the next pass. */
void cl_film_store_points(struct cl_film *f, const struct task *t);

/* Makes room for f->reading_rows rows, if any are to be read. */
bool cl_reading_begin(struct cl_reading *r, const struct cl_film *f,
                      struct error *err);
void cl_reading_free(struct cl_reading *r);

/* Puts the reading of r->count rows of a grid from r->first on, so many rows of
 * the film apart, into the queue. */
bool cl_reading_enqueue(struct cl_reading *r, const struct cl_film *f,
                        const struct cl_machine *m, uint32_t stride,
                        struct error *err);

/* Stores what has been read, and empties the reading. */
void cl_reading_store(struct cl_reading *r, struct cl_film *f, uint32_t stride);

#endif
