// SPDX-License-Identifier: MIT
/*
 * render_control.h - what the screen renders: live and normal mode, starting
 * and halting, on which backend, files that change, messages about it
 *
 * Live mode renders without a limit and starts anew at every change. Normal
 * mode renders one view to the samples of -s; it can be halted, and what it has
 * made is not thrown away unasked.
 *
 * Units:     nanoseconds of clock_ns(), samples of all pixels together
 * Ownership: the session stays the caller's; render_control_free() frees the
 * rest Threads:   main only Errors:    become messages, but for
 * render_control_init()
 */
#ifndef GLIM_RENDER_CONTROL_H
#define GLIM_RENDER_CONTROL_H

#include <stdbool.h>
#include <stdint.h>

#include "session/reload.h"
#include "session/save_thread.h"
#include "session/session.h"

struct message {
    char text[sizeof(struct error)];
    bool is_error; /* stays until a key */
    uint64_t said_ns;
    uint64_t until_ns; /* 0: none */
};

struct render_control {
    struct session *session;
    struct save_thread saver;
    struct reload reload;
    struct file_watch watch;
    struct render_progress
        progress; /* as of the last render_control_update() */
    struct message message;

    bool is_live;
    bool is_started;  /* normal mode: a render was begun */
    bool is_halted;   /* by the person */
    bool has_changed; /* there is something new to show; the screen clears it */
    bool has_changed_files; /* since they were loaded */
    uint64_t files_ns;      /* when to look at them, or load them with --watch;
                               UINT64_MAX: when the watch says so */
    uint32_t watched_version; /* of the session's files */
    uint64_t restarted_ns;

    uint64_t saved_samples;  /* of this picture, in a file */
    uint64_t saving_samples; /* that the saver will have written */
    char saving_what[64];    /* its size and samples */

    char **results; /* a line for each file */
    int result_count;
};

/* Starts to render in live mode. */
bool render_control_init(struct render_control *control,
                         struct session *session, struct error *err);

/* Shown for a while, or for longer; an error stays until a key, and so long at
 * least. */
void render_control_say(struct render_control *control, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void render_control_say_long(struct render_control *control, const char *format,
                             ...) __attribute__((format(printf, 2, 3)));
void render_control_say_error(struct render_control *control, const char *text);

/* The status line comes back. */
void render_control_clear_message(struct render_control *control);

/* A key was pressed: an error goes, at its time. It may have come while
 * somebody typed on. */
void render_control_acknowledge_error(struct render_control *control);

/* The key of an action, for messages that tell what to do next. */
struct keymap_name render_control_key(const struct render_control *control,
                                      enum action action);

/* Printed when the screen is closed. */
void render_control_add_result(struct render_control *control,
                               const char *text);

/* Returns true if the picture is of an older version of the edit, and will be
 * rendered anew: in live mode. */
bool render_control_is_outdated(const struct render_control *control);

/* Looks how far the render is, and restarts it if it is outdated and the look
 * before has found a picture. */
void render_control_update(struct render_control *control);

/* Restarts now if it is outdated, for what is to be done with the film. */
void render_control_restart_if_outdated(struct render_control *control);

/* True until there is a picture to show after a restart: a rough one, and where
 * a draft is soon whole, that. */
bool render_control_awaits_picture(const struct render_control *control);

/* True if a normal render would be lost. */
bool render_control_has_unsaved(const struct render_control *control);

/* True if what was changed of materials or light would be lost. */
bool render_control_has_unsaved_edit(const struct render_control *control);

/* True if the view may change now; else a message says when. */
bool render_control_may_move(struct render_control *control);

/* Loses what normal mode has rendered. */
void render_control_set_live(struct render_control *control, bool is_live);

/* In normal mode the first time starts the render. */
void render_control_start_or_halt(struct render_control *control);

/* One more sample for every pixel, then a halt. */
void render_control_step(struct render_control *control);

/* Renders the same anew; loses what normal mode has rendered. */
void render_control_restart(struct render_control *control);

/* From the CPU to the OpenCL device, which is brought up first if need be, or
 * back. A new picture begins: no film is made by both. */
void render_control_switch_backend(struct render_control *control);

/* Brings the device up in the background; the CPU draws on. */
void render_control_begin_device(struct render_control *control);

/* The start's event_fd is readable: takes the device, or says why not. */
void render_control_end_device(struct render_control *control);

/* The watch's fd is readable: have files of the scene changed? */
void render_control_check_files(struct render_control *control);

/* Begins to load the files of the scene anew; what is rendered stays until the
 * reload's event_fd says, in live mode, that render_control_end_reload() has
 * the result. An error, then render_control_end_reload() is false, leaves the
 * old scene. What is edited and not saved would be lost: it is refused. */
void render_control_reload(struct render_control *control);
bool render_control_end_reload(struct render_control *control);

void render_control_free(struct render_control *control);

#endif
