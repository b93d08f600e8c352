// SPDX-License-Identifier: MIT
/* Handles: scene, view and settings. */
#include "api/handle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/background.h"
#include "base/memory.h"
#include "world/world_materials.h"

/* The program whose copies run the code of others. */
#ifndef GLIM_PROGRAM
#define GLIM_PROGRAM "glim"
#endif

bool handle_fail(struct glim_error *to, const struct error *err)
{
    _Static_assert(sizeof to->text == sizeof err->text, "one length of texts");

    if (to != NULL)
        memcpy(to->text, err->text, sizeof to->text);
    return false;
}

bool handle_given(const void *pointer, const char *what, struct glim_error *err)
{
    struct error why;

    if (pointer != NULL)
        return true;
    fail(&why, "%s: found NULL, expected a pointer", what);
    return handle_fail(err, &why);
}

const char *glim_version(void)
{
    return GLIM_VERSION;
}

_Static_assert((int)GLIM_UP_Y == SCENE_UP_Y && (int)GLIM_UP_Z == SCENE_UP_Z,
               "axes have the same numbers");

static void take_whole_picture(struct glim *g)
{
    engine_set_whole(&g->engine, &g->view);
    g->has_picture = false;
}

static bool make_warnings(struct glim *g, struct error *err)
{
    size_t count = (size_t)g->engine.report.entry_count;

    g->warnings = alloc_array(count + 1, sizeof *g->warnings);
    for (size_t i = 0; g->warnings != NULL && i < count; i++) {
        g->warnings[i] = warnings_line(&g->engine.report.entries[i]);
        if (g->warnings[i] == NULL)
            return fail(err, "%s: out of memory for warnings",
                        g->engine.scene.path);
    }
    return (g->warnings != NULL && !g->engine.report.has_lost) ||
           fail(err, "%s: out of memory for warnings", g->engine.scene.path);
}

/* Assigns materials to objects according to the view file. */
static bool assign(struct glim *g, struct error *err)
{
    const struct scene *scene = &g->engine.scene;
    uint32_t *assigned = alloc_array(scene->object_count, sizeof *assigned);
    struct material_values *sources =
        alloc_array(scene->material_count, sizeof *sources);
    bool ok = (assigned != NULL && sources != NULL) ||
              fail(err, "%s: out of memory for the materials", scene->path);

    if (ok) {
        scene_find_assigned(scene, &g->view.assigns, assigned,
                            &g->engine.report);
        for (uint32_t i = 0; i < scene->material_count; i++)
            sources[i] = scene->material_origins[i].source;
        ok = world_set_materials(&g->engine.world, scene, scene->material_count,
                                 sources, assigned, err);
    }
    free(sources);
    free(assigned);
    return ok;
}

static bool check_options(const struct glim_open_options *o, struct error *err)
{
    /* unsigned also for compilers whose enumerations are */
    if ((unsigned)o->up > GLIM_UP_Z)
        return fail(err, "up: found %d, expected %d to %d", (int)o->up,
                    GLIM_UP_OF_FILE, GLIM_UP_Z);
    return !o->has_anim_time || isfinite(o->anim_time_s) ||
           fail(err,
                "animation: found a time of %g s, expected a finite number",
                o->anim_time_s);
}

static struct engine_options options_of(const char *path,
                                        const struct glim_open_options *o)
{
    struct engine_options e = {
        .view_path = o->view_path,
        .scene = {.path = path,
                  .up = (enum scene_up)o->up,
                  .camera = o->camera,
                  .choice = {.scene = o->scene,
                             .animation = o->animation,
                             .variant = o->variant,
                             .has_time = o->has_anim_time,
                             .time_s = o->anim_time_s},
                  .view_lines = o->view_lines},
        .turbidity = o->turbidity,
    };

    if (o->sun == NULL)
        return e;
    e.has_sun = true;
    e.sun_azimuth_deg = o->sun->azimuth_deg;
    e.sun_elevation_deg = o->sun->elevation_deg;
    return e;
}

static bool open_all(struct glim *g, const char *path,
                     const struct glim_open_options *o, struct error *err)
{
    struct engine_options how = options_of(path, o);
    struct engine *e = &g->engine;
    struct view file;

    g->program = strdup(o->program != NULL ? o->program : GLIM_PROGRAM);
    if (g->program == NULL)
        return fail(err, "%s: out of memory", path);
    how.device.program = g->program;
    g->cancel_fd = event_fd_open("glim", err);
    if (g->cancel_fd < 0 || !check_options(o, err) ||
        !handle_find_threads(o->threads, &how.scene.thread_count, err) ||
        !engine_load(e, &how, &g->view, &file, err))
        return false;
    /* these texts are the caller's */
    e->options.view_path = NULL;
    e->options.scene =
        (struct scene_options){.path = e->scene.path,
                               .thread_count = how.scene.thread_count};
    return assign(g, err) && make_warnings(g, err);
}

struct glim *glim_open(const char *path,
                       const struct glim_open_options *options,
                       struct glim_error *err)
{
    const struct glim_open_options defaults = {.view_path = NULL};
    struct glim *g;
    struct error why;

    if (!handle_given(path, "scene", err))
        return NULL;
    g = alloc_array(1, sizeof *g);
    if (g == NULL) {
        fail(&why, "%s: out of memory", path);
        handle_fail(err, &why);
        return NULL;
    }
    view_init(&g->view);
    if (!open_all(g, path, options ? options : &defaults, &why)) {
        glim_close(g);
        handle_fail(err, &why);
        return NULL;
    }
    take_whole_picture(g);
    return g;
}

void glim_close(struct glim *g)
{
    if (g == NULL)
        return;
    for (int i = 0; g->warnings != NULL && i < g->engine.report.entry_count;
         i++)
        free(g->warnings[i]);
    free(g->warnings);
    engine_close(&g->engine);
    view_free(&g->view);
    free(g->program);
    free(g->backend_log);
    free(g->saved_name);
    if (g->cancel_fd >= 0)
        close(g->cancel_fd);
    free(g);
}

const char *glim_warning(const struct glim *g, int number)
{
    return g != NULL && number >= 0 && number < g->engine.report.entry_count
               ? g->warnings[number]
               : NULL;
}

const char *glim_file(const struct glim *g, int number)
{
    return g != NULL && number >= 0
               ? scene_file(&g->engine.scene, &g->view, g->engine.view_path,
                            (uint32_t)number)
               : NULL;
}

struct glim_camera glim_get_camera(const struct glim *g)
{
    struct glim_camera camera = {.fovy_deg = 0};
    const struct pose *p;

    if (g == NULL)
        return camera;
    p = &g->view.pose;
    camera.fovy_deg = p->fovy_deg;
    camera.aperture = p->aperture;
    camera.focus = p->focus;
    memcpy(camera.eye, p->eye, sizeof camera.eye);
    memcpy(camera.at, p->at, sizeof camera.at);
    memcpy(camera.up, p->up, sizeof camera.up);
    return camera;
}

bool glim_set_camera(struct glim *g, const struct glim_camera *camera,
                     struct glim_error *err)
{
    struct pose pose, *p = &pose;
    struct error why;

    if (!handle_given(g, "handle", err) || !handle_given(camera, "camera", err))
        return false;
    pose = g->view.pose;
    memcpy(p->eye, camera->eye, sizeof p->eye);
    memcpy(p->at, camera->at, sizeof p->at);
    memcpy(p->up, camera->up, sizeof p->up);
    p->fovy_deg = camera->fovy_deg;
    p->aperture = camera->aperture;
    p->focus = camera->focus;
    if (!pose_check(p, "camera", &why))
        return handle_fail(err, &why);
    if (!(p->aperture >= 0 && p->focus >= 0)) {
        fail(&why,
             "camera: found an aperture of %g and a focus of %g, expected "
             "numbers from 0 on",
             p->aperture, p->focus);
        return handle_fail(err, &why);
    }
    g->view.pose = *p;
    g->view.has_camera = true;
    g->has_picture = false;
    return true;
}

void glim_get_size(const struct glim *g, int *width, int *height)
{
    if (width != NULL)
        *width = g != NULL ? g->view.width_px : 0;
    if (height != NULL)
        *height = g != NULL ? g->view.height_px : 0;
}

bool glim_set_size(struct glim *g, int width, int height,
                   struct glim_error *err)
{
    struct error why;

    if (!handle_given(g, "handle", err))
        return false;
    if (width < 0 || width > VIEW_SIDE_MAX || height < 0 ||
        height > VIEW_SIDE_MAX || (width == 0 && height == 0)) {
        fail(&why, "size: found %dx%d, expected 1 to %d pixels each way", width,
             height, VIEW_SIDE_MAX);
        return handle_fail(err, &why);
    }
    view_set_size(&g->view, width, height);
    take_whole_picture(g);
    return true;
}

bool glim_set_crop(struct glim *g, int x, int y, int width, int height,
                   struct glim_error *err)
{
    struct rect crop = {x, y, width, height};
    struct error why;

    if (!handle_given(g, "handle", err))
        return false;
    if (!engine_set_crop(&g->engine, &g->view, &crop, "crop", &why))
        return handle_fail(err, &why);
    g->has_picture = false;
    return true;
}

bool glim_set_max_bounces(struct glim *g, int count, struct glim_error *err)
{
    struct error why;

    if (!handle_given(g, "handle", err))
        return false;
    if (count < -1) {
        fail(&why, "bounces: found %d, expected a number from 0 on, or -1",
             count);
        return handle_fail(err, &why);
    }
    g->view.max_bounces = count;
    g->has_picture = false;
    return true;
}

void glim_set_seed(struct glim *g, uint32_t seed)
{
    if (g == NULL)
        return;
    g->engine.options.seed = seed;
    g->has_picture = false;
}
