// SPDX-License-Identifier: MIT
#include "command/reference_info.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glim/version.h"

#include "base/decimal.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text_stream.h"
#include "session/stats_json.h"

/* Finds the finite number of a member of the object. */
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
    return decimal_parse(&at, json + strlen(json), number) && isfinite(*number);
}

static void parse(struct reference_info *info, const char *json)
{
    info->is_known = find_number(json, "relmse", &info->relmse) &&
                     find_number(json, "mse", &info->mse) &&
                     info->relmse >= 0 && info->mse >= 0;
    if (!find_number(json, "relmse_low", &info->relmse_low) ||
        !find_number(json, "relmse_high", &info->relmse_high))
        info->relmse_low = info->relmse_high = 0;
    if (!find_number(json, "first_seed", &info->first_seed) ||
        !find_number(json, "seeds", &info->seed_count))
        info->first_seed = info->seed_count = 0;
}

char *reference_info_path(const char *picture_path)
{
    char *stem = path_stem(picture_path);
    char *path = stem != NULL ? format_text("%s.json", stem) : NULL;

    free(stem);
    return path;
}

struct reference_info reference_info_read(const char *picture_path)
{
    struct reference_info info = {0};
    char *path = reference_info_path(picture_path);
    char *json = NULL;
    size_t size_bytes;
    struct error ignored;

    if (path != NULL && file_read(path, &json, &size_bytes, &ignored))
        parse(&info, json);
    if (!info.is_known)
        info = (struct reference_info){0};
    free(json);
    free(path);
    return info;
}

static void write_command(FILE *to, char *const *arguments)
{
    fputs("  \"command\": [", to);
    for (int i = 0; arguments[i] != NULL; i++) {
        fputs(i > 0 ? ", " : "", to);
        json_write_string(to, arguments[i]);
    }
    fputs("],\n", to);
}

static void write_object(FILE *to, const struct reference_info *info,
                         const struct reference_origin *o)
{
    fputs("{\n  \"renderer\": \"glim " GLIM_VERSION "\",\n  \"scene\": ", to);
    json_write_string(to, o->scene_path);
    fputs(",\n", to);
    write_command(to, o->arguments);
    fprintf(to, "  \"width\": %d,\n  \"height\": %d,\n", o->width, o->height);
    fprintf(to, "  \"spp\": %" PRIu64 ",\n", o->spp);
    fprintf(to, "  \"first_seed\": %.0f,\n  \"seeds\": %.0f,\n",
            info->first_seed, info->seed_count);
    fprintf(to, "  \"seconds\": %.3f,\n", o->seconds);
    fprintf(to, "  \"mean\": %.9g,\n  \"mse\": %.6g,\n", o->mean, info->mse);
    fprintf(to, "  \"relmse\": %.6g,\n", info->relmse);
    fprintf(to, "  \"relmse_low\": %.6g,\n  \"relmse_high\": %.6g\n}\n",
            info->relmse_low, info->relmse_high);
}

bool reference_info_write(const struct reference_info *info,
                          const struct reference_origin *origin,
                          const char *path, struct error *err)
{
    struct text_stream s;

    if (text_stream_open(&s))
        write_object(s.to, info, origin);
    return text_stream_write(&s, path, err);
}
