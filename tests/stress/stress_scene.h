// SPDX-License-Identifier: MIT
/*
 * stress_scene.h - scenes of rows: written as text, rendered, compared with
 * a number
 *
 * A row's scene is written into OBJ and MTL files, loaded like any file, and
 * rendered with SEEDS seeds. The mean of all pixels must agree with the truth
 * by Student's t-test. With 11 degrees of freedom t exceeds T_LIMIT once in 1e6
 * (two-sided). There are some 120 such rows, so there is one false alarm in
 * 8,000 choices of seeds. The seeds are fixed.
 *
 * Units:     file units in scenes, degrees, radiance
 * Ownership: stress_scene_close() frees all and removes the files
 * Threads:   one
 * Errors:    the outcome has errors of glim; failures of the machine end the
 *            program
 */
#ifndef TESTS_STRESS_SCENE_H
#define TESTS_STRESS_SCENE_H

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "engine/scene_load.h"
#include "render/cpu_dispatch.h"
#include "render/opencl/backend_cl.h"
#include "render/opencl/cl_api.h"
#include "render/render_loop.h"
#include "rows.h"
#include "terminal/xmalloc.h"
#include "tests/unit/folder.h"
#include "world/world.h"

#define SEEDS   12
#define T_LIMIT 9.4
#define SIDE_PX 16

struct stress_scene {
    FILE *obj, *mtl;
    double scale, move[3]; /* applied to what is written, in this order */
    struct backend *backend;
    struct render *render;
};

/* A view of the scene. */
struct shot {
    double eye[3], at[3];
    double fovy_deg;
    double background;
    const char *sky; /* a file in the scene's folder, or NULL */
    uint64_t spp;    /* 0: 64 */
    int side_px;     /* 0: SIDE_PX */
    enum direct direct;
    uint32_t seed; /* first seed */
};

struct outcome {
    bool is_refused;
    struct error err;
    double mean, error; /* mean of all pixels, and its standard error */
    struct render_progress last;
    uint64_t warning_count;
    float *rgb; /* picture of the last seed, for free() */
    size_t number_count;
};

static inline void stress_scene_stop(const char *text)
{
    printf("FAIL scene: %s\n", text);
    exit(2);
}

/* Returns false, with a line on standard output, if there is no such device. */
static inline bool stress_scene_open(struct stress_scene *s, bool on_device)
{
    struct cl_request request = {.features = FEATURES_ALL};
    struct error err;
    char *log = NULL;

    *s = (struct stress_scene){.scale = 1};
    if (on_device) {
        cl_environment_prepare(0);
        s->backend = backend_cl_create(&request, &log, &err);
        free(log);
    } else {
        s->backend = backend_cpu_create((int)sysconf(_SC_NPROCESSORS_ONLN),
                                        cpu_kernel_best(), &err);
    }
    if (s->backend == NULL) {
        printf("skip: %s\n", err.text);
        return false;
    }
    s->render = render_create(s->backend, &err);
    if (s->render == NULL)
        stress_scene_stop(err.text);
    if (enter_folder(NULL) != 0)
        stress_scene_stop("no temporary folder");
    return true;
}

static inline void stress_scene_close(struct stress_scene *s)
{
    render_destroy(s->render);
    s->backend->destroy(s->backend);
    unlink("a.obj");
    unlink("a.mtl");
    unlink("sky");
    if (leave_empty_folder(NULL) != 0)
        stress_scene_stop("files are left in the temporary folder");
}

static inline void stress_scene_begin(struct stress_scene *s)
{
    s->obj = fopen("a.obj", "w");
    s->mtl = fopen("a.mtl", "w");
    if (s->obj == NULL || s->mtl == NULL)
        stress_scene_stop("cannot write the scene");
    fprintf(s->obj, "mtllib a.mtl\n");
}

static inline void stress_scene_end(struct stress_scene *s)
{
    if (fclose(s->obj) != 0 || fclose(s->mtl) != 0)
        stress_scene_stop("cannot write the scene");
}

static inline void put_material(struct stress_scene *s, const char *name,
                                const char *lines)
{
    fprintf(s->mtl, "newmtl %s\n%s\n", name, lines);
    fprintf(s->obj, "usemtl %s\n", name);
}

static inline void put_vertex(struct stress_scene *s, double x, double y,
                              double z)
{
    fprintf(s->obj, "v %.17g %.17g %.17g\n", x * s->scale + s->move[0],
            y * s->scale + s->move[1], z * s->scale + s->move[2]);
}

static inline void put_tri(struct stress_scene *s, const double p[3][3])
{
    for (int k = 0; k < 3; k++)
        put_vertex(s, p[k][0], p[k][1], p[k][2]);
    fprintf(s->obj, "f -3 -2 -1\n");
}

/* Adds the rectangle from lo to hi in the plane where the axis is `at`. */
static inline void put_quad(struct stress_scene *s, int axis, double at,
                            const double lo[2], const double hi[2])
{
    for (int i = 0; i < 4; i++) {
        double p[3];

        p[axis] = at;
        p[(axis + 1) % 3] = i == 1 || i == 2 ? hi[0] : lo[0];
        p[(axis + 2) % 3] = i > 1 ? hi[1] : lo[1];
        put_vertex(s, p[0], p[1], p[2]);
    }
    fprintf(s->obj, "f -4 -3 -2 -1\n");
}

/* Adds a box with shared vertices that is wound outwards. */
static inline void put_box(struct stress_scene *s, const double lo[3],
                           const double hi[3])
{
    for (int i = 0; i < 8; i++)
        put_vertex(s, i & 1 ? hi[0] : lo[0], i & 2 ? hi[1] : lo[1],
                   i & 4 ? hi[2] : lo[2]);
    fprintf(s->obj, "f -8 -6 -5 -7\nf -4 -3 -1 -2\nf -8 -7 -3 -4\n"
                    "f -6 -2 -1 -5\nf -8 -4 -2 -6\nf -7 -5 -1 -3\n");
}

static inline void load_scene(struct scene *scene, struct host_world *host,
                              const struct view *view, struct outcome *o)
{
    struct warnings report = {0};

    *scene = (struct scene){0};
    *host = (struct host_world){.tris = NULL};
    o->is_refused =
        !scene_load(scene, "a.obj", SCENE_UP_OF_FILE, &report, &o->err) ||
        !world_init(host, scene, 1, &report, &o->err) ||
        !world_load_sky(host, view, &report, &o->err);
    for (int i = 0; i < report.entry_count; i++)
        o->warning_count += report.entries[i].count;
    warnings_free(&report);
}

static inline struct view make_view(const struct stress_scene *s,
                                    const struct shot *shot)
{
    struct view view;

    view_init(&view);
    for (int k = 0; k < 3; k++) {
        view.pose.eye[k] = shot->eye[k] * s->scale + s->move[k];
        view.pose.at[k] = shot->at[k] * s->scale + s->move[k];
        view.lighting.background[k] = shot->background;
    }
    view.has_camera = view.lighting.has_background = true;
    view.pose.fovy_deg = shot->fovy_deg;
    view.width_px = view.height_px =
        shot->side_px > 0 ? shot->side_px : SIDE_PX;
    view.lighting.sky_path =
        shot->sky != NULL ? xformat("%s", shot->sky) : NULL;
    return view;
}

static inline void render_seed(struct stress_scene *s,
                               const struct scene *scene,
                               struct host_world *host, const struct view *view,
                               const struct shot *shot, uint32_t seed,
                               struct outcome *o)
{
    struct render_job job = {.host = host,
                             .crop = {0, 0, view->width_px, view->height_px},
                             .limits.spp = shot->spp > 0 ? shot->spp : 64};
    struct error err;

    if (!world_lend(host, scene, view, seed, &job.world, &err))
        stress_scene_stop(err.text);
    job.world.settings.direct = shot->direct;
    if (!render_start(s->render, &job, &err))
        stress_scene_stop(err.text);
    if (!render_wait(s->render, 600000))
        stress_scene_stop("a picture takes more than ten minutes");
    o->last = render_progress(s->render);
    if (o->last.state != RENDER_DONE)
        stress_scene_stop(o->last.error.text);
    film_linear(render_film(s->render), o->rgb);
}

/* Renders the scene that stress_scene_end() has completed, with `seeds` seeds.
 */
static inline struct outcome
stress_scene_render(struct stress_scene *s, const struct shot *shot, int seeds)
{
    struct outcome o = {0};
    struct view view = make_view(s, shot);
    struct scene scene;
    struct host_world host;
    double sum = 0, squares = 0;

    load_scene(&scene, &host, &view, &o);
    o.number_count = 3 * (size_t)view.width_px * (size_t)view.height_px;
    o.rgb = xcalloc(o.number_count, sizeof *o.rgb);
    for (int i = 0; i < seeds && !o.is_refused; i++) {
        double mean = 0;

        render_seed(s, &scene, &host, &view, shot, shot->seed + (uint32_t)i,
                    &o);
        for (size_t k = 0; k < o.number_count; k++)
            mean += (double)o.rgb[k] / (double)o.number_count;
        sum += mean;
        squares += mean * mean;
    }
    o.mean = sum / seeds;
    o.error =
        sqrt(fmax(squares / seeds - o.mean * o.mean, 0) / fmax(seeds - 1, 1));
    render_halt(s->render);
    world_free(&host);
    scene_free(&scene);
    view_free(&view);
    return o;
}

/* Writes a scene; the meaning of the number is the function's. */
typedef void scene_maker(struct stress_scene *s, double number);

struct truth {
    const char *name, *what;
    scene_maker *make;
    double number;
    double want;
    double bias; /* known relative bias; 0: rounding */
    struct shot shot;
    bool warns;
};

/* Rounding of a sum of a few float operations. */
#define ROUNDING 1e-5

static inline void check_truth(struct stress_scene *s, const struct truth *t)
{
    struct outcome o;
    double allowed;

    stress_scene_begin(s);
    t->make(s, t->number);
    stress_scene_end(s);
    o = stress_scene_render(s, &t->shot, SEEDS);
    if (o.is_refused) {
        row(false, t->name, "%s: refused: %s", t->what, o.err.text);
        free(o.rgb);
        return;
    }
    allowed = T_LIMIT * o.error + fmax(t->bias, ROUNDING) * t->want;
    row(fabs(o.mean - t->want) <= allowed && o.last.non_finite == 0 &&
            (o.warning_count > 0) == t->warns,
        t->name, "%s: %.6g, want %.6g, off by %.2g of %.2g%s%s", t->what,
        o.mean, t->want, fabs(o.mean - t->want), allowed,
        o.last.non_finite > 0 ? ", samples that are not finite" : "",
        (o.warning_count > 0) == t->warns ? ""
        : t->warns                        ? ", no warning"
                                          : ", warnings");
    free(o.rgb);
}

/* Two scenes whose pictures must have the same bytes. */
struct twins {
    const char *name, *what;
    scene_maker *make;
    double one, other;
    struct shot shot;
};

static inline void check_twins(struct stress_scene *s, const struct twins *t)
{
    const double numbers[] = {t->one, t->other};
    struct outcome o[2];

    for (int i = 0; i < 2; i++) {
        stress_scene_begin(s);
        t->make(s, numbers[i]);
        stress_scene_end(s);
        o[i] = stress_scene_render(s, &t->shot, 1);
    }
    row(!o[0].is_refused && !o[1].is_refused && o[0].mean > 0 &&
            o[0].last.non_finite == 0 && o[0].last.rays == o[1].last.rays &&
            memcmp(o[0].rgb, o[1].rgb, o[0].number_count * sizeof(float)) == 0,
        t->name,
        "%s: means %.9g and %.9g, rays %llu and %llu, want the same "
        "pictures",
        t->what, o[0].mean, o[1].mean, (unsigned long long)o[0].last.rays,
        (unsigned long long)o[1].last.rays);
    free(o[0].rgb);
    free(o[1].rgb);
}

#endif
