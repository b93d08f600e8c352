// SPDX-License-Identifier: MIT
#include "session/save.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/file.h"
#include "engine/engine_film.h"
#include "engine/engine_metadata.h"
#include "film/image_write.h"
#include "session/session_save.h"
#include "terminal/xmalloc.h"

static const char text_ending[] = "ans";

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

static bool begin(struct live_render *control, struct picture_to_save picture)
{
    struct render_progress now =
        render_progress(control->session->engine.render);
    char *stem = scene_name(control);
    struct error err;
    bool ok;

    picture.stem = stem;
    ok = save_thread_begin(&control->saver, &picture, &err);
    if (ok) {
        int length = snprintf(control->saving_what, sizeof control->saving_what,
                              " %dx%d", control->session->engine.crop.width,
                              control->session->engine.crop.height);

        control->saving_samples = control->saved_samples;
        if (picture.film != NULL) {
            control->saving_samples = now.samples;
            snprintf(control->saving_what + length,
                     sizeof control->saving_what - (size_t)length,
                     ", %" PRIu64 " spp", now.spp_done);
        }
        live_render_say_long(control, "saving ...");
    } else {
        live_render_say_error(control, err.text);
    }
    free(stem);
    return ok;
}

/* Starts to save the film. `world` is NULL, or that of a filtered picture. */
static void begin_film(struct live_render *control, const char *ending,
                       const struct world *world)
{
    struct engine *engine = &control->session->engine;
    struct picture_to_save picture = {.film = render_film(engine->render),
                                      .how = session_develop(control->session),
                                      .ending = ending};
    struct error ignored;
    struct view view;

    if (render_progress(engine->render).samples == 0) {
        live_render_say(control, "nothing to save yet");
        return;
    }
    session_view_to_save(control->session, &view);
    if (session_is_outdated(control->session) ||
        !engine_film_describe(engine, &view, &picture.identity,
                              &picture.identified, &ignored))
        picture.identified.positions = NULL;
    picture.metadata =
        engine_metadata_described(engine, &view, &picture.identity, false);
    picture.filtered_metadata =
        engine_metadata_described(engine, &view, &picture.identity, true);
    picture.kernels_path = engine->options.device.kernels_path;
    view_free(&view);
    if (world != NULL) {
        picture.is_filtered = true;
        picture.world = *world;
    }
    begin(control, picture);
}

void save_picture(struct live_render *control, const char *ending)
{
    begin_film(control, ending, NULL);
}

void save_filtered(struct live_render *control, const struct world *world)
{
    begin_film(control, "png", world);
}

void save_frame(struct live_render *control, struct frame *frame)
{
    if (!begin(control,
               (struct picture_to_save){.frame = *frame, .ending = "png"}))
        frame_free(frame);
}

/* Says what a saved picture is if that may not be expected. */
static const char *how_saved(const struct live_render *control)
{
    const struct save_thread *s = &control->saver;

    if (strcmp(s->picture.ending, text_ending) == 0)
        return "";
    if (s->picture.film == NULL)
        return ", as it is shown";
    return s->was_filtered                 ? ", filtered"
           : control->session->is_filtered ? ", with its noise"
                                           : "";
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
    say_saved(control, xformat("saved %s%s%s", name, control->saving_what,
                               how_saved(control)));
    control->saved_samples = control->saving_samples;
    free(name);
    return true;
}

void save_text(struct live_render *control, const struct frame *frame,
               const struct ansi_text_style *style)
{
    struct picture_to_save picture = {.ending = text_ending};
    struct error err;

    if (!ansi_text_of_frame(frame, style, &picture.text, &picture.text_bytes,
                            &err)) {
        live_render_say_error(control, err.text);
        return;
    }
    if (begin(control, picture))
        snprintf(control->saving_what, sizeof control->saving_what,
                 ", text of %dx%d characters", style->cols, style->rows);
    else
        free(picture.text);
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
