// SPDX-License-Identifier: MIT
#include "studio/save_commands.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"
#include "picture/image_write.h"
#include "session/recent.h"
#include "session/session_save.h"

/* A live picture is worth to be kept from this time on. */
#define WORTH_NS UINT64_C(5000000000)

/* The scene's name without folder and ending. */
static char *scene_name(const struct render_control *w)
{
    char *stem = path_stem(w->session->scene.path);
    const char *slash = strrchr(stem, '/');
    char *name = xstrdup(slash ? slash + 1 : stem);

    free(stem);
    return name;
}

void work_save_picture(struct render_control *w, const char *ending)
{
    struct render_progress now = render_progress(w->session->render);
    struct error err;
    char *stem;

    if (now.samples == 0) {
        render_control_say(w, "nothing to save yet");
        return;
    }
    stem = scene_name(w);
    if (save_thread_begin(&w->saver, render_film(w->session->render),
                          session_develop(w->session), stem, ending, &err)) {
        w->saving_samples = now.samples;
        snprintf(w->saving_what, sizeof w->saving_what,
                 "%dx%d, %" PRIu64 " spp",
                 render_film(w->session->render)->width,
                 render_film(w->session->render)->height, now.spp_done);
        render_control_say_long(w, "saving ...");
    } else {
        render_control_say_error(w, err.text);
    }
    free(stem);
}

bool work_finish_saving(struct render_control *w)
{
    struct error err;
    char *name, *text;

    if (!w->saver.is_busy)
        return true;
    name = save_thread_finish(&w->saver, &err);
    if (!name) {
        render_control_say_error(w, err.text);
        render_control_add_result(w, err.text);
        return false;
    }
    text = xformat("saved %s %s", name, w->saving_what);
    render_control_say(w, "%s", text);
    render_control_add_result(w, text);
    w->saved_samples = w->saving_samples;
    free(text);
    free(name);
    return true;
}

static void say_saved(struct render_control *w, char *text)
{
    render_control_say(w, "%s", text);
    render_control_add_result(w, text);
    free(text);
}

void work_save_frame(struct render_control *w, const struct frame *frame)
{
    char *stem = scene_name(w);
    struct error err;
    char *name = image_write_frame_numbered(frame, stem, &err);

    free(stem);
    if (name)
        say_saved(w, xformat("saved %s %dx%d, as it is shown", name,
                             frame->width, frame->height));
    else
        render_control_say_error(w, err.text);
    free(name);
}

void work_save_text(struct render_control *w, const struct frame *frame,
                    const struct ansi_text_style *style)
{
    char *stem = scene_name(w);
    struct error err;
    char *text, *name = NULL;
    size_t size_bytes;

    if (ansi_text_of_frame(frame, style, &text, &size_bytes, &err)) {
        name = file_write_numbered(stem, "ans", text, size_bytes, &err);
        free(text);
    }
    free(stem);
    if (name)
        say_saved(w, xformat("saved %s, text of %dx%d characters", name,
                             style->cols, style->rows));
    else
        render_control_say_error(w, err.text);
    free(name);
}

void work_save_view(struct render_control *w)
{
    struct session *s = w->session;
    struct file_change change;
    struct error err;
    const char *slash;
    char *text;

    if (w->reload.is_busy) { /* which has read the file, or not yet */
        if (w->is_live)
            render_control_say(w, "not written: the scene is being loaded");
        else
            render_control_say(
                w,
                "not written: a loaded scene waits for live mode: %s goes "
                "there",
                render_control_key(w, ACTION_MODE).text);
        return;
    }
    if (!session_save_view(s, &change, &err)) {
        render_control_say_error(w, err.text);
        return;
    }
    file_watch_wrote(&w->watch, s->view_path, &change.after);
    slash = strrchr(s->view_path, '/');
    text = change.is_kept
               ? xformat("wrote the view to %s, the old one is %s~",
                         s->view_path, slash ? slash + 1 : s->view_path)
               : xformat("wrote the view to %s", s->view_path);
    render_control_say(w, "%s", text);
    render_control_add_result(w, text);
    free(text);
}

bool work_save_edit(struct render_control *w)
{
    struct error err;
    char *what;

    if (!session_save_edit(w->session, &w->watch, &what, &err)) {
        render_control_say_error(w, err.text);
        return false;
    }
    w->files_ns = clock_ns(); /* what has changed may be loaded now */
    render_control_say(w, "%s", what);
    render_control_add_result(w, what);
    free(what);
    return true;
}

/* What somebody would miss: a picture that no file has, and that took a while,
 * or that q would ask about. */
static bool is_worth_keeping(const struct render_control *w)
{
    return w->progress.samples > w->saved_samples &&
           (w->progress.render_ns >= WORTH_NS ||
            render_control_has_unsaved(w) ||
            render_control_has_unsaved_edit(w));
}

void work_keep(struct render_control *w)
{
    struct session *s = w->session;
    struct error err;
    char *path, *text;

    render_halt(s->render);
    w->progress = render_progress(s->render);
    if (!is_worth_keeping(w))
        return;
    path = recent_lost_path();
    if (!path)
        text = xstrdup("not kept: found no folder for the person's state");
    else if (image_write(render_film(s->render), session_develop(s), path,
                         &err))
        text = xformat("kept %s, %" PRIu64 " spp", path, w->progress.spp_done);
    else
        text = xstrdup(err.text);
    render_control_add_result(w, text);
    free(text);
    free(path);
}
