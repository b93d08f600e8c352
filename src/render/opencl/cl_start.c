// SPDX-License-Identifier: MIT
#include "render/opencl/cl_start.h"

#include <inttypes.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "base/background.h"
#include "base/child.h"
#include "base/file.h"
#include "base/memory.h"
#include "read/mtl.h"
#include "read/obj.h"
#include "render/cpu_dispatch.h"
#include "render/opencl/cl_source.h"
#include "render/render_loop.h"
#include "scene/material.h"
#include "world/world.h"

/* ---- the self-test ---- */

#define SIDE 16
#define SPP  4

/* Tolerance. Devices may round division and square root differently. Most
 * pixels then differ in the last bits; a few paths take another branch, and
 * their pixels differ more. A faulty device differs everywhere. */
#define NEAR          1e-3
#define DIFFERENT_MAX 0.1

static const char materials[] = "newmtl wall\nKd .7 .6 .5\n"
                                "newmtl lamp\nKd 0 0 0\nKe 6 6 5\n"
                                "newmtl steel\nKd .9 .8 .6\nPm 1\nPr .5\n"
                                "newmtl mirror\nKs .9 .9 .9\nillum 3\n"
                                "newmtl pane\nillum 4\nTf .9 1 .9\n"
                                "newmtl frosted\nillum 7\nNi 1.5\nPr .4\n"
                                "newmtl clear\nillum 7\nNi 1.4\n"
                                "newmtl veil\nKd .2 .4 .8\nd .5\n"
                                "newmtl chalk\nKd .8 .8 .8\n"
                                "Kd_roughness .7\n"
                                "newmtl coated\nKd .5 .1 .1\nKs .2 .2 .2\n"
                                "illum 2\nPr .5\n";

/* A room, its lamp, and upright triangles. */
static const char faces[] =
    "v -2 0 -2\nv 2 0 -2\nv 2 0 2\nv -2 0 2\n"
    "v -2 3 -2\nv 2 3 -2\nv 2 3 2\nv -2 3 2\n"
    "v -1 2.9 -1\nv 1 2.9 -1\nv 1 2.9 1\nv -1 2.9 1\n"
    "usemtl wall\nf 5 6 7 8\nf 1 2 6 5\n"
    "f 2 3 7 6\nusemtl coated\nf 1 2 3 4\n"
    "usemtl chalk\nf 1 4 8 5\nusemtl lamp\nf 9 10 11 12\n"
    "v -1.8 .2 -1\nv -.6 .2 -1.2\nv -1.2 2 -1.1\n"
    "v -.5 .2 -1.2\nv .5 .2 -1.2\nv 0 2 -1.2\n"
    "v .6 .2 -1.2\nv 1.8 .2 -1\nv 1.2 2 -1.1\n"
    "v -1.5 .2 .5\nv -.5 .2 .3\nv -1 2 .4\n"
    "v -.4 .2 .2\nv .4 .2 .2\nv 0 2 .2\n"
    "v .5 .2 .3\nv 1.5 .2 .5\nv 1 2 .4\n"
    "usemtl steel\nf 13 14 15\nusemtl mirror\n"
    "f 16 17 18\nusemtl veil\nf 19 20 21\n"
    "usemtl frosted\nf 22 23 24\nusemtl pane\n"
    "f 25 26 27\nusemtl clear\nf 28 29 30\n";

static bool make_world(struct scene *scene, struct host_world *host,
                       uint64_t features, struct error *err)
{
    struct warnings report = {0};
    bool ok =
        mtl_add_default(scene, err) &&
        mtl_parse(scene, materials, sizeof materials - 1, "self-test", &report,
                  err) &&
        obj_parse(scene, faces, sizeof faces - 1, "self-test", &report, err) &&
        scene_finish(scene, &report, err);

    for (uint32_t i = 0; ok && i < scene->material_count; i++) {
        struct material *m = &scene->materials[i];

        if ((material_features(m, scene->textures) & ~features) != 0)
            *m = material_default();
    }
    ok = ok && world_init(host, scene, 1, &report, err);
    warnings_free(&report);
    return ok;
}

static bool make_job(const struct scene *scene, struct host_world *host,
                     uint64_t features, struct render_job *job,
                     struct error *err)
{
    struct view view;
    bool ok;

    *job = (struct render_job){.host = host,
                               .crop = {0, 0, SIDE, SIDE},
                               .limits.spp = SPP};
    view_init(&view);
    view.width_px = view.height_px = SIDE;
    view.pose.eye[0] = 0.3;
    view.pose.eye[1] = 1.4;
    view.pose.eye[2] = 1.9;
    view.pose.at[0] = view.pose.at[2] = 0;
    view.pose.at[1] = 1.3;
    view.pose.fovy_deg = 75;
    view.lighting.background[0] = view.lighting.background[1] =
        view.lighting.background[2] = 0.5;
    ok =
        (features & FEATURE_GUIDE) == 0 || world_guide(host, scene, &view, err);
    if ((features & FEATURE_LIGHT_PATHS) == 0)
        light_paths_free(&host->light_paths);
    ok = ok && world_lend(host, scene, &view, 1, &job->world, err);
    view_free(&view);
    return ok;
}

static bool render_with(struct backend *backend, const struct render_job *job,
                        float *rgb, struct error *err)
{
    struct render *r = render_create(backend, err);
    struct render_progress p;

    if (r == NULL)
        return false;
    if (!render_start(r, job, err)) {
        render_destroy(r);
        return false;
    }
    render_wait(r, -1);
    p = render_progress(r);
    if (p.state == RENDER_DONE)
        film_linear(render_film(r), rgb);
    else
        *err = p.error;
    render_destroy(r);
    return p.state == RENDER_DONE;
}

static bool judge(const float *a, const float *b,
                  char verdict[SELFTEST_VERDICT_BYTES], struct error *err)
{
    int pixels = SIDE * SIDE;
    int different = 0;
    int far_off = 0;

    for (int i = 0; i < pixels; i++) {
        const float *p = a + 3 * i;
        const float *q = b + 3 * i;

        different += memcmp(p, q, 3 * sizeof *p) != 0;
        for (int c = 0; c < 3; c++) {
            double x = (double)p[c];

            if (!(fabs((double)q[c] - x) <= NEAR * x)) {
                far_off++;
                break;
            }
        }
    }
    if (far_off > DIFFERENT_MAX * pixels)
        return fail(err,
                    "the self-test found %d of %d pixels wrong: the driver "
                    "cannot be trusted",
                    far_off, pixels);
    if (different == 0)
        snprintf(verdict, SELFTEST_VERDICT_BYTES, "the CPU's bits");
    else
        snprintf(verdict, SELFTEST_VERDICT_BYTES,
                 "%d of %d pixels differ from the CPU", different, pixels);
    return true;
}

bool selftest_run(struct backend *cpu, struct backend *device,
                  uint64_t features, char verdict[SELFTEST_VERDICT_BYTES],
                  struct error *err)
{
    struct scene scene = {0};
    struct host_world host = {.tris = NULL};
    struct render_job job;
    float rgb[2][3 * SIDE * SIDE];
    bool ok = make_world(&scene, &host, features, err) &&
              make_job(&scene, &host, features, &job, err) &&
              render_with(cpu, &job, rgb[0], err) &&
              render_with(device, &job, rgb[1], err) &&
              judge(rgb[0], rgb[1], verdict, err);

    world_free(&host);
    scene_free(&scene);
    return ok;
}

/* ---- probes ---- */

/* Limit of processor time: compilers take seconds, a hanging driver takes
 * forever. */
#define ANSWER_NS UINT64_C(60000000000)

/* Limit for the copy's output, more than a compiler prints. */
#define OUTPUT_BYTES_MAX ((size_t)1 << 20)

/* ---- cache ---- */

/* Returns the path of the cached result, for free(); NULL without a cache
 * folder, or if memory is out. */
static char *memory_path(const struct cl_request *r)
{
    const char *folder = getenv("POCL_CACHE_DIR");
    struct error ignored;
    char *text, *key, *path;

    if (folder == NULL || *folder == '\0')
        return NULL;
    text = cl_source_text(r->kernels_path, &ignored);
    if (text == NULL)
        return NULL;
    key = format_text("%s %" PRIu64 " %s", r->device != NULL ? r->device : "",
                      r->features, text);
    path = key != NULL
               ? format_text("%s/glim-%016" PRIx64, folder, cl_source_hash(key))
               : NULL;
    free(key);
    free(text);
    return path;
}

/* Removes the last line from the text and returns it, for free(); NULL if there
 * is none, or memory is out. */
static char *cut_last_line(char *text)
{
    size_t length = strlen(text);
    char *line;

    while (length > 0 && text[length - 1] == '\n')
        text[--length] = '\0';
    if (length == 0)
        return NULL;
    line = strrchr(text, '\n');
    if (line == NULL) {
        char *copy = strdup(text);

        *text = '\0';
        return copy;
    }
    *line = '\0';
    return strdup(line + 1);
}

/* Parses a good answer, whose last lines are the device and the verdict. Takes
 * ownership of the text. */
static bool take_answer(struct cl_probe *probe, char *text)
{
    *probe = (struct cl_probe){.log = text};
    probe->verdict = cut_last_line(text);
    probe->device = cut_last_line(text);
    return probe->device != NULL && probe->verdict != NULL;
}

bool cl_probe_recall(struct cl_probe *probe, const struct cl_request *r)
{
    char *path = memory_path(r);
    char *text = NULL;
    size_t size_bytes;
    struct error ignored;
    bool ok = path != NULL && file_read(path, &text, &size_bytes, &ignored);

    free(path);
    if (ok && take_answer(probe, text))
        return true;
    if (ok)
        cl_probe_free(probe);
    return false;
}

static void remember(const struct cl_probe *probe, const struct cl_request *r)
{
    char *path = memory_path(r);
    char *text = format_text("%s\n%s\n", probe->device, probe->verdict);
    struct error ignored;

    if (path != NULL && text != NULL)
        file_write(path, text, strlen(text), false, NULL, &ignored);
    free(text);
    free(path);
}

/* ---- the copy ---- */

bool cl_probe_answer(struct cl_probe *probe, const struct cl_request *r,
                     struct error *err)
{
    char verdict[SELFTEST_VERDICT_BYTES];
    struct backend *device, *cpu;
    bool ok = false;

    *probe = (struct cl_probe){0};
    device = backend_cl_create(r, &probe->log, err);
    if (device == NULL)
        return false;
    cpu = backend_cpu_create(1, cpu_kernel_best(), err);
    if (cpu != NULL) {
        ok = selftest_run(cpu, device, r->features, verdict, err);
        cpu->destroy(cpu);
    }
    if (ok) {
        probe->device = cl_probe_device(device);
        probe->verdict = strdup(verdict);
        ok = (probe->device != NULL && probe->verdict != NULL) ||
             fail(err, "OpenCL: out of memory");
    }
    device->destroy(device);
    return ok;
}

char *cl_probe_device(const struct backend *backend)
{
    return format_text("%s, %s", backend->device, backend->driver);
}

/* ---- its parent ---- */

/* Runs the copy with both outputs in one text. */
static enum child_end run_copy(const struct cl_request *r,
                               const atomic_bool *is_unwanted,
                               struct child_result *result)
{
    char features[24];
    const char *arguments[10] = {"glim", "--probe", features, "--backend",
                                 r->needs_gpu ? "auto" : "opencl"};
    struct child_task task = {
        .program = r->program,
        .arguments = arguments,
        .has_errors = true,
        .is_cut = true, /* the cause is at the beginning */
        .time_ns = ANSWER_NS,
        .size_bytes = OUTPUT_BYTES_MAX,
        .is_unwanted = is_unwanted,
    };
    int count = 5;

    snprintf(features, sizeof features, "%" PRIu64, r->features);
    if (r->device != NULL) {
        arguments[count++] = "--device";
        arguments[count++] = r->device;
    }
    if (r->kernels_path != NULL) {
        arguments[count++] = "--kernels";
        arguments[count++] = r->kernels_path;
    }
    return child_run(&task, result);
}

/* Reports the failure of the copy: its last line, or the signal that killed
 * it. */
static bool fail_copy(struct cl_probe *probe, char *output, int status,
                      struct error *err)
{
    char *line = cut_last_line(output);
    const char *said = line != NULL ? line : "";
    static const char prefix[] = "glim: ";

    if (strncmp(said, prefix, sizeof prefix - 1) == 0)
        said += sizeof prefix - 1;
    if (WIFSIGNALED(status))
        fail(err, "OpenCL: the driver crashed (%s)%s%s",
             strsignal(WTERMSIG(status)), *said != '\0' ? ": " : "", said);
    else if (*said != '\0')
        fail(err, "%s", said);
    else
        fail(err, "OpenCL: the self-test ended with status %d",
             WEXITSTATUS(status));
    *probe = (struct cl_probe){.log = output};
    free(line);
    return false;
}

static bool take_output(struct cl_probe *probe, char *output, int status,
                        struct error *err)
{
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return fail_copy(probe, output, status, err);
    if (take_answer(probe, output))
        return true;
    cl_probe_free(probe);
    return fail(err, "OpenCL: the self-test gave no verdict");
}

bool cl_probe_run(struct cl_probe *probe, const struct cl_request *r,
                  const atomic_bool *is_unwanted, struct error *err)
{
    struct child_result result;

    *probe = (struct cl_probe){0};
    switch (run_copy(r, is_unwanted, &result)) {
    case CHILD_NOT_RUN:
        return fail(err, "OpenCL: %s: cannot run the self-test: %s", r->program,
                    strerror(result.reason));
    case CHILD_UNKNOWN:
        return fail(err, "OpenCL: how the self-test ended is not known: %s",
                    strerror(result.reason));
    case CHILD_LATE:
    case CHILD_TOO_LONG:
    case CHILD_NO_MEMORY:
        return fail(err, "OpenCL: the driver does not answer");
    case CHILD_ENDED: break;
    }
    if (!take_output(probe, result.output, result.status, err))
        return false;
    remember(probe, r);
    return true;
}

void cl_probe_free(struct cl_probe *probe)
{
    free(probe->device);
    free(probe->verdict);
    free(probe->log);
    *probe = (struct cl_probe){0};
}

/* ---- starts ---- */

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
