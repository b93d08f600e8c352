// SPDX-License-Identifier: MIT
/*
 * fault.c - a library that lets one call of a program fail (LD_PRELOAD)
 *
 * With FAULT=memory:N, the Nth call of malloc() and its relatives gives no
 * memory; with FAULT=thread:N, the Nth pthread_create() starts none; with a +
 * behind the number, neither do all later ones. The file FAULT_COUNT, 8 bytes
 * of one number, counts the calls of all processes with this environment.
 * Allocations of ncurses never fail, because it crashes without memory.
 *
 * With FAULT_DISK=FILE, the file says how disks are at the moment: `slow MS`
 * lets fsync() take so many milliseconds, and `fails N` lets write() to files
 * fail with error number N.
 *
 * Threads:   any
 */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

static char kind[16];
static long first, last;
static atomic_long own_count, *count = &own_count;

/* Maps the count of all processes. */
static void share_count(const char *path)
{
    int fd = path != NULL ? open(path, O_RDWR | O_CREAT, 0600) : -1;
    void *at = MAP_FAILED;

    if (fd >= 0 && ftruncate(fd, sizeof *count) == 0)
        at = mmap(NULL, sizeof *count, PROT_READ | PROT_WRITE, MAP_SHARED, fd,
                  0);
    if (at != MAP_FAILED)
        count = at;
    if (fd >= 0)
        close(fd);
}

__attribute__((constructor)) static void begin(void)
{
    const char *what = getenv("FAULT");
    const char *colon = what != NULL ? strchr(what, ':') : NULL;

    if (colon == NULL || (size_t)(colon - what) >= sizeof kind)
        return;
    share_count(getenv("FAULT_COUNT"));
    first = atol(colon + 1);
    last = strchr(colon, '+') != NULL ? LONG_MAX : first;
    memcpy(kind, what, (size_t)(colon - what));
}

/* Counts a call from `caller`. */
static bool fails(const char *of, const void *caller)
{
    Dl_info info;
    long n;

    if (strcmp(of, kind) != 0 ||
        (dladdr(caller, &info) != 0 && info.dli_fname != NULL &&
         (strstr(info.dli_fname, "libtinfo") != NULL ||
          strstr(info.dli_fname, "libncurses") != NULL)))
        return false;
    n = atomic_fetch_add(count, 1) + 1;
    errno = ENOMEM;
    return n >= first && n <= last;
}

#define FAILS(of) fails(of, __builtin_return_address(0))

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t n, size_t size);
void *__libc_realloc(void *p, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

void *malloc(size_t size)
{
    return FAILS("memory") ? NULL : __libc_malloc(size);
}

void *calloc(size_t n, size_t size)
{
    return FAILS("memory") ? NULL : __libc_calloc(n, size);
}

void *realloc(void *p, size_t size)
{
    return FAILS("memory") ? NULL : __libc_realloc(p, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return FAILS("memory") ? NULL : __libc_memalign(alignment, size);
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attr,
                   void *(*start)(void *), void *context)
{
    int (*next)(pthread_t *, const pthread_attr_t *, void *(*)(void *),
                void *) = NULL;

    if (FAILS("thread"))
        return EAGAIN;
    *(void **)&next = dlsym(RTLD_NEXT, "pthread_create");
    return next(thread, attr, start, context);
}

/* ---- disks ---- */

/* Returns the number behind the word in the file FAULT_DISK, or 0. */
static int disk(const char *word)
{
    const char *path = getenv("FAULT_DISK");
    int fd = path != NULL ? open(path, O_RDONLY | O_CLOEXEC) : -1;
    char text[64], found[16];
    ssize_t length = fd >= 0 ? read(fd, text, sizeof text - 1) : 0;
    int number;

    if (fd >= 0)
        close(fd);
    text[length > 0 ? length : 0] = '\0';
    return sscanf(text, "%15s %d", found, &number) == 2 &&
                   strcmp(found, word) == 0
               ? number
               : 0;
}

int fsync(int fd)
{
    int (*next)(int) = NULL;

    usleep((useconds_t)disk("slow") * 1000);
    *(void **)&next = dlsym(RTLD_NEXT, "fsync");
    return next(fd);
}

ssize_t write(int fd, const void *bytes, size_t size)
{
    static ssize_t (*_Atomic known)(int, const void *, size_t);
    ssize_t (*next)(int, const void *, size_t) = known;
    struct stat file;
    int error;

    if (fstat(fd, &file) == 0 && S_ISREG(file.st_mode) &&
        (error = disk("fails")) != 0) {
        errno = error;
        return -1;
    }
    if (next == NULL) {
        *(void **)&next = dlsym(RTLD_NEXT, "write");
        known = next;
    }
    return next(fd, bytes, size);
}
