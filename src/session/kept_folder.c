// SPDX-License-Identifier: MIT
#include "session/kept_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/print.h"
#include "base/xdg.h"

#define S_NS  UINT64_C(1000000000)
#define DAY_S 86400

static const char ending[] = ".session";

/* ---- paths ---- */

/* Returns the path of the folder with a slash, for free(), or NULL. */
static char *folder_path(void)
{
    char *path = xdg_state_path("sessions");
    char *folder = NULL;

    if (path != NULL && folder_make(path))
        folder = format_text("%s/", path);
    free(path);
    return folder;
}

char *kept_scene(const char *scene_path)
{
    char *scene = realpath(scene_path, NULL);

    if (scene != NULL && strchr(scene, '\n') != NULL) {
        free(scene);
        scene = NULL;
    }
    return scene;
}

char *kept_path(const char *scene)
{
    char *folder = folder_path();
    char *path = NULL;

    if (folder != NULL)
        path =
            format_text("%s%016" PRIx64 "%s", folder,
                        hash_bytes(HASH_BEGIN, scene, strlen(scene)), ending);
    free(folder);
    return path;
}

/* One file has the locks of all scenes: each locks the byte at the hash of its
 * path, far behind the end of the file, which is empty. */
int kept_lock(const char *path)
{
    uint64_t hash = hash_bytes(HASH_BEGIN, path, strlen(path));
    struct flock lock = {.l_type = F_WRLCK,
                         .l_whence = SEEK_SET,
                         .l_start = (off_t)(hash >> 2),
                         .l_len = 1};
    char *name = path_beside(path, "lock");
    int fd = name != NULL ? open(name, O_RDWR | O_CREAT | O_CLOEXEC, 0600) : -1;

    free(name);
    if (fd >= 0 && fcntl(fd, F_SETLK, &lock) == 0)
        return fd;
    if (fd >= 0)
        close(fd);
    return -1;
}

/* ---- list ---- */

struct entry {
    char *path;
    struct file_identity file;
};

struct list {
    struct entry *entries;
    size_t count;
};

static int compare_age(const void *a, const void *b)
{
    const struct timespec *s = &((const struct entry *)a)->file.modified;
    const struct timespec *t = &((const struct entry *)b)->file.modified;

    if (s->tv_sec != t->tv_sec)
        return s->tv_sec > t->tv_sec ? -1 : 1;
    return s->tv_nsec > t->tv_nsec ? -1 : s->tv_nsec < t->tv_nsec;
}

static bool is_session(const char *name)
{
    size_t length = strlen(name), end = sizeof ending - 1;

    return length == 16 + end && strcmp(name + length - end, ending) == 0;
}

static void add(struct list *list, size_t *capacity, const char *path)
{
    void *entries = list->entries;

    if (path == NULL ||
        !grow_array(&entries, capacity, list->count + 1, sizeof(struct entry)))
        return;
    list->entries = entries;
    list->entries[list->count].path = strdup(path);
    list->entries[list->count].file = file_identify(path);
    if (list->entries[list->count].path != NULL)
        list->count++;
}

/* Lists the folder of `beside`, the last file first. A file for which memory is
 * out is left out. */
static struct list read_list(const char *beside)
{
    struct list list = {.count = 0};
    size_t capacity = 0;
    char *folder = path_beside(beside, ".");
    DIR *directory = folder != NULL ? opendir(folder) : NULL;
    const struct dirent *file;

    while (directory != NULL && (file = readdir(directory)) != NULL) {
        char *path =
            is_session(file->d_name) ? path_beside(beside, file->d_name) : NULL;

        add(&list, &capacity, path);
        free(path);
    }
    if (directory != NULL)
        closedir(directory);
    free(folder);
    if (list.count > 0)
        qsort(list.entries, list.count, sizeof *list.entries, compare_age);
    return list;
}

static void free_list(struct list *list)
{
    for (size_t i = 0; i < list->count; i++)
        free(list->entries[i].path);
    free(list->entries);
}

int kept_prune(const char *path, int days_max, uint64_t bytes_max)
{
    struct list list = read_list(path);
    time_t oldest = time(NULL) - (time_t)days_max * DAY_S;
    uint64_t bytes = 0;
    int count = 0;

    for (size_t i = 0; i < list.count; i++) {
        const struct file_identity *file = &list.entries[i].file;

        bytes += (uint64_t)file->size_bytes;
        if (bytes > bytes_max || file->modified.tv_sec < oldest)
            count += unlink(list.entries[i].path) == 0;
    }
    free_list(&list);
    return count;
}

/* ---- texts ---- */

/* Writes a time with its two largest units. */
static void print_time(char text[KEPT_TEXT_BYTES], uint64_t s)
{
    if (s < 60)
        snprintf(text, KEPT_TEXT_BYTES, "%" PRIu64 " s", s);
    else if (s < 3600)
        snprintf(text, KEPT_TEXT_BYTES, "%" PRIu64 " min %" PRIu64 " s", s / 60,
                 s % 60);
    else if (s < DAY_S)
        snprintf(text, KEPT_TEXT_BYTES, "%" PRIu64 " h %" PRIu64 " min",
                 s / 3600, s / 60 % 60);
    else
        snprintf(text, KEPT_TEXT_BYTES, "%" PRIu64 " d %" PRIu64 " h",
                 s / DAY_S, s / 3600 % 24);
}

void kept_describe(char text[KEPT_TEXT_BYTES], const struct kept *k)
{
    char duration[KEPT_TEXT_BYTES];

    print_time(duration, k->render_ns / S_NS);
    if (k->sizes[KEPT_FILM] == 0)
        snprintf(text, KEPT_TEXT_BYTES, "%s",
                 k->has_edits ? "unsaved changes" : "a view");
    else
        snprintf(text, KEPT_TEXT_BYTES, "%.40s of render%s", duration,
                 k->has_edits ? " and unsaved changes" : "");
}

static void print_entry(FILE *to, const struct entry *entry)
{
    char age[KEPT_TEXT_BYTES], what[KEPT_TEXT_BYTES];
    time_t now = time(NULL), then = entry->file.modified.tv_sec;
    struct kept k;
    struct error err;

    print_time(age, now > then ? (uint64_t)(now - then) : 0);
    if (kept_read_head(&k, entry->path, &err)) {
        kept_describe(what, &k);
        print_line(to, "%s: %s, %s ago, %.1f MB", k.scene, what, age,
                   (double)entry->file.size_bytes / 1e6);
    } else {
        print_line(to, "%s", err.text);
    }
    kept_free(&k);
}

bool kept_print_list(FILE *to, struct error *err)
{
    char *folder = folder_path();
    int removed;
    struct list list;

    if (folder == NULL)
        return fail(err, "found no folder for kept sessions, expected one in "
                         "XDG_STATE_HOME or HOME");
    removed = kept_prune(folder, KEPT_DAYS_MAX, KEPT_BYTES_MAX);
    list = read_list(folder);
    for (size_t i = 0; i < list.count; i++)
        print_entry(to, &list.entries[i]);
    if (list.count == 0)
        print_line(to, "no kept sessions");
    if (removed > 0)
        print_line(to, "removed %d old session%s", removed,
                   print_plural((uint64_t)removed));
    free_list(&list);
    free(folder);
    return true;
}
