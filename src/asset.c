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

char *asset_find(const char *beside, const char *name)
{
    char *found = *name == '\0' ? NULL : if_exists(beside, name);
    char *slashes;
    const char *last;

    if (found != NULL || strpbrk(name, "/\\") == NULL)
        return found;
    slashes = xstrdup(name);
    for (char *p = slashes; *p != '\0'; p++) {
        if (*p == '\\')
            *p = '/';
    }
    found = if_exists(beside, slashes);
    last = strrchr(slashes, '/') + 1;
    if (found == NULL && *last != '\0')
        found = if_exists(beside, last);
    free(slashes);
    return found;
}
