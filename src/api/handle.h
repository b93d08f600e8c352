// SPDX-License-Identifier: MIT
/*
 * handle.h - members of struct glim
 *
 * Threads:   as in glim.h
 */
#ifndef GLIM_HANDLE_H
#define GLIM_HANDLE_H

#include "glim/glim.h"

#include "engine/engine.h"

struct glim {
    struct engine engine;
    struct view view;
    char **warnings; /* report.entry_count lines */
    char *program;   /* path of glim, whose copies run the code of others */
    char *backend_log;
    char *saved_name;   /* result of glim_save_new() */
    bool has_picture;   /* there is a picture of the current settings */
    double error_limit; /* of glim_render(); 0: none */
    int cancel_fd;      /* readable after glim_cancel() */
};

/* Copies the text to the caller's error, if that is not NULL. Returns false. */
bool handle_fail(struct glim_error *to, const struct error *err);

/* Fails, with `what` as the place, if the pointer is NULL. */
bool handle_given(const void *pointer, const char *what,
                  struct glim_error *err);

/* Finds the number of threads that glim_set_threads() means. */
bool handle_find_threads(int given, int *count, struct error *err);

/* Describes a new picture with the current settings, without limits. */
bool handle_prepare(struct glim *g, struct render_job *job, struct error *err);

#endif
