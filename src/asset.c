// SPDX-License-Identifier: MIT
#include "glim/asset.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "glim/file.h"
#include "glim/util.h"

static char *if_exists(const char *beside, const char *name)
{
    char *path = path_beside(beside, name);

    if (access(path, F_OK) == 0)
        return path;
    free(path);
    return NULL;
}

/* "a\\ b" as in a shell becomes "a b". */
static void remove_escapes(char *name)
{
    char *to = name;

    for (const char *p = name; *p != '\0'; p++) {
        if (*p != '\\' || p[1] != ' ')
            *to++ = *p;
    }
    *to = '\0';
}

/* What the folder calls the file, or the first such name. */
static char *name_in_folder(const char *folder, const char *name)
{
    DIR *entries = opendir(folder);
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
    return found;
}

/* The file of this path but for capital and small letters, which other systems
 * do not tell apart. */
static char *in_any_case(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder, *real, *name;
    char *found = NULL;

    if (access(path, F_OK) == 0)
        return xstrdup(path);
    if (slash == NULL)
        return name_in_folder(".", path);
    folder = xformat("%.*s", (int)(slash - path), path);
    real = slash == path ? xstrdup("") : in_any_case(folder);
    name = real ? name_in_folder(*real ? real : "/", slash + 1) : NULL;
    if (name != NULL)
        found = xformat("%s/%s", real, name);
    free(folder);
    free(real);
    free(name);
    return found;
}

static char *find_in_any_case(const char *beside, const char *name)
{
    char *path = path_beside(beside, name);
    char *found = in_any_case(path);

    free(path);
    return found;
}

char *asset_find(const char *beside, const char *name)
{
    char *found = *name == '\0' ? NULL : if_exists(beside, name);
    char *other;
    const char *last;

    if (found != NULL || *name == '\0')
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
