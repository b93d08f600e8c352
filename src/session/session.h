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

#include "engine/engine.h"
#include "render/progress.h"
#include "session/command_line.h"
#include "session/edit.h"
#include "session/file_watch.h"

struct session {
    const struct options *options;
    struct engine engine;
    /* current materials, light and camera */
    struct edit edit;
    uint32_t rendered_version; /* edit.version at the last restart */
    struct pose opened_pose;   /* camera as loaded */
    char notice[256];          /* one line for the status line, or "" */
    /* counts changes of the list of session_watch() */
    uint32_t files_version;
    uint64_t start_ns; /* start of the program */
    uint64_t load_ns;
    /* time of the last session_start() */
    uint64_t restart_ns;
    /* sizes of drafts for live mode, in pixels; 0: no draft. A picture that
     * rests has a fine draft. */
    int draft_width, draft_height;
    int fine_width, fine_height;
    enum sample_kind sample; /* samples to be shown in live mode */
    bool is_filtered;        /* the screen's picture is to be filtered */
    /* of the last start in live mode */
    bool draft_has_surfaces, draft_is_fine;
    /* measured since restart_ns */
    struct speeds speeds;
    struct error_history errors;
    struct thread_load load;
    char *next_scene; /* path that the person opens instead, for free() */
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

/* What a start renders. Zeroed: live mode, from sample 0 on. */
struct session_start {
    struct render_limits limits; /* without one it is live mode with a draft */
    uint64_t steps;              /* halts after this many; 0: no halt */
    uint64_t first_sample;       /* index of the first sample */
    /* samples to go on from, of the same picture, which are taken out of the
     * film; NULL: none */
    struct film_file *from;
    /* live mode as before, but for the draft's size and the kind of samples:
     * the film stays if the edit has not changed */
    bool keeps_film;
    bool draft_is_fine; /* of a film that is kept */
};

/* Halts and starts with the shown state of the edit. */
bool session_start(struct session *s, const struct session_start *start,
                   struct error *err);

/* Starts from sample 0. */
bool session_restart(struct session *s, struct render_limits limits,
                     struct error *err);

/* Gives a material an image as a map, in place of the one that it has. A
 * statement that a new map multiplies becomes 1. Fails for a file that is no
 * image. */
bool session_set_map(struct session *s, uint32_t material, enum mtl_map map,
                     const char *path, struct error *err);

/* Returns true if the edit has changed since the last restart in more than
 * exposure and tone. */
bool session_is_outdated(const struct session *s);

/* Returns exposure and tone of the shown state of the edit. */
struct develop session_develop(const struct session *s);

/* Returns the progress of the render and adds it to the speeds and errors. Call
 * it several times per second. */
struct render_progress session_progress(struct session *s);

void session_close(struct session *s);

#endif
