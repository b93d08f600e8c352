// SPDX-License-Identifier: MIT
#include "formats/asset_path.h"

#include <dirent.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"

static char *if_exists(const char *beside, const char *name)
{
    char *path = path_beside(beside, name);

    if (access(path, F_OK) == 0)
        return path;
    free(path);
    return NULL;
}

/* Replaces each backslash and blank by the blank, as a shell does. */
static void remove_escapes(char *name)
{
    char *to = name;

    for (const char *p = name; *p != '\0'; p++) {
        if (*p != '\\' || p[1] != ' ')
            *to++ = *p;
    }
    *to = '\0';
}

/* Returns the first entry of the folder, in the order of strcmp(), whose name
 * equals `name` apart from letter case; NULL if there is none. */
static char *name_in_folder(int folder, const char *name)
{
    int copy = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *entries = copy >= 0 ? fdopendir(copy) : NULL;
    struct dirent *entry;
    char *found = NULL;

    while (entries != NULL && (entry = readdir(entries)) != NULL) {
        if (strcasecmp(entry->d_name, name) != 0 ||
            (found != NULL && strcmp(found, entry->d_name) < 0))
            continue;
        free(found);
        found = xstrdup(entry->d_name);
    }
    if (entries != NULL)
        closedir(entries);
    else if (copy >= 0)
        close(copy);
    return found;
}

/* Replaces one part of a path in place by the entry of the folder whose name
 * differs only in letter case. Returns false if there is none. */
static bool correct_part(int folder, char *part)
{
    char *found;

    if (*part == '\0' || faccessat(folder, part, F_OK, 0) == 0)
        return true;
    found = name_in_folder(folder, part);
    if (found != NULL)
        memcpy(part, found, strlen(part));
    free(found);
    return found != NULL;
}

/* Corrects the letter case of each part of the path, from left to right: files
 * written on systems that ignore case name their neighbours carelessly. */
static bool correct_letters(char *path)
{
    int folder = open(*path == '/' ? "/" : ".", O_PATH | O_CLOEXEC);
    bool ok = folder >= 0;

    for (char *part = path; ok; part++) {
        char *slash = strchrnul(part, '/');
        bool is_last = *slash == '\0';
        int next;

        *slash = '\0';
        ok = correct_part(folder, part);
        if (is_last)
            break;
        next = ok && *part != '\0'
                   ? openat(folder, part, O_PATH | O_DIRECTORY | O_CLOEXEC)
                   : folder;
        *slash = '/';
        if (next != folder) {
            close(folder);
            folder = next;
            ok = folder >= 0;
        }
        part = slash;
    }
    if (folder >= 0)
        close(folder);
    return ok;
}

static char *find_in_any_case(const char *beside, const char *name)
{
    char *path = path_beside(beside, name);

    if (correct_letters(path))
        return path;
    free(path);
    return NULL;
}

char *asset_path_find(const char *beside, const char *name)
{
    char *found, *other;
    const char *last;

    if (*name == '\0' || strlen(name) >= PATH_MAX)
        return NULL;
    found = if_exists(beside, name);
    if (found != NULL)
        return found;
    other = xstrdup(name);
    remove_escapes(other);
    found = if_exists(beside, other);
    for (char *p = other; *p != '\0'; p++) {
        if (*p == '\\')
            *p = '/';
    }
    last = strrchr(other, '/');
    last = last != NULL ? last + 1 : other;
    if (found == NULL)
        found = if_exists(beside, other);
    if (found == NULL && *last != '\0')
        found = if_exists(beside, last);
    if (found == NULL)
        found = find_in_any_case(beside, other);
    if (found == NULL && *last != '\0')
        found = find_in_any_case(beside, last);
    free(other);
    return found;
}
