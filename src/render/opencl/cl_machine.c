// SPDX-License-Identifier: MIT
#include "render/opencl/cl_machine.h"

#include <time.h>

/* Polling interval for devices whose driver waits busily. */
#define POLL_NS 100000

/* Work-items in a group: whole warps on GPUs; on CPUs large enough to hide the
 * cost of a group and small enough to halt soon. */
#define GROUP 64

bool cl_machine_check(const struct cl_machine *m, cl_int code, const char *call,
                      struct error *err)
{
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

bool cl_machine_open(struct cl_machine *m, const char *word, struct error *err)
{
    *m = (struct cl_machine){.api = cl_api_open(err)};
    if (m->api == NULL || !cl_device_list(&m->devices, err))
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
        if (code == CL_SUCCESS && status > CL_COMPLETE)
            nanosleep(&pause, NULL);
    }
    m->api->ReleaseEvent(*event);
    *event = NULL;
    if (code == CL_SUCCESS)
        code = status; /* a negative status is the error of the command */
    return cl_machine_check(m, code, "rendering", err);
}
