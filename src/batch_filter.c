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

void batch_filter_warn(void)
{
    print_line(stderr, "glim: warning: --denoise: a pixel has fewer than two "
                       "samples or no features; the picture is not filtered");
}

void batch_filter_say(const char *path)
{
    print_line(stderr, "%s: filtered", path);
}

bool batch_filter(struct session *s, struct film *filtered, struct error *err)
{
    struct film *film = render_film(s->render);

    if (!film_filter_applies(film)) {
        batch_filter_warn();
        return true;
    }
    s->is_denoised =
        film_filter_copy(film, options_threads(s->options), filtered, err);
    return s->is_denoised;
}

struct image_metadata batch_filter_metadata(const struct session *s,
                                            const struct film *film)
{
    return session_metadata(s,
                            s->is_denoised && film != render_film(s->render));
}

bool batch_filter_write(struct session *s, struct film *filtered,
                        struct error *err)
{
    struct image_metadata metadata = batch_filter_metadata(s, filtered);
    const char *path = s->options->denoise_path;

    if (!image_write(filtered, session_develop(s), &metadata, path, err))
        return false;
    batch_filter_say(path);
    return true;
}
