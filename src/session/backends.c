// SPDX-License-Identifier: MIT
#include "session/backends.h"

#include <stdlib.h>

#include "render/cpu_dispatch.h"
#include "cluster/cluster.h"

/* Lets all ranks of a cluster render what this backend is given. A worker gets
 * its work from rank 0. */
static bool share_out(struct backend **b, struct error *err)
{
    struct backend *cluster;

    if (cluster_size() == 1 || cluster_rank() > 0)
        return true;
    cluster = cluster_backend_create(*b, err);
    if (cluster != NULL)
        *b = cluster;
    return cluster != NULL;
}

bool backends_open(struct backends *m, const struct options *options,
                   struct error *err)
{
    const struct cpu_kernel *paths =
        options->paths != NULL ? options->paths : cpu_kernel_best();

    *m = (struct backends){.options = options};
    m->cpu = backend_cpu_create(options_threads(options), paths, err);
    return m->cpu != NULL && share_out(&m->cpu, err);
}

/* A running device only gets new kernels. */
bool backends_begin_device(struct backends *m, uint32_t features,
                           struct error *err)
{
    const struct options *o = m->options;
    struct cl_request request = {
        .program = "/proc/self/exe",
        .device = o->device,
        .kernels_path = o->kernels_path,
        .needs_gpu = o->backend == BACKEND_AUTO,
        .features = features,
    };

    m->features = features;
    m->start = cl_start_begin(&request, m->raw_device, err);
    return m->start != NULL;
}

bool backends_end_device(struct backends *m, char **log, struct error *err)
{
    free(m->verdict);
    m->raw_device = cl_start_end(m->start, &m->verdict, log, err);
    m->start = NULL;
    m->device = m->raw_device;
    return m->device != NULL && share_out(&m->device, err);
}

void backends_specialise(struct backends *m, uint32_t features)
{
    struct error ignored;

    if (m->device != NULL && m->start == NULL && m->features != features)
        backends_begin_device(m, features, &ignored);
}

bool backends_end_specialising(struct backends *m)
{
    struct error ignored;
    char *verdict, *log;

    if (m->device == NULL)
        return false;
    cl_start_end(m->start, &verdict, &log, &ignored);
    m->start = NULL;
    free(verdict);
    free(log);
    return true;
}

void backends_abandon_device(struct backends *m)
{
    if (m->start != NULL)
        cl_start_abandon(m->start);
    m->start = NULL;
}

void backends_close(struct backends *m)
{
    backends_abandon_device(m);
    if (m->device != NULL)
        m->device->destroy(m->device);
    if (m->cpu != NULL)
        m->cpu->destroy(m->cpu);
    free(m->verdict);
    *m = (struct backends){0};
}
