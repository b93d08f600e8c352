// SPDX-License-Identifier: MIT
/*
 * engine.h - an open scene with its world, its backends (the CPU, and an OpenCL
 * device if one is wanted and available) and the render of its picture: what
 * libglim, batch mode and the interactive program have in common
 *
 * The view belongs to the user of the engine, who may change it between
 * pictures: libglim has one, the interactive program an edit history.
 *
 * Units:     as view.h
 * Ownership: engine_close() frees all; the texts of the options are the
 *            caller's. backends_close() frees after the renderer has
 *            released them
 * Threads:   main only; engine_load() any
 * Errors:    engine_load() names the file; why there is no device
 */
#ifndef GLIM_ENGINE_H
#define GLIM_ENGINE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/warnings.h"
#include "engine/scene_load.h"
#include "render/backend.h"
#include "render/opencl/cl_start.h"
#include "render/render_loop.h"
#include "world/world.h"

/* ---- backends ---- */

struct backends {
    struct backend *cpu;
    struct backend *device; /* NULL if there is none */
    /* the device of this process, which is `device` or belongs to it */
    struct backend *raw_device;
    struct cl_start *start; /* NULL unless it is starting */
    char *verdict;          /* of the device's self-test */
    /* features that its kernels support, or will after the start */
    uint64_t features;
};

/* Creates the backend of the CPU, with the best kernel if `kernel` is NULL. */
bool backends_open(struct backends *b, const struct cpu_kernel *kernel,
                   int thread_count, struct error *err);

/* Starts the device of the request in the background. A running device only
 * gets new kernels. */
bool backends_begin_device(struct backends *b, const struct cl_request *request,
                           struct error *err);

/* Waits for the device. *log, for free(), is the output of drivers, or NULL. */
bool backends_end_device(struct backends *b, char **log, struct error *err);

/* Starts to build kernels for exactly the features of the request, for a
 * running device. The next picture uses them. A failure is not reported, since
 * general kernels exist. */
void backends_specialise(struct backends *b, const struct cl_request *request);

/* Completes a start that backends_specialise() began. Returns true if it
 * did. */
bool backends_end_specialising(struct backends *b);

/* Cancels a start. */
void backends_abandon_device(struct backends *b);

/* Destroys one of them, which the renderer does not use. */
void backends_drop_cpu(struct backends *b);
void backends_drop_device(struct backends *b);

void backends_close(struct backends *b);

/* ---- engines ---- */

/*
 * The view belongs to the user of the engine, who may change it between
 * pictures: libglim has one, the interactive program an edit history.
 */

/* What decides a picture besides the files. Zeroed, all is as these say. */
struct engine_options {
    struct scene_options scene;
    const char *view_path; /* NULL: beside the scene */
    const char *view_text; /* in place of the view file; NULL: none */
    /* instead of those of the view: 0 or false where it keeps its own */
    int width_px, height_px;
    bool has_max_bounces;
    int max_bounces; /* -1: no limit */
    bool has_sun;
    double sun_azimuth_deg, sun_elevation_deg;
    double turbidity;
    bool has_crop;
    struct rect crop;
    uint32_t seed;
    bool is_adaptive;
    bool is_exact;                   /* without light cells, which blur */
    bool wants_filter;               /* films have what the filter needs */
    const struct cpu_kernel *kernel; /* NULL: the best */
    struct cl_request device;        /* features are those of the scene */
};

struct engine {
    struct engine_options options;
    struct scene scene;
    struct host_world world;
    char *view_path; /* path of the view file, which may not exist */
    struct warnings report;
    struct rect crop; /* part of the picture to render */
    struct backends backends;
    struct render *render;     /* NULL before engine_begin() */
    struct film filtered;      /* of the film with this many samples */
    uint64_t filtered_samples; /* 0: none */
};

/* Loads scene, view and sky and applies the options to *view, which is
 * initialised. *file gets the size and the bounces that the view file has. A
 * scene without a camera is framed, one without light gets a soft sky. The
 * caller calls engine_close() also after an error, when the report may have
 * warnings. */
bool engine_load(struct engine *e, const struct engine_options *options,
                 struct view *view, struct view *file, struct error *err);

/* Creates the renderer, idle, unless there is one. */
bool engine_begin(struct engine *e, struct error *err);

/* Halts, and frees the renderer and the threads of the CPU. */
void engine_end(struct engine *e);

/* Halts and exchanges the loaded files with `fresh`, a later load of the same
 * files. Trees that fit are kept. */
void engine_take_loaded(struct engine *e, struct engine *fresh);

/* Sets the rectangle to render, in a picture of the view's size; `place` is for
 * messages. Or sets the whole picture. */
bool engine_set_crop(struct engine *e, const struct view *view,
                     const struct rect *crop, const char *place,
                     struct error *err);
void engine_set_whole(struct engine *e, const struct view *view);

/* Returns the kernel features that pictures need. */
uint64_t engine_features(const struct engine *e, const struct view *view);

/* Returns the request for a device with these features. */
struct cl_request engine_request(const struct engine *e, uint64_t features);

/* Waits for the device of the options, and lets it render. *log, for free(), is
 * the output of drivers, or NULL. */
bool engine_use_device(struct engine *e, const struct view *view, char **log,
                       struct error *err);

/* Lets the CPU render. */
void engine_use_cpu(struct engine *e);

/* Returns true if an OpenCL device renders. */
bool engine_uses_device(const struct engine *e);

/* Fills *world for a view and the options: world_lend(). */
bool engine_lend(const struct engine *e, const struct view *view,
                 struct world *world, struct error *err);

/* Describes a picture of the view from sample 0 on, without limits. The
 * materials are those that the world has. */
bool engine_prepare(struct engine *e, const struct view *view,
                    struct render_job *job, struct error *err);

/* Starts a picture that was prepared. */
bool engine_start(struct engine *e, const struct render_job *job,
                  struct error *err);

/* Returns true if the film can be filtered. */
bool engine_can_filter(const struct engine *e);

/* Returns the filtered film, of the samples so far, or NULL on errors. It stays
 * the engine's, until the next call or start. */
struct film *engine_filtered(struct engine *e, struct error *err);

void engine_close(struct engine *e);

#endif
