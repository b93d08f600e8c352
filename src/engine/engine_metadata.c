// SPDX-License-Identifier: MIT
#include "engine/engine_metadata.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/text_stream.h"
#include "engine/engine_film.h"
#include "read/view_file.h"
#include "render/render_metadata.h"

/* ---- how the scene was opened ---- */

/* Writes a line if the option has a value. */
static void write_option(FILE *to, const char *name, const char *value)
{
    if (value != NULL)
        fprintf(to, "option %s %s;", name, value);
}

/* Writes the options that are not in a view file. */
static void write_options(FILE *to, const struct engine_options *o)
{
    const struct scene_choice *choice = &o->scene.choice;
    char time[DECIMAL_TEXT_BYTES];

    decimal_format(time, choice->time_s);
    write_option(to, "gi", o->is_exact ? "exact" : NULL);
    if (o->scene.up != SCENE_UP_OF_FILE)
        write_option(to, "up", o->scene.up == SCENE_UP_Y ? "y" : "z");
    write_option(to, "scene", choice->scene);
    write_option(to, "variant", choice->variant);
    write_option(to, "animation", choice->animation);
    write_option(to, "anim-time", choice->has_time ? time : NULL);
}

/* Replaces ends of lines by others. */
static void put_line_ends(char *text, char from, char to)
{
    for (char *p = strchr(text, from); p != NULL; p = strchr(p, from))
        *p = to;
}

/* Writes the lines of a view. Returns false if a line has a semicolon. */
static bool write_view(FILE *to, const struct engine *e, const struct view *of)
{
    const struct file_bytes none = {e->scene.path, "", 0};
    struct view view = *of;
    struct error ignored;
    size_t size_bytes;
    char *text;
    bool ok;

    view.has_camera = view.has_size = true;
    memset(view.has_shot, 0, sizeof view.has_shot);
    if (!view_format(&view, &none, &text, &size_bytes, &ignored))
        return false;
    ok = strchr(text, ';') == NULL;
    put_line_ends(text, '\n', ';');
    fputs(text, to);
    free(text);
    return ok;
}

void engine_metadata_write_view(const struct engine *e, const struct view *view,
                                char text[FILM_VIEW_BYTES])
{
    struct text_stream s;
    bool ok = text_stream_open(&s);
    size_t size_bytes;
    char *whole;

    if (ok) {
        write_options(s.to, &e->options);
        ok = write_view(s.to, e, view);
    }
    whole = text_stream_close(&s, &size_bytes);
    text[0] = '\0';
    if (ok && whole != NULL && size_bytes < FILM_VIEW_BYTES)
        memcpy(text, whole, size_bytes + 1);
    free(whole);
}

char *engine_metadata_view(const struct image_metadata *m)
{
    const char *value = image_metadata_value(m, "glim:view");
    char *text = value != NULL ? strdup(value) : NULL;

    if (text != NULL)
        put_line_ends(text, ';', '\n');
    return text;
}

/* ---- pictures ---- */

struct image_metadata engine_metadata_described(const struct engine *e,
                                                const struct view *view,
                                                const struct film_identity *id,
                                                bool is_filtered)
{
    struct render_progress p = render_progress(e->render);
    struct film_range range;
    struct film_header h =
        engine_film_header(e, view, render_film(e->render)->first_sample, 0,
                           &range);

    h.identity = *id;
    return render_metadata_film(&p, &h, is_filtered);
}

struct image_metadata engine_metadata(struct engine *e, const struct view *view,
                                      bool is_filtered)
{
    struct film_identity id = {.seed = e->options.seed};
    struct error ignored;
    bool ok = engine_film_identify(e, view, &id, &ignored);
    struct image_metadata m =
        engine_metadata_described(e, view, &id, is_filtered);

    if (ok)
        render_metadata_identify(&m, &id);
    return m;
}
