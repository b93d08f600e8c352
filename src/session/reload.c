// SPDX-License-Identifier: MIT
#include "session/reload.h"

#include "base/clock.h"

bool reload_init(struct reload *r, const struct options *options,
                 struct error *err)
{
    *r = (struct reload){.options = options};
    return background_init(&r->loading, "reload", err);
}

static void load(void *context)
{
    struct reload *r = context;

    r->is_loaded = session_load(&r->fresh, r->options, clock_ns(), &r->error);
}

bool reload_begin(struct reload *r, struct error *err)
{
    if (r->loading.is_busy)
        return fail(err, "%s: is being loaded already", r->options->scene_path);
    return background_begin(&r->loading, load, r, r->options->scene_path, err);
}

bool reload_end(struct reload *r, struct session *fresh, struct error *err)
{
    background_finish(&r->loading);
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

    if (r->loading.is_busy) {
        reload_end(r, &fresh, &ignored);
        session_close(&fresh);
    }
    background_free(&r->loading);
}
