// SPDX-License-Identifier: MIT
/*
 * A scene is opened with its view, its sky and all other files, and rendered
 * with one sample per pixel. fuzz_put_scene() describes the input.
 */
#include "fuzz.h"
#include "mutate_text.h"
#include "session/session.h"

static void render(struct session *s)
{
    struct error err = {""};
    struct render_progress p;

    require(session_restart(s, (struct render_limits){.spp = 1}, &err),
            err.text);
    render_wait(s->engine.render, -1);
    p = render_progress(s->engine.render);
    require(p.state == RENDER_DONE, p.error.text);
    require(p.non_finite == 0, "finite samples");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *path = fuzz_put_scene(data, size);
    struct options options;
    struct session s;
    struct error err = {""};

    options_init(&options);
    options.scene_path = path;
    options.width_px = options.height_px = 8;
    options.thread_count = 1;
    options.batch = true;
    if (session_open(&s, &options, 0, &err))
        render(&s);
    else
        fuzz_check_message(err.text);
    fuzz_check_report(&s.engine.report);
    session_close(&s);
    free(path);
    return 0;
}
