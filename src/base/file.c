// SPDX-License-Identifier: MIT
#include "base/file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/hash.h"
#include "base/machine.h"
#include "base/memory.h"
#include "base/stop.h"

/* ---- temporary files ---- */

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

/* ---- files ---- */

/* Limit for a chain of symbolic links, as in the kernel. */
#define LINKS_MAX 40

/* Bytes of standard input that are read at once. */
#define STDIN_STEP_BYTES (1 << 20)

/* Tries to lock a name, and the longest pause between them. */
#define LOCK_TRIES 5
#define LOCK_MS    20

/* Limit for the numbers in file names that are tried. */
#define NUMBER_MAX 100000

/* Fails with the system's message for errno, or with a plainer one. */
static bool fail_errno(struct error *err, const char *path)
{
    switch (errno) {
    case ENOENT: return fail(err, "%s: no such file or folder", path);
    case ENOTDIR:
        return fail(err, "%s: no such file: a part of the path is not a folder",
                    path);
    case ESTALE:
        return fail(err, "%s: found changes by another program, not saved",
                    path);
    case ENAMETOOLONG:
        if (strlen(path) >= PATH_MAX)
            return fail(err,
                        "found a file name of %zu bytes, expected fewer than "
                        "%d: %.40s...",
                        strlen(path), PATH_MAX, path);
        break;
    default: break;
    }
    return fail(err, "%s: %s", path, strerror(errno));
}

static const char *kind_of(mode_t mode)
{
    if (S_ISDIR(mode))
        return "a folder";
    if (S_ISFIFO(mode))
        return "a pipe";
    if (S_ISSOCK(mode))
        return "a socket";
    return "a device";
}

static bool expect_regular(const char *path, const struct stat *st,
                           struct error *err)
{
    return S_ISREG(st->st_mode) || fail(err, "%s: found %s, expected a file",
                                        path, kind_of(st->st_mode));
}

/* Fails for a file larger than the memory limit, before the kernel's
 * out-of-memory killer ends the process. */
static bool expect_size(const char *path, int64_t size_bytes, struct error *err)
{
    struct memory_quota memory = cgroup_quota_memory("");

    if (size_bytes > FILE_BYTES_MAX)
        return fail(err, "%s: found %.1f GiB, expected %d GiB at most", path,
                    (double)size_bytes / (1 << 30),
                    (int)(FILE_BYTES_MAX >> 30));
    return (uint64_t)size_bytes <= memory.size_bytes ||
           fail(err,
                "%s: found %.1f GiB, expected no more than the %.1f GiB "
                "of memory %s",
                path, (double)size_bytes / (1 << 30),
                (double)memory.size_bytes / (1 << 30), memory.place);
}

/* Bytes of one read(), after which they are counted. */
#define READ_BYTES (1 << 24)

static _Atomic uint64_t bytes_read;

/* Reads to the end of the file. Returns the number of bytes, or -1 and errno.
 */
static int64_t read_all(int fd, char *to, int64_t size_bytes)
{
    int64_t done = 0;

    while (done < size_bytes) {
        int64_t rest = size_bytes - done;
        ssize_t n = read(fd, to + done,
                         (size_t)(rest < READ_BYTES ? rest : READ_BYTES));
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return -1;
        if (n == 0)
            break;
        done += n;
        atomic_fetch_add(&bytes_read, (uint64_t)n);
    }
    return done;
}

uint64_t file_bytes_read(void)
{
    return atomic_load(&bytes_read);
}

/* Opens a regular file. Returns -1 after an error. */
static int open_regular(const char *path, int64_t *size_bytes,
                        struct error *err)
{
    /* without O_NONBLOCK, opening a named pipe would wait for a writer */
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    struct stat st;

    if (fd < 0 || fstat(fd, &st) != 0) {
        fail_errno(err, path);
    } else if (expect_regular(path, &st, err) &&
               expect_size(path, st.st_size, err)) {
        *size_bytes = st.st_size;
        return fd;
    }
    if (fd >= 0)
        close(fd);
    return -1;
}

static bool read_open_file(int fd, int64_t size, const char *path, char **text,
                           size_t *size_bytes, struct error *err)
{
    char *memory = alloc_aligned((size_t)size + 1, 1);
    if (!memory)
        return fail(err, "%s: out of memory for its %.1f MiB", path,
                    (double)size / (1 << 20));
    int64_t found = read_all(fd, memory, size);
    if (found < 0) {
        fail_errno(err, path);
        free(memory);
        return false;
    }
    memory[found] = '\0';
    *text = memory;
    *size_bytes = (size_t)found;
    return true;
}

bool file_read(const char *path, char **text, size_t *size_bytes,
               struct error *err)
{
    int64_t size;
    int fd = open_regular(path, &size, err);

    if (fd < 0)
        return false;
    bool ok = read_open_file(fd, size, path, text, size_bytes, err);
    close(fd);
    return ok;
}

bool file_measure(const char *path, size_t *size_bytes, struct error *err)
{
    int64_t size;
    int fd = open_regular(path, &size, err);

    if (fd < 0)
        return false;
    *size_bytes = (size_t)size;
    close(fd);
    return true;
}

bool file_read_stdin(char **text, size_t *size_bytes, struct error *err)
{
    static const char name[] = "standard input";
    size_t size = 0, capacity = 0;
    void *memory = NULL;
    int64_t found;

    do {
        if (!expect_size(name, (int64_t)size, err))
            break;
        if (!grow_array(&memory, &capacity, size + STDIN_STEP_BYTES + 1, 1)) {
            fail(err, "%s: out of memory for its %.1f MiB", name,
                 (double)size / (1 << 20));
            break;
        }
        found = read_all(STDIN_FILENO, (char *)memory + size, STDIN_STEP_BYTES);
        if (found < 0) {
            fail_errno(err, name);
            break;
        }
        size += (size_t)found;
        if (found < STDIN_STEP_BYTES) {
            *text = memory;
            (*text)[size] = '\0';
            *size_bytes = size;
            return true;
        }
    } while (true);
    free(memory);
    return false;
}

static struct file_identity identity_of(const struct stat *st)
{
    return (struct file_identity){true, st->st_dev, st->st_ino, st->st_size,
                                  st->st_mtim};
}

struct file_identity file_identify(const char *path)
{
    struct stat st;

    if (stat(path, &st) != 0)
        return (struct file_identity){.exists = false};
    return identity_of(&st);
}

bool file_is_same(const struct file_identity *a, const struct file_identity *b)
{
    return a->exists == b->exists && a->device == b->device &&
           a->inode == b->inode && a->size_bytes == b->size_bytes &&
           a->modified.tv_sec == b->modified.tv_sec &&
           a->modified.tv_nsec == b->modified.tv_nsec;
}

/* Returns the folder of a path for free(), or NULL if memory is out. */
static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');

    if (!slash)
        return strdup(".");
    return slash == path ? strdup("/") : strndup(path, (size_t)(slash - path));
}

/* Follows the symbolic links of a path. The result need not exist. It is for
 * free(), or NULL if memory is out. */
static char *target_of(const char *path)
{
    char *target = strdup(path);
    char link[PATH_MAX];

    for (int i = 0; target && i < LINKS_MAX; i++) {
        ssize_t length = readlink(target, link, sizeof link - 1);
        if (length < 0)
            break;
        link[length] = '\0';
        char *next = path_beside(target, link);
        free(target);
        target = next;
    }
    return target;
}

static bool fail_memory(struct error *err, const char *path)
{
    return fail(err, "%s: out of memory for its name", path);
}

/* Fails unless the target is a regular file or missing, and can be written.
 * Messages call it `path`. */
static bool check_target(const char *target, const char *folder,
                         const char *path, struct error *err)
{
    struct stat st;
    bool ok = true;

    if (stat(target, &st) == 0) {
        ok = expect_regular(path, &st, err) &&
             (access(target, W_OK) == 0 || fail_errno(err, path));
    } else if (errno != ENOENT || *path == '\0') {
        ok = fail_errno(err, path);
    }
    if (ok && access(folder, W_OK | X_OK) != 0)
        ok = fail_errno(err, folder);
    return ok;
}

bool file_check(const char *path, struct error *err)
{
    char *target = target_of(path);
    char *folder = target ? folder_of(target) : NULL;
    bool ok = folder ? check_target(target, folder, path, err)
                     : fail_memory(err, path);

    free(folder);
    free(target);
    return ok;
}

/* Writes once to a pipe, and waits for its reader. Returns the number of bytes,
 * or -1 and errno. */
static ssize_t write_pipe(int fd, const void *data, size_t size_bytes)
{
    ssize_t n;

    stop_allow_begin();
    n = write(fd, data, size_bytes);
    if (n < 0 && errno == EAGAIN) {
        /* the pipe's creator may have made it non-blocking */
        poll(&(struct pollfd){.fd = fd, .events = POLLOUT}, 1, -1);
        errno = EINTR;
    }
    stop_allow_end();
    return n;
}

/* Writes all bytes with calls of `step`, write() or write_pipe(). */
static bool write_all(int fd, const char *data, size_t size_bytes,
                      ssize_t (*step)(int, const void *, size_t))
{
    while (size_bytes > 0) {
        ssize_t n = step(fd, data, size_bytes);

        if (n < 0 && errno != EINTR)
            return false;
        if (n > 0) {
            data += n;
            size_bytes -= (size_t)n;
        }
    }
    return true;
}

/* Syncs the folder, so that the new name is durable. File systems that cannot
 * do this are left alone. */
static void sync_folder(const char *folder)
{
    int fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);

    if (fd >= 0) {
        fsync(fd);
        close(fd);
    }
}

/* Returns false, with errno ESTALE, if the file has changed. */
static bool is_as_before(const char *target, const struct file_change *change)
{
    struct file_identity now = file_identify(target);

    if (file_is_same(&now, &change->before))
        return true;
    errno = ESTALE;
    return false;
}

static bool fill_after(int fd, struct file_change *change)
{
    struct stat st;

    if (fstat(fd, &st) != 0)
        return false;
    change->after = identity_of(&st);
    return true;
}

/* Replacement of a file: the data, the target, and the version that must be
 * there before. */
struct replacement {
    const char *folder, *target;
    const void *data;
    size_t size_bytes;
    bool must_be_new;
    bool *exists;               /* may be NULL */
    struct file_change *change; /* NULL replaces any version */
};

static bool expects_none(const struct replacement *r)
{
    return r->must_be_new || (r->change && !r->change->before.exists);
}

static bool fill(const struct replacement *r, int fd)
{
    struct stat old;
    bool keeps_mode = !r->must_be_new && stat(r->target, &old) == 0;

    return (!keeps_mode || fchmod(fd, old.st_mode & 0777) == 0) &&
           write_all(fd, r->data, r->size_bytes, write) && fsync(fd) == 0 &&
           (!r->change || fill_after(fd, r->change));
}

/* Writes, syncs and publishes a temporary file. Returns false and errno if a
 * step fails. */
static bool replace_by(const struct replacement *r, bool has_name)
{
    struct temp_file t;
    bool ok = temp_file_open(&t, r->folder, has_name, 0666) && fill(r, t.fd) &&
              (!r->change || is_as_before(r->target, r->change)) &&
              temp_file_publish(&t, r->target, expects_none(r));

    return temp_file_close(&t) && ok;
}

/* Writes the data to a file without a name if the file system supports it, and
 * otherwise to one with a temporary name. */
static bool replace(const struct replacement *r)
{
    bool ok = replace_by(r, false) ||
              (errno != EEXIST && errno != ESTALE && replace_by(r, true));

    if (!ok && errno == EEXIST && !r->must_be_new)
        errno = ESTALE;
    return ok;
}

/* Writes the replacement, whose target and folder are not set yet. */
static bool write_file(const char *path, struct replacement r,
                       struct error *err)
{
    char *target = r.must_be_new ? strdup(path) : target_of(path);
    char *folder = target ? folder_of(target) : NULL;
    bool ok = folder ? r.must_be_new || check_target(target, folder, path, err)
                     : fail_memory(err, path);

    r.target = target;
    r.folder = folder;
    stop_hold();
    if (ok)
        temp_file_sweep(folder);
    if (ok && !replace(&r)) {
        if (r.must_be_new && r.exists)
            *r.exists = errno == EEXIST;
        ok = fail_errno(err, path);
    }
    if (ok)
        sync_folder(folder);
    stop_release();
    free(folder);
    free(target);
    return ok;
}

bool file_write(const char *path, const void *data, size_t size_bytes,
                bool must_be_new, bool *exists, struct error *err)
{
    const struct replacement r = {.data = data,
                                  .size_bytes = size_bytes,
                                  .must_be_new = must_be_new,
                                  .exists = exists};

    return write_file(path, r, err);
}

bool file_replace(const char *path, const void *data, size_t size_bytes,
                  struct file_change *change, struct error *err)
{
    const struct replacement r = {.data = data,
                                  .size_bytes = size_bytes,
                                  .change = change};

    return write_file(path, r, err);
}

bool file_write_pipe(int fd, const void *data, size_t size_bytes)
{
    return write_all(fd, data, size_bytes, write_pipe);
}

bool file_write_stdout(const void *data, size_t size_bytes, struct error *err)
{
    return file_write_pipe(STDOUT_FILENO, data, size_bytes) ||
           fail(err, "standard output: %s", strerror(errno));
}

/* Returns true if the byte of the folder is locked by `fd` alone. A folder can
 * only be read, so that all could lock it: the one that finds another lock
 * gives its own back. */
static bool lock_byte(int fd, off_t byte, bool *is_free)
{
    struct flock lock = {.l_type = F_RDLCK,
                         .l_whence = SEEK_SET,
                         .l_start = byte,
                         .l_len = 1};
    bool ok = fcntl(fd, F_OFD_SETLK, &lock) == 0;

    lock.l_type = F_WRLCK;
    ok = ok && fcntl(fd, F_OFD_GETLK, &lock) == 0;
    *is_free = !ok || lock.l_type == F_UNLCK;
    if (!*is_free) {
        lock = (struct flock){.l_type = F_UNLCK, .l_start = byte, .l_len = 1};
        fcntl(fd, F_OFD_SETLK, &lock);
    }
    return ok;
}

/* The file itself is replaced again and again. Its folder stays: each name has
 * the byte at its hash. */
int file_lock(const char *path, struct error *err)
{
    char *target = target_of(path);
    char *folder = target ? folder_of(target) : NULL;
    const char *name = target ? path_name(target) : "";
    uint64_t hash = hash_bytes(HASH_BEGIN, name, strlen(name));
    int fd = folder ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    bool is_free = true;

    if (!folder)
        fail_memory(err, path);
    else if (fd < 0)
        fail_errno(err, folder);
    for (int i = 0; fd >= 0 && i < LOCK_TRIES; i++) {
        if (!lock_byte(fd, (off_t)(hash >> 2), &is_free) || is_free)
            break;
        poll(NULL, 0, (int)(clock_ns() / 1000 % LOCK_MS)); /* both may try */
    }
    if (!is_free) {
        fail(err,
             "%s: found another program that writes this file, expected "
             "another name or its end",
             path);
        close(fd);
        fd = -1;
    }
    free(folder);
    free(target);
    return fd;
}

char *file_write_numbered(const char *stem, const char *ending,
                          const void *data, size_t size_bytes,
                          struct error *err)
{
    char *path = format_text("%s.%s", stem, ending);

    for (int i = 2; path && i <= NUMBER_MAX; i++) {
        struct stat st;
        /* lstat() first: saves writing the file for each name that is taken */
        bool exists = lstat(path, &st) == 0;

        if (!exists && file_write(path, data, size_bytes, true, &exists, err))
            return path;
        if (!exists)
            goto failed;
        free(path);
        path = format_text("%s-%d.%s", stem, i, ending);
    }
    if (path)
        fail(err, "%s: found no free name", path);
    else
        fail_memory(err, stem);
failed:
    free(path);
    return NULL;
}

bool folder_make(char *path)
{
    for (char *p = path + 1;; p++) {
        char end = *p;

        if (end != '/' && end != '\0')
            continue;
        *p = '\0';
        bool ok = mkdir(path, 0700) == 0 || errno == EEXIST;
        *p = end;
        if (!ok || end == '\0')
            return ok;
    }
}

const char *path_name(const char *path)
{
    const char *slash = strrchr(path, '/');

    return slash ? slash + 1 : path;
}

char *path_beside(const char *beside, const char *name)
{
    const char *slash = strrchr(beside, '/');

    if (*name == '/' || !slash)
        return strdup(name);
    return format_text("%.*s%s", (int)(slash + 1 - beside), beside, name);
}

/* Returns the path with symbolic links of its folder resolved, for free(); NULL
 * if the folder does not exist or memory is out. */
static char *real_path(const char *path)
{
    char *folder = folder_of(path);
    char *real = folder ? realpath(folder, NULL) : NULL;
    char *whole = NULL;

    if (real)
        whole = format_text("%s/%s", strcmp(real, "/") == 0 ? "" : real,
                            path_name(path));
    free(real);
    free(folder);
    return whole;
}

char *path_seen_from(const char *beside, const char *path)
{
    char *real_beside = real_path(beside);
    char *real = real_path(path);
    char *name;

    if (real && real_beside) {
        size_t below = (size_t)(strrchr(real_beside, '/') + 1 - real_beside);
        name = strdup(strncmp(real, real_beside, below) == 0 ? real + below
                                                             : real);
    } else {
        name = strdup(path);
    }
    free(real);
    free(real_beside);
    return name;
}

bool path_is_same(const char *a, const char *b)
{
    char *targets[2] = {target_of(a), target_of(b)};
    char *real[2] = {targets[0] ? real_path(targets[0]) : NULL,
                     targets[1] ? real_path(targets[1]) : NULL};
    bool is_same = real[0] && real[1] && strcmp(real[0], real[1]) == 0;

    for (int i = 0; i < 2; i++) {
        free(targets[i]);
        free(real[i]);
    }
    return is_same || strcmp(a, b) == 0;
}

char *path_stem(const char *path)
{
    const char *name = path_name(path);
    const char *dot = strrchr(name, '.');
    size_t length = dot && dot != name ? (size_t)(dot - path) : strlen(path);

    return strndup(path, length);
}

char *path_stem_of_input(const char *path)
{
    char *stem = strcmp(path, "-") == 0 ? strdup("scene") : path_stem(path);
    size_t length = strlen(path);
    char *shorter;

    if (stem == NULL || length < 3 || strcmp(path + length - 3, ".gz") != 0)
        return stem;
    shorter = path_stem(stem);
    free(stem);
    return shorter;
}
