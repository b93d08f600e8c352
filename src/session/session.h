// SPDX-License-Identifier: MIT
/*
 * session.h - a scene, its view and its renderer: what batch mode and the
 * screen have in common
 *
 * Units:     as view.h and command_line.h
 * Ownership: session_close() frees all
 * Threads:   main only
 * Errors:    session_open() says what is wrong with which file
 */
#ifndef GLIM_SESSION_H
#define GLIM_SESSION_H

#include "scene/world.h"
#include "render/render_loop.h"
#include "render/render_rates.h"
#include "session/backends.h"
#include "session/command_line.h"
#include "session/edit_history.h"
#include "session/file_watch.h"

struct session {
    const struct options *options;
    struct scene scene;
    struct host_world world; /* made of the scene and the edit */
    struct edit edit; /* materials, light, camera, as they are to be rendered */
    uint32_t rendered_version; /* of the edit */
    struct pose opened_pose;   /* the camera as loaded, to go back to */
    struct rect crop;          /* of the picture, that is rendered */
    char *view_path;  /* where the view is kept: STEM.view or -c FILE */
    char notice[256]; /* one line for the person, or "" */
    struct warnings report;
    uint32_t files_version; /* counts changes of what session_watch() adds */
    struct backends backends;
    struct render *render;
    uint64_t start_ns; /* of the program */
    uint64_t load_ns;
    uint64_t restart_ns; /* when session_restart() last started the render */
    int draft_width, draft_height; /* of what will be seen live; 0: nothing */
    enum sample_kind sample;       /* what will be seen live */
    /* of the render since then */
    struct speeds speeds;
    struct thread_load load;
};

/* Loads scene, view and sky, applies the options, frames and lights what has
 * no camera and no light. Nothing is rendered yet. session_close() is due also
 * after an error, which may leave warnings in the report. */
bool session_open(struct session *s, const struct options *options,
                  uint64_t start_ns, struct error *err);

/* The part of it that reads files: for another session to take. */
bool session_load(struct session *s, const struct options *options,
                  uint64_t start_ns, struct error *err);

/* Halts, and takes what `fresh` has loaded of the same files. The camera and
 * its steps of undo stay, but for what the view file has changed. What was
 * loaded before is in `fresh` then. session_restart() is due. */
void session_take_loaded(struct session *s, struct session *fresh);

/* Adds all files that the session was loaded from, and those that would be
 * read if they were there. */
void session_watch(const struct session *s, struct file_watch *watch);

/* False, with a message, if what the option names would be written over one of
 * these files. */
bool session_check_output(const struct session *s, const char *option,
                          const char *path, struct error *err);

/* Halts and starts from sample 0 with what the edit shows. spp 0: no
 * limit. */
bool session_restart(struct session *s, uint64_t spp, struct error *err);

/* The same, but it halts after the first sample of every pixel. */
bool session_step(struct session *s, uint64_t spp, struct error *err);

/* Returns true if what is to be shown has changed since session_restart(): more
 * than its development. */
bool session_is_outdated(const struct session *s);

/* As the light says that is shown. */
struct develop session_develop(const struct session *s);

/* How far the render is. To be called some times a second, for the speeds. */
struct render_progress session_progress(struct session *s);

/* True if an OpenCL device renders. */
bool session_uses_device(const struct session *s);

void session_close(struct session *s);

#endif
