// SPDX-License-Identifier: MIT
#include "session/save.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "base/file.h"
#include "film/image_write.h"
#include "session/session_save.h"
#include "terminal/xmalloc.h"

/* Returns the scene's file name without folder and extension, for free(). */
static char *scene_name(const struct live_render *control)
{
    char *stem =
        xchecked(path_stem_of_input(control->session->engine.scene.path));
    char *name = xstrdup(path_name(stem));

    free(stem);
    return name;
}

/* Shows a line, which is also printed at the end, and frees it. */
static void say_saved(struct live_render *control, char *text)
{
    live_render_say(control, "%s", text);
    live_render_add_result(control, text);
    free(text);
}

void save_picture(struct live_render *control, const char *ending)
{
    struct render_progress now =
        render_progress(control->session->engine.render);
    struct film *film = render_film(control->session->engine.render);
    struct error err;
    char *stem;

    if (now.samples == 0) {
        live_render_say(control, "nothing to save yet");
        return;
    }
    stem = scene_name(control);
    if (save_thread_begin(&control->saver,
                          &(struct picture_to_save){
                              film, session_develop(control->session),
                              engine_metadata(&control->session->engine, false),
                              stem, ending},
                          &err)) {
        control->saving_samples = now.samples;
        snprintf(control->saving_what, sizeof control->saving_what,
                 "%dx%d, %" PRIu64 " spp%s", film->width, film->height,
                 now.spp_done,
                 control->session->is_filtered ? ", with its noise" : "");
        live_render_say_long(control, "saving ...");
    } else {
        live_render_say_error(control, err.text);
    }
    free(stem);
}

bool save_finish(struct live_render *control)
{
    struct error err;
    char *name;

    if (!control->saver.copying.is_busy)
        return true;
    name = save_thread_finish(&control->saver, &err);
    if (!name) {
        live_render_say_error(control, err.text);
        live_render_add_result(control, err.text);
        return false;
    }
    say_saved(control, xformat("saved %s %s", name, control->saving_what));
    control->saved_samples = control->saving_samples;
    free(name);
    return true;
}

void save_frame(struct live_render *control, const struct frame *frame)
{
    char *stem = scene_name(control);
    struct error err;
    char *name = image_write_frame_numbered(frame, stem, &err);

    free(stem);
    if (name)
        say_saved(control, xformat("saved %s %dx%d, as it is shown", name,
                                   frame->width, frame->height));
    else
        live_render_say_error(control, err.text);
    free(name);
}

void save_text(struct live_render *control, const struct frame *frame,
               const struct ansi_text_style *style)
{
    char *stem = scene_name(control);
    struct error err;
    char *text, *name = NULL;
    size_t size_bytes;

    if (ansi_text_of_frame(frame, style, &text, &size_bytes, &err)) {
        name = file_write_numbered(stem, "ans", text, size_bytes, &err);
        free(text);
    }
    free(stem);
    if (name)
        say_saved(control, xformat("saved %s, text of %dx%d characters", name,
                                   style->cols, style->rows));
    else
        live_render_say_error(control, err.text);
    free(name);
}

void save_view(struct live_render *control)
{
    struct session *s = control->session;
    struct file_change change;
    struct error err;

    /* the reload may have read the old view file */
    if (control->reload.loading.is_busy) {
        if (control->is_live)
            live_render_say(control, "not written: the scene is being loaded");
        else
            live_render_say(
                control,
                "not written: the scene was loaded again, which live mode "
                "takes over: %s switches to it",
                live_render_key(control, ACTION_MODE).text);
        return;
    }
    if (!session_save_view(s, &change, &err)) {
        live_render_say_error(control, err.text);
        return;
    }
    file_watch_wrote(&control->watch, s->engine.view_path, &change.after);
    say_saved(control,
              xformat("wrote the view to %s%s%s%s", s->engine.view_path,
                      change.is_kept ? ", the old one is " : "",
                      change.is_kept ? path_name(s->engine.view_path) : "",
                      change.is_kept ? "~" : ""));
}

bool save_edit(struct live_render *control)
{
    struct error err;
    char *what;

    if (!session_save_edit(control->session, &control->watch, &what, &err)) {
        live_render_say_error(control, err.text);
        return false;
    }
    control->files_ns = clock_ns(); /* reload changed files now */
    say_saved(control, what);
    return true;
}
