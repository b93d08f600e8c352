// SPDX-License-Identifier: MIT
#include "session/save_thread.h"

#include <stdlib.h>

#include "base/stop.h"
#include "film/image_write.h"
#include "terminal/xmalloc.h"

bool save_thread_init(struct save_thread *s, struct error *err)
{
    *s = (struct save_thread){.stem = NULL};
    return background_init(&s->copying, "saver", err);
}

static void save(void *context)
{
    struct save_thread *s = context;
    struct film copy = {0};
    bool ok;

    stop_hold();
    ok = film_copy(&copy, s->picture.film, &s->error);
    background_has_copied(&s->copying);
    if (ok)
        s->name =
            image_write_numbered(&copy, s->picture.how, &s->picture.metadata,
                                 s->stem, s->picture.ending, &s->error);
    film_free(&copy);
    stop_release();
}

bool save_thread_begin(struct save_thread *s, const struct picture_to_save *p,
                       struct error *err)
{
    char *what;
    bool ok;

    if (s->copying.is_busy)
        return fail(err, "%s.%s: the previous picture is still being saved",
                    p->stem, p->ending);
    s->picture = *p;
    s->picture.stem = s->stem = xstrdup(p->stem);
    s->name = NULL;
    what = xformat("%s.%s", p->stem, p->ending);
    ok = background_begin(&s->copying, save, s, what, err);
    free(what);
    if (!ok)
        free(s->stem);
    return ok;
}

char *save_thread_finish(struct save_thread *s, struct error *err)
{
    background_finish(&s->copying);
    free(s->stem);
    s->stem = NULL;
    if (!s->name)
        *err = s->error;
    return s->name;
}

void save_thread_free(struct save_thread *s)
{
    struct error ignored;

    if (s->copying.is_busy)
        free(save_thread_finish(s, &ignored));
    background_free(&s->copying);
}
