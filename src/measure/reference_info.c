// SPDX-License-Identifier: MIT
#include "measure/reference_info.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/file.h"
#include "base/memory.h"

/* Finds the number of a member of the object. */
static bool find_number(const char *json, const char *name, double *number)
{
    char key[64];
    const char *at;

    snprintf(key, sizeof key, "\"%s\":", name);
    at = strstr(json, key);
    if (at == NULL)
        return false;
    at += strlen(key);
    at += strspn(at, " \t\r\n");
    return decimal_parse(&at, json + strlen(json), number);
}

static void parse(struct reference_info *info, const char *json)
{
    info->is_known = find_number(json, "relmse", &info->relmse) &&
                     find_number(json, "mse", &info->mse) &&
                     info->relmse >= 0 && info->mse >= 0;
    if (!find_number(json, "first_seed", &info->first_seed) ||
        !find_number(json, "seeds", &info->seed_count))
        info->seed_count = 0;
}

struct reference_info reference_info_read(const char *picture_path)
{
    struct reference_info info = {0};
    char *stem = path_stem(picture_path);
    char *path = stem != NULL ? format_text("%s.json", stem) : NULL;
    char *json = NULL;
    size_t size_bytes;
    struct error ignored;

    if (path != NULL && file_read(path, &json, &size_bytes, &ignored))
        parse(&info, json);
    if (!info.is_known)
        info = (struct reference_info){0};
    free(json);
    free(path);
    free(stem);
    return info;
}
