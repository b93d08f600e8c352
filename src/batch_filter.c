// SPDX-License-Identifier: MIT
#include "batch_filter.h"

#include <stdio.h>

#include "base/print.h"
#include "filter/film_filter.h"
#include "picture/image_write.h"

bool batch_filter_check(const struct session *s, struct error *err)
{
    const char *path = s->options->denoise_path;

    return session_check_output(s, "--denoise", path, err) &&
           image_write_check(path, err);
}

bool batch_filter(struct session *s, struct film *filtered, struct error *err)
{
    struct film *film = render_film(s->render);
    struct pool *pool;
    bool ok;

    if (!film_filter_applies(film)) {
        print_line(stderr, "glim: warning: --denoise: a pixel has fewer than "
                           "two samples; the picture is not filtered");
        return true;
    }
    pool = pool_create(options_threads(s->options), err);
    if (pool == NULL)
        return false;
    ok = film_init(filtered, film->width, film->height, err) &&
         film_filter(film, pool, filtered, err);
    pool_destroy(pool);
    s->is_denoised = ok;
    return ok;
}

struct image_metadata batch_filter_metadata(const struct session *s,
                                            const struct film *film)
{
    struct image_metadata m = session_metadata(s);

    if (s->is_denoised && film != render_film(s->render))
        image_metadata_add(&m, "glim:denoised", "true");
    return m;
}

bool batch_filter_write(struct session *s, struct film *filtered,
                        struct error *err)
{
    struct image_metadata metadata = batch_filter_metadata(s, filtered);
    const char *path = s->options->denoise_path;

    if (!image_write(filtered, session_develop(s), &metadata, path, err))
        return false;
    print_line(stderr, "%s: filtered", path);
    return true;
}
