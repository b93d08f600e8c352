// SPDX-License-Identifier: MIT
#include "base/xdg.h"

#include <stdlib.h>

#include "base/file.h"
#include "base/memory.h"

char *xdg_folder(const char *variable, const char *below_home)
{
    const char *folder = getenv(variable);
    const char *home = getenv("HOME");

    if (folder && *folder == '/')
        return format_text("%s/glim", folder);
    if (home && *home == '/')
        return format_text("%s/%s/glim", home, below_home);
    return NULL;
}

char *xdg_state_path(const char *name)
{
    char *folder = xdg_folder("XDG_STATE_HOME", ".local/state");
    char *path = NULL;

    if (folder && folder_make(folder))
        path = format_text("%s/%s", folder, name);
    free(folder);
    return path;
}
