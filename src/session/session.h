// SPDX-License-Identifier: MIT
/*
 * session.h - an open scene with its edit and its renderer, shared by batch
 * mode and the interactive program
 *
 * Units:     as view.h and command_line.h
 * Ownership: session_close() frees all; the options are the caller's
 * Threads:   main only; session_load() any
 * Errors:    session_open() and session_load() name the file
 */
#ifndef GLIM_SESSION_H
#define GLIM_SESSION_H

#include "scene/world.h"
#include "render/error_history.h"
#include "render/render_loop.h"
#include "render/render_metadata.h"
#include "render/render_rates.h"
#include "session/backends.h"
#include "session/command_line.h"
#include "session/edit.h"
#include "session/file_watch.h"
#include "session/video_pipe.h"

struct session {
    const struct options *options;
    struct scene scene;
    struct host_world world; /* made from the scene and the edit */
    /* current materials, light and camera */
    struct edit edit;
    uint32_t rendered_version; /* edit.version at the last restart */
    struct pose opened_pose;   /* camera as loaded */
    struct rect crop;          /* part of the picture to render */
    char *view_path;           /* path of the view file: STEM.view or -c FILE */
    char notice[256];          /* one line for the status line, or "" */
    struct warnings report;
    /* counts changes of the list of session_watch() */
    uint32_t files_version;
    struct backends backends;
    struct render *render;
    uint64_t start_ns; /* start of the program */
    uint64_t load_ns;
    /* time of the last session_restart() or session_step() */
    uint64_t restart_ns;
    /* size of the draft for live mode, in pixels; 0: no draft */
    int draft_width, draft_height;
    enum sample_kind sample; /* samples to be shown in live mode */
    bool is_filtered;        /* the screen's picture is to be filtered */
    bool draft_has_surfaces; /* of the last restart in live mode */
    bool is_denoised;        /* a filtered picture was written */
    struct video_pipe video; /* of batch mode's pictures, if it is open */
    /* of batch mode's films: what decides the samples, the index of the first
     * one, and the samples to go on from (NULL: none) */
    struct film_identity film_identity;
    uint64_t first_sample;
    struct film_file *from;
    /* measured since restart_ns */
    struct speeds speeds;
    struct error_history errors;
    struct thread_load load;
};

/* Loads scene, view and sky and applies the options. A scene without a camera
 * is framed, one without light gets a soft sky. Rendering does not start yet.
 * The caller calls session_close() also after an error, when the report may
 * have warnings. */
bool session_open(struct session *s, const struct options *options,
                  uint64_t start_ns, struct error *err);

/* Loads the files only, for session_take_loaded() of another session. */
bool session_load(struct session *s, const struct options *options,
                  uint64_t start_ns, struct error *err);

/* Halts and exchanges the loaded files with `fresh`, a later load of the same
 * files, which the caller closes. Camera and its undo steps stay, except values
 * that the view file has changed. The caller calls session_restart() next. */
void session_take_loaded(struct session *s, struct session *fresh);

/* Adds the files that the session was loaded from, and those that would be
 * loaded if they existed. */
void session_watch(const struct session *s, struct file_watch *watch);

/* Returns false, with an error, if the output path of an option is a file that
 * the session reads. */
bool session_check_output(const struct session *s, const char *option,
                          const char *path, struct error *err);

/* Halts and starts from sample 0 with the shown state of the edit. Without a
 * limit it is the render of live mode, which begins with a draft. */
bool session_restart(struct session *s, struct render_limits limits,
                     struct error *err);

/* Restarts in the same way, and halts after the first sample of every pixel. */
bool session_step(struct session *s, struct render_limits limits,
                  struct error *err);

/* Returns true if the edit has changed since the last restart in more than
 * exposure and tone. */
bool session_is_outdated(const struct session *s);

/* Returns exposure and tone of the shown state of the edit. */
struct develop session_develop(const struct session *s);

/* Returns the kernel features that renders of the session need. */
uint32_t session_features(const struct session *s);

/* Returns the progress of the render and adds it to the speeds and errors. Call
 * it several times per second. */
struct render_progress session_progress(struct session *s);

/* Returns the metadata of the picture as it is now, or of its filtered copy. */
struct image_metadata session_metadata(const struct session *s,
                                       bool is_denoised);

/* Returns true if an OpenCL device renders. */
bool session_uses_device(const struct session *s);

void session_close(struct session *s);

#endif
