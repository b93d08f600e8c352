// SPDX-License-Identifier: MIT
#include "render/opencl/cl_start.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/background.h"
#include "base/memory.h"
#include "render/opencl/cl_probe.h"

struct cl_start {
    struct cl_request request;
    struct backend *old; /* backend that gets new kernels; NULL: create one */
    struct background starting;
    atomic_bool is_unwanted;
    /* valid when the thread has ended */
    struct backend *backend;
    char *verdict;
    char *log;
    struct error error;
};

/* Moves the texts of the probe to the caller's results. */
static void keep_texts(struct cl_start *s, struct cl_probe *probe)
{
    free(s->verdict);
    free(s->log);
    s->verdict = probe->verdict;
    s->log = probe->log;
    probe->verdict = NULL;
    probe->log = NULL;
}

static bool try_copy(struct cl_start *s, struct cl_probe *probe)
{
    bool ok = cl_probe_run(probe, &s->request, &s->is_unwanted, &s->error);

    keep_texts(s, probe);
    return ok;
}

static bool create(struct cl_start *s)
{
    char *log;

    if (s->old == NULL)
        s->backend = backend_cl_create(&s->request, &log, &s->error);
    else if (backend_cl_specialise(s->old, s->request.features, &log,
                                   &s->error))
        s->backend = s->old;
    if (log != NULL) {
        free(s->log);
        s->log = log;
    }
    return s->backend != NULL;
}

/* Returns true if the device still has the driver that was tested. */
static bool is_tried(const struct cl_start *s, const struct cl_probe *probe)
{
    char *device = cl_probe_device(s->backend);
    bool ok = device != NULL && strcmp(device, probe->device) == 0;

    free(device);
    return ok;
}

static void drop_backend(struct cl_start *s)
{
    if (s->backend != NULL && s->backend != s->old)
        s->backend->destroy(s->backend);
    s->backend = NULL;
}

static void bring_up(void *context)
{
    struct cl_start *s = context;
    struct cl_probe probe = {0};
    bool is_known = cl_probe_recall(&probe, &s->request);

    if (is_known)
        keep_texts(s, &probe);
    if ((is_known || try_copy(s, &probe)) && create(s) && is_known &&
        !is_tried(s, &probe)) {
        cl_probe_free(&probe);
        if (!try_copy(s, &probe))
            drop_backend(s);
    }
    cl_probe_free(&probe);
}

struct cl_start *cl_start_begin(const struct cl_request *request,
                                struct backend *backend, struct error *err)
{
    struct cl_start *s = alloc_array(1, sizeof *s);

    if (s == NULL) {
        fail(err, "OpenCL: out of memory");
        return NULL;
    }
    s->request = *request;
    s->old = backend;
    if (!background_init(&s->starting, "OpenCL", err)) {
        free(s);
        return NULL;
    }
    if (!background_begin(&s->starting, bring_up, s, "OpenCL", err)) {
        background_free(&s->starting);
        free(s);
        return NULL;
    }
    return s;
}

int cl_start_event_fd(const struct cl_start *s)
{
    return s->starting.event_fd;
}

/* Collects the result after the thread has ended. */
static struct backend *finish(struct cl_start *s, char **verdict, char **log,
                              struct error *err)
{
    struct backend *backend = s->backend;

    *verdict = s->verdict;
    *log = s->log;
    if (backend == NULL)
        *err = s->error;
    background_free(&s->starting);
    free(s);
    return backend;
}

struct backend *cl_start_end(struct cl_start *s, char **verdict, char **log,
                             struct error *err)
{
    background_finish(&s->starting);
    return finish(s, verdict, log, err);
}

void cl_start_abandon(struct cl_start *s)
{
    struct error ignored;
    char *verdict, *log;

    atomic_store(&s->is_unwanted, true);
    background_finish(&s->starting);
    drop_backend(s);
    finish(s, &verdict, &log, &ignored);
    free(verdict);
    free(log);
}
