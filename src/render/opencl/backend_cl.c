// SPDX-License-Identifier: MIT
/*
 * A pass is divided into tasks, each of some points of the grid. The device
 * makes the camera rays of a task, traces the paths and adds them to a film of
 * its own. Two tasks are in the queue, so that the device never waits for the
 * host. Complete rows are read back every READ_NS, and the rest at the end of a
 * pass. Only whole points are stored in the film of the host, so it is good
 * after a failure. The driver's calls have a thread, which is left alone with
 * all that it uses if the driver does not answer.
 */
#include "render/opencl/backend_cl.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/min_max.h"
#include "render/opencl/cl_buffers.h"
#include "render/opencl/cl_device.h"
#include "render/opencl/cl_source.h"
#include "kernels/camera.h"
#include "kernels/features.h"

struct cl_kernels {
    cl_program program;
    cl_kernel clear;
    cl_kernel generate;
    cl_kernel trace;
    cl_kernel add;
    uint64_t features;
};

#define TASK_PATHS_FIRST 8192
#define TASK_PATHS_MIN   512
#define TASK_PATHS_MAX   (1u << 20) /* limit of the counters in struct tally */
#define TASK_NS          6000000    /* time that one task should take */

/* Time between readbacks of finished rows. */
#define READ_NS 25000000

/* A task in the queue, with its buffers. */
struct slot {
    cl_mem starts;
    cl_mem samples;
    cl_mem surfaces; /* NULL if the film has none */
    cl_mem tally;
    uint32_t capacity; /* of starts and samples, in paths */
    struct task task;
    struct tally result;
    struct cl_readback reading;
    uint64_t begin_ns;
    cl_event done; /* NULL: the slot is free */
};

/* What the thread of the driver is asked for, and its answer. */
struct request {
    const struct cl_request *start;
    char *log; /* of a build that failed */
    struct backend_picture picture;
    struct pass pass;
    const struct cancel *cancel;
    enum pass_result result;
    struct error error;
};

struct backend_cl {
    struct backend base;
    struct cl_machine machine;
    struct cl_thread thread;
    struct request request;
    char *text;             /* source text of the kernels */
    struct cl_kernels full; /* with the features of the request */
    struct cl_kernels special;
    const struct cl_kernels *kernels; /* those of this picture */
    pthread_mutex_t lock;
    /* guarded by lock; replaces `special` at the next begin() */
    struct cl_kernels next;
    struct cl_world world;
    cl_mem cancel;
    cl_mem shares; /* of adaptive sampling; NULL: none yet in this picture */
    cl_mem light;  /* of light paths; NULL: none yet */
    uint64_t light_version;
    const struct cancel *cancel_source;

    struct cl_film film;
    uint32_t x0, y0; /* corner of the film in the picture */
    /* the last pass, and how many of its points have all their samples; a pass
     * that was cancelled continues there, as halts in quick succession would
     * end before it came so far again */
    uint64_t target;
    int stride;
    uint32_t complete_points;
    struct slot slots[2];
    uint32_t task_paths;
    uint64_t done_ns; /* time when the last task ended */
    uint64_t read_ns; /* time when the last readback began */
};

/* Progress of a pass. */
struct progress {
    const struct pass *pass;
    uint32_t columns, rows; /* size of the grid */
    uint32_t next;          /* first point that is in no task yet */
    uint32_t read;          /* first point that is in no readback yet */
};

/* ---- kernels ---- */

static void cl_kernels_free(struct cl_kernels *k, const struct cl_machine *m)
{
    const cl_kernel kernels[] = {k->clear, k->generate, k->trace, k->add};

    for (size_t i = 0; i < sizeof kernels / sizeof kernels[0]; i++)
        if (kernels[i] != NULL)
            m->api->ReleaseKernel(kernels[i]);
    if (k->program != NULL)
        m->api->ReleaseProgram(k->program);
    *k = (struct cl_kernels){0};
}

/* Returns the compiler's log, for free(), or NULL when memory is out. */
static char *build_log(const struct cl_kernels *k, const struct cl_machine *m)
{
    size_t size_bytes = 0;
    char *log;

    m->api->GetProgramBuildInfo(k->program, m->device->id, CL_PROGRAM_BUILD_LOG,
                                0, NULL, &size_bytes);
    log = alloc_array(1, size_bytes + 1);
    if (log == NULL)
        return NULL;
    m->api->GetProgramBuildInfo(k->program, m->device->id, CL_PROGRAM_BUILD_LOG,
                                size_bytes, log, NULL);
    return log;
}

/* Finds the first error message of a log; most compilers write "error". Returns
 * its length. */
static int first_message(const char *log, const char **line)
{
    const char *at = strstr(log, "error");

    if (at == NULL)
        at = log;
    while (at > log && at[-1] != '\n')
        at--;
    *line = at;
    return (int)strcspn(at, "\n");
}

static bool compile(struct cl_kernels *k, const struct cl_machine *m,
                    char **log, struct error *err)
{
    char options[128];
    const char *line;
    int length;
    cl_int code;

    /* rounds division and sqrt as IEEE 754 does, where the device can */
    snprintf(options, sizeof options,
             "-cl-std=CL1.2 -Werror -DFEATURES=%" PRIu64 "ul%s", k->features,
             m->device->has_correct_divide
                 ? " -cl-fp32-correctly-rounded-divide-sqrt"
                 : "");
    code = m->api->BuildProgram(k->program, 1, &m->device->id, options, NULL,
                                NULL);
    if (code == CL_SUCCESS)
        return true;
    *log = build_log(k, m);
    length = first_message(*log != NULL ? *log : "", &line);
    return fail(err, "OpenCL device %s: the kernels do not compile: %.*s",
                m->device->name, length, length > 0 ? line : "");
}

static bool find_kernel(struct cl_kernels *k, const struct cl_machine *m,
                        const char *name, cl_kernel *kernel, struct error *err)
{
    cl_int code;

    *kernel = m->api->CreateKernel(k->program, name, &code);
    return cl_machine_check(m, code, name, err);
}

/* Features that a build must have besides those asked for. NVIDIA's compiler
 * does not end on builds without texture and bump code (driver 580.159, H100);
 * with both it takes 5 to 15 s. */
static uint64_t features_needed(const struct cl_machine *m)
{
    return strstr(m->device->platform_name, "NVIDIA") != NULL
               ? FEATURE_TEXTURES | FEATURE_BUMPS
               : 0;
}

/* Builds the kernels. Takes seconds unless the driver has cached a build of
 * this text. After a failure *log is the compiler's output, for free();
 * otherwise it is NULL. */
static bool cl_kernels_build(struct cl_kernels *k, const struct cl_machine *m,
                             const char *text, uint64_t features, char **log,
                             struct error *err)
{
    cl_int code;

    *k = (struct cl_kernels){.features = features | features_needed(m)};
    *log = NULL;
    k->program =
        m->api->CreateProgramWithSource(m->context, 1, &text, NULL, &code);
    if (!cl_machine_check(m, code, "clCreateProgramWithSource", err))
        return false;
    if (compile(k, m, log, err) &&
        find_kernel(k, m, "clear_buffers", &k->clear, err) &&
        find_kernel(k, m, "generate_rays", &k->generate, err) &&
        find_kernel(k, m, "trace_paths", &k->trace, err) &&
        find_kernel(k, m, "add_samples", &k->add, err))
        return true;
    cl_kernels_free(k, m);
    return false;
}

/* ---- calls ---- */

static bool call_done(struct backend_cl *b, cl_int code, const char *call,
                      struct error *err)
{
    return cl_machine_check(&b->machine, code, call, err);
}

/* ---- geometry, picture ---- */

/* Lets the thread do some work, until it ends or the driver does not answer. */
static enum pass_result ask(struct backend_cl *b, void (*work)(void *context),
                            struct error *err)
{
    b->request.result = PASS_DONE;
    if (!cl_thread_run(&b->thread, work, b, b->request.cancel)) {
        fail(err, "OpenCL: the driver does not answer");
        return PASS_FAILED;
    }
    if (b->request.result == PASS_FAILED)
        *err = b->request.error;
    return b->request.result;
}

static void free_world(void *context)
{
    struct backend_cl *b = context;

    cl_world_free(&b->world, &b->machine);
}

static bool cl_load(struct backend *base, struct host_world *host,
                    struct world *world, struct error *err)
{
    struct backend_cl *b = (struct backend_cl *)base;

    if (ask(b, free_world, err) == PASS_FAILED)
        return false;
    if (base->pool == NULL)
        base->pool = world_pool(host);
    if (!world_ensure_tree(host, world, base->pool, err))
        return false;
    base->tree_bytes = bvh8_bytes(world_tree(host));
    return true;
}

static void cl_unload(struct backend *base)
{
    struct error ignored;

    ask((struct backend_cl *)base, free_world, &ignored);
    base->tree_bytes = 0;
}

static void free_slot(struct backend_cl *b, struct slot *s)
{
    cl_machine_drop(&b->machine, &s->starts);
    cl_machine_drop(&b->machine, &s->samples);
    cl_machine_drop(&b->machine, &s->surfaces);
    cl_machine_drop(&b->machine, &s->tally);
    cl_readback_free(&s->reading);
    *s = (struct slot){0};
}

static bool clear_film(struct backend_cl *b, size_t pixel_count,
                       struct error *err)
{
    uint64_t count = pixel_count;
    cl_kernel clear = b->kernels->clear;

    return call_done(b,
                     b->machine.api->SetKernelArg(clear, 0, sizeof count,
                                                  &count),
                     "clSetKernelArg", err) &&
           cl_machine_set(&b->machine, clear, 1,
                          (cl_mem[]){b->film.sums, b->film.odd_sums,
                                     b->film.surfaces, b->film.counts},
                          4, err) &&
           cl_machine_enqueue(&b->machine, clear, pixel_count, err);
}

/* Chooses the special kernels if they have all features that the world needs,
 * else the full ones. */
static void choose_kernels(struct backend_cl *b, uint64_t features)
{
    pthread_mutex_lock(&b->lock);
    if (b->next.program != NULL) {
        cl_kernels_free(&b->special, &b->machine);
        b->special = b->next;
        b->next = (struct cl_kernels){0};
    }
    pthread_mutex_unlock(&b->lock);
    b->kernels =
        b->special.program != NULL && (features & ~b->special.features) == 0
            ? &b->special
            : &b->full;
}

static bool begin_picture(struct backend_cl *b, const struct backend_picture *p,
                          struct error *err)
{
    size_t pixel_count = (size_t)p->film->width * (size_t)p->film->height;

    choose_kernels(b, p->world->settings.features);
    cl_machine_drop(&b->machine, &b->shares);
    cl_machine_drop(&b->machine, &b->light);
    b->x0 = (uint32_t)p->x0;
    b->y0 = (uint32_t)p->y0;
    b->complete_points = 0;
    return cl_world_update(&b->world, &b->machine, p, &b->base.upload_count,
                           err) &&
           cl_film_begin(&b->film, &b->machine, p->film, err) &&
           cl_readback_begin(&b->slots[0].reading, &b->film, err) &&
           cl_readback_begin(&b->slots[1].reading, &b->film, err) &&
           (atomic_load(&p->film->samples) > 0
                ? cl_film_upload(&b->film, &b->machine, err)
                : clear_film(b, pixel_count, err));
}

static void begin_work(void *context)
{
    struct backend_cl *b = context;
    struct request *r = &b->request;

    if (!begin_picture(b, &r->picture, &r->error))
        r->result = PASS_FAILED;
}

static bool cl_begin(struct backend *base, const struct backend_picture *p,
                     struct error *err)
{
    struct backend_cl *b = (struct backend_cl *)base;

    b->request.picture = *p;
    return ask(b, begin_work, err) != PASS_FAILED;
}

/* ---- tasks ---- */

static bool make_room(struct backend_cl *b, struct slot *s, uint32_t paths,
                      struct error *err)
{
    const struct cl_machine *m = &b->machine;
    bool has_surfaces = b->film.surfaces != NULL;

    if (s->tally == NULL)
        s->tally = cl_machine_buffer(m, NULL, sizeof s->result, false, err);
    if (s->tally == NULL)
        return false;
    if (paths <= s->capacity && (s->surfaces != NULL) == has_surfaces)
        return true;
    cl_machine_drop(m, &s->starts);
    cl_machine_drop(m, &s->samples);
    cl_machine_drop(m, &s->surfaces);
    s->capacity = 0;
    s->starts = cl_machine_buffer(m, NULL, paths * sizeof(struct camera_sample),
                                  false, err);
    if (s->starts != NULL)
        s->samples =
            cl_machine_buffer(m, NULL, paths * sizeof(struct path_sample),
                              false, err);
    if (s->samples != NULL && has_surfaces)
        s->surfaces =
            cl_machine_buffer(m, NULL, paths * sizeof(struct first_surface),
                              false, err);
    if (s->samples == NULL || (has_surfaces && s->surfaces == NULL))
        return false;
    s->capacity = paths;
    return true;
}

/* Enqueues the three kernels of a task. */
static bool enqueue_task(struct backend_cl *b, struct slot *s,
                         struct error *err)
{
    const struct cl_kernels *k = b->kernels;
    const cl_kernel kernels[] = {k->generate, k->trace, k->add};
    uint32_t paths = s->task.count * s->task.samples;
    const struct tally none = {0};

    for (int i = 0; i < 3; i++)
        if (!call_done(b,
                       b->machine.api->SetKernelArg(kernels[i], 0,
                                                    sizeof s->task, &s->task),
                       "clSetKernelArg", err))
            return false;
    return call_done(b,
                     b->machine.api->EnqueueFillBuffer(
                         b->machine.queue, s->tally, &none.samples,
                         sizeof none.samples, 0, sizeof none, 0, NULL, NULL),
                     "clEnqueueFillBuffer", err) &&
           cl_machine_set(&b->machine, k->generate, 1,
                          (cl_mem[]){b->cancel, b->world.buffers[CL_SETTINGS],
                                     b->film.counts, b->shares, s->starts},
                          5, err) &&
           cl_machine_set(&b->machine, k->trace, 1,
                          (cl_mem[]){b->cancel, s->starts, s->samples,
                                     s->surfaces},
                          4, err) &&
           cl_machine_set(&b->machine, k->trace, 5, b->world.buffers,
                          CL_BUFFER_COUNT, err) &&
           cl_machine_set(&b->machine, k->add, 1,
                          (cl_mem[]){s->samples, s->surfaces, b->film.sums,
                                     b->film.odd_sums, b->film.surfaces,
                                     b->film.counts, s->tally, b->light},
                          8, err) &&
           cl_machine_enqueue(&b->machine, k->generate, paths, err) &&
           cl_machine_enqueue(&b->machine, k->trace, paths, err) &&
           cl_machine_enqueue(&b->machine, k->add, s->task.count, err);
}

/* Enqueues a readback of the points of all queued tasks, behind them. Readbacks
 * have whole rows, so an incomplete last row is read again later. */
static bool enqueue_reading(struct backend_cl *b, struct progress *p,
                            struct cl_readback *r, cl_event *done,
                            struct error *err)
{
    uint32_t stride = (uint32_t)p->pass->stride;
    uint32_t end = (p->next + p->columns - 1) / p->columns;

    r->first = p->read / p->columns;
    r->count = (uint32_t)u64_min(end - r->first, b->film.readback_rows);
    p->read = (uint32_t)u64_min(p->next, (r->first + r->count) * p->columns);
    b->read_ns = clock_ns();
    return cl_readback_enqueue(r, &b->film, &b->machine, stride, done, err);
}

static bool is_reading_due(const struct backend_cl *b, uint64_t now_ns)
{
    return !cl_film_is_shared(&b->film) && now_ns >= b->read_ns + READ_NS;
}

/* Enqueues a task of the next points of the pass, with a readback if one is
 * due. */
static bool start_task(struct backend_cl *b, struct progress *p, struct slot *s,
                       struct error *err)
{
    uint32_t samples = p->pass->samples;
    uint32_t points = b->task_paths / samples;
    uint32_t left = p->columns * p->rows - p->next;
    const struct cl_api *api = b->machine.api;

    s->task = (struct task){.target = p->pass->target,
                            .first_sample = b->film.film->first_sample,
                            .samples = samples,
                            .first = p->next,
                            .count = (uint32_t)u64_min(points, left),
                            .columns = p->columns,
                            .stride = (uint32_t)p->pass->stride,
                            .width = (uint32_t)b->film.film->width,
                            .x0 = b->x0,
                            .y0 = b->y0,
                            .has_shares = p->pass->shares != NULL};
    if (p->pass->light != NULL)
        s->task.light_pixels = (uint32_t)p->pass->light->pixel_count;
    s->begin_ns = clock_ns();
    s->reading.count = 0;
    p->next += s->task.count;
    return make_room(b, s, s->task.count * samples, err) &&
           enqueue_task(b, s, err) &&
           (!is_reading_due(b, s->begin_ns) ||
            enqueue_reading(b, p, &s->reading, NULL, err)) &&
           call_done(b,
                     api->EnqueueReadBuffer(b->machine.queue, s->tally,
                                            CL_FALSE, 0, sizeof s->result,
                                            &s->result, 0, NULL, &s->done),
                     "clEnqueueReadBuffer", err) &&
           call_done(b, api->Flush(b->machine.queue), "clFlush", err);
}

/* Adapts the size of the next tasks to TASK_NS by the time of this one. */
static void adapt(struct backend_cl *b, const struct slot *s)
{
    uint32_t paths = s->task.count * s->task.samples;
    uint64_t now_ns = clock_ns();
    uint64_t begin_ns = s->begin_ns > b->done_ns ? s->begin_ns : b->done_ns;
    double wanted = (double)TASK_NS / (double)(now_ns - begin_ns + 1);

    b->done_ns = now_ns;
    if (paths < b->task_paths / 2)
        return; /* the short last task of a pass is not representative */
    wanted = wanted < 0.5 ? 0.5 : wanted > 2 ? 2 : wanted;
    wanted *= b->task_paths;
    b->task_paths = wanted < TASK_PATHS_MIN   ? TASK_PATHS_MIN
                    : wanted > TASK_PATHS_MAX ? TASK_PATHS_MAX
                                              : (uint32_t)wanted;
}

static bool finish_task(struct backend_cl *b, struct slot *s,
                        const struct cancel *cancel, struct error *err)
{
    if (!cl_machine_wait(&b->machine, &s->done, err))
        return false;
    film_count_more(b->film.film, &s->result);
    if (cl_film_is_shared(&b->film))
        cl_film_store_points(&b->film, &s->task);
    else
        cl_readback_store(&s->reading, &b->film, s->task.stride);
    /* kernels that see the cancel leave samples out */
    if (!cancel_requested(cancel) || !b->machine.device->is_cpu)
        b->complete_points = s->task.first + s->task.count;
    if (!cancel_requested(cancel))
        adapt(b, s);
    return true;
}

/* Reads back the points that no earlier readback contains, at the end of a
 * pass. The host stores one readback while the device sends the next. */
static bool read_rest(struct backend_cl *b, struct progress *p,
                      struct error *err)
{
    for (int turn = 0;; turn = 1 - turn) {
        struct slot *next = &b->slots[turn], *s = &b->slots[1 - turn];
        bool has_more = !cl_film_is_shared(&b->film) && p->read < p->next;

        if (has_more &&
            (!enqueue_reading(b, p, &next->reading, &next->done, err) ||
             !call_done(b, b->machine.api->Flush(b->machine.queue), "clFlush",
                        err)))
            return false;
        if (s->done != NULL) {
            if (!cl_machine_wait(&b->machine, &s->done, err))
                return false;
            cl_readback_store(&s->reading, &b->film, (uint32_t)p->pass->stride);
        } else if (!has_more) {
            return true;
        }
    }
}

/* Gives the kernels the word to test for cancellation. A device that is a CPU
 * reads the host's own word. Other devices might see a change too late, when
 * the next pass has begun, so their word stays 0. */
static bool bind_cancel(struct backend_cl *b, const struct cancel *cancel,
                        struct error *err)
{
    static const uint32_t never = 0;
    bool is_cpu = b->machine.device->is_cpu;

    if (b->cancel_source == cancel)
        return true;
    cl_machine_drop(&b->machine, &b->cancel);
    b->cancel =
        cl_machine_buffer(&b->machine, is_cpu ? (const void *)cancel : &never,
                          sizeof never, true, err);
    b->cancel_source = b->cancel != NULL ? cancel : NULL;
    return b->cancel != NULL;
}

/* Uploads the shares of pixels, unless the device has them. */
static bool bind_shares(struct backend_cl *b, const struct pass *pass,
                        struct error *err)
{
    const struct film *film = b->film.film;
    size_t pixels = (size_t)film->width * (size_t)film->height;

    if (pass->shares == NULL || b->shares != NULL)
        return true;
    b->shares = cl_machine_buffer(&b->machine, pass->shares,
                                  pixels * sizeof *pass->shares, false, err);
    return b->shares != NULL;
}

/* Uploads the light of light paths, unless the device has it. */
static bool bind_light(struct backend_cl *b, const struct pass *pass,
                       struct error *err)
{
    const struct pass_light *l = pass->light;

    if (l == NULL || (b->light != NULL && b->light_version == l->version))
        return true;
    cl_machine_drop(&b->machine, &b->light);
    b->light =
        cl_machine_buffer(&b->machine, l->pixels,
                          6 * l->pixel_count * sizeof *l->pixels, false, err);
    b->light_version = l->version;
    return b->light != NULL &&
           (l->grids == NULL ||
            cl_world_set_cells(&b->world, &b->machine, l, err));
}

/* Waits until a failed pass can no longer write to the host's memory. */
static void drain(struct backend_cl *b)
{
    if (cl_thread_is_left(&b->thread))
        return;
    b->machine.api->Finish(b->machine.queue);
    for (int i = 0; i < 2; i++) {
        if (b->slots[i].done != NULL)
            b->machine.api->ReleaseEvent(b->slots[i].done);
        b->slots[i].done = NULL;
    }
}

static bool run_tasks(struct backend_cl *b, struct progress *p,
                      const struct cancel *cancel, struct error *err)
{
    for (int turn = 0;; turn = 1 - turn) {
        struct slot *s = &b->slots[turn];
        bool has_more;

        if (s->done != NULL && !finish_task(b, s, cancel, err))
            return false;
        has_more = !cancel_requested(cancel) && p->next < p->columns * p->rows;
        if (has_more && !start_task(b, p, s, err))
            return false;
        if (!has_more && b->slots[1 - turn].done == NULL)
            return read_rest(b, p, err);
    }
}

static enum pass_result run_pass(struct backend_cl *b, const struct pass *pass,
                                 const struct cancel *cancel, struct error *err)
{
    const struct film *film = b->film.film;
    uint32_t stride = (uint32_t)pass->stride;
    struct progress p = {
        .pass = pass,
        .columns = ((uint32_t)film->width + stride - 1) / stride,
        .rows = ((uint32_t)film->height + stride - 1) / stride,
    };

    if (b->target != pass->target || b->stride != pass->stride)
        b->complete_points = 0;
    b->target = pass->target;
    b->stride = pass->stride;
    p.next = p.read = b->complete_points;
    b->done_ns = 0;
    if (!bind_cancel(b, cancel, err) || !bind_shares(b, pass, err) ||
        !bind_light(b, pass, err) || !run_tasks(b, &p, cancel, err)) {
        drain(b);
        return PASS_FAILED;
    }
    return cancel_requested(cancel) ? PASS_CANCELLED : PASS_DONE;
}

static void pass_work(void *context)
{
    struct backend_cl *b = context;
    struct request *r = &b->request;

    r->result = run_pass(b, &r->pass, r->cancel, &r->error);
}

static enum pass_result cl_pass(struct backend *base, const struct pass *pass,
                                const struct cancel *cancel, struct error *err)
{
    struct backend_cl *b = (struct backend_cl *)base;
    enum pass_result result;

    b->request.pass = *pass;
    b->request.cancel = cancel;
    result = ask(b, pass_work, err);
    b->request.cancel = NULL;
    if (result == PASS_FAILED)
        film_count_again(b->film.film);
    return result;
}

/* ---- life ---- */

static void release(void *context)
{
    struct backend_cl *b = context;

    for (int i = 0; i < 2; i++)
        free_slot(b, &b->slots[i]);
    cl_film_free(&b->film, &b->machine);
    cl_world_free(&b->world, &b->machine);
    cl_machine_drop(&b->machine, &b->cancel);
    cl_machine_drop(&b->machine, &b->shares);
    cl_machine_drop(&b->machine, &b->light);
    cl_kernels_free(&b->next, &b->machine);
    cl_kernels_free(&b->special, &b->machine);
    cl_kernels_free(&b->full, &b->machine);
    cl_machine_close(&b->machine);
}

static void cl_destroy(struct backend *base)
{
    struct backend_cl *b = (struct backend_cl *)base;
    const struct cancel at_once = {.requested = 1};

    if (!cl_thread_run(&b->thread, release, b, &at_once))
        return; /* the driver may still use all of it */
    cl_thread_end(&b->thread);
    pool_destroy(base->pool);
    pthread_mutex_destroy(&b->lock);
    free(b->text);
    free(b);
}

bool backend_cl_specialise(struct backend *base, uint64_t features, char **log,
                           struct error *err)
{
    struct backend_cl *b = (struct backend_cl *)base;
    struct cl_kernels kernels;

    if (!cl_kernels_build(&kernels, &b->machine, b->text, features, log, err))
        return false;
    pthread_mutex_lock(&b->lock);
    cl_kernels_free(&b->next, &b->machine);
    b->next = kernels;
    pthread_mutex_unlock(&b->lock);
    return true;
}

/* Opens the device and builds the kernels. */
static bool open_machine(struct backend_cl *b, const struct cl_request *r,
                         char **log, struct error *err)
{
    struct cl_machine *m = &b->machine;

    if (!cl_machine_open(m, r->device, &b->thread, err))
        return false;
    if (r->needs_gpu && !m->device->is_gpu)
        return fail(err, "OpenCL: found no GPU, only %s", m->device->name);
    return cl_kernels_build(&b->full, m, b->text, r->features, log, err);
}

static void open_work(void *context)
{
    struct backend_cl *b = context;
    struct request *r = &b->request;

    if (!open_machine(b, r->start, &r->log, &r->error))
        r->result = PASS_FAILED;
}

struct backend *backend_cl_create(const struct cl_request *r, char **log,
                                  struct error *err)
{
    struct backend_cl *b = alloc_array(1, sizeof *b);

    *log = NULL;
    if (b == NULL) {
        fail(err, "OpenCL: out of memory");
        return NULL;
    }
    b->text = cl_source_text(r->kernels_path, err);
    if (b->text == NULL || !cl_thread_init(&b->thread, err)) {
        free(b->text);
        free(b);
        return NULL;
    }
    pthread_mutex_init(&b->lock, NULL);
    b->task_paths = TASK_PATHS_FIRST;
    b->request.start = r;
    if (ask(b, open_work, err) == PASS_FAILED) {
        *log = b->request.log;
        cl_destroy(&b->base);
        return NULL;
    }
    b->base.name = "opencl";
    b->base.device = b->machine.device->name;
    b->base.driver = b->machine.device->driver_version;
    b->base.thread_count = (int)b->machine.device->compute_units;
    b->base.load = cl_load;
    b->base.unload = cl_unload;
    b->base.begin = cl_begin;
    b->base.takes_light = true;
    b->base.pass = cl_pass;
    b->base.destroy = cl_destroy;
    return &b->base;
}
