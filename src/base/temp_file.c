// SPDX-License-Identifier: MIT
#include "base/temp_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/hash.h"
#include "base/memory.h"

/* Names that are tried. Names contain the clock, so one usually suffices. */
#define TRIES 100

/* Age in seconds from which files of other hosts are swept too. Their process
 * numbers mean nothing here, and their clocks may differ. */
#define OLD_S (24 * 60 * 60)

/* Returns a hash of the boot and of the process namespace, within which process
 * numbers are unique; 0 if they are not known. Each container has its own
 * namespace. */
static uint32_t host_id(void)
{
    char boot[64];
    struct stat space;
    int fd = open("/proc/sys/kernel/random/boot_id", O_RDONLY | O_CLOEXEC);
    ssize_t length = fd >= 0 ? read(fd, boot, sizeof boot) : -1;
    uint64_t hash;

    if (fd >= 0)
        close(fd);
    if (length <= 0 || stat("/proc/self/ns/pid", &space) != 0)
        return 0;
    hash = hash_bytes(HASH_BEGIN, boot, (size_t)length);
    hash = hash_number(hash, (uint64_t)space.st_ino);
    return (uint32_t)(hash >> 32) | 1;
}

#define NAME_BYTES 40

static void format_name(char name[NAME_BYTES], uint32_t host, int pid,
                        unsigned number)
{
    snprintf(name, NAME_BYTES, ".glim-%08" PRIx32 "-%d-%08x", host, pid,
             number);
}

/* Returns a new name for free(), or NULL and ENOMEM if memory is out. */
static char *new_name(const char *folder, unsigned try)
{
    char name[NAME_BYTES];

    format_name(name, host_id(), (int)getpid(), (unsigned)clock_ns() + try);
    return format_text("%s/%s", folder, name);
}

static bool open_named(struct temp_file *t, mode_t mode)
{
    for (unsigned i = 0; i < TRIES; i++) {
        t->name = new_name(t->folder, i);
        if (!t->name)
            return false;
        t->fd = open(t->name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
        if (t->fd >= 0)
            return true;
        free(t->name);
        t->name = NULL;
        if (errno != EEXIST)
            break;
    }
    return false;
}

bool temp_file_open(struct temp_file *t, const char *folder, bool has_name,
                    mode_t mode)
{
    *t = (struct temp_file){.fd = -1, .folder = folder};
    if (has_name)
        return open_named(t, mode);
    t->fd = open(folder, O_TMPFILE | O_WRONLY | O_CLOEXEC, mode);
    return t->fd >= 0;
}

/* Gives an unnamed file this name. Fails if the name is taken. */
static bool link_unnamed(const struct temp_file *t, const char *path)
{
    char self[64];

    snprintf(self, sizeof self, "/proc/self/fd/%d", t->fd);
    return linkat(AT_FDCWD, self, AT_FDCWD, path, AT_SYMLINK_FOLLOW) == 0;
}

static bool link_temporarily(struct temp_file *t)
{
    for (unsigned i = 0; i < TRIES; i++) {
        char *name = new_name(t->folder, i);
        if (name && link_unnamed(t, name)) {
            t->name = name;
            return true;
        }
        free(name);
        if (errno != EEXIST)
            break;
    }
    return false;
}

static void forget_name(struct temp_file *t)
{
    free(t->name);
    t->name = NULL;
}

/* Publishes by link(), which never replaces a file. File systems without links
 * have a rename that does not replace either. */
static bool publish_new(struct temp_file *t, const char *target)
{
    if (link(t->name, target) == 0)
        return true; /* temp_file_close() removes the temporary name */
    if ((errno != EPERM && errno != EOPNOTSUPP) ||
        renameat2(AT_FDCWD, t->name, AT_FDCWD, target, RENAME_NOREPLACE) != 0)
        return false;
    forget_name(t);
    return true;
}

bool temp_file_publish(struct temp_file *t, const char *target,
                       bool must_be_new)
{
    if (!t->name) {
        if (link_unnamed(t, target))
            return true;
        if (errno != EEXIST || must_be_new || !link_temporarily(t))
            return false;
    } else if (must_be_new) {
        return publish_new(t, target);
    }
    if (rename(t->name, target) != 0)
        return false;
    forget_name(t);
    return true;
}

bool temp_file_close(struct temp_file *t)
{
    int reason = errno;
    bool ok;

    if (t->name)
        unlink(t->name);
    forget_name(t);
    errno = reason;
    ok = t->fd < 0 || close(t->fd) == 0;
    t->fd = -1;
    return ok;
}

/* Parses a temporary name. Returns false unless format_name() makes exactly the
 * same text of its numbers. */
static bool parse_name(const char *name, uint32_t *host, int *pid)
{
    char same[NAME_BYTES];
    unsigned number;

    if (sscanf(name, ".glim-%8" SCNx32 "-%d-%8x", host, pid, &number) != 3)
        return false;
    format_name(same, *host, *pid, number);
    return strcmp(name, same) == 0 && *pid > 0;
}

static bool is_left_over(int folder, const char *name, uint32_t here)
{
    uint32_t host;
    struct stat st;
    int pid;

    if (!parse_name(name, &host, &pid) ||
        fstatat(folder, name, &st, AT_SYMLINK_NOFOLLOW) != 0 ||
        !S_ISREG(st.st_mode) || st.st_uid != geteuid())
        return false;
    if (host != 0 && host == here && kill(pid, 0) != 0 && errno == ESRCH)
        return true;
    return time(NULL) - st.st_mtime > OLD_S;
}

void temp_file_sweep(const char *folder)
{
    DIR *entries = opendir(folder);
    uint32_t here = host_id();
    struct dirent *entry;

    if (!entries)
        return;
    while ((entry = readdir(entries)) != NULL)
        if (is_left_over(dirfd(entries), entry->d_name, here))
            unlinkat(dirfd(entries), entry->d_name, 0);
    closedir(entries);
}
