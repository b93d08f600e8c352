// SPDX-License-Identifier: MIT
#include "glim/asset.h"

#include <stdlib.h>
#include <string.h>
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

char *asset_find(const char *beside, const char *name)
{
    char *found = *name == '\0' ? NULL : if_exists(beside, name);
    char *other;
    const char *last;

    if (found != NULL || strpbrk(name, "/\\") == NULL)
        return found;
    other = xstrdup(name);
    remove_escapes(other);
    found = if_exists(beside, other);
    for (char *p = other; *p != '\0'; p++) {
        if (*p == '\\')
            *p = '/';
    }
    if (found == NULL)
        found = if_exists(beside, other);
    last = strrchr(other, '/');
    if (found == NULL && last != NULL && last[1] != '\0')
        found = if_exists(beside, last + 1);
    free(other);
    return found;
}
