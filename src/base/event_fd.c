// SPDX-License-Identifier: MIT
#include "base/event_fd.h"

#include <errno.h>
#include <string.h>
#include <sys/eventfd.h>
#include <unistd.h>

int event_fd_open(const char *whose, struct error *err)
{
    int fd = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);

    if (fd < 0)
        fail(err, "%s: cannot open an event descriptor: %s", whose,
             strerror(errno));
    return fd;
}

void event_fd_set(int fd)
{
    const uint64_t one = 1;

    if (write(fd, &one, sizeof one) < 0) {
        /* the counter is full, so the descriptor is readable anyway */
    }
}

void event_fd_clear(int fd)
{
    uint64_t count;

    if (read(fd, &count, sizeof count) < 0) {
        /* the counter was zero already */
    }
}
