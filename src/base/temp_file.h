// SPDX-License-Identifier: MIT
/*
 * temp_file.h - temporary files that get their final name when they are
 * complete
 *
 * Where the file system supports O_TMPFILE a file has no name while it is
 * written, so that a killed process leaves nothing behind. Elsewhere, and for
 * the moment before it replaces another file, its name is
 * .glim-HOST-PID-NUMBER.
 *
 * Ownership: temp_file_close() closes and frees what temp_file_open() opened;
 *            folders and names stay the caller's
 * Threads:   any; each file from one thread
 * Errors:    false and errno
 */
#ifndef GLIM_TEMP_FILE_H
#define GLIM_TEMP_FILE_H

#include <stdbool.h>
#include <sys/types.h>

struct temp_file {
    int fd;
    char *name; /* NULL: it has none */
    const char *folder;
};

/* Opens a file for writing in the folder. Fails if it shall have no name and
 * the file system does not know such files. */
bool temp_file_open(struct temp_file *t, const char *folder, bool has_name,
                    mode_t mode);

/* Gives the file its final name in the same folder, in one step: whoever looks
 * sees the old file or the whole new one. Replaces what is there, or fails with
 * EEXIST if it must be new. */
bool temp_file_publish(struct temp_file *t, const char *target,
                       bool must_be_new);

/* Closes the file, whose temporary name disappears if it still has one. Only
 * the result of close() is told; errno stays otherwise. */
bool temp_file_close(struct temp_file *t);

/* Removes this person's temporary files in the folder that nobody will finish:
 * those of dead processes of this host, and any that is older than a day. */
void temp_file_sweep(const char *folder);

#endif
