// SPDX-License-Identifier: MIT
#include "render/opencl/cl_environment.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/thread_pool.h"
#include "base/xdg.h"

/* Variable with the name of PoCL's cache folder. */
#define CACHE_VARIABLE "POCL_CACHE_DIR"

/* Signals that LLVM 15 handles (lib/Support/Unix/Signals.inc), and SIGFPE,
 * which PoCL handles. */
static const int taken[CL_SIGNAL_COUNT] = {SIGHUP,  SIGINT,  SIGQUIT, SIGILL,
                                           SIGTRAP, SIGABRT, SIGBUS,  SIGFPE,
                                           SIGSEGV, SIGUSR1, SIGUSR2, SIGTERM,
                                           SIGXCPU, SIGXFSZ, SIGSYS};

/* Sets the cache folder. Without a home folder PoCL finds one itself. */
static void choose_cache(void)
{
    char *cache = xdg_folder("XDG_CACHE_HOME", ".cache");
    char *folder;

    if (!cache)
        return;
    folder = format_text("%s/pocl", cache);
    if (folder)
        setenv(CACHE_VARIABLE, folder, 0);
    free(folder);
    free(cache);
}

void cl_environment_prepare(int thread_count)
{
    char count[16];

    if (thread_count == 0)
        thread_count = usable_threads();
    snprintf(count, sizeof count, "%d", thread_count);
    setenv("POCL_MAX_PTHREAD_COUNT", count, 0);
    setenv("POCL_CPU_MAX_CU_COUNT", count, 0); /* since PoCL 4 */
    setenv("POCL_SIGFPE_HANDLER", "0", 1);
    choose_cache();
}

bool cl_cache_open(struct error *err)
{
    const char *folder = getenv(CACHE_VARIABLE);

    if (!folder || *folder == '\0')
        return true;
    char *path = format_text("%s/.", folder); /* fails for a plain file */
    if (!path)
        return fail(err, "OpenCL: out of memory");
    bool ok = folder_make(path) && access(path, R_OK | W_OK | X_OK) == 0;
    free(path);
    return ok || fail(err, "%s: %s", folder, strerror(errno));
}

void cl_signals_keep(struct cl_signals *s)
{
    for (int i = 0; i < CL_SIGNAL_COUNT; i++)
        sigaction(taken[i], NULL, &s->actions[i]);
}

void cl_signals_put_back(const struct cl_signals *s)
{
    for (int i = 0; i < CL_SIGNAL_COUNT; i++)
        sigaction(taken[i], &s->actions[i], NULL);
}
