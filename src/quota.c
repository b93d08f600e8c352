// SPDX-License-Identifier: MIT
#include "glim/quota.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PATH_BYTES 4096

/* Reads the first line; false if there is none. */
static bool first_line(const char *path, char *line, int line_bytes)
{
    FILE *f = fopen(path, "re");
    bool ok = f && fgets(line, line_bytes, f);

    if (f)
        fclose(f);
    return ok;
}

/* The smaller limit; 0 is none. */
static int tighter(int a, int b)
{
    return a == 0 || (b != 0 && b < a) ? b : a;
}

static int processors(long long quota_us, long long period_us)
{
    if (quota_us <= 0 || period_us <= 0)
        return 0;
    long long n = quota_us / period_us + (quota_us % period_us != 0);
    return n < 1000000 ? (int)n : 0;
}

/* Version 2: "max 100000" or "150000 100000". */
static int limit_v2(const char *folder)
{
    char path[PATH_BYTES + 32], line[128];
    long long quota_us, period_us;

    snprintf(path, sizeof path, "%s/cpu.max", folder);
    if (!first_line(path, line, sizeof line) ||
        sscanf(line, "%lld %lld", &quota_us, &period_us) != 2)
        return 0;
    return processors(quota_us, period_us);
}

/* Version 1: two files, -1 for no quota. */
static int limit_v1(const char *folder)
{
    char path[PATH_BYTES + 32], line[128];
    long long quota_us, period_us;

    snprintf(path, sizeof path, "%s/cpu.cfs_quota_us", folder);
    if (!first_line(path, line, sizeof line) ||
        sscanf(line, "%lld", &quota_us) != 1)
        return 0;
    snprintf(path, sizeof path, "%s/cpu.cfs_period_us", folder);
    if (!first_line(path, line, sizeof line) ||
        sscanf(line, "%lld", &period_us) != 1)
        return 0;
    return processors(quota_us, period_us);
}

/* From the group up to the mount. A container may see the host's path here but
 * only its own group at the mount: folders that are missing limit nothing. */
static int limit_of_parents(const char *mount, const char *group, bool is_v2)
{
    char folder[PATH_BYTES];
    size_t mount_length = strlen(mount);
    int limit = 0;

    if (snprintf(folder, sizeof folder, "%s%s", mount, group) >=
        (int)sizeof folder)
        return 0;
    for (;;) {
        limit = tighter(limit, is_v2 ? limit_v2(folder) : limit_v1(folder));
        char *slash = strrchr(folder + mount_length, '/');
        if (!slash)
            return limit;
        *slash = '\0';
    }
}

static bool names_cpu(const char *controllers)
{
    char list[256];

    snprintf(list, sizeof list, ",%s,", controllers);
    return strstr(list, ",cpu,") != NULL;
}

/* A line is "7:cpu,cpuacct:/group", or "0::/group" for version 2. */
static int limit_of_line(const char *root, char *line)
{
    char mount[PATH_BYTES];
    char *controllers = strchr(line, ':');
    char *group = controllers ? strchr(controllers + 1, ':') : NULL;

    if (!group)
        return 0;
    *group++ = '\0';
    controllers++;
    group[strcspn(group, "\n")] = '\0';
    if (*controllers == '\0') {
        snprintf(mount, sizeof mount, "%s/sys/fs/cgroup", root);
        return limit_of_parents(mount, group, true);
    }
    if (!names_cpu(controllers))
        return 0;
    snprintf(mount, sizeof mount, "%s/sys/fs/cgroup/%s", root, controllers);
    int limit = limit_of_parents(mount, group, false);
    snprintf(mount, sizeof mount, "%s/sys/fs/cgroup/cpu", root);
    return tighter(limit, limit_of_parents(mount, group, false));
}

int quota_processors(const char *root)
{
    char path[PATH_BYTES];
    char *line = NULL;
    size_t line_bytes = 0;
    int limit = 0;

    snprintf(path, sizeof path, "%s/proc/self/cgroup", root);
    FILE *f = fopen(path, "re");
    if (!f)
        return 0;
    while (getline(&line, &line_bytes, f) > 0)
        limit = tighter(limit, limit_of_line(root, line));
    free(line);
    fclose(f);
    return limit;
}
