// SPDX-License-Identifier: MIT
/*
 * file.h - whole files in, whole files out
 *
 * Units:     bytes
 * Ownership: what file_read() and the path functions return is for free()
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

/* No greater file is read. */
#define FILE_BYTES_MAX ((int64_t)8 << 30)

/* Reads a regular file (a folder or a device is an error). text[size_bytes]
 * is a NUL that is not counted. */
bool file_read(const char *path, char **text, size_t *size_bytes,
               struct error *err);

/* What tells a file from the same one later. */
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
    bool is_kept; /* what was before is in a file of the same name with a ~ */
};

/* Fails, early, for what file_write() could not write: a folder, a device, no
 * such folder, no permission. Changes nothing. */
bool file_check(const char *path, struct error *err);

/* Replaces the file atomically: temporary file in its folder, fsync, and the
 * name at last (temp_file.h). Keeps the permissions of a file that was there;
 * replaces what a link points to. If must_be_new, an existing file is left
 * alone and *exists (may be NULL) is set. */
bool file_write(const char *path, const void *data, size_t size_bytes,
                bool must_be_new, bool *exists, struct error *err);

/* As file_write(), but fails if the file is no longer what change->before says:
 * what someone else has written meanwhile is not lost. change->after is the
 * new one then. */
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

/* `name` seen from the folder of `beside`; absolute names stay. */
char *path_beside(const char *beside, const char *name);

/* How the file `beside` names the file at `path`: from its own folder on if the
 * file lies below it, else absolutely. */
char *path_seen_from(const char *beside, const char *path);

/* Would writing to either path write the same file, which may not exist yet? */
bool path_is_same(const char *a, const char *b);

/* The last part of the path, which it points into. */
const char *path_name(const char *path);

/* The path without the ending of its last part: a/b.obj gives a/b. */
char *path_stem(const char *path);

#endif
