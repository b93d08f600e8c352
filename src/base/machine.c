// SPDX-License-Identifier: MIT
#include "base/machine.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

/* ---- instruction sets ---- */

#if defined(__x86_64__)

bool cpu_has_avx2(void)
{
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi");
}

bool cpu_has_avx512(void)
{
    return cpu_has_avx2() && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512bw");
}

#else

bool cpu_has_avx2(void)
{
    return false;
}

bool cpu_has_avx512(void)
{
    return false;
}

#endif

/* ---- quotas ---- */

#define PATH_BYTES 4096

/* Reads the first line of a file. Returns false if there is none. */
static bool first_line(const char *path, char *line, int line_bytes)
{
    FILE *f = fopen(path, "re");
    bool ok = f && fgets(line, line_bytes, f);

    if (f)
        fclose(f);
    return ok;
}

/* Returns the smaller of two limits, where 0 means no limit. */
static uint64_t tighter(uint64_t a, uint64_t b)
{
    return a == 0 || (b != 0 && b < a) ? b : a;
}

/* Resource that control groups limit: the name of its controller in version 1,
 * and a function that reads the limit from the files of a group's folder (0 if
 * there is none). */
struct resource {
    const char *controller;
    uint64_t (*limit)(const char *folder, bool is_v2);
};

/* Reads the first line of a file in the folder. Returns false if it fails. */
static bool line_in(const char *folder, const char *name, char *line,
                    int line_bytes)
{
    char path[PATH_BYTES + 32];

    snprintf(path, sizeof path, "%s/%s", folder, name);
    return first_line(path, line, line_bytes);
}

static uint64_t processors(long long quota_us, long long period_us)
{
    if (quota_us <= 0 || period_us <= 0)
        return 0;
    long long n = quota_us / period_us + (quota_us % period_us != 0);
    return n < 1000000 ? (uint64_t)n : 0;
}

/* Reads the processor quota. Version 2 has one file with "max 100000" or
 * "150000 100000"; version 1 has two files, with -1 for no quota. */
static uint64_t processor_limit(const char *folder, bool is_v2)
{
    char line[128];
    long long quota_us, period_us;

    if (is_v2)
        return line_in(folder, "cpu.max", line, sizeof line) &&
                       sscanf(line, "%lld %lld", &quota_us, &period_us) == 2
                   ? processors(quota_us, period_us)
                   : 0;
    if (!line_in(folder, "cpu.cfs_quota_us", line, sizeof line) ||
        sscanf(line, "%lld", &quota_us) != 1 ||
        !line_in(folder, "cpu.cfs_period_us", line, sizeof line) ||
        sscanf(line, "%lld", &period_us) != 1)
        return 0;
    return processors(quota_us, period_us);
}

/* Reads the memory limit: a number of bytes, or "max". */
static uint64_t memory_limit(const char *folder, bool is_v2)
{
    const char *name = is_v2 ? "memory.max" : "memory.limit_in_bytes";
    char line[128];
    uint64_t size_bytes;

    return line_in(folder, name, line, sizeof line) &&
                   sscanf(line, "%" SCNu64, &size_bytes) == 1
               ? size_bytes
               : 0;
}

static const struct resource processor_time = {"cpu", processor_limit};
static const struct resource memory = {"memory", memory_limit};

/* Returns the smallest limit of the group and of its parents up to the mount. A
 * container may see the host's path here but only its own group at the mount,
 * so missing folders count as no limit. */
static uint64_t limit_of_parents(const struct resource *r, const char *mount,
                                 const char *group, bool is_v2)
{
    char folder[PATH_BYTES];
    size_t mount_length = strlen(mount);
    uint64_t limit = 0;

    if (snprintf(folder, sizeof folder, "%s%s", mount, group) >=
        (int)sizeof folder)
        return 0;
    for (;;) {
        limit = tighter(limit, r->limit(folder, is_v2));
        char *slash = strrchr(folder + mount_length, '/');
        if (!slash)
            return limit;
        *slash = '\0';
    }
}

static bool has_controller(const char *controllers, const char *name)
{
    char list[256], wanted[32];

    snprintf(list, sizeof list, ",%s,", controllers);
    snprintf(wanted, sizeof wanted, ",%s,", name);
    return strstr(list, wanted) != NULL;
}

/* Returns the limit for a line of proc/self/cgroup: "7:cpu,cpuacct:/group", or
 * "0::/group" in version 2. */
static uint64_t limit_of_line(const struct resource *r, const char *root,
                              char *line)
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
        return limit_of_parents(r, mount, group, true);
    }
    if (!has_controller(controllers, r->controller))
        return 0;
    snprintf(mount, sizeof mount, "%s/sys/fs/cgroup/%s", root, controllers);
    uint64_t limit = limit_of_parents(r, mount, group, false);
    snprintf(mount, sizeof mount, "%s/sys/fs/cgroup/%s", root, r->controller);
    return tighter(limit, limit_of_parents(r, mount, group, false));
}

static uint64_t group_limit(const struct resource *r, const char *root)
{
    char path[PATH_BYTES];
    char *line = NULL;
    size_t line_bytes = 0;
    uint64_t limit = 0;

    snprintf(path, sizeof path, "%s/proc/self/cgroup", root);
    FILE *f = fopen(path, "re");
    if (!f)
        return 0;
    while (getline(&line, &line_bytes, f) > 0)
        limit = tighter(limit, limit_of_line(r, root, line));
    free(line);
    fclose(f);
    return limit;
}

int cgroup_quota_processors(const char *root)
{
    return (int)group_limit(&processor_time, root);
}

static void tighten(struct memory_quota *quota, uint64_t size_bytes,
                    const char *place)
{
    if (size_bytes != 0 && size_bytes < quota->size_bytes)
        *quota = (struct memory_quota){size_bytes, place};
}

struct memory_quota cgroup_quota_memory(const char *root)
{
    struct memory_quota quota = {(uint64_t)sysconf(_SC_PHYS_PAGES) *
                                     (uint64_t)sysconf(_SC_PAGESIZE),
                                 "in this machine"};
    struct rlimit limit;

    tighten(&quota, group_limit(&memory, root), "in the control group");
    if (getrlimit(RLIMIT_DATA, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        tighten(&quota, limit.rlim_cur, "under ulimit -d");
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        tighten(&quota, limit.rlim_cur, "under ulimit -v");
    return quota;
}
