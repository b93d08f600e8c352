// SPDX-License-Identifier: MIT
/*
 * file_watch.h - detects changes of files
 *
 * Folders are watched instead of files, because editors write a new file and
 * rename it. An event only causes a look at the files (stat). While a file is
 * written, and for a second while one is missing, nothing counts as changed,
 * since a program is probably replacing it.
 * If folders cannot be watched, fd is -1 and the caller has to poll.
 *
 * Ownership: paths are copied; file_watch_free() frees
 * Threads:   one at a time
 */
#ifndef GLIM_FILE_WATCH_H
#define GLIM_FILE_WATCH_H

#include <stdbool.h>
#include <stddef.h>

#include "base/file.h"

struct watched;

struct file_watch {
    int fd; /* readable after an event in one of the folders */
    struct watched *files;
    size_t file_count, capacity;
    bool is_changing; /* of the last look */
};

void file_watch_init(struct file_watch *w);

/* Begins a new list of files. The known states of files are kept; missing files
 * stay on the list. */
void file_watch_begin(struct file_watch *w);

/* Adds a file, which need not exist, in its present state. */
void file_watch_add(struct file_watch *w, const char *path);

/* Ends the list and watches the folders. */
void file_watch_end(struct file_watch *w);

/* Removes pending events from fd. */
void file_watch_drain(struct file_watch *w);

/* Looks at the files. Returns true if one differs from its known state. If
 * w->is_changing, the caller has to look again in a moment: a file has changed
 * since the last look, is being written, or is missing. */
bool file_watch_has_changed(struct file_watch *w);

/* Returns true if one of the files is this one, by whatever name. */
bool file_watch_has(const struct file_watch *w, const char *path);

/* Fails if the path that an option names is one of the files, which the scene
 * is read from. */
bool file_watch_spares(const struct file_watch *w, const char *option,
                       const char *path, struct error *err);

/* Takes the present state of all files as known, also that one is missing. */
void file_watch_settle(struct file_watch *w);

/* Tells that this program has written the whole file. */
void file_watch_wrote(struct file_watch *w, const char *path,
                      const struct file_identity *identity);

/* Tells that this program has changed a part of the file. If the state before
 * was known, the new state is known. */
void file_watch_replaced(struct file_watch *w, const char *path,
                         const struct file_change *change);

void file_watch_free(struct file_watch *w);

#endif
