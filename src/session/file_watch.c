// SPDX-License-Identifier: MIT
#include "session/file_watch.h"

#include <limits.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <unistd.h>

#include "base/clock.h"
#include "terminal/xmalloc.h"

/* Events of files that are written, complete, renamed or removed, and of
 * attributes, since `chmod` may make a file readable and `touch` counts as a
 * change. */
#define EVENTS                                                              \
    (IN_MODIFY | IN_CLOSE_WRITE | IN_MOVED_FROM | IN_MOVED_TO | IN_CREATE | \
     IN_DELETE | IN_ATTRIB)

/* Time for which a missing file is waited for: editors and git remove a file
 * before they write it. */
#define ABSENT_NS UINT64_C(1000000000)

/* Time for which a file that is written counts as incomplete until it is
 * closed: an export takes a while between its writes. */
#define WRITING_NS UINT64_C(5000000000)

struct watched {
    char *path;
    struct file_identity known;
    struct file_identity seen; /* at the last look */
    uint64_t absent_ns;  /* when a look has found it missing; 0: it has not */
    uint64_t writing_ns; /* last write before it was closed; 0: it is closed */
    bool has_existed;    /* at some time */
    bool is_listed;      /* named since file_watch_begin() */
};

void file_watch_init(struct file_watch *w)
{
    *w = (struct file_watch){.fd = -1};
}

void file_watch_begin(struct file_watch *w)
{
    for (size_t i = 0; i < w->file_count; i++)
        w->files[i].is_listed = false;
}

static struct watched *find(struct file_watch *w, const char *path)
{
    for (size_t i = 0; i < w->file_count; i++) {
        if (strcmp(w->files[i].path, path) == 0)
            return &w->files[i];
    }
    return NULL;
}

void file_watch_add(struct file_watch *w, const char *path)
{
    struct watched *known = find(w, path);

    if (known) {
        known->is_listed = true;
        return;
    }
    if (w->file_count == w->capacity) {
        w->capacity = w->capacity == 0 ? 8 : 2 * w->capacity;
        w->files = xrealloc(w->files, w->capacity * sizeof w->files[0]);
    }
    w->files[w->file_count++] = (struct watched){.path = xstrdup(path),
                                                 .known = file_identify(path),
                                                 .seen = file_identify(path),
                                                 .is_listed = true};
}

static void watch_folder_of(int fd, const char *path)
{
    char *folder = xchecked(path_beside(path, "."));

    /* a missing folder has no files that change */
    inotify_add_watch(fd, folder, EVENTS);
    free(folder);
}

/* Watches the folder of a link and that of its target, since either may
 * change. */
static void watch_folders(int fd, const char *path)
{
    char target[PATH_MAX];

    watch_folder_of(fd, path);
    if (realpath(path, target))
        watch_folder_of(fd, target);
}

void file_watch_end(struct file_watch *w)
{
    size_t kept = 0;

    if (w->fd >= 0)
        close(w->fd);
    w->fd = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    for (size_t i = 0; i < w->file_count; i++) {
        struct watched *f = &w->files[i];

        /* one that was there is missed, and may come back */
        f->has_existed |= f->known.exists;
        if (!f->is_listed && (!f->has_existed || access(f->path, F_OK) == 0)) {
            free(f->path);
            continue;
        }
        watch_folders(w->fd, f->path);
        w->files[kept++] = *f;
    }
    w->file_count = kept;
}

/* Notes whether a file of this name, in whichever folder, is being written. */
static void note_event(struct file_watch *w, const struct inotify_event *e)
{
    for (size_t i = 0; i < w->file_count; i++)
        if (strcmp(path_name(w->files[i].path), e->name) == 0)
            w->files[i].writing_ns =
                (e->mask & IN_MODIFY) != 0 ? clock_ns() : 0;
}

void file_watch_drain(struct file_watch *w)
{
    _Alignas(struct inotify_event) char events[4096];
    ssize_t size;

    while (w->fd >= 0 && (size = read(w->fd, events, sizeof events)) > 0) {
        for (ssize_t at = 0; at < size;) {
            const struct inotify_event *e = (const void *)(events + at);

            if (e->len > 0)
                note_event(w, e);
            at += (ssize_t)(sizeof *e + e->len);
        }
    }
}

/* Looks at a file. Returns true if it is not complete, or may be missing for a
 * moment only. */
static bool look(struct watched *f, uint64_t now_ns, bool *has_settled)
{
    struct file_identity now = file_identify(f->path);

    *has_settled = file_is_same(&now, &f->seen);
    f->seen = now;
    if (now.exists || !f->known.exists)
        f->absent_ns = 0;
    else if (f->absent_ns == 0)
        f->absent_ns = now_ns;
    return (f->absent_ns != 0 && now_ns < f->absent_ns + ABSENT_NS) ||
           (f->writing_ns != 0 && now_ns < f->writing_ns + WRITING_NS);
}

bool file_watch_has_changed(struct file_watch *w)
{
    uint64_t now_ns = clock_ns();
    bool has_changed = false, is_incomplete = false, has_settled;

    w->is_changing = false;
    for (size_t i = 0; i < w->file_count; i++) {
        struct watched *f = &w->files[i];

        is_incomplete |= look(f, now_ns, &has_settled);
        w->is_changing |= !has_settled;
        has_changed |= !file_is_same(&f->seen, &f->known);
    }
    w->is_changing |= is_incomplete;
    return has_changed && !is_incomplete;
}

bool file_watch_has(const struct file_watch *w, const char *path)
{
    struct file_identity it = file_identify(path);

    for (size_t i = 0; i < w->file_count && it.exists; i++) {
        struct file_identity now = file_identify(w->files[i].path);

        if (file_is_same(&now, &it))
            return true;
    }
    return false;
}

bool file_watch_spares(const struct file_watch *w, const char *option,
                       const char *path, struct error *err)
{
    return !file_watch_has(w, path) ||
           fail(err,
                "%s: found '%s', which the scene is read from, expected "
                "another file",
                option, path);
}

void file_watch_settle(struct file_watch *w)
{
    for (size_t i = 0; i < w->file_count; i++) {
        w->files[i].has_existed |= w->files[i].known.exists;
        w->files[i].known = file_identify(w->files[i].path);
    }
}

void file_watch_wrote(struct file_watch *w, const char *path,
                      const struct file_identity *identity)
{
    struct watched *f = find(w, path);

    if (f)
        f->known = *identity;
}

void file_watch_replaced(struct file_watch *w, const char *path,
                         const struct file_change *change)
{
    struct watched *f = find(w, path);

    if (f &&
        (!change->before.exists || file_is_same(&f->known, &change->before)))
        f->known = change->after;
}

void file_watch_free(struct file_watch *w)
{
    for (size_t i = 0; i < w->file_count; i++)
        free(w->files[i].path);
    free(w->files);
    if (w->fd >= 0)
        close(w->fd);
    file_watch_init(w);
}
