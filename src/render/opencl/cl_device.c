// SPDX-License-Identifier: MIT
#include "render/opencl/cl_device.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/memory.h"
#include "base/print.h"
#include "render/opencl/cl_api.h"

/* ---- devices ---- */

/* Removes blanks around a name; drivers pad theirs. */
static char *trimmed(char *text)
{
    if (!text)
        return NULL;

    size_t begin = strspn(text, " \t\n");
    size_t length = strlen(text + begin);

    while (length > 0 && isspace((unsigned char)text[begin + length - 1]))
        length--;
    memmove(text, text + begin, length);
    text[length] = '\0';
    print_replace(text);
    return text;
}

/* Returns the name of a platform, for free(), or NULL when memory is out. */
static char *platform_name(const struct cl_api *cl, cl_platform_id platform)
{
    size_t size_bytes = 0;

    cl->GetPlatformInfo(platform, CL_PLATFORM_NAME, 0, NULL, &size_bytes);
    char *text = alloc_array(size_bytes + 1, 1);
    if (text)
        cl->GetPlatformInfo(platform, CL_PLATFORM_NAME, size_bytes, text, NULL);
    return trimmed(text);
}

static char *device_text(const struct cl_api *cl, cl_device_id id,
                         cl_device_info what)
{
    size_t size_bytes = 0;

    cl->GetDeviceInfo(id, what, 0, NULL, &size_bytes);
    char *text = alloc_array(size_bytes + 1, 1);
    if (text)
        cl->GetDeviceInfo(id, what, size_bytes, text, NULL);
    return trimmed(text);
}

/* Queries a device. Fields that the driver does not know stay zero. */
static struct cl_device describe(const struct cl_api *cl,
                                 cl_platform_id platform, cl_device_id id)
{
    struct cl_device d = {.platform = platform, .id = id};
    cl_device_type type = 0;
    cl_device_fp_config floats = 0;

    d.platform_name = platform_name(cl, platform);
    d.name = device_text(cl, id, CL_DEVICE_NAME);
    d.version = device_text(cl, id, CL_DEVICE_VERSION);
    d.driver_version = device_text(cl, id, CL_DRIVER_VERSION);
    cl->GetDeviceInfo(id, CL_DEVICE_TYPE, sizeof type, &type, NULL);
    cl->GetDeviceInfo(id, CL_DEVICE_SINGLE_FP_CONFIG, sizeof floats, &floats,
                      NULL);
    cl->GetDeviceInfo(id, CL_DEVICE_GLOBAL_MEM_SIZE, sizeof d.memory_bytes,
                      &d.memory_bytes, NULL);
    cl->GetDeviceInfo(id, CL_DEVICE_MAX_MEM_ALLOC_SIZE,
                      sizeof d.max_alloc_bytes, &d.max_alloc_bytes, NULL);
    cl->GetDeviceInfo(id, CL_DEVICE_MAX_COMPUTE_UNITS, sizeof d.compute_units,
                      &d.compute_units, NULL);
    d.is_cpu = (type & CL_DEVICE_TYPE_CPU) != 0;
    d.is_gpu = (type & CL_DEVICE_TYPE_GPU) != 0;
    d.has_correct_divide = (floats & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    return d;
}

static void free_device(struct cl_device *d)
{
    free(d->platform_name);
    free(d->name);
    free(d->version);
    free(d->driver_version);
}

static bool has_texts(const struct cl_device *d)
{
    return d->platform_name && d->name && d->version && d->driver_version;
}

/* Adds `count` devices to the list, which has room for them. */
static bool add_devices(struct cl_devices *list, const struct cl_api *cl,
                        cl_platform_id platform, const cl_device_id *ids,
                        cl_uint count)
{
    for (cl_uint i = 0; i < count; i++) {
        struct cl_device d = describe(cl, platform, ids[i]);

        if (!has_texts(&d)) {
            free_device(&d);
            return false;
        }
        list->items[list->count++] = d;
    }
    return true;
}

/* Adds the devices of a platform. A platform without hardware has none. Returns
 * false if memory is out. */
static bool add_platform(struct cl_devices *list, const struct cl_api *cl,
                         cl_platform_id platform)
{
    cl_uint count = 0;

    if (cl->GetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, NULL, &count) !=
            CL_SUCCESS ||
        count == 0)
        return true;
    cl_device_id *ids = alloc_array(count, sizeof *ids);
    void *items = realloc(list->items,
                          ((size_t)list->count + count) * sizeof *list->items);
    bool ok = ids && items;
    if (items)
        list->items = items;
    if (ok) {
        cl->GetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, ids, NULL);
        ok = add_devices(list, cl, platform, ids, count);
    }
    free(ids);
    return ok;
}

static bool fail_memory(struct error *err)
{
    return fail(err, "OpenCL: out of memory for the list of devices");
}

/* Reports that there is no device. PoCL reports no reason if its cache folder
 * is not writable, so that error is checked first. */
static bool fail_deviceless(const struct cl_api *cl, cl_platform_id platform,
                            const struct error *no_cache, struct error *err)
{
    char *name = platform_name(cl, platform);
    const char *chosen = getenv("POCL_DEVICES");

    if (!name)
        fail_memory(err);
    else if (no_cache)
        fail(err,
             "OpenCL: found no device of platform '%s': PoCL cannot write its "
             "cache, %s (POCL_CACHE_DIR names another folder)",
             name, no_cache->text);
    else if (chosen)
        fail(err,
             "OpenCL: found no device of platform '%s' with POCL_DEVICES='%s'",
             name, chosen);
    else
        fail(err, "OpenCL: found no device of platform '%s'", name);
    free(name);
    return false;
}

static bool list_platforms(struct cl_devices *list, const struct cl_api *cl,
                           struct error *err)
{
    struct error no_cache;
    bool has_cache = cl_cache_open(&no_cache);
    cl_uint count = 0;
    cl_int status = cl->GetPlatformIDs(0, NULL, &count);

    if (status == CL_PLATFORM_NOT_FOUND_KHR ||
        (status == CL_SUCCESS && count == 0))
        return fail(err, "OpenCL: found no platform, expected a driver such "
                         "as Debian's package pocl-opencl-icd");
    if (status != CL_SUCCESS)
        return fail(err, "OpenCL: clGetPlatformIDs: %s", cl_error_name(status));

    cl_platform_id *platforms = alloc_array(count, sizeof *platforms);
    if (!platforms)
        return fail_memory(err);
    cl->GetPlatformIDs(count, platforms, NULL);
    bool ok = true;
    for (cl_uint i = 0; ok && i < count; i++)
        ok = add_platform(list, cl, platforms[i]) || fail_memory(err);
    if (ok && list->count == 0)
        ok = fail_deviceless(cl, platforms[0], has_cache ? NULL : &no_cache,
                             err);
    free(platforms);
    return ok;
}

bool cl_device_list(struct cl_devices *list, struct error *err)
{
    const struct cl_api *cl = cl_api_open(err);
    struct cl_signals signals;

    *list = (struct cl_devices){0};
    if (!cl)
        return false;
    cl_signals_keep(&signals);
    bool ok = list_platforms(list, cl, err);
    cl_signals_put_back(&signals);
    if (!ok)
        cl_devices_free(list);
    return ok;
}

void cl_devices_free(struct cl_devices *list)
{
    for (int i = 0; i < list->count; i++)
        free_device(&list->items[i]);
    free(list->items);
    *list = (struct cl_devices){0};
}

/* Returns true if the word selects the device. Digits only are a number: 4 does
 * not select a device with 4090 in its name. */
static bool is_selected(const struct cl_devices *list, int index,
                        const char *word)
{
    const struct cl_device *d = &list->items[index];
    char number[16];

    snprintf(number, sizeof number, "%d", index + 1);
    if (word[strspn(word, "0123456789")] == '\0')
        return strcmp(word, number) == 0;
    return strcasestr(d->name, word) || strcasestr(d->platform_name, word);
}

/* Writes the devices that the word selects (NULL: all) as "1 'Name', 2 'Name'".
 * A list that is too long for an error is cut. */
static void format_names(struct error *names, const struct cl_devices *list,
                         const char *word)
{
    size_t length = 0;

    names->text[0] = '\0';
    for (int i = 0; i < list->count; i++) {
        if (word && !is_selected(list, i, word))
            continue;
        snprintf(names->text + length, sizeof names->text - length, "%s%d '%s'",
                 length > 0 ? ", " : "", i + 1, list->items[i].name);
        length = strlen(names->text);
    }
}

static const struct cl_device *find_best(const struct cl_devices *list)
{
    for (int i = 0; i < list->count; i++) {
        if (list->items[i].is_gpu)
            return &list->items[i];
    }
    return &list->items[0];
}

const struct cl_device *cl_device_find(const struct cl_devices *list,
                                       const char *word, struct error *err)
{
    const struct cl_device *found = NULL;
    int count = 0;

    if (!word)
        return find_best(list);
    for (int i = 0; i < list->count; i++) {
        if (is_selected(list, i, word)) {
            found = &list->items[i];
            count++;
        }
    }
    if (count == 1)
        return found;

    struct error names;
    format_names(&names, list, found ? word : NULL);
    if (found)
        fail(err,
             "--device: found '%s' in the names of %d devices, expected one of "
             "%s",
             word, count, names.text);
    else
        fail(err, "--device: found no device '%s', expected one of %s", word,
             names.text);
    return NULL;
}

/* Returns the length of "OpenCL 3.0"; the driver's own text follows it. */
static int version_length(const char *version)
{
    const char *blank = strchr(version, ' ');

    if (!blank)
        return (int)strlen(version);
    return (int)(blank + 1 - version + (ptrdiff_t)strcspn(blank + 1, " "));
}

static const char *kind_of(const struct cl_device *d)
{
    return d->is_gpu ? "GPU" : d->is_cpu ? "CPU" : "other";
}

static int wider(int width, const char *text)
{
    int length = (int)strlen(text);

    return length > width ? length : width;
}

void cl_devices_print(const struct cl_devices *list, FILE *out)
{
    int device = wider(0, "device");
    int driver = wider(0, "driver");

    for (int i = 0; i < list->count; i++) {
        device = wider(device, list->items[i].name);
        driver = wider(driver, list->items[i].driver_version);
    }
    print_line(out, "%2s  %-5s  %5s  %10s  %-10s  %-*s  %-*s  %s", "N", "kind",
               "units", "memory", "version", driver, "driver", device, "device",
               "platform");
    for (int i = 0; i < list->count; i++) {
        const struct cl_device *d = &list->items[i];

        print_line(out,
                   "%2d  %-5s  %5" PRIu32
                   "  %6.1f GiB  %-10.*s  %-*s  %-*s  %s",
                   i + 1, kind_of(d), d->compute_units,
                   (double)d->memory_bytes / (1 << 30),
                   version_length(d->version), d->version, driver,
                   d->driver_version, device, d->name, d->platform_name);
    }
}

/* ---- an open device ---- */

/* Polling interval for devices whose driver waits busily. */
#define POLL_NS 100000

/* Work-items in a group: whole warps on GPUs; on CPUs large enough to hide the
 * cost of a group and small enough to halt soon. */
#define GROUP 64

bool cl_machine_check(const struct cl_machine *m, cl_int code, const char *call,
                      struct error *err)
{
    if (m->thread != NULL && !cl_thread_beat(m->thread))
        return fail(err, "OpenCL: %s: too late", call);
    if (code == CL_SUCCESS)
        return true;
    return fail(err, "OpenCL device %s: %s: %s", m->device->name, call,
                cl_error_name(code));
}

static bool open_device(struct cl_machine *m, struct error *err)
{
    const cl_context_properties properties[] = {
        CL_CONTEXT_PLATFORM, (cl_context_properties)m->device->platform, 0};
    cl_int code;

    m->context =
        m->api->CreateContext(properties, 1, &m->device->id, NULL, NULL, &code);
    if (!cl_machine_check(m, code, "clCreateContext", err))
        return false;
    m->queue = m->api->CreateCommandQueue(m->context, m->device->id, 0, &code);
    return cl_machine_check(m, code, "clCreateCommandQueue", err);
}

bool cl_machine_open(struct cl_machine *m, const char *word,
                     struct cl_thread *thread, struct error *err)
{
    *m = (struct cl_machine){.api = cl_api_open(err), .thread = thread};
    if (m->api == NULL || !cl_device_list(&m->devices, err) ||
        !cl_machine_check(m, CL_SUCCESS, "the list of devices", err))
        return false;
    m->device = cl_device_find(&m->devices, word, err);
    if (m->device != NULL && open_device(m, err))
        return true;
    cl_machine_close(m);
    return false;
}

void cl_machine_close(struct cl_machine *m)
{
    if (m->queue != NULL)
        m->api->ReleaseCommandQueue(m->queue);
    if (m->context != NULL)
        m->api->ReleaseContext(m->context);
    cl_devices_free(&m->devices);
    *m = (struct cl_machine){0};
}

cl_mem cl_machine_buffer(const struct cl_machine *m, const void *data,
                         size_t size_bytes, bool shared, struct error *err)
{
    static const uint32_t nothing[4];
    cl_mem_flags flags = CL_MEM_READ_WRITE;
    cl_mem buffer;
    cl_int code;

    if (size_bytes > m->device->max_alloc_bytes) {
        fail(err,
             "OpenCL device %s: found an array of %.1f MiB, expected at most "
             "%.1f MiB",
             m->device->name, (double)size_bytes / (1 << 20),
             (double)m->device->max_alloc_bytes / (1 << 20));
        return NULL;
    }
    if (size_bytes == 0) { /* OpenCL refuses empty buffers */
        data = nothing;
        size_bytes = sizeof nothing;
        shared = false;
    }
    if (data != NULL)
        flags |= shared && m->device->is_cpu ? CL_MEM_USE_HOST_PTR
                                             : CL_MEM_COPY_HOST_PTR;
    buffer = m->api->CreateBuffer(m->context, flags, size_bytes,
                                  (void *)(uintptr_t)data, &code);
    return cl_machine_check(m, code, "clCreateBuffer", err) ? buffer : NULL;
}

void cl_machine_drop(const struct cl_machine *m, cl_mem *buffer)
{
    if (*buffer != NULL)
        m->api->ReleaseMemObject(*buffer);
    *buffer = NULL;
}

bool cl_machine_set(const struct cl_machine *m, cl_kernel kernel, cl_uint first,
                    const cl_mem *buffers, cl_uint count, struct error *err)
{
    for (cl_uint i = 0; i < count; i++)
        if (!cl_machine_check(m,
                              m->api->SetKernelArg(kernel, first + i,
                                                   sizeof *buffers,
                                                   &buffers[i]),
                              "clSetKernelArg", err))
            return false;
    return true;
}

bool cl_machine_enqueue(const struct cl_machine *m, cl_kernel kernel,
                        size_t count, struct error *err)
{
    size_t local = GROUP;
    size_t global = (count + GROUP - 1) / GROUP * GROUP;

    return cl_machine_check(m,
                            m->api->EnqueueNDRangeKernel(m->queue, kernel, 1,
                                                         NULL, &global, &local,
                                                         0, NULL, NULL),
                            "clEnqueueNDRangeKernel", err);
}

bool cl_machine_wait(const struct cl_machine *m, cl_event *event,
                     struct error *err)
{
    const struct timespec pause = {0, POLL_NS};
    cl_int status = CL_QUEUED;
    cl_int code = CL_SUCCESS;

    if (m->device->is_cpu) /* its threads do the work, so waiting sleeps */
        code = m->api->WaitForEvents(1, event);
    while (code == CL_SUCCESS && status > CL_COMPLETE) {
        code = m->api->GetEventInfo(*event, CL_EVENT_COMMAND_EXECUTION_STATUS,
                                    sizeof status, &status, NULL);
        if (code == CL_SUCCESS && status > CL_COMPLETE) {
            if (m->thread != NULL && cl_thread_is_left(m->thread))
                return fail(err, "OpenCL: a command: too late");
            nanosleep(&pause, NULL);
        }
    }
    m->api->ReleaseEvent(*event);
    *event = NULL;
    if (code == CL_SUCCESS)
        code = status; /* a negative status is the error of the command */
    return cl_machine_check(m, code, "rendering", err);
}
