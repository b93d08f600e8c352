// SPDX-License-Identifier: MIT
#include "read/view_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/decimal.h"
#include "base/memory.h"
#include "base/text_stream.h"
#include "read/view_parse.h"
#include "world/light/daylight.h"

bool view_read(struct view *view, const char *path, struct warnings *report,
               struct error *err)
{
    char *text;
    size_t size_bytes;
    bool ok;

    if (!file_read(path, &text, &size_bytes, err))
        return false;
    ok = view_parse(view, text, size_bytes, path, report, err);
    free(text);
    return ok;
}

static void write_numbers(FILE *to, const char *key, const double *values,
                          int count)
{
    fputs(key, to);
    for (int i = 0; i < count; i++) {
        char text[DECIMAL_TEXT_BYTES];
        decimal_format(text, values[i]);
        fprintf(to, " %s", text);
    }
}

static void write_line(FILE *to, const char *key, const double *values,
                       int count)
{
    write_numbers(to, key, values, count);
    fputc('\n', to);
}

/* Writes what lines of fog and of smoke share. */
static void write_medium(FILE *to, const double scatter[3],
                         const double absorb[3], double anisotropy)
{
    write_numbers(to, " scatter", scatter, 3);
    write_numbers(to, " absorb", absorb, 3);
    write_numbers(to, " anisotropy", &anisotropy, 1);
}

static void write_fog(FILE *to, const struct fog *f)
{
    if (!fog_is_there(f))
        return;
    fputs("fog", to);
    write_medium(to, f->scatter, f->absorb, f->anisotropy);
    if (f->falloff > 0) {
        write_numbers(to, " height", &f->base, 1);
        write_numbers(to, " falloff", &f->falloff, 1);
    }
    fputc('\n', to);
}

/* Writes a key with a name, unless it is empty. */
static void write_name(FILE *to, const char *key, const char *name)
{
    if (name[0] == '\0')
        return;
    fprintf(to, " %s ", key);
    quoted_name_write(to, name);
}

/* Writes a number that differs from its default. */
static void write_changed(FILE *to, const char *key, double value,
                          double by_default)
{
    if (value < by_default || value > by_default)
        write_numbers(to, key, &value, 1);
}

/* Writes a line for each medium; `path` is that of the file. */
static void write_smokes(FILE *to, const struct smokes *smokes,
                         const char *path)
{
    static const double zero[3] = {0, 0, 0};

    for (uint32_t i = 0; i < smokes->count; i++) {
        const struct smoke *s = &smokes->items[i];
        const struct smoke_numbers *n = &s->numbers;
        char *name = view_name(s->path, path);

        fputs("medium ", to);
        quoted_name_write(to, name != NULL ? name : s->path);
        free(name);
        write_name(to, "grid", s->grid);
        write_medium(to, n->scatter, n->absorb, n->anisotropy);
        write_name(to, "temperature", s->temperature);
        write_changed(to, " kelvin", n->kelvin, smoke_defaults.kelvin);
        write_changed(to, " glow", n->glow, smoke_defaults.glow);
        if (s->up_is_z)
            fputs(" up z", to);
        if (memcmp(n->at, zero, sizeof zero) != 0)
            write_numbers(to, " at", n->at, 3);
        write_changed(to, " scale", n->scale, smoke_defaults.scale);
        if (smoke_has_box(n))
            write_numbers(to, " box", n->box, 6);
        fputc('\n', to);
    }
}

static void write_shots(FILE *to, const struct view *v)
{
    for (int i = 0; i < VIEW_SHOTS; i++) {
        const struct pose *p = &v->shots[i];

        if (!v->has_shot[i])
            continue;
        fprintf(to, "view %d", i + 1);
        write_numbers(to, " eye", p->eye, 3);
        write_numbers(to, " at", p->at, 3);
        write_numbers(to, " up", p->up, 3);
        write_numbers(to, " fovy", &p->fovy_deg, 1);
        write_numbers(to, " aperture", &p->aperture, 1);
        write_numbers(to, " focus", &p->focus, 1);
        fputc('\n', to);
    }
}

/* Writes the line of one key. Most values that equal their default are left
 * out. */
static void write_key(FILE *to, const struct view *v, enum view_key_id id,
                      const char *sky, const char *path)
{
    switch (id) {
    case KEY_EYE:
        if (v->has_camera)
            write_line(to, "eye", v->pose.eye, 3);
        break;
    case KEY_AT:
        if (v->has_camera)
            write_line(to, "at", v->pose.at, 3);
        break;
    case KEY_UP: write_line(to, "up", v->pose.up, 3); break;
    case KEY_FOVY: write_line(to, "fovy", &v->pose.fovy_deg, 1); break;
    case KEY_RES:
        if (v->has_size)
            fprintf(to, "res %d %d\n", v->width_px, v->height_px);
        break;
    case KEY_BACKGROUND:
        if (v->lighting.has_background)
            write_line(to, "background", v->lighting.background, 3);
        break;
    case KEY_MAX_BOUNCES:
        if (v->max_bounces >= 0)
            fprintf(to, "max_bounces %d\n", v->max_bounces);
        break;
    case KEY_SKY:
        if (sky)
            fprintf(to, "sky %s%s\n", sky, lexer_rest_guard(sky));
        break;
    case KEY_SKY_STRENGTH:
        if (v->lighting.sky_strength < 1 || v->lighting.sky_strength > 1)
            write_line(to, "sky_strength", &v->lighting.sky_strength, 1);
        break;
    case KEY_SKY_ROTATION:
        if (v->lighting.sky_rotation_deg < 0 ||
            v->lighting.sky_rotation_deg > 0)
            write_line(to, "sky_rotation", &v->lighting.sky_rotation_deg, 1);
        break;
    case KEY_SUN:
        if (v->lighting.sun.is_on) {
            double angles[2] = {v->lighting.sun.azimuth_deg,
                                v->lighting.sun.elevation_deg};

            write_line(to, "sun", angles, 2);
        }
        break;
    case KEY_TURBIDITY:
        if (v->lighting.sun.turbidity < TURBIDITY_DEFAULT ||
            v->lighting.sun.turbidity > TURBIDITY_DEFAULT)
            write_line(to, "turbidity", &v->lighting.sun.turbidity, 1);
        break;
    case KEY_FOG: write_fog(to, &v->lighting.fog); break;
    case KEY_MEDIUM: write_smokes(to, &v->smokes, path); break;
    case KEY_APERTURE:
        if (v->pose.aperture > 0)
            write_line(to, "aperture", &v->pose.aperture, 1);
        break;
    case KEY_FOCUS:
        if (v->pose.focus > 0)
            write_line(to, "focus", &v->pose.focus, 1);
        break;
    case KEY_EXPOSURE:
        if (v->lighting.exposure < 0 || v->lighting.exposure > 0)
            write_line(to, "exposure", &v->lighting.exposure, 1);
        break;
    case KEY_TONE:
        if (v->lighting.tone != TONE_LINEAR)
            fprintf(to, "tone %s\n", view_tones[v->lighting.tone]);
        break;
    case KEY_ASSIGN: assigns_write(&v->assigns, to); break;
    case KEY_LIGHT_UNIT:
        if (v->light_unit != LIGHT_UNIT_OF_FILE)
            fprintf(to, "light_unit %s\n", light_units[v->light_unit]);
        break;
    case KEY_LIGHT: view_lights_write(&v->lamps, path, to); break;
    case KEY_VIEW: write_shots(to, v); break;
    }
}

/* State of writing over the lines of the old text. */
struct writer {
    FILE *to;
    const struct view *view;
    const char *sky;         /* NULL if the view has none */
    bool is_same[VIEW_KEYS]; /* the old text has this value */
    bool is_written[VIEW_KEYS];
    struct view_reader
        old; /* parses the old lines into a view that is dropped */
};

/* Copies a line; an unterminated last line gets a line end. A line that ends in
 * a backslash gets two, for the backslash joins the next line. The same holds
 * for a backslash and a carriage return, to which the first line feed
 * belongs. */
static void keep_line(FILE *to, const char *line, const struct lexer *after,
                      bool has_end)
{
    char last = after->p[-1];

    fwrite(line, 1, (size_t)(after->p - line), to);
    if (!has_end)
        fputs(last == '\\' || last == '\r' ? "\n\n" : "\n", to);
}

/* Writes the current value if the line has the key of another one, otherwise
 * copies the line. The parser finds the end of the line. */
static void write_line_over(struct writer *w, struct lexer *lex)
{
    const char *line = lex->p;
    struct lexer start = *lex;
    const struct view_key *key =
        lexer_at_line_end(&start) ? NULL : view_find_key(lexer_word(&start));
    struct error ignored;
    bool has_end;

    view_parse_line(&w->old, lex, &ignored);
    has_end = lexer_next_line(lex);
    if (!key || w->is_same[key - view_keys]) {
        keep_line(w->to, line, lex, has_end);
    } else if (!w->is_written[key - view_keys]) {
        write_key(w->to, w->view, key->id, w->sky, w->old.path);
        w->is_written[key - view_keys] = true;
    }
}

/* Writes the old text with the values that have changed, then those of keys
 * that it did not have. */
static void write_over(struct writer *w, const char *text, size_t size_bytes)
{
    struct lexer lex;

    lexer_init(&lex, text, size_bytes);
    while (lex.p < lex.end)
        write_line_over(w, &lex);
    for (size_t i = 0; i < VIEW_KEYS; i++) {
        if (!w->is_written[i] && !w->is_same[i])
            write_key(w->to, w->view, view_keys[i].id, w->sky, w->old.path);
    }
}

/* Returns the text of a key, for free(), or NULL without memory. */
static char *key_text(const struct view *v, enum view_key_id id,
                      const char *sky, const char *path)
{
    struct text_stream s;
    size_t size_bytes;

    if (text_stream_open(&s))
        write_key(s.to, v, id, sky, path);
    return text_stream_close(&s, &size_bytes);
}

/* Returns the name of the view's sky, for free(), or NULL if it has none. */
static char *sky_name(const struct view *v, const char *path)
{
    return v->lighting.sky_path != NULL ? view_name(v->lighting.sky_path, path)
                                        : NULL;
}

/* Returns true if a line of the text begins with a key. */
static bool has_keys(const struct file_bytes *text)
{
    struct lexer lex;

    lexer_init(&lex, text->bytes, text->size_bytes);
    while (lex.p < lex.end) {
        if (!lexer_at_line_end(&lex) && view_find_key(lexer_word(&lex)) != NULL)
            return true;
        lexer_next_line(&lex);
    }
    return false;
}

/* Finds the keys whose values the old text has, so that their lines stay as
 * they were written. A new file gets all keys. */
static void find_same(struct writer *w, const struct file_bytes *old)
{
    struct warnings ignored = {0};
    struct view before;
    struct error err;
    char *sky = NULL;

    view_init(&before);
    if (has_keys(old) && view_parse(&before, old->bytes, old->size_bytes,
                                    old->path, &ignored, &err)) {
        sky = sky_name(&before, old->path);
        for (size_t i = 0; i < VIEW_KEYS; i++) {
            char *text = key_text(w->view, view_keys[i].id, w->sky, old->path);
            char *old_text = key_text(&before, view_keys[i].id, sky, old->path);

            w->is_same[i] =
                text != NULL && old_text != NULL && strcmp(text, old_text) == 0;
            free(text);
            free(old_text);
        }
    }
    free(sky);
    view_free(&before);
    warnings_free(&ignored);
}

/* Refuses names with a line end inside, which no line can hold. `of` is what
 * they are names of. */
static bool check_quoted_name(const char *name, const char *of,
                              const char *path, struct error *err)
{
    return strpbrk(name, "\r\n") == NULL ||
           fail(err, "%s: found a line end in the %s name, expected none", path,
                of);
}

/* Refuses names that a line without quotes cannot hold: also those with a blank
 * at the end. */
static bool check_name(const char *name, const char *of, const char *path,
                       struct error *err)
{
    size_t length = strlen(name);

    if (!check_quoted_name(name, of, path, err))
        return false;
    if (length > 0 && lexer_is_blank(name[length - 1]))
        return fail(
            err, "%s: found a blank at the end of the %s name, expected none",
            path, of);
    return true;
}

static bool check_names(const struct view *view, const char *path,
                        struct error *err)
{
    bool ok = view->lighting.sky_path == NULL ||
              check_name(view->lighting.sky_path, "sky's", path, err);

    for (uint32_t i = 0; i < view->lamps.count && ok; i++) {
        const struct profile *profile = view->lamps.items[i].profile;

        ok = profile == NULL ||
             check_name(profile->path, "light's IES", path, err);
    }
    for (uint32_t i = 0; i < view->smokes.count && ok; i++)
        ok = check_quoted_name(view->smokes.items[i].path, "medium's", path,
                               err) &&
             check_quoted_name(view->smokes.items[i].grid, "grid's", path,
                               err) &&
             check_quoted_name(view->smokes.items[i].temperature, "grid's",
                               path, err);
    return ok;
}

bool view_format(const struct view *view, const struct file_bytes *old,
                 char **text, size_t *size_bytes, struct error *err)
{
    const char *path = old->path;
    struct warnings ignored = {0};
    struct text_stream stream;
    struct view scratch;
    struct writer w = {.view = view,
                       .old = {.view = &scratch,
                               .path = path,
                               .report = &ignored}};
    char *sky;

    if (!check_names(view, path, err))
        return false;
    if (!text_stream_open(&stream))
        return fail(err, "%s: out of memory", path);
    w.to = stream.to;
    w.sky = sky = sky_name(view, path);
    find_same(&w, old);
    view_init(&scratch);
    write_over(&w, old->bytes, old->size_bytes);
    view_free(&scratch);
    warnings_free(&ignored);
    free(sky);
    *text = text_stream_close(&stream, size_bytes);
    if (*text != NULL && (sky || !view->lighting.sky_path))
        return true;
    free(*text);
    *text = NULL;
    return fail(err, "%s: out of memory", path);
}

/* Reads the file that will be replaced; returns the first lines of a new one if
 * there is none. */
static bool read_old(const char *path, char **text, size_t *size_bytes,
                     struct error *err)
{
    if (access(path, F_OK) == 0)
        return file_read(path, text, size_bytes, err);
    *text = strdup("# a view of a scene: points in the scene's units, angles "
                   "in degrees,\n# background as radiance, exposure in "
                   "stops\n");
    if (!*text)
        return fail(err, "%s: out of memory", path);
    *size_bytes = strlen(*text);
    return true;
}

/* Writes the old text to the file with a ~ if the new text differs. */
static bool keep_old(const struct file_bytes *old, const char *text,
                     size_t size_bytes, struct file_change *change,
                     struct error *err)
{
    char *name;

    change->is_kept =
        change->before.exists && (old->size_bytes != size_bytes ||
                                  memcmp(old->bytes, text, size_bytes) != 0);
    if (!change->is_kept)
        return true;
    name = format_text("%s~", old->path);
    if (!name)
        return fail(err, "%s: out of memory", old->path);
    bool ok = file_write(name, old->bytes, old->size_bytes, false, NULL, err);
    free(name);
    return ok;
}

bool view_write(const struct view *view, const char *path,
                struct file_change *change, struct error *err)
{
    struct file_bytes old = {.path = path};
    char *old_text, *text;
    size_t size_bytes;
    bool ok;

    change->before = file_identify(path);
    if (!read_old(path, &old_text, &old.size_bytes, err))
        return false;
    old.bytes = old_text;
    ok = view_format(view, &old, &text, &size_bytes, err);
    if (ok) {
        ok = keep_old(&old, text, size_bytes, change, err) &&
             file_replace(path, text, size_bytes, change, err);
        free(text);
    }
    free(old_text);
    return ok;
}
