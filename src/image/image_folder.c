// SPDX-License-Identifier: MIT
#include "image/image_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "image/image_header.h"

/* Bytes that tell the kind of every image. */
#define HEAD_BYTES 512

/* Entries of all folders that are looked at. */
#define ENTRIES_MAX 10000

struct search {
    struct image_folder *images;
    int entries;
};

static bool is_image(const char *path)
{
    char head[HEAD_BYTES];
    struct image_file f = {.path = path, .data = head};
    int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    ssize_t count = fd >= 0 ? read(fd, head, sizeof head) : -1;

    if (fd >= 0)
        close(fd);
    f.size_bytes = count > 0 ? (size_t)count : 0;
    return image_header_kind(&f) != IMAGE_UNKNOWN;
}

static void add(struct image_folder *images, char *path)
{
    char **paths = realloc(images->paths,
                           ((size_t)images->count + 1) * sizeof *images->paths);

    if (paths != NULL) {
        images->paths = paths;
        paths[images->count++] = path;
    } else {
        free(path);
    }
}

/* Looks at the entries of a folder; `prefix` is its path with a slash, or "".
 */
static void look_in(struct search *s, const char *prefix, bool goes_deeper)
{
    DIR *folder = opendir(*prefix != '\0' ? prefix : ".");
    struct dirent *entry;

    while (folder != NULL && (entry = readdir(folder)) != NULL &&
           s->entries++ < ENTRIES_MAX && s->images->count < IMAGE_FOLDER_MAX) {
        char *path = entry->d_name[0] == '.'
                         ? NULL
                         : format_text("%s%s", prefix, entry->d_name);
        char *deeper = path != NULL ? format_text("%s/", path) : NULL;
        struct stat about;
        bool is_there = deeper != NULL && stat(path, &about) == 0;

        if (is_there && S_ISDIR(about.st_mode) && goes_deeper)
            look_in(s, deeper, false);
        if (is_there && S_ISREG(about.st_mode) && is_image(path))
            add(s->images, path);
        else
            free(path);
        free(deeper);
    }
    if (folder != NULL)
        closedir(folder);
}

static int compare(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

void image_folder_list(struct image_folder *images, const char *beside)
{
    struct search s = {.images = images};
    char *prefix =
        format_text("%.*s", (int)(path_name(beside) - beside), beside);

    *images = (struct image_folder){.count = 0};
    if (prefix != NULL)
        look_in(&s, prefix, true);
    free(prefix);
    if (images->count > 0)
        qsort(images->paths, (size_t)images->count, sizeof *images->paths,
              compare);
}

void image_folder_free(struct image_folder *images)
{
    for (int i = 0; i < images->count; i++)
        free(images->paths[i]);
    free(images->paths);
    *images = (struct image_folder){.count = 0};
}
