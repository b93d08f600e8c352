// SPDX-License-Identifier: MIT
/*
 * autosave.h - keeps the session in a file while it runs, and offers what
 * an earlier session of the scene has left
 *
 * A session is kept if it has unsaved changes or has rendered for 5 seconds.
 * Its file is written at once after a change, every minute and at an end that
 * nobody has asked for, and removed when the person quits. What is offered
 * stays until it is taken or dropped: before this session is written, the
 * offered file is set aside under another name. Of several programs with the
 * same scene, only the first one keeps its session.
 *
 * Ownership: autosave_free() frees; the rest is the caller's
 * Threads:   main only
 * Errors:    become messages
 */
#ifndef GLIM_AUTOSAVE_H
#define GLIM_AUTOSAVE_H

#include "session/autosave_file.h"
#include "session/live_render.h"
#include "studio/camera/camera_control.h"

struct autosave {
    struct live_render *control;
    struct camera_control *camera;
    char *scene;
    char *path;             /* of this session's file; NULL: nothing is kept */
    char *aside;            /* of an offered file that is set aside */
    int lock_fd;            /* -1: another program keeps the scene's session */
    int timer_fd;           /* readable when autosave_write() is due */
    const char *offer_path; /* path or aside; NULL: nothing is offered */
    bool drops_aside;       /* after the next file, as it was taken over */
    bool is_hurried;        /* the timer is set to a change */
    bool writes_edits;      /* the last file has unsaved changes */
    uint32_t changes;       /* of the edit, when the timer was set */
    bool has_file;       /* the file is there and this session's to replace */
    bool has_failed;     /* the last file; said once */
    bool has_said_large; /* that the film is too large */
    uint64_t written_hash, written_samples; /* of the last file */
};

/* Looks for a file of the scene. offer_path says that one is found, and a
 * message what it has. */
void autosave_init(struct autosave *k, struct live_render *control,
                   struct camera_control *camera);

/* Restores the offered session: view, edits, and the film if it is of the
 * same picture. */
void autosave_go_on(struct autosave *k);

/* Removes the offered session. */
void autosave_drop(struct autosave *k);

/* Sets the timer to the next file if there are new unsaved changes. */
void autosave_note_changes(struct autosave *k);

/* Starts to write the session if it is worth it and has changed. */
void autosave_write(struct autosave *k);

/* Handles the readable event_fd of the control's keeping thread. */
void autosave_finish(struct autosave *k);

/* Writes the session at the end if is_lost; removes its file otherwise. An
 * offer that was neither taken nor dropped stays. The render is halted. */
void autosave_end(struct autosave *k, bool is_lost);

void autosave_free(struct autosave *k);

#endif
