// SPDX-License-Identifier: MIT
/*
 * backend.h - what can turn a world into samples
 *
 * Units:     samples a pixel
 * Ownership: destroy() frees the backend
 * Threads:   one thread at a time calls these; cancel_request() from any
 * Errors:    load() and pass() say why
 */
#ifndef GLIM_BACKEND_H
#define GLIM_BACKEND_H

#include "base/thread_pool.h"
#include "picture/film.h"
#include "scene/world.h"
#include "render/cpu_kernel.h"

enum pass_result { PASS_DONE, PASS_CANCELLED, PASS_FAILED };

/* One pass: every pixel of the grid (0, stride, 2 stride, ...) in both
 * directions that has fewer than `target` samples gets up to that many. */
struct pass {
    int stride;
    uint64_t target;
    uint32_t samples; /* that a pixel lacks, at most; up to SAMPLE_BLOCK */
    uint32_t order;   /* shuffles the blocks */
};

struct backend {
    const char *name;   /* "cpu", "opencl" */
    const char *device; /* its name and that of its driver's version, */
    const char *driver; /* or NULL */
    int thread_count;
    uint64_t tree_bytes;   /* of what load() built, or found */
    uint64_t shape;        /* version of the one that is loaded; 0: none */
    uint64_t upload_count; /* of arrays, so far; 0 for the CPU */

    /* A new shape: builds what the ray queries need. For backends that have no
     * tree of their own this is the host's, which others may have built before.
     * `world` is lent from the host, as in begin(). */
    bool (*load)(struct backend *b, struct host_world *host,
                 const struct world *world, struct error *err);

    /* Frees what load() built but the host's tree: another backend renders. */
    void (*unload)(struct backend *b);

    /* A new picture: the film is empty, its corner is pixel (x0, y0) of the
     * whole. The world may differ from load()'s in all but its shape; host,
     * arrays and film must stay until the last pass(). */
    bool (*begin)(struct backend *b, const struct host_world *host,
                  const struct world *world, struct film *film, int x0, int y0,
                  struct error *err);

    /* Renders into the film of begin(), which has it all at the end. */
    enum pass_result (*pass)(struct backend *b, const struct pass *pass,
                             const struct cancel *cancel, struct error *err);

    /* Processor time of a thread so far, in nanoseconds; from any thread. NULL:
     * the threads are a device's. */
    uint64_t (*cpu_ns)(const struct backend *b, int thread);

    void (*destroy)(struct backend *b);
};

struct backend *backend_cpu_create(int thread_count,
                                   const struct cpu_kernel *paths,
                                   struct error *err);

#endif
