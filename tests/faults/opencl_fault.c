// SPDX-License-Identifier: MIT
/*
 * opencl_fault.c - a libOpenCL.so.1 that passes calls on to the system's, and
 * lets one of them fail or never return
 *
 * Programs find it by LD_LIBRARY_PATH; FAULT_OPENCL is the path of the system's
 * library. With FAULT=opencl:N the Nth call fails, with
 * FAULT=clFinish:N the Nth call of this function, with a + behind the number
 * all later ones as well. FAULT_CODE is the error, CL_OUT_OF_RESOURCES if it is
 * not set, or "hang": the call never returns. FAULT=event:N lets the Nth
 * question for the state of a command, or wait for one, find that it has
 * failed. FAULT_COUNT is as in fault.c; FAULT_DEVICE=other hides that devices
 * are CPUs, so that the host does not share their memory.
 *
 * Threads:   any
 */
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

static char kind[40];
static long first, last;
static atomic_long own_count, *count = &own_count;
static cl_int error_code = CL_OUT_OF_RESOURCES;
static bool hangs, hides_cpus;
static void *library;

/* Maps the count of all processes. */
static void share_count(const char *path)
{
    int fd = path != NULL ? open(path, O_RDWR | O_CREAT, 0600) : -1;
    void *at = MAP_FAILED;

    if (fd >= 0 && ftruncate(fd, sizeof *count) == 0)
        at = mmap(NULL, sizeof *count, PROT_READ | PROT_WRITE, MAP_SHARED, fd,
                  0);
    if (at != MAP_FAILED)
        count = at;
    if (fd >= 0)
        close(fd);
}

static void read_environment(void)
{
    const char *what = getenv("FAULT");
    const char *colon = what != NULL ? strchr(what, ':') : NULL;
    const char *code = getenv("FAULT_CODE");
    const char *path = getenv("FAULT_OPENCL");

    hides_cpus = getenv("FAULT_DEVICE") != NULL;
    hangs = code != NULL && strcmp(code, "hang") == 0;
    if (code != NULL && !hangs)
        error_code = atoi(code);
    library = path != NULL ? dlopen(path, RTLD_NOW | RTLD_LOCAL) : NULL;
    if (library == NULL)
        abort();
    if (colon == NULL || (size_t)(colon - what) >= sizeof kind)
        return;
    share_count(getenv("FAULT_COUNT"));
    first = atol(colon + 1);
    last = strchr(colon, '+') != NULL ? LONG_MAX : first;
    memcpy(kind, what, (size_t)(colon - what));
}

static void *next(const char *name)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;

    pthread_once(&once, read_environment);
    return dlsym(library, name);
}

/* Counts a call. */
static bool is_chosen(const char *name, const char *group)
{
    long n;

    if (strcmp(kind, name) != 0 && strcmp(kind, group) != 0)
        return false;
    n = atomic_fetch_add(count, 1) + 1;
    return n >= first && n <= last;
}

static bool fails(const char *name, const char *group)
{
    if (!is_chosen(name, group))
        return false;
    while (hangs)
        pause();
    return true;
}

/* A function that returns a code. `after` may change what it found. */
#define CALL_AFTER(name, parameters, arguments, after) \
    cl_int name parameters                             \
    {                                                  \
        __typeof__(name) *call = next(#name);          \
        cl_int code;                                   \
                                                       \
        if (fails(#name, "opencl"))                    \
            return error_code;                         \
        code = call arguments;                         \
        after;                                         \
        return code;                                   \
    }

#define CALL(name, parameters, arguments) \
    CALL_AFTER(name, parameters, arguments, )

/* A function that returns an object, or NULL and the code. */
#define CREATE(type, name, parameters, arguments) \
    type name parameters                          \
    {                                             \
        __typeof__(name) *call = next(#name);     \
                                                  \
        if (!fails(#name, "opencl"))              \
            return call arguments;                \
        if (code != NULL)                         \
            *code = error_code;                   \
        return NULL;                              \
    }

/* ---- platforms and devices ---- */

CALL(clGetPlatformIDs, (cl_uint n, cl_platform_id *ids, cl_uint *found),
     (n, ids, found))
CALL(clGetPlatformInfo,
     (cl_platform_id id, cl_platform_info what, size_t size, void *to,
      size_t *needed),
     (id, what, size, to, needed))
CALL(clGetDeviceIDs,
     (cl_platform_id id, cl_device_type type, cl_uint n, cl_device_id *ids,
      cl_uint *found),
     (id, type, n, ids, found))

static void hide_cpu(cl_device_info what, void *to)
{
    if (hides_cpus && what == CL_DEVICE_TYPE && to != NULL)
        *(cl_device_type *)to = CL_DEVICE_TYPE_ACCELERATOR;
}

CALL_AFTER(clGetDeviceInfo,
           (cl_device_id id, cl_device_info what, size_t size, void *to,
            size_t *needed),
           (id, what, size, to, needed), hide_cpu(what, to))
CREATE(cl_context, clCreateContext,
       (const cl_context_properties *properties, cl_uint n,
        const cl_device_id *ids,
        void(CL_CALLBACK *report)(const char *, const void *, size_t, void *),
        void *user, cl_int *code),
       (properties, n, ids, report, user, code))
CALL(clReleaseContext, (cl_context context), (context))
CREATE(cl_command_queue, clCreateCommandQueue,
       (cl_context context, cl_device_id id,
        cl_command_queue_properties properties, cl_int *code),
       (context, id, properties, code))
CALL(clReleaseCommandQueue, (cl_command_queue queue), (queue))

/* ---- kernels ---- */

CREATE(cl_program, clCreateProgramWithSource,
       (cl_context context, cl_uint n, const char **texts,
        const size_t *lengths, cl_int *code),
       (context, n, texts, lengths, code))
CALL(clBuildProgram,
     (cl_program program, cl_uint n, const cl_device_id *ids,
      const char *options, void(CL_CALLBACK *done)(cl_program, void *),
      void *user),
     (program, n, ids, options, done, user))
CALL(clGetProgramBuildInfo,
     (cl_program program, cl_device_id id, cl_program_build_info what,
      size_t size, void *to, size_t *needed),
     (program, id, what, size, to, needed))
CALL(clReleaseProgram, (cl_program program), (program))
CREATE(cl_kernel, clCreateKernel,
       (cl_program program, const char *name, cl_int *code),
       (program, name, code))
CALL(clSetKernelArg,
     (cl_kernel kernel, cl_uint index, size_t size, const void *value),
     (kernel, index, size, value))
CALL(clReleaseKernel, (cl_kernel kernel), (kernel))

/* ---- buffers and commands ---- */

CREATE(cl_mem, clCreateBuffer,
       (cl_context context, cl_mem_flags flags, size_t size, void *data,
        cl_int *code),
       (context, flags, size, data, code))
CALL(clReleaseMemObject, (cl_mem buffer), (buffer))
CALL(clEnqueueNDRangeKernel,
     (cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
      const size_t *offset, const size_t *global, const size_t *local,
      cl_uint n, const cl_event *list, cl_event *event),
     (queue, kernel, dimensions, offset, global, local, n, list, event))
CALL(clEnqueueReadBuffer,
     (cl_command_queue queue, cl_mem buffer, cl_bool blocks, size_t offset,
      size_t size, void *to, cl_uint n, const cl_event *list, cl_event *event),
     (queue, buffer, blocks, offset, size, to, n, list, event))
CALL(clEnqueueWriteBuffer,
     (cl_command_queue queue, cl_mem buffer, cl_bool blocks, size_t offset,
      size_t size, const void *from, cl_uint n, const cl_event *list,
      cl_event *event),
     (queue, buffer, blocks, offset, size, from, n, list, event))
CALL(clEnqueueReadBufferRect,
     (cl_command_queue queue, cl_mem buffer, cl_bool blocks, const size_t *from,
      const size_t *to_origin, const size_t *region, size_t row, size_t slice,
      size_t to_row, size_t to_slice, void *to, cl_uint n, const cl_event *list,
      cl_event *event),
     (queue, buffer, blocks, from, to_origin, region, row, slice, to_row,
      to_slice, to, n, list, event))
CALL(clEnqueueFillBuffer,
     (cl_command_queue queue, cl_mem buffer, const void *pattern, size_t size,
      size_t offset, size_t bytes, cl_uint n, const cl_event *list,
      cl_event *event),
     (queue, buffer, pattern, size, offset, bytes, n, list, event))

/* Lets a command that has ended be one that failed. */
static cl_int failed_wait(cl_int code)
{
    return is_chosen("event", "") ? CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST
                                  : code;
}

static void fail_event(cl_event_info what, void *to)
{
    if (what == CL_EVENT_COMMAND_EXECUTION_STATUS && *(cl_int *)to <= 0 &&
        is_chosen("event", ""))
        *(cl_int *)to = error_code;
}

CALL_AFTER(clWaitForEvents, (cl_uint n, const cl_event *events), (n, events),
           code = failed_wait(code))
CALL_AFTER(clGetEventInfo,
           (cl_event event, cl_event_info what, size_t size, void *to,
            size_t *needed),
           (event, what, size, to, needed), fail_event(what, to))
CALL(clReleaseEvent, (cl_event event), (event))
CALL(clFlush, (cl_command_queue queue), (queue))
CALL(clFinish, (cl_command_queue queue), (queue))
