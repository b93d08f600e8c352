// SPDX-License-Identifier: MIT
/*
 * backend.h - the interface of backends: devices that render samples of a world
 *
 * Units:     samples per pixel
 * Ownership: destroy() frees the backend
 * Threads:   one thread at a time; cancel_request() from any thread
 * Errors:    load(), begin() and pass() set *err
 */
#ifndef GLIM_BACKEND_H
#define GLIM_BACKEND_H

#include "base/thread_pool.h"
#include "film/film.h"
#include "render/cpu_kernel.h"
#include "world/world.h"
#include "kernels/sample_share.h"

enum pass_result { PASS_DONE, PASS_CANCELLED, PASS_FAILED };

/* Most samples of a pixel in a pass. */
#define PASS_SAMPLES_MAX 256

/* Most samples in the mean, with which pixels of any share have that many. */
#define PASS_MEAN_MAX (PASS_SAMPLES_MAX * SHARE_ONE / SHARE_MAX)

/* Light that the samples of a pass share: light_block.h. */
struct pass_light {
    /* for all samples: 3 numbers for each pixel of the film for samples with
     * even indices, then for those with odd ones */
    const float *pixels;
    size_t pixel_count;             /* of the film; 0: no such light */
    const struct light_grid *grids; /* world.light_grids; NULL: none */
    const struct light_cell *cells;
    size_t cell_count;
    uint64_t version; /* equal ones have the same numbers */
};

/* One pass over the pixels of a grid (0, stride, 2 stride, ... in both
 * directions). Pixels with fewer samples than their target get up to that
 * many. */
struct pass {
    int stride;
    uint64_t target; /* of each pixel, or the mean of all */
    /* shares of all pixels in the samples: kernels/sample_share.h; or NULL */
    const uint16_t *shares;
    /* greatest number that a pixel needs; up to PASS_SAMPLES_MAX, unless the
     * backend wants longer passes */
    uint32_t samples;
    uint32_t order;                 /* seed for the random order of blocks */
    const struct pass_light *light; /* NULL: none */
};

/* Returns the samples of pixel `at` of the film after a pass. */
static inline uint64_t pass_target(const struct pass *pass, size_t at)
{
    return pass->shares != NULL ? share_samples(pass->shares[at], pass->target)
                                : pass->target;
}

/* Work of one process of a cluster on the picture of begin(). */
struct rank_progress {
    uint64_t samples;   /* of all pixels together, in the film */
    uint64_t answers;   /* parts of passes that it has rendered */
    uint64_t busy_ns;   /* time in which it rendered them */
    uint64_t silent_ns; /* time since it has been expected to answer; 0: idle */
};

/* Returns a pass with this target and this mean number of samples. */
static inline struct pass pass_with(struct pass pass, uint64_t target,
                                    uint64_t mean)
{
    pass.target = target;
    if (pass.shares != NULL)
        mean = (mean * SHARE_MAX + SHARE_ONE - 1) / SHARE_ONE;
    pass.samples = (uint32_t)mean;
    return pass;
}

/* Returns the mean number of samples of a pass. */
static inline uint64_t pass_mean(const struct pass *pass)
{
    return pass->shares != NULL
               ? (uint64_t)pass->samples * SHARE_ONE / SHARE_MAX
               : pass->samples;
}

/* A picture that a backend renders. Its film has the corner (x0, y0) in the
 * whole picture; it is empty or comes from a file: pixels without samples have
 * sums of 0. `world` is lent from the host. */
struct backend_picture {
    const struct host_world *host;
    const struct world *world;
    struct film *film;
    int x0, y0;
    bool goes_on; /* the picture of the last begin(), in another world */
};

struct backend {
    const char *name;   /* "cpu", "opencl" */
    const char *device; /* name of the device and */
    const char *driver; /* version of its driver, or NULL */
    int thread_count;
    struct pool *pool; /* of the host, idle between passes; NULL: none */
    /* samples that a pass should have at least, since its end takes time; 0:
     * those of the plan */
    uint32_t pass_least;
    bool takes_light;    /* passes may have light */
    uint64_t tree_bytes; /* size of the host's tree, loaded */
    /* version of the loaded WORLD_SHAPE; 0 if none is loaded */
    uint64_t shape;
    uint64_t upload_count; /* arrays uploaded so far; 0 for the CPU */
    int rank_count;        /* processes that render; 0: this one alone */

    /* Prepares a new shape for ray queries. Builds the host's tree if nobody
     * has yet, and lends it to `world`, which is lent from the host, as in
     * begin(). */
    bool (*load)(struct backend *b, struct host_world *host,
                 struct world *world, struct error *err);

    /* Frees everything that load() built, except the host's tree. Called when
     * another backend takes over. */
    void (*unload)(struct backend *b);

    /* Begins a new picture, whose world may differ from that of load() in
     * everything except its shape. Host, arrays and film must live until the
     * last pass(). */
    bool (*begin)(struct backend *b, const struct backend_picture *picture,
                  struct error *err);

    /* Renders into the film of begin(). All samples are in the film at the
     * return. */
    enum pass_result (*pass)(struct backend *b, const struct pass *pass,
                             const struct cancel *cancel, struct error *err);

    /* Returns the processor time of a thread so far, in nanoseconds. Callable
     * from any thread. NULL if the threads are a device's. */
    uint64_t (*cpu_ns)(const struct backend *b, int thread);

    /* Returns the progress of a rank, which is below rank_count. Callable from
     * any thread. */
    struct rank_progress (*rank_progress)(const struct backend *b, int rank);

    void (*destroy)(struct backend *b);
};

/* Creates the CPU backend with the kernel of one instruction set. Returns NULL
 * on errors. */
struct backend *backend_cpu_create(int thread_count,
                                   const struct cpu_kernel *paths,
                                   struct error *err);

#endif
