// SPDX-License-Identifier: MIT
/*
 * file_watch.h - notices that files have changed
 *
 * Editors write a new file and rename it, so the folders are watched; what has
 * changed is what the files themselves say then (stat). A file that is gone is
 * about to come back: until it is there again nothing counts as changed.
 *
 * Ownership: paths are copied; file_watch_free() frees
 * Threads:   one at a time
 * Errors:    none: where folders cannot be watched fd is -1, and the caller
 *            looks from time to time
 */
#ifndef GLIM_FILE_WATCH_H
#define GLIM_FILE_WATCH_H

#include <stdbool.h>
#include <stddef.h>

#include "base/file.h"

struct watched;

struct file_watch {
    int fd; /* readable when something happens in one of the folders */
    struct watched *files;
    size_t file_count, capacity;
};

void file_watch_init(struct file_watch *w);

/* Begins a new list of files. What was known of files stays known; those that
 * are gone stay on the list. */
void file_watch_begin(struct file_watch *w);

/* Adds a file, which need not exist, as it is now. */
void file_watch_add(struct file_watch *w, const char *path);

/* Ends the list: watches the folders. */
void file_watch_end(struct file_watch *w);

/* Makes fd wait for what comes next. */
void file_watch_drain(struct file_watch *w);

/* True if a file is not as it was known, and none is gone. */
bool file_watch_has_changed(const struct file_watch *w);

/* Whether one of the files is this one, by whatever name. */
bool file_watch_has(const struct file_watch *w, const char *path);

/* Each file is known as it is now. */
void file_watch_settle(struct file_watch *w);

/* This program has written the whole file. */
void file_watch_wrote(struct file_watch *w, const char *path,
                      const struct file_identity *identity);

/* It has changed a part of it: if the rest was known before, all is known. */
void file_watch_replaced(struct file_watch *w, const char *path,
                         const struct file_change *change);

void file_watch_free(struct file_watch *w);

#endif
