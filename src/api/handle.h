// SPDX-License-Identifier: MIT
/*
 * handle.h - members of struct glim
 *
 * Threads:   as in glim.h
 */
#ifndef GLIM_HANDLE_H
#define GLIM_HANDLE_H

#include "glim/glim.h"

#include "base/error.h"
#include "base/warnings.h"
#include "render/render_loop.h"
#include "scene/scene.h"
#include "scene/view.h"
#include "scene/world.h"

struct glim {
    struct scene scene;
    struct host_world world;
    struct view view;
    char *view_path; /* path of the view file, which may not exist */
    struct warnings report;
    char **warnings; /* report.entry_count lines */

    struct rect crop;
    uint32_t seed;
    int thread_count; /* 0: all processors of the process */
    char *program;    /* path of glim, whose copies run the code of others */

    struct backend *cpu;    /* NULL until needed */
    struct backend *device; /* renders unless NULL */
    char *backend_log;
    struct render *render; /* NULL until needed */
    char *saved_name;      /* result of glim_save_new() */
    bool has_picture;      /* there is a picture of the current settings */
    double error_limit;    /* of glim_render(); 0: none */
    bool is_adaptive;
    bool wants_denoise;        /* the film has what the filter needs */
    uint32_t device_features;  /* of the device's kernels */
    struct film filtered;      /* of the film with this many samples */
    uint64_t filtered_samples; /* 0: none */
    int cancel_fd;             /* readable after glim_cancel() */
};

/* Copies the text to the caller's error, if that is not NULL. Returns false. */
bool handle_fail(struct glim_error *to, const struct error *err);

/* Fails, with `what` as the place, if the pointer is NULL. */
bool handle_given(const void *pointer, const char *what,
                  struct glim_error *err);

/* Sets the number of threads of loading and rendering, as glim_set_threads()
 * takes it, without an effect on those that run. */
bool handle_set_threads(struct glim *g, int count, struct error *err);

/* Returns the number of threads, at least 1. */
int handle_threads(const struct glim *g);

/* Converts the progress of the renderer to that of the interface. */
struct glim_progress handle_progress(const struct render_progress *p);

/* Describes a new picture with the current settings, without limits. */
bool handle_prepare(struct glim *g, struct render_job *job, struct error *err);

/* Starts a picture that was prepared. */
bool handle_start(struct glim *g, const struct render_job *job,
                  struct error *err);

/* Frees the filtered picture. */
void handle_drop_filtered(struct glim *g);

/* Frees the renderer and the threads of the CPU backend. The next glim_render()
 * creates them again. */
void handle_drop_render(struct glim *g);

#endif
