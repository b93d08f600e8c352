// SPDX-License-Identifier: MIT
#include "command/command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/print.h"
#include "base/stop.h"
#include "command/batch_progress.h"
#include "engine/engine_metadata.h"
#include "film/image_write.h"
#include "inspect/aov_picture.h"
#include "inspect/false_color.h"
#include "inspect/view_modes.h"
#include "session/frame_series.h"
#include "session/session_film.h"
#include "session/stats_json.h"
#include "terminal/ansi_diff.h"
#include "terminal/tty.h"
#include "terminal/xmalloc.h"

/* A render to files: of one picture, or of a series. */
struct batch {
    struct session *session;
    struct view_mode show;
    struct session_film film;
    struct frame_series series; /* its session is NULL for one picture */
    bool is_denoised;           /* a filtered picture was written */
};

/* Checks the file of an option, if it is given: that the scene is not read from
 * it, and then with `check`. */
static bool check_file(const struct session *s, const char *option,
                       const char *path,
                       bool (*check)(const char *path, struct error *err),
                       struct error *err)
{
    return !path ||
           (session_check_output(s, option, path, err) && check(path, err));
}

/* ---- properties of surfaces ---- */

/* Names in EXR files: those of OpenEXR where it has some, else layers whose
 * channels have one letter, as Blender and Nuke need it. */
static const struct exr_layer layers_of_kinds[AOV_KINDS] = {
    [AOV_ALBEDO] = {"albedo.", "RGB", NULL},
    [AOV_NORMALS] = {"N.", "XYZ", NULL},
    [AOV_POSITION] = {"P.", "XYZ", NULL},
    [AOV_DEPTH] = {"", "Z", NULL},
    [AOV_UV] = {"uv.", "UV", NULL},
    [AOV_OBJECT] = {"object.", "X", NULL},
    [AOV_MATERIAL] = {"material.", "X", NULL},
};

/* Returns the name of the file beside the picture, for free(). */
static char *aov_path(const char *picture, int kind)
{
    char *stem = xchecked(path_stem(picture));
    char *path = xformat("%s.%s.pfm", stem, options_aovs[kind]);

    free(stem);
    return path;
}

/* Fails if the file is one that the session reads, or another output. */
static bool check_aov_path(const struct session *s, const char *picture,
                           const char *path, struct error *err)
{
    const struct options *o = s->options;
    const char *const others[] = {picture,       o->denoise_path,
                                  o->stats_path, o->error_map_path,
                                  o->film_path,  o->checkpoint_path};

    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        if (others[i] != NULL && path_is_same(path, others[i]))
            return fail(err,
                        "--aov: found '%s', the file of another option, "
                        "expected another file",
                        path);
    return check_file(s, "--aov", path, file_check, err);
}

/* Returns true if the properties are layers of the picture that the options
 * name. */
static bool aovs_are_layers(const struct options *o)
{
    return o->aovs != 0 && o->output_path != NULL &&
           image_write_format_of(o->output_path) == IMAGE_WRITE_EXR;
}

/* Checks before the render that the files of --aov beside the picture can be
 * written. */
static bool check_aovs(const struct session *s, const char *picture,
                       struct error *err)
{
    bool ok = true;

    for (int i = 0; i < AOV_KINDS && ok; i++) {
        char *path;

        if ((s->options->aovs >> i & 1) == 0 || aovs_are_layers(s->options))
            continue;
        path = aov_path(picture, i);
        ok = check_aov_path(s, picture, path, err);
        free(path);
    }
    return ok;
}

/* Renders the kinds, one after the other, each as 3 numbers for each pixel of
 * the crop. Returns memory for free(), or NULL. */
static float *render_aovs(struct view_mode *show, uint32_t kinds,
                          struct error *err)
{
    const struct session *s = show->session;
    struct rect crop = s->engine.crop;
    size_t size = 3 * (size_t)crop.width * (size_t)crop.height;
    struct world world;
    float *numbers, *to;

    if (!view_mode_traced(show, &world, err))
        return NULL;
    to = numbers =
        alloc_array(size, (size_t)__builtin_popcount(s->options->aovs) *
                              sizeof *numbers);
    if (numbers == NULL)
        fail(err, "--aov: out of memory for %dx%d pixels", crop.width,
             crop.height);
    for (int i = 0; i < AOV_KINDS && numbers != NULL; i++) {
        struct aov_picture a = {(enum aov_kind)i, &s->engine.scene, &world,
                                crop};

        if ((kinds >> i & 1) == 0)
            continue;
        aov_picture_render(&a, view_mode_pool(show), to);
        to += size;
    }
    return numbers;
}

static bool write_aov(struct view_mode *show, int kind, const char *path,
                      struct error *err)
{
    struct rect crop = show->session->engine.crop;
    float *numbers = render_aovs(show, 1u << kind, err);
    bool ok = numbers != NULL &&
              image_write_floats(numbers, crop.width, crop.height, path, err);

    free(numbers);
    return ok;
}

/* Writes the files of --aov beside the picture, unless they are layers. */
static bool write_aovs(struct view_mode *show, const char *picture,
                       struct error *err)
{
    const struct options *o = show->session->options;
    bool ok = true;

    for (int i = 0; i < AOV_KINDS && ok; i++) {
        char *path;

        if ((o->aovs >> i & 1) == 0 || aovs_are_layers(o))
            continue;
        path = aov_path(picture, i);
        ok = write_aov(show, i, path, err);
        free(path);
    }
    return ok;
}

/* Writes the film and the layers of --aov to the picture. */
static bool write_aov_layers(struct view_mode *show, struct film *film,
                             const struct image_metadata *metadata,
                             struct error *err)
{
    const struct session *s = show->session;
    size_t size =
        3 * (size_t)s->engine.crop.width * (size_t)s->engine.crop.height;
    struct exr_layer layers[AOV_KINDS];
    float *numbers = render_aovs(show, s->options->aovs, err);
    int count = 0;
    bool ok;

    for (int i = 0; i < AOV_KINDS && numbers != NULL; i++) {
        if ((s->options->aovs >> i & 1) == 0)
            continue;
        layers[count] = layers_of_kinds[i];
        layers[count].values = numbers + (size_t)count * size;
        count++;
    }
    ok = numbers != NULL && image_write_layers(film, metadata, layers, count,
                                               s->options->output_path, err);
    free(numbers);
    return ok;
}

/* ---- coloured text ---- */

/* Returns the file for the text; NULL for standard output. */
static const char *text_path(const struct options *o)
{
    const char *path = o->output_path;

    return path && strcmp(path, "-") != 0 ? path : NULL;
}

/* Returns the glyphs of the text. The terminal is not asked, since the text may
 * be read on another one; it is assumed to show Unicode. Without colours the
 * locale decides between braille and ASCII. */
static enum glyphs text_glyphs(const struct options *o, enum palette palette)
{
    bool may_learn;
    bool has_unicode = palette != PALETTE_MONO || tty_is_utf8(&may_learn);

    return term_caps_glyphs(o->display.glyph, palette, has_unicode);
}

static enum palette text_palette(const struct options *o)
{
    const char *no_color = getenv("NO_COLOR");

    if (o->display.color == COLOR_AUTO && no_color && no_color[0] != '\0')
        return PALETTE_MONO;
    return term_caps_palette(o->display.color);
}

/* Writes the picture of the view as text. *name becomes the name for messages,
 * for free(). */
static bool write_text(struct view_mode *show, struct film *film, char **name,
                       struct error *err)
{
    const struct session *s = show->session;
    const struct options *o = s->options;
    struct cells_rect fit =
        cells_fit(s->engine.crop.width, s->engine.crop.height, o->text_cols,
                  o->text_rows,
                  o->display.cell_aspect > 0 ? o->display.cell_aspect : 2);
    enum palette palette = text_palette(o);
    struct ansi_text_style style = {fit.cols, fit.rows, palette,
                                    text_glyphs(o, palette)};
    const char *path = text_path(o);
    struct frame frame = {0};
    size_t size_bytes;
    char *text;
    bool ok = ansi_text_frame_init(&frame, &style, err) &&
              view_mode_picture(show, film, &frame, err) &&
              ansi_text_of_frame(&frame, &style, &text, &size_bytes, err);

    frame_free(&frame);
    if (!ok)
        return false;
    *name = xstrdup(path ? path : "standard output");
    ok = path ? file_write(path, text, size_bytes, false, NULL, err)
              : file_write_stdout(text, size_bytes, err);
    free(text);
    return ok;
}

/* ---- before the render ---- */

/* Checks before the render, which may take minutes, that the output files can
 * be written. */
static bool check_outputs(const struct batch *b, struct error *err)
{
    const struct session *s = b->session;
    const struct options *o = s->options;

    if (!check_file(s, "--stats", o->stats_path, stats_json_check, err))
        return false;
    if (o->output_path &&
        (!session_check_output(s, "-o", o->output_path, err) ||
         !check_aovs(s, o->output_path, err)))
        return false;
    if (!check_file(s, "--denoise", o->denoise_path, image_write_check, err) ||
        !check_file(s, "--error-map", o->error_map_path, image_write_check,
                    err) ||
        !check_file(s, "--film", o->film_path, file_check, err) ||
        !check_file(s, "--checkpoint", o->checkpoint_path, file_check, err))
        return false;
    if (o->text_cols > 0)
        return !text_path(o) || file_check(text_path(o), err);
    return b->series.video.process != 0 ||
           batch_check_picture(o->output_path, err);
}

/* ---- pictures ---- */

/* Returns the metadata of the film, which may be the filtered one. It takes a
 * while, by the hashes of the scene. */
static struct image_metadata metadata_of(struct session *s,
                                         const struct film *film)
{
    struct view view = edit_view(&s->edit);

    return engine_metadata(&s->engine, &view, film == &s->engine.filtered);
}

/* Writes to the file that the options name. */
static bool write_picture(struct session *s, struct film *film,
                          const struct frame *frame, struct error *err)
{
    const char *path = s->options->output_path;
    struct image_metadata metadata;

    if (frame)
        return image_write_frame(frame, path, err);
    metadata = metadata_of(s, film);
    return image_write(film, session_develop(s), &metadata, path, err);
}

/* Writes to a file with a free name and returns the name, for free(). */
static char *write_numbered(struct session *s, struct film *film,
                            const struct frame *frame, struct error *err)
{
    char *stem = xchecked(path_stem_of_input(s->options->scene_path));
    const char *last = path_name(stem);
    struct image_metadata metadata;
    char *name;

    if (frame) {
        name = image_write_frame_numbered(frame, NULL, last, err);
    } else {
        metadata = metadata_of(s, film);
        name = image_write_numbered(film, session_develop(s), &metadata, last,
                                    "png", err);
    }
    free(stem);
    return name;
}

/* Adds the frame, or the film if frame is NULL, to the video. */
static bool write_to_video(struct batch *b, struct film *film,
                           const struct frame *frame, struct error *err)
{
    struct frame developed = {0};
    bool ok;

    if (frame)
        return video_pipe_write(&b->series.video, frame, err);
    ok = frame_init(&developed, film->width, film->height, err);
    if (ok)
        film_resolve(film, session_develop(b->session), &developed);
    ok = ok && video_pipe_write(&b->series.video, &developed, err);
    frame_free(&developed);
    return ok;
}

/* Saves the frame, or the film if frame is NULL. *name is the file's name, for
 * free(). */
static bool save_pixels(struct batch *b, struct film *film,
                        const struct frame *frame, char **name,
                        struct error *err)
{
    struct session *s = b->session;
    const char *path = s->options->output_path;

    if (b->series.video.process != 0) {
        *name = xstrdup(path);
        return write_to_video(b, film, frame, err);
    }
    if (path) {
        *name = xstrdup(strcmp(path, "-") == 0 ? "standard output" : path);
        return write_picture(s, film, frame, err);
    }
    *name = write_numbered(s, film, frame, err);
    return *name != NULL;
}

/* Saves the picture of --show. */
static bool save_shown(struct batch *b, char **name, struct error *err)
{
    const struct rect *crop = &b->session->engine.crop;
    struct frame frame = {0};
    bool ok = frame_init(&frame, crop->width, crop->height, err) &&
              view_mode_picture(&b->show, NULL, &frame, err) &&
              save_pixels(b, NULL, &frame, name, err);

    frame_free(&frame);
    return ok;
}

/* Saves the film with the layers of --aov. */
static bool save_layers(struct batch *b, struct film *film, char **name,
                        struct error *err)
{
    struct image_metadata metadata = metadata_of(b->session, film);

    *name = xstrdup(b->session->options->output_path);
    return write_aov_layers(&b->show, film, &metadata, err);
}

static bool save_picture(struct batch *b, struct film *film, char **name,
                         struct error *err)
{
    const struct options *o = b->session->options;

    if (o->text_cols > 0)
        return write_text(&b->show, film, name, err);
    if (b->show.kind != SHOW_LIGHT)
        return save_shown(b, name, err);
    if (aovs_are_layers(o))
        return save_layers(b, film, name, err);
    return save_pixels(b, film, NULL, name, err);
}

/* Filters the film into *film, unless pixels lack samples. */
static bool filter(struct batch *b, struct film **film, struct error *err)
{
    struct film *filtered;

    if (!engine_can_filter(&b->session->engine)) {
        batch_warn_unfiltered();
        return true;
    }
    filtered = engine_filtered(&b->session->engine, err);
    if (!filtered)
        return false;
    b->is_denoised = true;
    *film = filtered;
    return true;
}

/* Writes the filtered picture to its own file. */
static bool write_filtered(struct session *s, struct film *film,
                           struct error *err)
{
    struct image_metadata metadata = metadata_of(s, film);
    const char *path = s->options->denoise_path;

    if (!image_write(film, session_develop(s), &metadata, path, err))
        return false;
    batch_say_filtered(path);
    return true;
}

/* Saves the film, filtered if the options want that. With --denoise=FILE the
 * filtered picture has a file of its own. */
static bool save_film(struct batch *b, char **name, struct error *err)
{
    struct session *s = b->session;
    struct film *own = render_film(s->engine.render), *film = own;

    b->is_denoised = false;
    if (s->options->denoise && !filter(b, &film, err))
        return false;
    if (b->is_denoised && s->options->denoise_path) {
        if (!write_filtered(s, film, err))
            return false;
        film = own;
    }
    return save_picture(b, film, name, err);
}

/* Fails if the free name of the picture is that of another file. */
static bool is_other_file(const char *option, const char *path,
                          const char *picture, struct error *err)
{
    return !path_is_same(picture, path) ||
           fail(err,
                "%s: found '%s', the file of the picture, expected another "
                "file",
                option, path);
}

/* Writes the files beside the picture. */
static bool save_more(struct batch *b, const char *picture, struct error *err)
{
    const struct session *s = b->session;
    const char *stats = s->options->stats_path;
    const char *map = s->options->error_map_path;

    return (!map || (is_other_file("--error-map", map, picture, err) &&
                     error_map_write(render_film(s->engine.render),
                                     session_develop(s).exposure, map, err))) &&
           (!stats || (is_other_file("--stats", stats, picture, err) &&
                       stats_json_write(s, b->is_denoised, stats, err))) &&
           check_aovs(s, picture, err) && write_aovs(&b->show, picture, err);
}

static bool save_all(struct batch *b, struct error *err)
{
    struct session *s = b->session;
    struct render_progress p = render_progress(s->engine.render);
    char *name = NULL;
    bool ok;

    if (p.samples == 0) {
        /* an old picture is better than a black one */
        return batch_say_empty(err);
    }
    stop_hold();
    ok = save_film(b, &name, err);
    if (ok)
        batch_say_result(name, s, &p);
    ok = ok && save_more(b, name, err);
    stop_release();
    free(name);
    return ok;
}

/* Saves the films and the picture, each even if the other one fails. */
static bool save_film_and_all(struct batch *b, struct error *err)
{
    struct error film_err;
    bool has_film, has_picture;

    stop_hold();
    has_film = session_film_write(&b->film, &film_err);
    has_picture = save_all(b, err);
    stop_release();
    if (!has_picture) {
        if (!has_film)
            error_add(err, &film_err);
        return false;
    }
    if (!has_film)
        *err = film_err;
    return has_film;
}

/* Makes the picture of --show with one ray for each pixel. */
static bool run_show(struct batch *b, struct error *err)
{
    const struct session *s = b->session;
    char *name = NULL;
    bool ok = view_mode_set(&b->show, s->options->show, err) &&
              save_picture(b, render_film(s->engine.render), &name, err);

    if (ok)
        print_line(stderr, "%s: %dx%d, %s, %.1f s", name, s->engine.crop.width,
                   s->engine.crop.height, options_shows[s->options->show],
                   seconds_between(s->start_ns, clock_ns()));
    free(name);
    return ok;
}

/* ---- one or several ---- */

/* Starts the render, from the film to be resumed, if there is one. */
static bool start(struct batch *b, struct error *err)
{
    struct session_start start = {.limits =
                                      session_film_limits(b->session->options),
                                  .first_sample = b->film.first_sample};

    return session_film_resume(&b->film, &start.from, err) &&
           session_start(b->session, &start, err);
}

/* Goes on with the samples of a device that has failed. */
static bool go_on_with_cpu(struct batch *b, const char *reason,
                           struct error *err)
{
    struct session_start start = {.limits =
                                      session_film_limits(b->session->options),
                                  .first_sample = b->film.first_sample,
                                  .keeps_film = true};

    batch_warn_of_device(reason);
    engine_use_cpu(&b->session->engine);
    return session_start(b->session, &start, err);
}

/* Renders, until the film is complete or a signal comes. */
static bool render_all(struct batch *b, struct error *err)
{
    struct batch_bar bar = batch_bar_begin();
    struct session *s = b->session;
    struct render_progress p;
    bool ok = start(b, err) && session_film_watch(&b->film, err);

    if (!ok)
        return false;
    bar.film = &b->film;
    bar.series = b->series.session != NULL ? &b->series : NULL;
    p = batch_wait(s, &bar);
    if (p.state == RENDER_FAILED && engine_uses_device(&s->engine)) {
        ok = go_on_with_cpu(b, p.error.text, err);
        if (ok)
            p = batch_wait(s, &bar);
    }
    session_film_stop(&b->film);
    if (ok && p.state == RENDER_FAILED)
        ok = fail(err, "%s", p.error.text);
    return ok;
}

/* Returns true if a signal has stopped the render before its end. */
static bool is_incomplete(const struct session *s)
{
    return batch_stop_signal() != 0 &&
           render_progress(s->engine.render).state != RENDER_DONE;
}

/* Renders one frame, and sets *is_written unless a signal came before its
 * end. */
static bool run_frame(struct batch *b, bool *is_written, struct error *err)
{
    struct session *s = b->session;

    if (!check_outputs(b, err))
        return false;
    if (s->options->show != SHOW_LIGHT)
        return (*is_written = run_show(b, err));
    if (!render_all(b, err))
        return false;
    return is_incomplete(s) || (*is_written = save_all(b, err));
}

/* Renders the frames of a series, each as a picture of its own. */
static bool run_frames(struct batch *b, struct error *err)
{
    struct frame_series *series = &b->series;
    bool ok = frame_series_begin(series, b->session, err), is_written;
    int done = 0;

    while (ok && batch_stop_signal() == 0 && frame_series_has_next(series)) {
        is_written = false;
        ok = frame_series_next(series, err) && run_frame(b, &is_written, err);
        done += is_written;
    }
    ok = ok && frame_series_close(series, err);
    if (ok)
        batch_say_frames(done, frame_series_count(series), series->begin_ns);
    frame_series_end(series);
    return ok;
}

/* Renders one picture or several. */
static bool run_render(struct batch *b, int *status, struct error *err)
{
    const struct options *o = b->session->options;
    bool is_series = frame_series_is_wanted(o);

    if (!session_film_begin(&b->film, b->session, err))
        return false;
    /* before the signal handlers are set, since drivers replace them */
    if (o->show == SHOW_LIGHT && !batch_use_device(b->session, err))
        return false;
    if (!batch_catch_signals(err))
        return false;
    if (!(is_series ? run_frames(b, err)
                    : render_all(b, err) && save_film_and_all(b, err)))
        return false;
    *status = batch_stop_signal() != 0 ? 128 + batch_stop_signal() : 0;
    return true;
}

bool batch_run(struct session *s, int *status, struct error *err)
{
    bool is_series = frame_series_is_wanted(s->options);
    struct batch b = {.session = s};
    bool ok;

    /* each frame has its own names */
    if (!is_series && !check_outputs(&b, err))
        return false;
    view_mode_init(&b.show, s);
    *status = 0;
    ok = is_series || s->options->show == SHOW_LIGHT
             ? run_render(&b, status, err)
             : run_show(&b, err);
    session_film_end(&b.film);
    view_mode_free(&b.show);
    return ok;
}
