// SPDX-License-Identifier: MIT
/*
 * file.h - reads and writes whole files, and takes paths apart
 *
 * Units:     bytes
 * Ownership: file_read() and the path functions return memory for free();
 *            temp_file_close() closes and frees what temp_file_open() opened
 * Threads:   any; each temporary file from one thread
 * Errors:    the system's words, with the path; the path functions return NULL
 *            when memory is out; temporary files false, with errno set
 */
#ifndef GLIM_FILE_H
#define GLIM_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>
#include <time.h>

#include "base/error.h"

/* ---- temporary files ---- */

/*
 * If the file system supports O_TMPFILE, a file has no name while it is
 * written, so that a killed process leaves nothing behind. Elsewhere, and for
 * the moment before it replaces another file, its name is
 * .glim-HOST-PID-NUMBER.
 */

struct temp_file {
    int fd;
    char *name; /* NULL while the file has no name */
    const char *folder;
};

/* Opens a file for writing in the folder. Fails if has_name is false and the
 * file system does not support O_TMPFILE. */
bool temp_file_open(struct temp_file *t, const char *folder, bool has_name,
                    mode_t mode);

/* Gives the file its final name in the same folder in one step, so that readers
 * see the old file or the whole new one. Replaces an existing file, or fails
 * with EEXIST if must_be_new. */
bool temp_file_publish(struct temp_file *t, const char *target,
                       bool must_be_new);

/* Closes the file and removes its temporary name if it still has one. Returns
 * false if close() fails; otherwise errno is kept. */
bool temp_file_close(struct temp_file *t);

/* Removes abandoned temporary files of this user in the folder: those of dead
 * processes of this host, and all that are older than a day. */
void temp_file_sweep(const char *folder);

/* ---- files ---- */

/* Size limit of file_read(). */
#define FILE_BYTES_MAX ((int64_t)8 << 30)

/* Reads a regular file (a folder or a device is an error). text[size_bytes]
 * is a NUL that is not counted. */
bool file_read(const char *path, char **text, size_t *size_bytes,
               struct error *err);

/* Fails where file_read() would; otherwise tells how much it would read. */
bool file_measure(const char *path, size_t *size_bytes, struct error *err);

/* Returns the bytes of all files that the program has read so far. Any thread
 * may call it. */
uint64_t file_bytes_read(void);

/* A file in memory: not owned. */
struct file_bytes {
    const char *path;
    const void *bytes;
    size_t size_bytes;
};

/* Reads standard input to its end, of the same sizes. */
bool file_read_stdin(char **text, size_t *size_bytes, struct error *err);

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
    bool is_kept; /* the old version is kept as NAME~ */
};

/* Fails where file_write() would, without changing anything: for a folder, a
 * device, a missing folder, without permission. */
bool file_check(const char *path, struct error *err);

/* Replaces the file atomically: a temporary file in its folder is written,
 * synced and given the name at last. Keeps the permissions of an
 * existing file. Writes through symbolic links. If must_be_new, an existing
 * file is left alone and *exists (may be NULL) is set. */
bool file_write(const char *path, const void *data, size_t size_bytes,
                bool must_be_new, bool *exists, struct error *err);

/* Writes as file_write() does, but fails if the file differs from
 * change->before, so that no change by others is lost. Sets change->after to
 * the new file. */
bool file_replace(const char *path, const void *data, size_t size_bytes,
                  struct file_change *change, struct error *err);

/* Writes the file under the first free name of STEM.ENDING, STEM-2.ENDING,
 * STEM-3.ENDING and so on. Never replaces a file. Returns the name for free(),
 * or NULL on failure. */
char *file_write_numbered(const char *stem, const char *ending,
                          const void *data, size_t size_bytes,
                          struct error *err);

/* Writes all bytes to a pipe, even if it is non-blocking. Returns false and
 * errno on failure. */
bool file_write_pipe(int fd, const void *data, size_t size_bytes);

/* Writes all bytes to standard output, as file_write_pipe(). */
bool file_write_stdout(const void *data, size_t size_bytes, struct error *err);

/* Locks the name of a file, which need not exist, for this process: returns a
 * descriptor that keeps the lock until it is closed, also by the death of the
 * process. Returns -1 and an error if another process of this machine has the
 * lock. Systems without such locks let all have it. */
int file_lock(const char *path, struct error *err);

/* Makes the folder and its missing parents, with access for this user only.
 * Writes to `path` while it runs and restores it. Returns false and errno on
 * failure. */
bool folder_make(char *path);

/* Returns the path of `name` relative to the folder of `beside`. An absolute
 * name is not changed. */
char *path_beside(const char *beside, const char *name);

/* Returns the name of `path` for use in the file `beside`: relative if it lies
 * in the folder of `beside` or below, else absolute. */
char *path_seen_from(const char *beside, const char *path);

/* Returns true if both paths name the same file, which may not exist yet. */
bool path_is_same(const char *a, const char *b);

/* Returns a pointer to the last part of the path. */
const char *path_name(const char *path);

/* Returns the path without the ending of its last part: a/b.obj gives a/b. */
char *path_stem(const char *path);

/* Does the same for a file that is read: a/b.obj.gz gives a/b, and "-", which
 * stands for standard input, gives "scene". */
char *path_stem_of_input(const char *path);

#endif
