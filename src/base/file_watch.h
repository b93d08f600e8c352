// SPDX-License-Identifier: MIT
/*
 * file_watch.h - notices that files have changed
 *
 * Editors write a new file and rename it, so the folders are watched; what has
 * changed is what the files themselves say then (stat). A file that is gone is
 * about to come back: until it is there again nothing counts as changed.
 *
 * Units:     none
 * Ownership: paths are copied; watch_free() frees
 * Threads:   one at a time
 * Errors:    none: where folders cannot be watched fd is -1, and the caller
 *            looks from time to time
 */
#ifndef GLIM_FILE_WATCH_H
#define GLIM_FILE_WATCH_H

#include "base/file.h"

struct watched;

struct watch {
    int fd; /* readable when something happens in one of the folders */
    struct watched *files;
    size_t file_count, capacity;
};

void watch_init(struct watch *w);

/* Begins a new list of files. What was known of files stays known; those that
 * are gone stay on the list. */
void watch_begin(struct watch *w);

/* Adds a file, which need not exist, as it is now. */
void watch_add(struct watch *w, const char *path);

/* Ends the list: watches the folders. */
void watch_end(struct watch *w);

/* Makes fd wait for what comes next. */
void watch_drain(struct watch *w);

/* True if a file is not as it was known, and none is gone. */
bool watch_has_changed(const struct watch *w);

/* Whether one of the files is this one, by whatever name. */
bool watch_has(const struct watch *w, const char *path);

/* Each file is known as it is now. */
void watch_settle(struct watch *w);

/* This program has written the whole file. */
void watch_wrote(struct watch *w, const char *path,
                 const struct file_identity *identity);

/* It has changed a part of it: if the rest was known before, all is known. */
void watch_replaced(struct watch *w, const char *path,
                    const struct file_change *change);

void watch_free(struct watch *w);

#endif
