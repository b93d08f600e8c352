// SPDX-License-Identifier: MIT
/*
 * autosave.h - keeps the session in a file while it runs, and offers what
 * an earlier session of the scene has left
 *
 * A session is kept if it has unsaved changes or has rendered for 5 seconds.
 * Its file is written every minute and at an end that nobody has asked for, and
 * removed when the person quits. Of several programs with the same scene, only
 * the first one keeps its session.
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
    char *scene, *path; /* path NULL: nothing is kept */
    int lock_fd;        /* -1: another program keeps the scene's session */
    int timer_fd;       /* readable when autosave_write() is due */
    struct autosave_file offer; /* head of the file that was found */
    bool has_offer;             /* the person has not answered yet */
    char question[AUTOSAVE_TEXT_BYTES + 64];
    bool has_file;       /* the file is there and this session's to replace */
    bool has_failed;     /* the last file; said once */
    bool has_said_large; /* that the film is too large */
    uint64_t written_hash, written_samples; /* of the last file */
};

/* Looks for a file of the scene. has_offer says that one is found. */
void autosave_init(struct autosave *k, struct live_render *control,
                   struct camera_control *camera);

/* Restores the offered session: view, edits, and the film if it is of the
 * same picture. */
void autosave_go_on(struct autosave *k);

/* Declines the offer. The next file replaces the offered one. */
void autosave_start_anew(struct autosave *k);

/* Starts to write the session if it is worth it and has changed. */
void autosave_write(struct autosave *k);

/* Handles the readable event_fd of the control's keeping thread. */
void autosave_finish(struct autosave *k);

/* Writes the session at the end if is_lost; removes its file otherwise. An
 * offer without an answer stays for the next session. The render is halted. */
void autosave_end(struct autosave *k, bool is_lost);

void autosave_free(struct autosave *k);

#endif
