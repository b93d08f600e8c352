// SPDX-License-Identifier: MIT
#include "opencl/cl_probe.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"
#include "render/cpu_dispatch.h"
#include "opencl/cl_source.h"
#include "opencl/selftest.h"

extern char **environ;

/* Time limit: compilers take seconds, a hanging driver takes forever. */
#define ANSWER_NS UINT64_C(60000000000)

/* Polling interval of *is_unwanted. */
#define LOOK_MS 50

/* Limit for the copy's output, more than a compiler prints. */
#define OUTPUT_BYTES_MAX ((size_t)1 << 20)

/* ---- cache ---- */

/* Returns the path of the cached result, for free(); NULL without a cache
 * folder, or if memory is out. */
static char *memory_path(const struct cl_request *r)
{
    const char *folder = getenv("POCL_CACHE_DIR");
    struct error ignored;
    char *text, *key, *path;

    if (folder == NULL || *folder == '\0')
        return NULL;
    text = cl_source_text(r->kernels_path, &ignored);
    if (text == NULL)
        return NULL;
    key = format_text("%s %u %s", r->device != NULL ? r->device : "",
                      r->features, text);
    path = key != NULL
               ? format_text("%s/glim-%016" PRIx64, folder, cl_source_hash(key))
               : NULL;
    free(key);
    free(text);
    return path;
}

/* Removes the last line from the text and returns it, for free(); NULL if there
 * is none, or memory is out. */
static char *cut_last_line(char *text)
{
    size_t length = strlen(text);
    char *line;

    while (length > 0 && text[length - 1] == '\n')
        text[--length] = '\0';
    if (length == 0)
        return NULL;
    line = strrchr(text, '\n');
    if (line == NULL) {
        char *copy = strdup(text);

        *text = '\0';
        return copy;
    }
    *line = '\0';
    return strdup(line + 1);
}

/* Parses a good answer, whose last lines are the device and the verdict. Takes
 * ownership of the text. */
static bool take_answer(struct cl_probe *probe, char *text)
{
    *probe = (struct cl_probe){.log = text};
    probe->verdict = cut_last_line(text);
    probe->device = cut_last_line(text);
    return probe->device != NULL && probe->verdict != NULL;
}

bool cl_probe_recall(struct cl_probe *probe, const struct cl_request *r)
{
    char *path = memory_path(r);
    char *text = NULL;
    size_t size_bytes;
    struct error ignored;
    bool ok = path != NULL && file_read(path, &text, &size_bytes, &ignored);

    free(path);
    if (ok && take_answer(probe, text))
        return true;
    if (ok)
        cl_probe_free(probe);
    return false;
}

static void remember(const struct cl_probe *probe, const struct cl_request *r)
{
    char *path = memory_path(r);
    char *text = format_text("%s\n%s\n", probe->device, probe->verdict);
    struct error ignored;

    if (path != NULL && text != NULL)
        file_write(path, text, strlen(text), false, NULL, &ignored);
    free(text);
    free(path);
}

/* ---- the copy ---- */

bool cl_probe_answer(struct cl_probe *probe, const struct cl_request *r,
                     struct error *err)
{
    char verdict[SELFTEST_VERDICT_BYTES];
    struct backend *device, *cpu;
    bool ok = false;

    *probe = (struct cl_probe){0};
    device = backend_cl_create(r, &probe->log, err);
    if (device == NULL)
        return false;
    cpu = backend_cpu_create(1, cpu_kernel_best(), err);
    if (cpu != NULL) {
        ok = selftest_run(cpu, device, r->features, verdict, err);
        cpu->destroy(cpu);
    }
    if (ok) {
        probe->device = cl_probe_device(device);
        probe->verdict = strdup(verdict);
        ok = (probe->device != NULL && probe->verdict != NULL) ||
             fail(err, "OpenCL: out of memory");
    }
    device->destroy(device);
    return ok;
}

char *cl_probe_device(const struct backend *backend)
{
    return format_text("%s, %s", backend->device, backend->driver);
}

/* ---- its parent ---- */

/* Starts the copy with both outputs in the pipe and the signal handling that
 * glim was started with. Returns 0 or an error number. */
static int spawn(pid_t *pid, const char *program, const char *const *arguments,
                 int output)
{
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    sigset_t none, all;
    int reason;

    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes,
                             POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, output, 1);
    posix_spawn_file_actions_adddup2(&files, output, 2);
    /* posix_spawn() does not change the arguments, in spite of its type */
    reason = posix_spawn(pid, program, &files, &attributes,
                         (char *const *)(uintptr_t)arguments, environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    return reason;
}

static int start_copy(pid_t *pid, const struct cl_request *r, int output)
{
    char features[16];
    const char *arguments[10] = {"glim", "--probe", features, "--backend",
                                 r->needs_gpu ? "auto" : "opencl"};
    int count = 5;

    snprintf(features, sizeof features, "%u", r->features);
    if (r->device != NULL) {
        arguments[count++] = "--device";
        arguments[count++] = r->device;
    }
    if (r->kernels_path != NULL) {
        arguments[count++] = "--kernels";
        arguments[count++] = r->kernels_path;
    }
    return spawn(pid, r->program, arguments, output);
}

/* Reads the pipe to its end. Returns NULL on a timeout, if *is_unwanted becomes
 * true, or if memory is out. */
static char *read_output(int fd, const atomic_bool *is_unwanted)
{
    uint64_t end_ns = clock_ns() + ANSWER_NS;
    char *text = alloc_array(1, 1);
    size_t length = 0;

    while (text != NULL) {
        struct pollfd in = {.fd = fd, .events = POLLIN};
        char bytes[4096];
        ssize_t count;

        if (atomic_load(is_unwanted) || clock_ns() > end_ns) {
            free(text);
            return NULL;
        }
        if (poll(&in, 1, LOOK_MS) <= 0)
            continue;
        count = read(fd, bytes, sizeof bytes);
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            return text;
        if (length + (size_t)count > OUTPUT_BYTES_MAX)
            continue; /* the beginning has the cause, so the rest is skipped */
        char *longer = realloc(text, length + (size_t)count + 1);
        if (longer == NULL)
            free(text);
        text = longer;
        if (text == NULL)
            break;
        memcpy(text + length, bytes, (size_t)count);
        length += (size_t)count;
        text[length] = '\0';
    }
    return NULL;
}

/* Reports the failure of the copy: its last line, or the signal that killed
 * it. */
static bool fail_copy(struct cl_probe *probe, char *output, int status,
                      struct error *err)
{
    char *line = cut_last_line(output);
    const char *said = line != NULL ? line : "";
    static const char prefix[] = "glim: ";

    if (strncmp(said, prefix, sizeof prefix - 1) == 0)
        said += sizeof prefix - 1;
    if (WIFSIGNALED(status))
        fail(err, "OpenCL: the driver crashed (%s)%s%s",
             strsignal(WTERMSIG(status)), *said != '\0' ? ": " : "", said);
    else if (*said != '\0')
        fail(err, "%s", said);
    else
        fail(err, "OpenCL: the self-test ended with status %d",
             WEXITSTATUS(status));
    *probe = (struct cl_probe){.log = output};
    free(line);
    return false;
}

static bool take_output(struct cl_probe *probe, char *output, int status,
                        struct error *err)
{
    if (output == NULL)
        return fail(err, "OpenCL: the driver does not answer");
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return fail_copy(probe, output, status, err);
    if (take_answer(probe, output))
        return true;
    cl_probe_free(probe);
    return fail(err, "OpenCL: the self-test gave no verdict");
}

bool cl_probe_run(struct cl_probe *probe, const struct cl_request *r,
                  const atomic_bool *is_unwanted, struct error *err)
{
    pid_t child;
    int fds[2], reason, status = 0;
    char *output;

    *probe = (struct cl_probe){0};
    if (pipe2(fds, O_CLOEXEC) != 0)
        return fail(err, "OpenCL: cannot open a pipe: %s", strerror(errno));
    reason = start_copy(&child, r, fds[1]);
    close(fds[1]);
    if (reason != 0) {
        close(fds[0]);
        return fail(err, "OpenCL: %s: cannot run the self-test: %s", r->program,
                    strerror(reason));
    }
    output = read_output(fds[0], is_unwanted);
    close(fds[0]);
    if (output == NULL)
        kill(child, SIGKILL);
    while (waitpid(child, &status, 0) < 0) {
        if (errno == EINTR)
            continue;
        free(output);
        return fail(err, "OpenCL: how the self-test ended is not known: %s",
                    strerror(errno));
    }
    if (!take_output(probe, output, status, err))
        return false;
    remember(probe, r);
    return true;
}

void cl_probe_free(struct cl_probe *probe)
{
    free(probe->device);
    free(probe->verdict);
    free(probe->log);
    *probe = (struct cl_probe){0};
}
