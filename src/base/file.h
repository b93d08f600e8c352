// SPDX-License-Identifier: MIT
/*
 * file.h - reads and writes whole files, and takes paths apart
 *
 * Units:     bytes
 * Ownership: file_read() and the path functions return memory for free()
 * Threads:   any
 * Errors:    the system's words, with the path; the path functions return NULL
 *            when memory is out
 */
#ifndef GLIM_FILE_H
#define GLIM_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>
#include <time.h>

#include "base/error.h"

/* Size limit of file_read(). */
#define FILE_BYTES_MAX ((int64_t)8 << 30)

/* Reads a regular file (a folder or a device is an error). text[size_bytes]
 * is a NUL that is not counted. */
bool file_read(const char *path, char **text, size_t *size_bytes,
               struct error *err);

/* Identifies a version of a file, to find out later if it has changed. */
struct file_identity {
    bool exists;
    dev_t device;
    ino_t inode;
    off_t size_bytes;
    struct timespec modified;
};

struct file_identity file_identify(const char *path);
bool file_is_same(const struct file_identity *a, const struct file_identity *b);

/* A file that was read, changed and written again. */
struct file_change {
    struct file_identity before, after;
    bool is_kept; /* the old version is kept in NAME~ */
};

/* Fails early where file_write() would: for a folder, a device, a missing
 * folder, without permission. Changes nothing. */
bool file_check(const char *path, struct error *err);

/* Replaces the file atomically: temporary file in its folder, fsync, and the
 * name at last (temp_file.h). Keeps the permissions of a file that was there;
 * replaces what a link points to. If must_be_new, an existing file is left
 * alone and *exists (may be NULL) is set. */
bool file_write(const char *path, const void *data, size_t size_bytes,
                bool must_be_new, bool *exists, struct error *err);

/* file_write() that fails if the file is not as change->before has it, so that
 * no change by others is lost. Sets change->after to the new file. */
bool file_replace(const char *path, const void *data, size_t size_bytes,
                  struct file_change *change, struct error *err);

/* Writes STEM.ENDING, or STEM-2.ENDING, STEM-3.ENDING, ... : the first name
 * that is free; never replaces a file. The name is for free(); NULL: failed. */
char *file_write_numbered(const char *stem, const char *ending,
                          const void *data, size_t size_bytes,
                          struct error *err);

/* Writes all, also where standard output does not block. */
bool file_write_stdout(const void *data, size_t size_bytes, struct error *err);

/* Makes the folder, and those that it lies in, for this person only. `path` is
 * changed meanwhile. False and errno if that fails. */
bool folder_make(char *path);

/* Returns the path of `name` relative to the folder of `beside`. An absolute
 * name is not changed. */
char *path_beside(const char *beside, const char *name);

/* Returns the name of `path` for use in the file `beside`: relative to the
 * folder of that if it lies below, else absolute. */
char *path_seen_from(const char *beside, const char *path);

/* True if both paths name the same file, which may not exist yet. */
bool path_is_same(const char *a, const char *b);

/* The last part of the path, which it points into. */
const char *path_name(const char *path);

/* The path without the ending of its last part: a/b.obj gives a/b. */
char *path_stem(const char *path);

#endif
