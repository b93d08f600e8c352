// SPDX-License-Identifier: MIT
#include "glim/view_file.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "glim/lex.h"
#include "glim/number.h"

/* Their squares and differences are still finite. */
#define GREATEST 1e30

/* The neighbours of what fovy must not be. */
#define FOVY_LEAST    1e-6
#define FOVY_GREATEST 179.999999

enum key_id {
    KEY_EYE,
    KEY_AT,
    KEY_UP,
    KEY_FOVY,
    KEY_RES,
    KEY_BACKGROUND,
    KEY_MAX_BOUNCES,
    KEY_SKY_STRENGTH,
    KEY_SKY_ROTATION,
    KEY_APERTURE,
    KEY_FOCUS,
    KEY_EXPOSURE,
    KEY_SKY,    /* has a name */
    KEY_TONE,   /* has a name */
    KEY_ASSIGN, /* has two names */
    KEY_VIEW    /* has a number and other keys */
};

/* In the order in which a new file has them. */
static const struct key {
    const char *name;
    enum key_id id;
    int count; /* of numbers */
    bool is_whole;
    double least, greatest;
    const char *expected;
} keys[] = {
    {"eye", KEY_EYE, 3, false, -GREATEST, GREATEST,
     "3 numbers from -1e30 to 1e30"},
    {"at", KEY_AT, 3, false, -GREATEST, GREATEST,
     "3 numbers from -1e30 to 1e30"},
    {"up", KEY_UP, 3, false, -GREATEST, GREATEST,
     "3 numbers from -1e30 to 1e30"},
    {"fovy", KEY_FOVY, 1, false, FOVY_LEAST, FOVY_GREATEST,
     "an angle above 0 and below 180 degrees"},
    {"res", KEY_RES, 2, true, 1, VIEW_SIDE_MAX,
     "2 whole numbers from 1 to 65536"},
    {"background", KEY_BACKGROUND, 3, false, 0, GREATEST,
     "3 numbers from 0 to 1e30"},
    {"max_bounces", KEY_MAX_BOUNCES, 1, true, -1, INT_MAX,
     "a whole number, or -1 for no limit"},
    {"sky", KEY_SKY, 0, false, 0, 0, "an image file"},
    {"sky_strength", KEY_SKY_STRENGTH, 1, false, 0, GREATEST,
     "a number from 0 to 1e30"},
    {"sky_rotation", KEY_SKY_ROTATION, 1, false, -1e6, 1e6,
     "an angle from -1e6 to 1e6 degrees"},
    {"aperture", KEY_APERTURE, 1, false, 0, GREATEST,
     "a number from 0 to 1e30"},
    {"focus", KEY_FOCUS, 1, false, 0, GREATEST, "a number from 0 to 1e30"},
    {"exposure", KEY_EXPOSURE, 1, false, -100, 100,
     "a number of stops from -100 to 100"},
    {"tone", KEY_TONE, 0, false, 0, 0, "linear, reinhard or aces"},
    {"assign", KEY_ASSIGN, 0, false, 0, 0, "two names"},
    {"view", KEY_VIEW, 1, true, 1, VIEW_SHOTS, "a number from 1 to 9"},
};

#define KEY_COUNT (sizeof keys / sizeof keys[0])

struct reader {
    struct view *view;
    const char *path;
    struct lex *lex;
    struct report *report;
    uint64_t eye_line, at_line; /* 0: not in this file */
};

static bool fail_at(const struct reader *r, struct word found,
                    const char *expected, const char *key, struct error *err)
{
    return fail(err, "%s:%" PRIu64 ": found %s, expected %s for %s", r->path,
                r->lex->line, word_quote(found).text, expected, key);
}

/* One number of the key, and nothing joined to it. */
static bool read_number(struct reader *r, const struct key *key, double *value,
                        struct error *err)
{
    struct lex before = *r->lex;
    bool ok = !lex_at_line_end(r->lex) && lex_number(r->lex, value) &&
              *value >= key->least && *value <= key->greatest &&
              (!key->is_whole || *value == floor(*value));

    if (ok)
        return true;
    struct word found = {.length = 0};
    if (!lex_at_line_end(&before))
        found = lex_word(&before);
    return fail_at(r, found, key->expected, key->name, err);
}

static void store(struct view *view, enum key_id id, const double *v)
{
    switch (id) {
    case KEY_EYE: memcpy(view->eye, v, sizeof view->eye); break;
    case KEY_AT: memcpy(view->at, v, sizeof view->at); break;
    case KEY_UP: memcpy(view->up, v, sizeof view->up); break;
    case KEY_FOVY: view->fovy_deg = v[0]; break;
    case KEY_RES:
        view->width_px = (int)v[0];
        view->height_px = (int)v[1];
        view->has_size = true;
        break;
    case KEY_BACKGROUND:
        memcpy(view->background, v, sizeof view->background);
        view->has_background = true;
        break;
    case KEY_MAX_BOUNCES: view->max_bounces = (int)v[0]; break;
    case KEY_SKY_STRENGTH: view->sky_strength = v[0]; break;
    case KEY_SKY_ROTATION: view->sky_rotation_deg = v[0]; break;
    case KEY_APERTURE: view->aperture = v[0]; break;
    case KEY_FOCUS: view->focus = v[0]; break;
    case KEY_EXPOSURE: view->exposure = v[0]; break;
    case KEY_SKY:
    case KEY_TONE:
    case KEY_ASSIGN:
    case KEY_VIEW: break;
    }
}

/* The numbers of the key, into a view that may be another than the file's. */
static bool read_numbers(struct reader *r, const struct key *key,
                         struct view *view, struct error *err)
{
    double values[3] = {0};

    for (int i = 0; i < key->count; i++) {
        if (!read_number(r, key, &values[i], err))
            return false;
    }
    if (key->id == KEY_UP && values[0] == 0 && values[1] == 0 && values[2] == 0)
        return fail(err,
                    "%s:%" PRIu64 ": found 0 0 0, expected a direction "
                    "for up",
                    r->path, r->lex->line);
    store(view, key->id, values);
    return true;
}

static const struct key *find_key(struct word name)
{
    for (size_t i = 0; i < KEY_COUNT; i++) {
        if (word_is(name, keys[i].name))
            return &keys[i];
    }
    return NULL;
}

static bool is_of_pose(const struct key *key)
{
    return key->id <= KEY_FOVY || key->id == KEY_APERTURE ||
           key->id == KEY_FOCUS;
}

/* view N eye X Y Z at X Y Z ...: what is left out is as the keys above say. */
static bool read_shot(struct reader *r, const struct key *view_key,
                      struct error *err)
{
    uint64_t line = r->lex->line;
    struct view shot = *r->view;
    bool has_eye = false;
    bool has_at = false;
    char place[512];
    double number;

    if (!read_number(r, view_key, &number, err))
        return false;
    while (!lex_at_line_end(r->lex)) {
        struct word name = lex_word(r->lex);
        const struct key *key = find_key(name);

        if (!key || !is_of_pose(key))
            return fail_at(r, name, "eye, at, up, fovy, aperture or focus",
                           view_key->name, err);
        if (!read_numbers(r, key, &shot, err))
            return false;
        has_eye |= key->id == KEY_EYE;
        has_at |= key->id == KEY_AT;
    }
    if (!has_eye || !has_at)
        return fail_at(r, (struct word){.length = 0}, "eye and at",
                       view_key->name, err);
    snprintf(place, sizeof place, "%s:%" PRIu64, r->path, line);
    if (!view_check(&shot, place, err))
        return false;
    r->view->shots[(int)number - 1] = view_pose(&shot);
    r->view->has_shot[(int)number - 1] = true;
    return true;
}

static bool read_sky(struct reader *r, struct error *err)
{
    char *name = lex_rest(r->lex);

    if (!name || *name == '\0') {
        free(name);
        return fail(err,
                    "%s:%" PRIu64 ": found no name, expected an image "
                    "file for sky",
                    r->path, r->lex->line);
    }
    free(r->view->sky_path);
    r->view->sky_path = path_beside(r->path, name);
    free(name);
    return true;
}

static bool read_key(struct reader *r, const struct key *key, struct error *err)
{
    if (!read_numbers(r, key, r->view, err))
        return false;
    if (!lex_at_line_end(r->lex))
        return fail_at(r, lex_word(r->lex), key->expected, key->name, err);
    if (key->id == KEY_EYE)
        r->eye_line = r->lex->line;
    if (key->id == KEY_AT)
        r->at_line = r->lex->line;
    return true;
}

static bool read_tone(struct reader *r, const struct key *key,
                      struct error *err)
{
    struct word name = {.length = 0};

    if (!lex_at_line_end(r->lex))
        name = lex_word(r->lex);
    for (uint32_t i = 0; i < TONES; i++) {
        if (!word_is(name, view_tones[i]) || !lex_at_line_end(r->lex))
            continue;
        r->view->tone = i;
        return true;
    }
    return fail_at(r, name, key->expected, key->name, err);
}

static bool read_assign(struct reader *r, struct error *err)
{
    uint64_t line = r->lex->line;

    return assigns_read(&r->view->assigns, r->lex) ||
           fail(err,
                "%s:%" PRIu64 ": found another line than assign OBJECT "
                "MATERIAL, expected two names, those with blanks in quotes",
                r->path, line);
}

static bool read_line(void *context, struct lex *lex, struct error *err)
{
    struct reader *r = context;

    r->lex = lex;
    if (lex_at_line_end(r->lex))
        return true;
    struct word name = lex_word(r->lex);
    const struct key *key = find_key(name);
    if (key && key->id == KEY_SKY)
        return read_sky(r, err);
    if (key && key->id == KEY_TONE)
        return read_tone(r, key, err);
    if (key && key->id == KEY_ASSIGN)
        return read_assign(r, err);
    if (key && key->id == KEY_VIEW)
        return read_shot(r, key, err);
    if (key)
        return read_key(r, key, err);
    report_add(r->report, "lines with an unknown key",
               "%s:%" PRIu64 ": found the unknown key %s, skipped", r->path,
               r->lex->line, word_quote(name).text);
    return true;
}

/* A camera needs both points; which of them the file gave is known only at its
 * end. */
static bool finish_camera(struct reader *r, struct error *err)
{
    char place[512];
    bool has_both = r->eye_line && r->at_line;
    uint64_t line = r->eye_line > r->at_line ? r->eye_line : r->at_line;

    if (line == 0)
        return true;
    if (!has_both && !r->view->has_camera)
        return fail(err, "%s:%" PRIu64 ": found only '%s', expected eye and at",
                    r->path, line, r->eye_line ? "eye" : "at");
    r->view->has_camera = true;
    snprintf(place, sizeof place, "%s:%" PRIu64, r->path, line);
    return view_check(r->view, place, err);
}

bool view_read(struct view *view, const char *path, struct report *report,
               struct error *err)
{
    struct reader r = {.view = view, .path = path, .report = report};

    return lex_file(path, read_line, &r, err) && finish_camera(&r, err);
}

static void write_numbers(FILE *to, const char *key, const double *values,
                          int count)
{
    fputs(key, to);
    for (int i = 0; i < count; i++) {
        char text[NUMBER_TEXT_BYTES];
        number_format(text, values[i]);
        fprintf(to, " %s", text);
    }
}

static void write_line(FILE *to, const char *key, const double *values,
                       int count)
{
    write_numbers(to, key, values, count);
    fputc('\n', to);
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

/* What is as view_init() made it is left out. */
static void write_key(FILE *to, const struct view *v, enum key_id id,
                      const char *sky)
{
    switch (id) {
    case KEY_EYE:
        if (v->has_camera)
            write_line(to, "eye", v->eye, 3);
        break;
    case KEY_AT:
        if (v->has_camera)
            write_line(to, "at", v->at, 3);
        break;
    case KEY_UP: write_line(to, "up", v->up, 3); break;
    case KEY_FOVY: write_line(to, "fovy", &v->fovy_deg, 1); break;
    case KEY_RES:
        if (v->has_size)
            fprintf(to, "res %d %d\n", v->width_px, v->height_px);
        break;
    case KEY_BACKGROUND:
        if (v->has_background)
            write_line(to, "background", v->background, 3);
        break;
    case KEY_MAX_BOUNCES:
        if (v->max_bounces >= 0)
            fprintf(to, "max_bounces %d\n", v->max_bounces);
        break;
    case KEY_SKY:
        if (sky)
            fprintf(to, "sky %s\n", sky);
        break;
    case KEY_SKY_STRENGTH:
        if (v->sky_strength < 1 || v->sky_strength > 1)
            write_line(to, "sky_strength", &v->sky_strength, 1);
        break;
    case KEY_SKY_ROTATION:
        if (v->sky_rotation_deg < 0 || v->sky_rotation_deg > 0)
            write_line(to, "sky_rotation", &v->sky_rotation_deg, 1);
        break;
    case KEY_APERTURE:
        if (v->aperture > 0)
            write_line(to, "aperture", &v->aperture, 1);
        break;
    case KEY_FOCUS:
        if (v->focus > 0)
            write_line(to, "focus", &v->focus, 1);
        break;
    case KEY_EXPOSURE:
        if (v->exposure < 0 || v->exposure > 0)
            write_line(to, "exposure", &v->exposure, 1);
        break;
    case KEY_TONE:
        if (v->tone != TONE_LINEAR)
            fprintf(to, "tone %s\n", view_tones[v->tone]);
        break;
    case KEY_ASSIGN: assigns_write(&v->assigns, to); break;
    case KEY_VIEW: write_shots(to, v); break;
    }
}

/* The lines of `text`, those with a key as the view has it now; then the keys
 * that were not there. */
static void write_over(FILE *to, const char *text, size_t size_bytes,
                       const struct view *view, const char *sky)
{
    bool is_written[KEY_COUNT] = {false};
    struct lex lex;

    lex_init(&lex, text, size_bytes);
    while (lex.p < lex.end) {
        const char *line = lex.p;
        const struct key *key =
            lex_at_line_end(&lex) ? NULL : find_key(lex_word(&lex));

        lex_next_line(&lex);
        if (!key) {
            fwrite(line, 1, (size_t)(lex.p - line), to);
            if (lex.p[-1] != '\n' && lex.p[-1] != '\r')
                fputc('\n', to);
        } else if (!is_written[key - keys]) {
            write_key(to, view, key->id, sky);
            is_written[key - keys] = true;
        }
    }
    for (size_t i = 0; i < KEY_COUNT; i++) {
        if (!is_written[i])
            write_key(to, view, keys[i].id, sky);
    }
}

/* The text of the file that will be replaced, or how a new one begins. */
static bool read_old(const char *path, char **text, size_t *size_bytes,
                     struct error *err)
{
    if (access(path, F_OK) == 0)
        return file_read(path, text, size_bytes, err);
    *text = xstrdup("# a view of a scene: points in the scene's units, angles "
                    "in degrees,\n# background as radiance, exposure in "
                    "stops\n");
    *size_bytes = strlen(*text);
    return true;
}

/* Before one text is replaced by another. */
static bool keep_old(const char *path, const char *old_text, size_t old_bytes,
                     const char *text, size_t size_bytes,
                     struct file_change *change, struct error *err)
{
    char *name;

    change->is_kept =
        change->before.exists &&
        (old_bytes != size_bytes || memcmp(old_text, text, size_bytes) != 0);
    if (!change->is_kept)
        return true;
    name = xformat("%s~", path);
    bool ok = file_write(name, old_text, old_bytes, false, NULL, err);
    free(name);
    return ok;
}

bool view_write(const struct view *view, const char *path,
                struct file_change *change, struct error *err)
{
    char *old_text, *text = NULL;
    size_t old_bytes, size_bytes = 0;

    if (view->sky_path && strpbrk(view->sky_path, "\r\n"))
        return fail(err,
                    "%s: found a line end in the name of the sky, "
                    "expected none",
                    path);
    change->before = file_identify(path);
    if (!read_old(path, &old_text, &old_bytes, err))
        return false;
    FILE *to = open_memstream(&text, &size_bytes);
    if (!to) {
        free(old_text);
        return fail(err, "%s: out of memory", path);
    }
    char *sky = view->sky_path ? path_seen_from(path, view->sky_path) : NULL;
    write_over(to, old_text, old_bytes, view, sky);
    free(sky);
    bool ok = fclose(to) == 0
                  ? keep_old(path, old_text, old_bytes, text, size_bytes,
                             change, err) &&
                        file_replace(path, text, size_bytes, change, err)
                  : fail(err, "%s: out of memory", path);
    free(old_text);
    free(text);
    return ok;
}
