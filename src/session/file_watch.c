// SPDX-License-Identifier: MIT
#include "session/file_watch.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <unistd.h>

#include "terminal/xmalloc.h"

/* Events of complete or renamed files, and of attributes, since `chmod` may
 * make a file readable and `touch` counts as a change. */
#define EVENTS (IN_CLOSE_WRITE | IN_MOVED_TO | IN_CREATE | IN_ATTRIB)

struct watched {
    char *path;
    struct file_identity known;
    bool is_listed; /* named since file_watch_begin() */
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
    w->files[w->file_count++] =
        (struct watched){xstrdup(path), file_identify(path), true};
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

        bool is_gone = f->known.exists && access(f->path, F_OK) != 0;

        if (!f->is_listed && !is_gone) {
            free(f->path);
            continue;
        }
        watch_folders(w->fd, f->path);
        w->files[kept++] = *f;
    }
    w->file_count = kept;
}

void file_watch_drain(struct file_watch *w)
{
    char events[4096];

    while (w->fd >= 0 && read(w->fd, events, sizeof events) > 0)
        continue;
}

bool file_watch_has_changed(const struct file_watch *w)
{
    bool has_changed = false;

    for (size_t i = 0; i < w->file_count; i++) {
        struct file_identity now = file_identify(w->files[i].path);

        if (w->files[i].known.exists && !now.exists)
            return false;
        has_changed |= !file_is_same(&now, &w->files[i].known);
    }
    return has_changed;
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
        struct watched *f = &w->files[i];
        struct file_identity now = file_identify(f->path);

        if (now.exists)
            f->known = now;
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
