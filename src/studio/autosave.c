// SPDX-License-Identifier: MIT
#include "studio/autosave.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include "base/hash.h"
#include "engine/engine_film.h"
#include "film/film_file.h"
#include "session/autosave_state.h"
#include "terminal/xmalloc.h"

/* Least render time for which a picture is kept. */
#define WORTH_NS UINT64_C(5000000000)

/* Time to the first file, and between files, in seconds. With WORTH_NS, no more
 * than a minute is lost. */
#define FIRST_S    10
#define INTERVAL_S 55

/* Time from a change to its file. A key that is held makes a few files. */
#define CHANGE_NS 200000000

/* ---- begin ---- */

/* Sets the timer to the next file and those after it. */
static void set_timer(const struct autosave *k, struct timespec first)
{
    const struct itimerspec times = {.it_value = first,
                                     .it_interval.tv_sec = INTERVAL_S};

    if (k->timer_fd >= 0)
        timerfd_settime(k->timer_fd, 0, &times, NULL);
}

/* Writes the session soon. */
static void hurry(struct autosave *k)
{
    k->is_hurried = true;
    set_timer(k, (struct timespec){.tv_nsec = CHANGE_NS});
}

/* Offers a file if it is one of the scene. A damaged one is removed; one that
 * cannot be read now stays for later. */
static void offer(struct autosave *k, const char *path)
{
    char what[AUTOSAVE_TEXT_BYTES];
    struct autosave_file head;
    struct error err;

    if (access(path, F_OK) != 0)
        return;
    if (!autosave_file_read_head(&head, path, &err)) {
        live_render_say_error(k->control, err.text);
        if (head.is_damaged)
            unlink(path);
    } else if (strcmp(head.scene, k->scene) == 0) {
        autosave_describe(what, &head);
        live_render_say(k->control, "kept: %s; %s goes on with it", what,
                        live_render_key(k->control, ACTION_RESTORE).text);
        k->offer_path = path;
    }
    autosave_file_free(&head);
}

/* Ends an offer. One that is set aside comes after the other. */
static void end_offer(struct autosave *k)
{
    bool was_aside = k->offer_path == k->aside;

    k->offer_path = NULL;
    if (!was_aside)
        offer(k, k->aside);
}

void autosave_init(struct autosave *k, struct live_render *control,
                   struct camera_control *camera)
{
    const struct session *s = control->session;

    *k = (struct autosave){.control = control,
                           .camera = camera,
                           .lock_fd = -1,
                           .timer_fd = -1,
                           .scene = autosave_scene(s->options->scene_path)};
    k->path = k->scene != NULL ? autosave_path(k->scene) : NULL;
    k->aside = k->path != NULL ? autosave_path_aside(k->path) : NULL;
    if (k->aside != NULL)
        k->lock_fd = autosave_lock(k->path);
    if (k->lock_fd < 0)
        return;
    /* without a timer, files are written at the end only */
    k->timer_fd = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK);
    set_timer(k, (struct timespec){.tv_sec = FIRST_S});
    offer(k, k->path);
    if (k->offer_path == NULL)
        offer(k, k->aside);
}

/* ---- write ---- */

/* Returns true if the film has taken a while, and is of the edit as it is. */
static bool is_film_worth(const struct autosave *k)
{
    const struct session *s = k->control->session;
    struct render_progress p = render_progress(s->engine.render);

    return p.render_ns >= WORTH_NS && p.spp_done > 0 &&
           s->sample == SAMPLE_LIGHT && !s->edit.is_comparing &&
           !session_is_outdated(s);
}

/* Returns true if the file has these texts and all samples. */
static bool is_written(struct autosave *k, const struct autosave_file *kept,
                       bool has_film)
{
    uint64_t samples =
        render_progress(k->control->session->engine.render).samples;
    uint64_t hash = HASH_BEGIN;
    bool is_same;

    samples = has_film ? samples : 0;
    for (int i = 0; i < AUTOSAVE_FILM; i++)
        hash = hash_bytes(hash, kept->parts[i], kept->sizes[i]);
    is_same =
        k->has_file && hash == k->written_hash && samples == k->written_samples;
    k->written_hash = hash;
    k->written_samples = samples;
    return is_same;
}

static void remove_file(struct autosave *k)
{
    if (k->has_file)
        unlink(k->path);
    k->has_file = false;
}

/* Makes room for this session's file. */
static bool set_offer_aside(struct autosave *k, struct error *err)
{
    if (k->offer_path != k->path)
        return true;
    if (rename(k->path, k->aside) != 0)
        return fail(err, "%s: %s", k->aside, strerror(errno));
    k->offer_path = k->aside;
    return true;
}

/* Removes an offered file that was taken over, as the session has it now. */
static void drop_aside(struct autosave *k)
{
    if (k->drops_aside)
        unlink(k->aside);
    k->drops_aside = false;
}

/* Starts to write the session. Returns false, with a message, on errors. */
static bool begin(struct autosave *k)
{
    struct session *s = k->control->session;
    struct autosave_file kept = {.is_live = k->control->is_live ||
                                            !k->control->is_started,
                                 .scene = xstrdup(k->scene)};
    bool film = is_film_worth(k), ok;
    struct error err;

    ok = autosave_history_take(&kept, s, k->path, &err);
    k->writes_edits = kept.has_edits;
    if (ok && !film && !kept.has_edits) {
        remove_file(k);
        drop_aside(k);
    } else if (ok && !is_written(k, &kept, film)) {
        ok = set_offer_aside(k, &err) &&
             autosave_writer_begin(&k->control->keeping, s, &kept, k->path,
                                   film, &err);
    }
    autosave_file_free(&kept);
    if (!ok) {
        live_render_say_error(k->control, err.text);
        k->written_hash = 0;
    }
    return ok;
}

void autosave_write(struct autosave *k)
{
    uint64_t count;

    if (read(k->timer_fd, &count, sizeof count) < 0)
        return; /* it was read already */
    k->is_hurried = false;
    if (!k->control->keeping.copying.is_busy)
        begin(k);
    else
        k->changes--; /* again for what came meanwhile */
}

void autosave_note_changes(struct autosave *k)
{
    const struct edit *edit = &k->control->session->edit;

    if (k->timer_fd < 0 || k->is_hurried || edit->changes == k->changes)
        return;
    k->changes = edit->changes;
    if (k->writes_edits || live_render_has_unsaved_edit(k->control))
        hurry(k);
}

void autosave_finish(struct autosave *k)
{
    bool is_left_out, had_failed = k->has_failed;
    struct error err;

    k->has_file = true; /* also of an earlier time, or without the film */
    k->has_failed =
        !autosave_writer_finish(&k->control->keeping, &is_left_out, &err);
    if (k->has_failed) {
        k->written_hash = 0;
        if (!had_failed)
            live_render_say_error(k->control, err.text);
        return;
    }
    drop_aside(k);
    if (is_left_out && !k->has_said_large) {
        live_render_say(k->control,
                        "the picture is too large to be kept, except by "
                        "saving it: %s",
                        live_render_key(k->control, ACTION_SAVE).text);
        k->has_said_large = true;
    }
}

/* Adds a line about the last file to the results. */
static void add_result(struct autosave *k)
{
    char what[AUTOSAVE_TEXT_BYTES];
    struct autosave_file kept;
    struct error err;
    char *text;

    if (autosave_file_read_head(&kept, k->path, &err)) {
        autosave_describe(what, &kept);
        text = xformat("kept %s: glim %s goes on", what,
                       k->control->session->options->scene_path);
        live_render_add_result(k->control, text);
        free(text);
    }
    autosave_file_free(&kept);
}

void autosave_end(struct autosave *k, bool is_lost)
{
    struct autosave_writer *w = &k->control->keeping;
    struct message before = k->control->message;

    if (k->lock_fd < 0)
        return;
    if (w->copying.is_busy)
        autosave_finish(k);
    if (!is_lost) {
        remove_file(k);
        drop_aside(k);
        return;
    }
    k->control->message = (struct message){0};
    k->has_failed = false;
    if (begin(k) && w->copying.is_busy)
        autosave_finish(k);
    if (k->control->message.text[0] != '\0')
        live_render_add_result(k->control, k->control->message.text);
    else if (k->has_file)
        add_result(k);
    k->control->message = before;
}

/* ---- go on ---- */

/* Takes the film over if it is of the picture that is rendered now. */
static bool take_film(struct autosave *k, const struct autosave_file *kept,
                      struct error *err)
{
    struct session *s = k->control->session;
    struct view view = edit_view(&s->edit);
    struct film_identity identity;
    struct film_file film = {0};
    bool ok = film_file_parse(&film, k->path, kept->parts[AUTOSAVE_FILM],
                              kept->sizes[AUTOSAVE_FILM], err) &&
              engine_film_identify(&s->engine, &view, &identity, err) &&
              film_identity_check(&film.header.identity, k->path, &identity,
                                  s->options->scene_path, err);

    if (ok &&
        (film.header.range_count != 1 || film.header.ranges[0].first != 0))
        ok = fail(err, "%s: found another film, expected one from sample 0 on",
                  k->path);
    if (ok)
        live_render_go_on(k->control, kept->is_live, &film);
    film_file_free(&film);
    return ok;
}

/* Restores what the file has. Returns false, with a message, if not even the
 * edits are restored. */
static bool restore(struct autosave *k, const struct autosave_file *kept)
{
    struct live_render *control = k->control;
    uint32_t missing;
    struct error err;

    if (!autosave_history_restore(kept, control->session, k->path, &missing,
                                  &err)) {
        live_render_say_error(control, err.text);
        return false;
    }
    camera_control_set_scene(k->camera);
    live_render_go_on(control, true, NULL);
    if (kept->sizes[AUTOSAVE_FILM] > 0 && !take_film(k, kept, &err))
        live_render_say_error(control, err.text);
    else if (missing > 0)
        live_render_say(control,
                        "restored, without the changes of %" PRIu32
                        " materials that the scene does not have any more",
                        missing);
    else
        live_render_say(control, "restored: %s",
                        kept->sizes[AUTOSAVE_FILM] > 0 ? "view, changes, render"
                                                       : "view and changes");
    return true;
}

void autosave_go_on(struct autosave *k)
{
    const char *path = k->offer_path;
    struct autosave_file kept;
    struct error err;
    bool ends;

    if (path == NULL)
        return;
    if (autosave_file_read(&kept, path, &err)) {
        ends = restore(k, &kept);
    } else {
        live_render_say_error(k->control, err.text);
        ends = kept.is_damaged;
    }
    autosave_file_free(&kept);
    if (!ends)
        return; /* the offer stays */
    if (path == k->path)
        k->has_file = true;
    else
        k->drops_aside = true;
    hurry(k);
    end_offer(k);
}

void autosave_drop(struct autosave *k)
{
    if (k->offer_path == NULL)
        return;
    unlink(k->offer_path);
    live_render_say(k->control, "the kept session is dropped");
    end_offer(k);
}

void autosave_free(struct autosave *k)
{
    if (k->lock_fd >= 0)
        close(k->lock_fd);
    if (k->timer_fd >= 0)
        close(k->timer_fd);
    free(k->scene);
    free(k->path);
    free(k->aside);
}
