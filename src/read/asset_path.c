// SPDX-License-Identifier: MIT
#include "read/asset_path.h"

#include <dirent.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/file.h"

/* State of the search. */
struct search {
    const char *beside;
    char *path; /* NULL if nothing is found yet */
    bool has_memory;
};

/* Takes the name if nothing was found before and the file exists. */
static void try_name(struct search *s, const char *name,
                     bool (*is_there)(char *path))
{
    char *path;

    if (s->path != NULL || !s->has_memory)
        return;
    path = path_beside(s->beside, name);
    s->has_memory = path != NULL;
    if (path != NULL && is_there(path))
        s->path = path;
    else
        free(path);
}

static bool exists(char *path)
{
    return access(path, F_OK) == 0;
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

/* Finds the first entry of the folder, in the order of strcmp(), whose name
 * equals `name` apart from letter case. Returns false if there is none. */
static bool name_in_folder(int folder, const char *name,
                           char found[NAME_MAX + 1])
{
    int copy = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *entries = copy >= 0 ? fdopendir(copy) : NULL;
    struct dirent *entry;

    *found = '\0';
    while (entries != NULL && (entry = readdir(entries)) != NULL) {
        if (strcasecmp(entry->d_name, name) != 0 ||
            (*found != '\0' && strcmp(found, entry->d_name) < 0))
            continue;
        snprintf(found, NAME_MAX + 1, "%s", entry->d_name);
    }
    if (entries != NULL)
        closedir(entries);
    else if (copy >= 0)
        close(copy);
    return *found != '\0';
}

/* Replaces one part of a path in place by the entry of the folder whose name
 * differs only in letter case. Returns false if there is none. */
static bool correct_part(int folder, char *part)
{
    char found[NAME_MAX + 1];

    if (*part == '\0' || faccessat(folder, part, F_OK, 0) == 0)
        return true;
    if (!name_in_folder(folder, part, found))
        return false;
    memcpy(part, found, strlen(part));
    return true;
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

/* Removes double quotes around the name. */
static void remove_quotes(char *name)
{
    size_t length = strlen(name);

    if (length < 2 || name[0] != '"' || name[length - 1] != '"')
        return;
    memmove(name, name + 1, length - 2);
    name[length - 2] = '\0';
}

/* Tries the names that a missing file may have on this system. */
static void try_others(struct search *s, char *name)
{
    const char *last;

    remove_quotes(name);
    try_name(s, name, exists);
    remove_escapes(name);
    try_name(s, name, exists);
    for (char *p = name; *p != '\0'; p++) {
        if (*p == '\\')
            *p = '/';
    }
    last = strrchr(name, '/');
    last = last != NULL ? last + 1 : name;
    try_name(s, name, exists);
    if (*last != '\0')
        try_name(s, last, exists);
    try_name(s, name, correct_letters);
    if (*last != '\0')
        try_name(s, last, correct_letters);
}

bool asset_path_find(const char *beside, const char *name, char **path)
{
    struct search s = {beside, NULL, true};
    char *other;

    *path = NULL;
    if (*name == '\0' || strlen(name) >= PATH_MAX)
        return true;
    try_name(&s, name, exists);
    if (s.path == NULL && s.has_memory) {
        other = strdup(name);
        s.has_memory = other != NULL;
        if (other != NULL)
            try_others(&s, other);
        free(other);
    }
    *path = s.path;
    return s.has_memory;
}
