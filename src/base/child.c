// SPDX-License-Identifier: MIT
#include "base/child.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/memory.h"

extern char **environ;

/* Polling interval of *is_unwanted. */
#define LOOK_MS 50

/* Size of a read, and of the pipe if the system grants it: a child that writes
 * much then waits less. */
#define PIPE_BYTES (1 << 16)

/* Returns a file in memory at the start of the input, or -1 and errno. A file
 * is never full, as a pipe is. */
static int open_input(const struct child_task *t)
{
    int fd = memfd_create("input", MFD_CLOEXEC);
    size_t done = 0;
    int reason;

    if (fd < 0)
        return -1;
    while (done < t->input_bytes) {
        ssize_t count =
            write(fd, (const char *)t->input + done, t->input_bytes - done);

        if (count >= 0)
            done += (size_t)count;
        else if (errno != EINTR)
            break;
    }
    if (done == t->input_bytes && lseek(fd, 0, SEEK_SET) == 0)
        return fd;
    reason = errno;
    close(fd);
    errno = reason;
    return -1;
}

/* Starts the program with its output in the pipe. `input` is -1 without one.
 * Returns 0 or an error number. */
static int start(pid_t *pid, const struct child_task *t, int input, int output)
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
    if (input >= 0)
        posix_spawn_file_actions_adddup2(&files, input, 0);
    else
        posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, output, 1);
    if (t->has_errors)
        posix_spawn_file_actions_adddup2(&files, output, 2);
    else
        posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
    /* posix_spawn() does not change the arguments, in spite of its type */
    reason = posix_spawn(pid, t->program, &files, &attributes,
                         (char *const *)(uintptr_t)t->arguments, environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    return reason;
}

/* Reads once. Returns false at the end of the output, and when there is no
 * reason to read more, which is put into *end. */
static bool read_some(int fd, const struct child_task *t,
                      struct child_result *r, size_t *capacity,
                      enum child_end *end)
{
    void *bytes = r->output;
    ssize_t count;

    if (!grow_array(&bytes, capacity, r->size_bytes + PIPE_BYTES + 1, 1)) {
        *end = CHILD_NO_MEMORY;
        return false;
    }
    r->output = bytes;
    count = read(fd, r->output + r->size_bytes, PIPE_BYTES);
    if (count < 0 && errno == EINTR)
        return true;
    if (count <= 0)
        return false;
    if (r->size_bytes + (size_t)count <= t->size_bytes) {
        r->size_bytes += (size_t)count;
        return true;
    }
    if (!t->is_cut)
        *end = CHILD_TOO_LONG;
    return t->is_cut;
}

/* The time that a child has had. */
struct child_time {
    pid_t child;
    uint64_t begin_ns,
        active_ns; /* when it began, and last used the processor */
    uint64_t cpu_ns;
};

/* Time of the clock for each limit of processor time: a share of the processor
 * that even a busy machine gives. */
#define CLOCK_FACTOR 10

/* Returns the processor time of the child's threads; the last one known if it
 * has ended. */
static uint64_t child_cpu_ns(const struct child_time *time)
{
    struct timespec cpu;
    clockid_t clock;

    if (clock_getcpuclockid(time->child, &clock) != 0 ||
        clock_gettime(clock, &cpu) != 0)
        return time->cpu_ns;
    return (uint64_t)cpu.tv_sec * 1000000000u + (uint64_t)cpu.tv_nsec;
}

static bool is_late(struct child_time *time, uint64_t limit_ns)
{
    uint64_t now_ns = clock_ns(), cpu_ns = child_cpu_ns(time);

    if (cpu_ns != time->cpu_ns)
        time->active_ns = now_ns;
    time->cpu_ns = cpu_ns;
    return cpu_ns > limit_ns || now_ns - time->active_ns > limit_ns ||
           (now_ns - time->begin_ns) / CLOCK_FACTOR > limit_ns;
}

static enum child_end read_output(pid_t child, int fd,
                                  const struct child_task *t,
                                  struct child_result *r)
{
    uint64_t now_ns = clock_ns();
    struct child_time time = {child, now_ns, now_ns, 0};
    enum child_end end = CHILD_ENDED;
    size_t capacity = 0;

    for (;;) {
        struct pollfd in = {.fd = fd, .events = POLLIN};

        if (is_late(&time, t->time_ns) ||
            (t->is_unwanted != NULL && atomic_load(t->is_unwanted)))
            return CHILD_LATE;
        if (poll(&in, 1, LOOK_MS) <= 0)
            continue;
        if (!read_some(fd, t, r, &capacity, &end))
            break;
    }
    if (end == CHILD_ENDED)
        r->output[r->size_bytes] = '\0';
    return end;
}

/* Waits for the child. Returns false if its status is lost. */
static bool await(pid_t child, struct child_result *r)
{
    while (waitpid(child, &r->status, 0) < 0) {
        if (errno == EINTR)
            continue;
        r->reason = errno;
        return false;
    }
    return true;
}

/* Starts the program. *output is the end of the pipe to read from. Returns 0 or
 * an error number. */
static int start_with_pipe(pid_t *pid, const struct child_task *t, int *output)
{
    int input = -1, fds[2], reason;

    *output = -1;
    if (pipe2(fds, O_CLOEXEC) != 0)
        return errno;
    fcntl(fds[0], F_SETPIPE_SZ, PIPE_BYTES * 16);
    if (t->input != NULL && (input = open_input(t)) < 0)
        reason = errno;
    else
        reason = start(pid, t, input, fds[1]);
    if (input >= 0)
        close(input);
    close(fds[1]);
    if (reason != 0)
        close(fds[0]);
    *output = fds[0];
    return reason;
}

enum child_end child_run(const struct child_task *t, struct child_result *r)
{
    enum child_end end;
    pid_t child;
    int output;

    *r = (struct child_result){0};
    r->reason = start_with_pipe(&child, t, &output);
    if (r->reason != 0)
        return CHILD_NOT_RUN;
    end = read_output(child, output, t, r);
    close(output);
    if (end != CHILD_ENDED)
        kill(child, SIGKILL);
    if (!await(child, r) && end == CHILD_ENDED)
        end = CHILD_UNKNOWN;
    if (end != CHILD_ENDED) {
        free(r->output);
        r->output = NULL;
        r->size_bytes = 0;
    }
    return end;
}
