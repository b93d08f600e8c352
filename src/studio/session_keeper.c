// SPDX-License-Identifier: MIT
#include "studio/session_keeper.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include "base/hash.h"
#include "engine/engine_film.h"
#include "picture/film_file.h"
#include "session/kept_history.h"
#include "terminal/xmalloc.h"

/* Least render time for which a picture is kept. */
#define WORTH_NS UINT64_C(5000000000)

/* Time to the first file, and between files, in seconds. With WORTH_NS, no more
 * than a minute is lost. */
#define FIRST_S    10
#define INTERVAL_S 55

/* ---- begin ---- */

/* Returns a timer, or -1: then files are written at the end only. */
static int start_timer(void)
{
    const struct itimerspec times = {.it_value.tv_sec = FIRST_S,
                                     .it_interval.tv_sec = INTERVAL_S};
    int fd = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK);

    if (fd >= 0)
        timerfd_settime(fd, 0, &times, NULL);
    return fd;
}

static void find_offer(struct session_keeper *k)
{
    char what[KEPT_TEXT_BYTES];
    struct error err;

    if (access(k->path, F_OK) != 0)
        return;
    if (!kept_read_head(&k->offer, k->path, &err)) {
        render_control_say_error(k->control, err.text);
        k->has_file = true;
    } else if (strcmp(k->offer.scene, k->scene) == 0) {
        kept_describe(what, &k->offer);
        snprintf(k->question, sizeof k->question,
                 "Enter goes on, r starts anew: %s kept", what);
        k->has_offer = true;
    }
}

void session_keeper_init(struct session_keeper *k,
                         struct render_control *control,
                         struct camera_control *camera)
{
    const struct session *s = control->session;

    *k = (struct session_keeper){.control = control,
                                 .camera = camera,
                                 .lock_fd = -1,
                                 .timer_fd = -1,
                                 .scene = kept_scene(s->options->scene_path)};
    k->path = k->scene != NULL ? kept_path(k->scene) : NULL;
    if (k->path != NULL)
        k->lock_fd = kept_lock(k->path);
    if (k->lock_fd < 0)
        return;
    k->timer_fd = start_timer();
    find_offer(k);
}

/* ---- write ---- */

/* Returns true if the film has taken a while, and is of the edit as it is. */
static bool is_film_worth(const struct session_keeper *k)
{
    const struct session *s = k->control->session;
    struct render_progress p = render_progress(s->engine.render);

    return p.render_ns >= WORTH_NS && p.spp_done > 0 &&
           s->sample == SAMPLE_LIGHT && !s->edit.is_comparing &&
           !session_is_outdated(s);
}

/* Returns true if the file has these texts and all samples. */
static bool is_written(struct session_keeper *k, const struct kept *kept,
                       bool has_film)
{
    uint64_t samples =
        render_progress(k->control->session->engine.render).samples;
    uint64_t hash = HASH_BEGIN;
    bool is_same;

    samples = has_film ? samples : 0;
    for (int i = 0; i < KEPT_FILM; i++)
        hash = hash_bytes(hash, kept->parts[i], kept->sizes[i]);
    is_same =
        k->has_file && hash == k->written_hash && samples == k->written_samples;
    k->written_hash = hash;
    k->written_samples = samples;
    return is_same;
}

static void remove_file(struct session_keeper *k)
{
    if (k->has_file)
        unlink(k->path);
    k->has_file = false;
}

/* Starts to write the session. Returns false, with a message, on errors. */
static bool begin(struct session_keeper *k)
{
    struct session *s = k->control->session;
    struct kept kept = {.is_live =
                            k->control->is_live || !k->control->is_started,
                        .scene = xstrdup(k->scene)};
    bool film = is_film_worth(k), ok;
    struct error err;

    ok = kept_history_take(&kept, s, k->path, &err);
    if (ok && !film && !kept.has_edits)
        remove_file(k);
    else if (ok && !is_written(k, &kept, film))
        ok = kept_writer_begin(&k->control->keeping, s, &kept, k->path, film,
                               &err);
    kept_free(&kept);
    if (!ok) {
        render_control_say_error(k->control, err.text);
        k->written_hash = 0;
    }
    return ok;
}

void session_keeper_write(struct session_keeper *k)
{
    uint64_t count;

    if (read(k->timer_fd, &count, sizeof count) < 0)
        return; /* it was read already */
    if (!k->has_offer && !k->control->keeping.copying.is_busy)
        begin(k);
}

void session_keeper_finish(struct session_keeper *k)
{
    bool is_left_out, had_failed = k->has_failed;
    struct error err;

    k->has_file = true; /* also of an earlier time, or without the film */
    k->has_failed =
        !kept_writer_finish(&k->control->keeping, &is_left_out, &err);
    if (k->has_failed) {
        k->written_hash = 0;
        if (!had_failed)
            render_control_say_error(k->control, err.text);
        return;
    }
    if (is_left_out && !k->has_said_large) {
        render_control_say(k->control,
                           "the picture is too large to be kept, except by "
                           "saving it: %s",
                           render_control_key(k->control, ACTION_SAVE).text);
        k->has_said_large = true;
    }
}

/* Adds a line about the last file to the results. */
static void add_result(struct session_keeper *k)
{
    char what[KEPT_TEXT_BYTES];
    struct kept kept;
    struct error err;
    char *text;

    if (kept_read_head(&kept, k->path, &err)) {
        kept_describe(what, &kept);
        text = xformat("kept %s: glim %s goes on", what,
                       k->control->session->options->scene_path);
        render_control_add_result(k->control, text);
        free(text);
    }
    kept_free(&kept);
}

void session_keeper_end(struct session_keeper *k, bool is_lost)
{
    struct kept_writer *w = &k->control->keeping;
    struct message before = k->control->message;

    if (k->lock_fd < 0)
        return;
    if (w->copying.is_busy)
        session_keeper_finish(k);
    if (k->has_offer)
        return;
    if (!is_lost) {
        remove_file(k);
        return;
    }
    k->control->message = (struct message){0};
    k->has_failed = false;
    if (begin(k) && w->copying.is_busy)
        session_keeper_finish(k);
    if (k->control->message.text[0] != '\0')
        render_control_add_result(k->control, k->control->message.text);
    else if (k->has_file)
        add_result(k);
    k->control->message = before;
}

/* ---- go on ---- */

/* Takes the film over if it is of the picture that is rendered now. */
static bool take_film(struct session_keeper *k, const struct kept *kept,
                      struct error *err)
{
    struct session *s = k->control->session;
    struct view view = edit_view(&s->edit);
    struct film_identity identity;
    struct film_file film = {0};
    bool ok = film_file_parse(&film, k->path, kept->parts[KEPT_FILM],
                              kept->sizes[KEPT_FILM], err) &&
              engine_film_identify(&s->engine, &view, &identity, err) &&
              film_identity_check(&film.header.identity, k->path, &identity,
                                  s->options->scene_path, err);

    if (ok &&
        (film.header.range_count != 1 || film.header.ranges[0].first != 0))
        ok = fail(err, "%s: found another film, expected one from sample 0 on",
                  k->path);
    if (ok)
        render_control_go_on(k->control, kept->is_live, &film);
    film_file_free(&film);
    return ok;
}

static void restore(struct session_keeper *k, const struct kept *kept)
{
    struct render_control *control = k->control;
    uint32_t missing;
    struct error err;

    if (!kept_history_restore(kept, control->session, k->path, &missing,
                              &err)) {
        render_control_say_error(control, err.text);
        return;
    }
    camera_control_set_scene(k->camera);
    render_control_go_on(control, true, NULL);
    if (kept->sizes[KEPT_FILM] > 0 && !take_film(k, kept, &err))
        render_control_say_error(control, err.text);
    else if (missing > 0)
        render_control_say(control,
                           "restored, without the changes of %" PRIu32
                           " materials that the scene does not have any more",
                           missing);
    else
        render_control_say(control, "restored: %s",
                           kept->sizes[KEPT_FILM] > 0 ? "view, changes, render"
                                                      : "view and changes");
}

void session_keeper_go_on(struct session_keeper *k)
{
    struct kept kept;
    struct error err;

    if (kept_read(&kept, k->path, &err))
        restore(k, &kept);
    else
        render_control_say_error(k->control, err.text);
    kept_free(&kept);
    session_keeper_start_anew(k);
}

void session_keeper_start_anew(struct session_keeper *k)
{
    k->has_offer = false;
    k->has_file = true;
}

void session_keeper_free(struct session_keeper *k)
{
    kept_free(&k->offer);
    if (k->lock_fd >= 0)
        close(k->lock_fd);
    if (k->timer_fd >= 0)
        close(k->timer_fd);
    free(k->scene);
    free(k->path);
}
