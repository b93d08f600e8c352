// SPDX-License-Identifier: MIT
#include "render/opencl/cl_api.h"

#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/library_child.h"
#include "base/memory.h"
#include "base/thread_pool.h"
#include "base/xdg.h"

/* ---- environment ---- */

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

/* ---- functions ---- */

#define LIBRARY "libOpenCL.so.1"

static struct cl_api api;
static bool is_loaded;
static struct error load_error;

static const struct library_function functions[] = {
#define ROW(name) {"cl" #name, offsetof(struct cl_api, name)},
    CL_API_FUNCTIONS(ROW)
#undef ROW
};

/* Loads the library for good: drivers do not survive being unloaded. */
static void load(void)
{
    const char *missing;

    is_loaded = dynamic_library_load(LIBRARY, functions,
                                     sizeof functions / sizeof functions[0],
                                     &api, &missing);
    if (is_loaded)
        return;
    if (missing == NULL)
        fail(&load_error, "OpenCL: %s (Debian's package: ocl-icd-libopencl1)",
             dlerror());
    else
        fail(&load_error, "OpenCL: %s has no %s, expected OpenCL 1.2", LIBRARY,
             missing);
}

const struct cl_api *cl_api_open(struct error *err)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;

    pthread_once(&once, load);
    if (is_loaded)
        return &api;
    *err = load_error;
    return NULL;
}

const char *cl_error_name(cl_int code)
{
#define NAME(code) \
    case code: return #code
    switch (code) {
        NAME(CL_SUCCESS);
        NAME(CL_DEVICE_NOT_FOUND);
        NAME(CL_DEVICE_NOT_AVAILABLE);
        NAME(CL_COMPILER_NOT_AVAILABLE);
        NAME(CL_MEM_OBJECT_ALLOCATION_FAILURE);
        NAME(CL_OUT_OF_RESOURCES);
        NAME(CL_OUT_OF_HOST_MEMORY);
        NAME(CL_PROFILING_INFO_NOT_AVAILABLE);
        NAME(CL_MEM_COPY_OVERLAP);
        NAME(CL_IMAGE_FORMAT_MISMATCH);
        NAME(CL_IMAGE_FORMAT_NOT_SUPPORTED);
        NAME(CL_BUILD_PROGRAM_FAILURE);
        NAME(CL_MAP_FAILURE);
        NAME(CL_MISALIGNED_SUB_BUFFER_OFFSET);
        NAME(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST);
        NAME(CL_COMPILE_PROGRAM_FAILURE);
        NAME(CL_LINKER_NOT_AVAILABLE);
        NAME(CL_LINK_PROGRAM_FAILURE);
        NAME(CL_DEVICE_PARTITION_FAILED);
        NAME(CL_KERNEL_ARG_INFO_NOT_AVAILABLE);
        NAME(CL_INVALID_VALUE);
        NAME(CL_INVALID_DEVICE_TYPE);
        NAME(CL_INVALID_PLATFORM);
        NAME(CL_INVALID_DEVICE);
        NAME(CL_INVALID_CONTEXT);
        NAME(CL_INVALID_QUEUE_PROPERTIES);
        NAME(CL_INVALID_COMMAND_QUEUE);
        NAME(CL_INVALID_HOST_PTR);
        NAME(CL_INVALID_MEM_OBJECT);
        NAME(CL_INVALID_IMAGE_FORMAT_DESCRIPTOR);
        NAME(CL_INVALID_IMAGE_SIZE);
        NAME(CL_INVALID_SAMPLER);
        NAME(CL_INVALID_BINARY);
        NAME(CL_INVALID_BUILD_OPTIONS);
        NAME(CL_INVALID_PROGRAM);
        NAME(CL_INVALID_PROGRAM_EXECUTABLE);
        NAME(CL_INVALID_KERNEL_NAME);
        NAME(CL_INVALID_KERNEL_DEFINITION);
        NAME(CL_INVALID_KERNEL);
        NAME(CL_INVALID_ARG_INDEX);
        NAME(CL_INVALID_ARG_VALUE);
        NAME(CL_INVALID_ARG_SIZE);
        NAME(CL_INVALID_KERNEL_ARGS);
        NAME(CL_INVALID_WORK_DIMENSION);
        NAME(CL_INVALID_WORK_GROUP_SIZE);
        NAME(CL_INVALID_WORK_ITEM_SIZE);
        NAME(CL_INVALID_GLOBAL_OFFSET);
        NAME(CL_INVALID_EVENT_WAIT_LIST);
        NAME(CL_INVALID_EVENT);
        NAME(CL_INVALID_OPERATION);
        NAME(CL_INVALID_GL_OBJECT);
        NAME(CL_INVALID_BUFFER_SIZE);
        NAME(CL_INVALID_MIP_LEVEL);
        NAME(CL_INVALID_GLOBAL_WORK_SIZE);
        NAME(CL_INVALID_PROPERTY);
        NAME(CL_INVALID_IMAGE_DESCRIPTOR);
        NAME(CL_INVALID_COMPILER_OPTIONS);
        NAME(CL_INVALID_LINKER_OPTIONS);
        NAME(CL_INVALID_DEVICE_PARTITION_COUNT);
        NAME(CL_PLATFORM_NOT_FOUND_KHR);
    default: return "an unknown OpenCL error";
    }
#undef NAME
}
