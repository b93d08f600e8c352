// SPDX-License-Identifier: MIT
#include "session/scene_files.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "engine/scene_load.h"
#include "film/image_write.h"
#include "image/image_read.h"
#include "session/autosave_file.h"
#include "session/state_list.h"
#include "terminal/xmalloc.h"

/* Most files of a folder that are listed. */
#define FILES_MAX 4000

/* ---- names ---- */

bool scene_files_reads(const char *name)
{
    const struct scene_format *f = scene_format_named(name);

    return f != NULL && name[0] != '.' &&
           (f->missing == NULL || f->missing() == NULL);
}

/* Returns the path with ~ for the user's folder. */
static char *short_path(const char *path)
{
    const char *home = getenv("HOME");
    size_t length = home != NULL ? strlen(home) : 0;

    if (length > 1 && strncmp(path, home, length) == 0 && path[length] == '/')
        return xformat("~%s", path + length);
    return xstrdup(path);
}

/* ---- lists ---- */

/* Takes path and text. */
static void add(struct scene_files *s, char *path, char *text,
                const char *group, bool is_folder)
{
    s->files = xrealloc(s->files, ((size_t)s->count + 1) * sizeof *s->files);
    s->files[s->count++] = (struct scene_file){path, text, group, is_folder};
}

static void add_recent(struct scene_files *s)
{
    struct state_list recent;

    recent_read(&recent);
    for (int i = 0; i < recent.count; i++)
        add(s, xstrdup(recent.lines[i]), short_path(recent.lines[i]),
            "Opened last", false);
    state_list_free(&recent);
}

/* Folders come first; then by name. */
static int compare(const void *a, const void *b)
{
    const struct scene_file *x = a, *y = b;

    if (x->is_folder != y->is_folder)
        return x->is_folder ? -1 : 1;
    return strverscmp(x->text, y->text);
}

static void add_entry(struct scene_files *s, const char *folder,
                      const char *name, const char *group, bool has_folders)
{
    char *path = xformat("%s/%s", strcmp(folder, "/") == 0 ? "" : folder, name);
    struct stat found;
    bool is_folder = false, is_listed = false;

    if (stat(path, &found) == 0) {
        is_folder = S_ISDIR(found.st_mode);
        is_listed = is_folder
                        ? has_folders && name[0] != '.'
                        : S_ISREG(found.st_mode) && scene_files_reads(name);
    }
    if (is_listed)
        add(s, path, xformat("%s%s", name, is_folder ? "/" : ""), group,
            is_folder);
    else
        free(path);
}

static void add_folder(struct scene_files *s, const char *folder,
                       const char *group, bool has_folders)
{
    DIR *directory = opendir(folder);
    const struct dirent *entry;
    int first = s->count;

    while (directory != NULL && (entry = readdir(directory)) != NULL &&
           s->count - first < FILES_MAX)
        add_entry(s, folder, entry->d_name, group, has_folders);
    if (directory != NULL)
        closedir(directory);
    if (s->count > first)
        qsort(s->files + first, (size_t)(s->count - first), sizeof *s->files,
              compare);
}

/* Adds the scenes of the first of these folders that exists, seen from the
 * folder of the program: as installed, or as built. */
static void add_shipped(struct scene_files *s)
{
    static const char *const places[] = {"../share/glim/scenes", "../../scenes",
                                         "../../../scenes"};
    char program[4096];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    bool is_found = false;

    if (length <= 0)
        return;
    program[length] = '\0';
    for (size_t i = 0; i < sizeof places / sizeof places[0] && !is_found; i++) {
        char *beside = xchecked(path_beside(program, places[i]));
        char *folder = realpath(beside, NULL);

        is_found = folder != NULL && access(folder, R_OK | X_OK) == 0;
        if (is_found && strcmp(folder, s->folder) != 0)
            add_folder(s, folder, "Of glim", false);
        free(folder);
        free(beside);
    }
}

void scene_files_list(struct scene_files *s, const char *folder)
{
    char *parent;

    *s = (struct scene_files){.folder = realpath(folder ? folder : ".", NULL)};
    if (s->folder == NULL)
        s->folder = xstrdup("/");
    s->title = short_path(s->folder);
    if (folder == NULL)
        add_recent(s);
    parent = xformat("%s/..", s->folder);
    add(s, parent, xstrdup("../"), s->title, true);
    add_folder(s, s->folder, s->title, true);
    if (folder == NULL)
        add_shipped(s);
}

void scene_files_free(struct scene_files *s)
{
    for (int i = 0; i < s->count; i++) {
        free(s->files[i].path);
        free(s->files[i].text);
    }
    free(s->files);
    free(s->folder);
    free(s->title);
    *s = (struct scene_files){.count = 0};
}

/* ---- pictures ---- */

/* Returns the path of the picture of a scene, for free(), or NULL. */
static char *picture_path(const char *scene_path)
{
    char *scene = autosave_scene(scene_path);
    char *path = scene != NULL ? autosave_path_picture(scene) : NULL;

    free(scene);
    return path;
}

void scene_picture_keep(const char *scene_path, const struct frame *frame)
{
    char *path = picture_path(scene_path);
    struct error ignored;

    if (path != NULL)
        image_write_frame(frame, path, &ignored);
    free(path);
}

static bool copy_image(const struct image *image, struct frame *frame)
{
    struct error ignored;

    if (image->width > SCENE_PICTURE_SIDE ||
        image->height > SCENE_PICTURE_SIDE ||
        !frame_init(frame, image->width, image->height, &ignored))
        return false;
    for (int i = 0; i < image->width * image->height; i++)
        memcpy(frame->rgb + 3 * i, image->rgba + 4 * i, 3);
    return true;
}

bool scene_picture_read(const char *scene_path, struct frame *frame)
{
    char *path = picture_path(scene_path);
    struct image_file file;
    struct image image = {0};
    uint64_t clamped = 0;
    struct error ignored;
    bool ok = path != NULL && access(path, R_OK) == 0 &&
              image_open(&file, path, IMAGE_8BIT, 0, &ignored) &&
              image_decode(&file, &image, &clamped, &ignored) &&
              copy_image(&image, frame);

    image_free(&image);
    free(path);
    return ok;
}
