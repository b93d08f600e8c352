// SPDX-License-Identifier: MIT
#include "engine/backends.h"

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

void backends_drop_cpu(struct backends *b)
{
    if (b->cpu != NULL)
        b->cpu->destroy(b->cpu);
    b->cpu = NULL;
}

bool backends_open(struct backends *b, const struct cpu_kernel *kernel,
                   int thread_count, struct error *err)
{
    b->cpu =
        backend_cpu_create(thread_count,
                           kernel != NULL ? kernel : cpu_kernel_best(), err);
    if (b->cpu != NULL && share_out(&b->cpu, err))
        return true;
    backends_drop_cpu(b);
    return false;
}

bool backends_begin_device(struct backends *b, const struct cl_request *request,
                           struct error *err)
{
    b->features = request->features;
    b->start = cl_start_begin(request, b->raw_device, err);
    return b->start != NULL;
}

bool backends_end_device(struct backends *b, char **log, struct error *err)
{
    free(b->verdict);
    b->raw_device = cl_start_end(b->start, &b->verdict, log, err);
    b->start = NULL;
    b->device = b->raw_device;
    return b->device != NULL && share_out(&b->device, err);
}

void backends_specialise(struct backends *b, const struct cl_request *request)
{
    struct error ignored;

    if (b->device != NULL && b->start == NULL &&
        b->features != request->features)
        backends_begin_device(b, request, &ignored);
}

bool backends_end_specialising(struct backends *b)
{
    struct error ignored;
    char *verdict, *log;

    if (b->device == NULL)
        return false;
    cl_start_end(b->start, &verdict, &log, &ignored);
    b->start = NULL;
    free(verdict);
    free(log);
    return true;
}

void backends_abandon_device(struct backends *b)
{
    if (b->start != NULL)
        cl_start_abandon(b->start);
    b->start = NULL;
}

void backends_drop_device(struct backends *b)
{
    backends_abandon_device(b);
    if (b->device != NULL)
        b->device->destroy(b->device);
    b->device = b->raw_device = NULL;
    free(b->verdict);
    b->verdict = NULL;
}

void backends_close(struct backends *b)
{
    backends_drop_device(b);
    backends_drop_cpu(b);
}
