// SPDX-License-Identifier: MIT
#include "import/import.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "base/cgroup_quota.h"
#include "base/child.h"
#include "base/file.h"
#include "import/assimp_api.h"
#include "import/import_stream.h"

/* Formats of libassimp 5.2, without those that glim reads, those of animations
 * alone, and endings of other kinds of files, such as .xml. */
const char import_endings[] =
    "fbx dae 3ds x3d x3db x blend off lwo lxo lws ase ask dxf ac acc ac3d b3d "
    "cob 3mf amf irr irrmesh md2 md3 mdl mdc md5mesh ms3d ogex q3o q3s smd nff "
    "enff iqm pmx ndo sib hmp 3d uc xgl zgl zae bsp pk3 ifc assbin";

/* Limits of time and memory: a start, and more for each byte of the file.
 * libassimp reads 5 to 50 MB/s, and a scene is up to 40 times its file. */
#define TIME_S           30
#define BYTES_A_SECOND   1000000
#define MEMORY_BYTES     ((uint64_t)1 << 30)
#define MEMORY_OF_A_BYTE 60

/* Longest message that is shown. */
#define MESSAGE_MAX 300

static unsigned time_limit_s(size_t size_bytes)
{
    return TIME_S + (unsigned)(size_bytes / BYTES_A_SECOND);
}

static uint64_t memory_limit_bytes(size_t size_bytes)
{
    uint64_t quota = cgroup_quota_memory("").size_bytes;
    uint64_t wanted = MEMORY_BYTES + MEMORY_OF_A_BYTE * (uint64_t)size_bytes;

    return wanted < quota ? wanted : quota;
}

/* Reports the end of a copy that did not send a scene: its message, or the
 * signal. */
static bool fail_copy(const char *path, const struct child_result *r,
                      struct error *err)
{
    size_t length = strcspn(r->output, "\n");

    if (WIFSIGNALED(r->status) && WTERMSIG(r->status) == SIGXCPU)
        return fail(err, "%s: libassimp does not end", path);
    if (WIFSIGNALED(r->status))
        return fail(err, "%s: libassimp crashed (%s)", path,
                    strsignal(WTERMSIG(r->status)));
    if (length == 0)
        return fail(err, "%s: libassimp ended with status %d", path,
                    WEXITSTATUS(r->status));
    return fail(err, "%s: %.*s", path,
                (int)(length < MESSAGE_MAX ? length : MESSAGE_MAX), r->output);
}

/* Reports a copy that was killed or not started. */
static bool fail_end(enum child_end end, const char *path,
                     const struct child_result *r, unsigned time_s,
                     struct error *err)
{
    switch (end) {
    case CHILD_NOT_RUN:
    case CHILD_UNKNOWN:
        return fail(err, "%s: libassimp could not be run: %s", path,
                    strerror(r->reason));
    case CHILD_LATE:
        return fail(err, "%s: libassimp was not ready after %u s", path,
                    time_s);
    case CHILD_TOO_LONG:
    case CHILD_NO_MEMORY:
        return fail(err, "%s: out of memory for the scene", path);
    case CHILD_ENDED: break;
    }
    return fail_copy(path, r, err);
}

bool import_parse(struct scene *scene, const char *bytes, size_t size_bytes,
                  const char *path, struct warnings *report, struct error *err)
{
    char limits[64];
    const char *const arguments[] = {"glim", "--import", limits,
                                     "-f",   path,       NULL};
    unsigned time_s = time_limit_s(size_bytes);
    uint64_t memory_bytes = memory_limit_bytes(size_bytes);
    struct child_task task = {
        .program = scene->program,
        .arguments = arguments,
        .time_ns = UINT64_C(1000000000) * time_s,
        .size_bytes = memory_bytes,
    };
    struct child_result result;
    enum child_end end;
    bool ok;

    (void)bytes;
    if (strcmp(path, "-") == 0 || scene->program == NULL)
        return fail(err,
                    "%s: found a format that only the program glim reads, and "
                    "only from a file",
                    path);
    snprintf(limits, sizeof limits, "%u,%" PRIu64, time_s, memory_bytes);
    end = child_run(&task, &result);
    if (end != CHILD_ENDED || !WIFEXITED(result.status) ||
        WEXITSTATUS(result.status) != 0)
        ok = fail_end(end, path, &result, time_s, err);
    else
        ok = import_stream_read(scene, result.output, result.size_bytes, path,
                                report, err);
    free(result.output);
    return ok;
}

const char *import_missing(void)
{
    struct error ignored;

    return assimp_api_open(&ignored) != NULL ? NULL : ASSIMP_PACKAGE;
}
