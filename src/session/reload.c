// SPDX-License-Identifier: MIT
#include "session/reload.h"

#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/event_fd.h"
#include "base/thread_pool.h"

bool reload_init(struct reload *r, const struct options *options,
                 struct error *err)
{
    *r = (struct reload){.event_fd = event_fd_open("reload", err),
                         .options = options};
    return r->event_fd >= 0;
}

static void *reload_main(void *argument)
{
    struct reload *r = argument;

    r->is_loaded = session_load(&r->fresh, r->options, clock_ns(), &r->error);
    event_fd_set(r->event_fd);
    return NULL;
}

bool reload_begin(struct reload *r, struct error *err)
{
    int reason;

    if (r->is_busy)
        return fail(err, "%s: is being loaded already", r->options->scene_path);
    reason = thread_start(&r->thread, reload_main, r);
    if (reason != 0)
        return fail(err, "%s: cannot start a thread to load it: %s",
                    r->options->scene_path, strerror(reason));
    r->is_busy = true;
    return true;
}

bool reload_end(struct reload *r, struct session *fresh, struct error *err)
{
    pthread_join(r->thread, NULL);
    r->is_busy = false;
    event_fd_clear(r->event_fd);
    *fresh = r->fresh;
    r->fresh = (struct session){0}; /* the caller owns it now */
    if (!r->is_loaded)
        *err = r->error;
    return r->is_loaded;
}

void reload_free(struct reload *r)
{
    struct session fresh;
    struct error ignored;

    if (r->is_busy) {
        reload_end(r, &fresh, &ignored);
        session_close(&fresh);
    }
    close(r->event_fd);
}
