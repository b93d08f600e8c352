// SPDX-License-Identifier: MIT
#include "base/library_child.h"

#include <dlfcn.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "base/machine.h"

/* ---- functions ---- */

bool dynamic_library_load(const char *file,
                          const struct library_function *functions,
                          size_t count, void *table, const char **missing)
{
    void *library = dlopen(file, RTLD_NOW | RTLD_LOCAL);

    *missing = NULL;
    if (library == NULL)
        return false;
    for (size_t i = 0; i < count; i++) {
        void *function = dlsym(library, functions[i].name);

        if (function == NULL) {
            *missing = functions[i].name;
            return false;
        }
        /* ISO C does not allow a cast from object pointer to function
         * pointer */
        memcpy((char *)table + functions[i].offset, &function, sizeof function);
    }
    return true;
}

/* ---- copies ---- */

/* Limits of time and memory of small files. */
#define TIME_S       30
#define MEMORY_BYTES ((uint64_t)1 << 30)

/* Longest message that is shown. */
#define MESSAGE_MAX 300

/* Sanitizers map more memory than any limit. gcc and clang name them in their
 * own ways. */
#ifndef __has_feature
#define __has_feature(name) 0
#endif
#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__ || \
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HAS_SHADOW 1
#else
#define HAS_SHADOW 0
#endif

static struct library_limits limits_of(const struct library_task *t)
{
    uint64_t quota = cgroup_quota_memory("").size_bytes;
    uint64_t wanted =
        MEMORY_BYTES + t->memory_of_a_byte * (uint64_t)t->size_bytes;

    if (t->memory_most != 0 && t->memory_most < quota)
        quota = t->memory_most;
    return (struct library_limits){
        .time_s = TIME_S + (unsigned)(t->size_bytes / t->bytes_a_second),
        .memory_bytes = wanted < quota ? wanted : quota,
    };
}

/* Reports the end of a copy that failed: its message, or the signal. */
static bool fail_copy(const char *library, const struct child_result *r,
                      struct error *err)
{
    size_t length = strcspn(r->output, "\n");

    if (WIFSIGNALED(r->status) && WTERMSIG(r->status) == SIGXCPU)
        return fail(err, "%s does not end", library);
    if (WIFSIGNALED(r->status))
        return fail(err, "%s crashed (%s)", library,
                    strsignal(WTERMSIG(r->status)));
    if (length == 0)
        return fail(err, "%s ended with status %d", library,
                    WEXITSTATUS(r->status));
    return fail(err, "%.*s", (int)(length < MESSAGE_MAX ? length : MESSAGE_MAX),
                r->output);
}

bool library_child_run(const struct library_task *task,
                       struct child_result *result, struct error *err)
{
    struct library_limits limits = limits_of(task);
    char text[64];
    const char *const arguments[] = {
        "glim",     task->option, text, task->path != NULL ? "-f" : NULL,
        task->path, NULL};
    struct child_task child = {
        .program = task->program,
        .arguments = arguments,
        .input = task->input,
        .input_bytes = task->size_bytes,
        .time_ns = UINT64_C(1000000000) * limits.time_s,
        .size_bytes = limits.memory_bytes,
    };

    if (task->path != NULL) {
        child.input = task->words;
        child.input_bytes = task->words != NULL ? strlen(task->words) : 0;
    }
    snprintf(text, sizeof text, "%u,%" PRIu64, limits.time_s,
             limits.memory_bytes);
    switch (child_run(&child, result)) {
    case CHILD_NOT_RUN:
    case CHILD_UNKNOWN:
        return fail(err, "%s could not be run: %s", task->library,
                    strerror(result->reason));
    case CHILD_LATE:
        return fail(err, "%s was not ready after %u s", task->library,
                    limits.time_s);
    case CHILD_TOO_LONG:
    case CHILD_NO_MEMORY: return fail(err, "out of memory for the scene");
    case CHILD_ENDED: break;
    }
    return (WIFEXITED(result->status) && WEXITSTATUS(result->status) == 0) ||
           fail_copy(task->library, result, err);
}

void library_child_limit(struct library_limits limits)
{
    const struct rlimit time = {limits.time_s, limits.time_s};
    const struct rlimit memory = {limits.memory_bytes, limits.memory_bytes};
    const struct rlimit none = {0, 0};

    setrlimit(RLIMIT_CPU, &time);
    if (!HAS_SHADOW)
        setrlimit(RLIMIT_AS, &memory);
    setrlimit(RLIMIT_CORE, &none);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
}

bool library_child_fail(FILE *to, const struct error *err)
{
    fprintf(to, "%s\n", err->text);
    fflush(to);
    return false;
}
