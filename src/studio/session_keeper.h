// SPDX-License-Identifier: MIT
/*
 * session_keeper.h - keeps the session in a file while it runs, and offers what
 * an earlier session of the scene has left
 *
 * A session is kept if it has unsaved changes or has rendered for 5 seconds.
 * Its file is written every minute and at an end that nobody has asked for, and
 * removed when the person quits. Of several programs with the same scene, only
 * the first one keeps its session.
 *
 * Ownership: session_keeper_free() frees; the rest is the caller's
 * Threads:   main only
 * Errors:    become messages
 */
#ifndef GLIM_SESSION_KEEPER_H
#define GLIM_SESSION_KEEPER_H

#include "session/kept_folder.h"
#include "studio/camera_control.h"
#include "studio/render_control.h"

struct session_keeper {
    struct render_control *control;
    struct camera_control *camera;
    char *scene, *path; /* path NULL: nothing is kept */
    int lock_fd;        /* -1: another program keeps the scene's session */
    int timer_fd;       /* readable when session_keeper_write() is due */
    struct kept offer;  /* head of the file that was found */
    bool has_offer;     /* the person has not answered yet */
    char question[KEPT_TEXT_BYTES + 64];
    bool has_file;       /* the file is there and this session's to replace */
    bool has_failed;     /* the last file; said once */
    bool has_said_large; /* that the film is too large */
    uint64_t written_hash, written_samples; /* of the last file */
};

/* Looks for a file of the scene. has_offer says that one is found. */
void session_keeper_init(struct session_keeper *k,
                         struct render_control *control,
                         struct camera_control *camera);

/* Restores the offered session: view, edits, and the film if it is of the
 * same picture. */
void session_keeper_go_on(struct session_keeper *k);

/* Declines the offer. The next file replaces the offered one. */
void session_keeper_start_anew(struct session_keeper *k);

/* Starts to write the session if it is worth it and has changed. */
void session_keeper_write(struct session_keeper *k);

/* Handles the readable event_fd of the control's keeping thread. */
void session_keeper_finish(struct session_keeper *k);

/* Writes the session at the end if is_lost; removes its file otherwise. An
 * offer without an answer stays for the next session. The render is halted. */
void session_keeper_end(struct session_keeper *k, bool is_lost);

void session_keeper_free(struct session_keeper *k);

#endif
