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
    char *view_path; /* STEM.view, or the one that was asked for */
    struct warnings report;
    char **warnings; /* report.entry_count lines */

    struct rect crop;
    uint32_t seed;
    int thread_count; /* 0: all that the process may use */
    char *program;    /* that tries devices; NULL: the installed one */

    struct backend *cpu;    /* NULL: not needed yet */
    struct backend *device; /* renders if it is there */
    char *backend_log;
    struct render *render; /* NULL: not needed yet */
    char *saved_name;      /* of glim_save_new() */
    bool has_picture;      /* as the settings are */
    int cancel_fd;         /* readable: somebody has asked for a stop */
};

/* Copies the text to the caller's error, if there is one, and returns false. */
bool handle_fail(struct glim_error *to, const struct error *err);

/* Sets the number of threads of loading and rendering, as glim_set_threads()
 * takes it, without an effect on those that run. */
bool handle_set_threads(struct glim *g, int count, struct error *err);

/* Returns the number of threads, at least 1. */
int handle_threads(const struct glim *g);

struct glim_progress handle_progress(const struct render_progress *p);

/* Frees the renderer and the threads of the CPU, which the next glim_render()
 * makes anew. */
void handle_drop_render(struct glim *g);

#endif
