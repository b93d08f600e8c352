// SPDX-License-Identifier: MIT
/*
 * temp_file.h - temporary files that get their final name when they are
 * complete
 *
 * If the file system supports O_TMPFILE, a file has no name while it is
 * written, so that a killed process leaves nothing behind. Elsewhere, and for
 * the moment before it replaces another file, its name is
 * .glim-HOST-PID-NUMBER.
 *
 * Ownership: temp_file_close() closes and frees what temp_file_open() opened;
 *            folders and names stay the caller's
 * Threads:   any; each file from one thread
 * Errors:    false, with errno set
 */
#ifndef GLIM_TEMP_FILE_H
#define GLIM_TEMP_FILE_H

#include <stdbool.h>
#include <sys/types.h>

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

#endif
