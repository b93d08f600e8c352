// SPDX-License-Identifier: MIT
#include "glim/view.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glim/file.h"
#include "glim/lex.h"
#include "glim/number.h"

/* Their squares and differences are still finite. */
#define GREATEST 1e30

/* As the command line: 65536 squared fits no memory, but is no nonsense. */
#define SIDE_MAX 65536

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
    KEY_EXPOSURE
};

/* Keys with numbers; `sky` alone has a name. */
static const struct key {
    const char *name;
    enum key_id id;
    int count;
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
    {"res", KEY_RES, 2, true, 1, SIDE_MAX, "2 whole numbers from 1 to 65536"},
    {"background", KEY_BACKGROUND, 3, false, 0, GREATEST,
     "3 numbers from 0 to 1e30"},
    {"max_bounces", KEY_MAX_BOUNCES, 1, true, -1, INT_MAX,
     "a whole number, or -1 for no limit"},
    {"sky_strength", KEY_SKY_STRENGTH, 1, false, 0, GREATEST,
     "a number from 0 to 1e30"},
    {"sky_rotation", KEY_SKY_ROTATION, 1, false, -1e6, 1e6,
     "an angle from -1e6 to 1e6 degrees"},
    {"aperture", KEY_APERTURE, 1, false, 0, GREATEST,
     "a number from 0 to 1e30"},
    {"focus", KEY_FOCUS, 1, false, 0, GREATEST, "a number from 0 to 1e30"},
    {"exposure", KEY_EXPOSURE, 1, false, -100, 100,
     "a number of stops from -100 to 100"},
};

struct reader {
    struct view *view;
    const char *path;
    struct lex lex;
    struct report *report;
    uint64_t eye_line, at_line; /* 0: not in this file */
};

void view_init(struct view *view)
{
    *view = (struct view){
        .up = {0, 1, 0},
        .fovy_deg = 40,
        .width_px = 1024,
        .height_px = 576,
        .max_bounces = -1,
        .sky_strength = 1,
    };
}

static bool fail_at(const struct reader *r, struct word found,
                    const char *expected, const char *key, struct error *err)
{
    return fail(err, "%s:%" PRIu64 ": found %s, expected %s for %s", r->path,
                r->lex.line, word_quote(found).text, expected, key);
}

/* One number of the key, and nothing joined to it. */
static bool read_number(struct reader *r, const struct key *key, double *value,
                        struct error *err)
{
    struct lex before = r->lex;
    bool ok = !lex_at_line_end(&r->lex) && lex_number(&r->lex, value) &&
              *value >= key->least && *value <= key->greatest &&
              (!key->is_whole || *value == floor(*value));

    if (ok)
        return true;
    struct word found = {.length = 0};
    if (!lex_at_line_end(&before))
        found = lex_word(&before);
    return fail_at(r, found, key->expected, key->name, err);
}

static void store(struct reader *r, const struct key *key, const double *v)
{
    struct view *view = r->view;

    switch (key->id) {
    case KEY_EYE:
        memcpy(view->eye, v, sizeof view->eye);
        r->eye_line = r->lex.line;
        break;
    case KEY_AT:
        memcpy(view->at, v, sizeof view->at);
        r->at_line = r->lex.line;
        break;
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
    }
}

static bool read_numbers(struct reader *r, const struct key *key,
                         struct error *err)
{
    double values[3] = {0};

    for (int i = 0; i < key->count; i++) {
        if (!read_number(r, key, &values[i], err))
            return false;
    }
    if (!lex_at_line_end(&r->lex)) {
        struct word surplus = lex_word(&r->lex);
        return fail_at(r, surplus, key->expected, key->name, err);
    }
    if (key->id == KEY_UP && values[0] == 0 && values[1] == 0 && values[2] == 0)
        return fail(err,
                    "%s:%" PRIu64 ": found 0 0 0, expected a direction "
                    "for up",
                    r->path, r->lex.line);
    store(r, key, values);
    return true;
}

static bool read_sky(struct reader *r, struct error *err)
{
    char *name = lex_rest(&r->lex);

    if (!name || *name == '\0') {
        free(name);
        return fail(err,
                    "%s:%" PRIu64 ": found no name, expected an image "
                    "file for sky",
                    r->path, r->lex.line);
    }
    free(r->view->sky_path);
    r->view->sky_path = path_beside(r->path, name);
    free(name);
    return true;
}

static bool read_line(struct reader *r, struct error *err)
{
    if (lex_at_line_end(&r->lex))
        return true;
    struct word name = lex_word(&r->lex);
    if (word_is(name, "sky"))
        return read_sky(r, err);
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
        if (word_is(name, keys[i].name))
            return read_numbers(r, &keys[i], err);
    }
    report_add(r->report, "lines with an unknown key",
               "%s:%" PRIu64 ": found the unknown key %s, skipped", r->path,
               r->lex.line, word_quote(name).text);
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
    char *text;
    size_t size_bytes;
    bool ok = true;

    if (!file_read(path, &text, &size_bytes, err))
        return false;
    lex_init(&r.lex, text, size_bytes);
    while (ok && r.lex.p < r.lex.end) {
        ok = read_line(&r, err);
        lex_next_line(&r.lex);
    }
    free(text);
    return ok && finish_camera(&r, err);
}

static bool is_zero(const double v[3])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

bool view_check(const struct view *view, const char *place, struct error *err)
{
    double look[3];

    for (int i = 0; i < 3; i++) {
        look[i] = view->at[i] - view->eye[i];
        if (!isfinite(look[i]) || !isfinite(view->up[i]))
            return fail(err,
                        "%s: found a camera at infinity, expected finite "
                        "numbers for eye, at and up",
                        place);
    }
    if (is_zero(look))
        return fail(err, "%s: found eye and at in one point, expected two",
                    place);
    if (is_zero(view->up))
        return fail(err, "%s: found 0 0 0, expected a direction for up", place);
    if (!(view->fovy_deg > 0 && view->fovy_deg < 180))
        return fail(err,
                    "%s: found a fovy of %g degrees, expected one above "
                    "0 and below 180",
                    place, view->fovy_deg);
    return true;
}

static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');

    return slash ? xformat("%.*s", (int)(slash + 1 - path), path)
                 : xstrdup("./");
}

/* The path with its folder as the system knows it; NULL if there is no such
 * folder. */
static char *real_path(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = folder_of(path);
    char *real = realpath(folder, NULL);
    char *whole = NULL;

    if (real)
        whole = xformat("%s/%s", strcmp(real, "/") == 0 ? "" : real,
                        slash ? slash + 1 : path);
    free(real);
    free(folder);
    return whole;
}

/* How a view file at view_path names the file at `path`: from its own folder
 * on if the file lies below it, else absolutely. */
static char *name_in_view(const char *view_path, const char *path)
{
    char *real_view = real_path(view_path);
    char *real = real_path(path);
    char *name;

    if (real && real_view) {
        size_t below = (size_t)(strrchr(real_view, '/') + 1 - real_view);
        name =
            xstrdup(strncmp(real, real_view, below) == 0 ? real + below : real);
    } else {
        name = xstrdup(path);
    }
    free(real);
    free(real_view);
    return name;
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
    fputc('\n', to);
}

/* What is as view_init() made it is left out. */
static void write_keys(FILE *to, const struct view *v, const char *sky)
{
    fputs("# a view of a scene: points in the scene's units, angles in "
          "degrees,\n# background as radiance, exposure in stops\n",
          to);
    if (v->has_camera) {
        write_numbers(to, "eye", v->eye, 3);
        write_numbers(to, "at", v->at, 3);
    }
    write_numbers(to, "up", v->up, 3);
    write_numbers(to, "fovy", &v->fovy_deg, 1);
    if (v->has_size)
        fprintf(to, "res %d %d\n", v->width_px, v->height_px);
    if (v->has_background)
        write_numbers(to, "background", v->background, 3);
    if (v->max_bounces >= 0)
        fprintf(to, "max_bounces %d\n", v->max_bounces);
    if (sky)
        fprintf(to, "sky %s\n", sky);
    if (v->sky_strength < 1 || v->sky_strength > 1)
        write_numbers(to, "sky_strength", &v->sky_strength, 1);
    if (v->sky_rotation_deg < 0 || v->sky_rotation_deg > 0)
        write_numbers(to, "sky_rotation", &v->sky_rotation_deg, 1);
    if (v->aperture > 0)
        write_numbers(to, "aperture", &v->aperture, 1);
    if (v->focus > 0)
        write_numbers(to, "focus", &v->focus, 1);
    if (v->exposure < 0 || v->exposure > 0)
        write_numbers(to, "exposure", &v->exposure, 1);
}

bool view_write(const struct view *view, const char *path, struct error *err)
{
    char *text = NULL;
    size_t size_bytes = 0;

    if (view->sky_path && strpbrk(view->sky_path, "\r\n"))
        return fail(err,
                    "%s: found a line end in the name of the sky, "
                    "expected none",
                    path);
    FILE *to = open_memstream(&text, &size_bytes);
    if (!to)
        return fail(err, "%s: out of memory", path);
    char *sky = view->sky_path ? name_in_view(path, view->sky_path) : NULL;
    write_keys(to, view, sky);
    free(sky);
    bool ok = fclose(to) == 0
                  ? file_write(path, text, size_bytes, false, NULL, err)
                  : fail(err, "%s: out of memory", path);
    free(text);
    return ok;
}

void view_copy(struct view *to, const struct view *from)
{
    char *sky_path = from->sky_path ? xstrdup(from->sky_path) : NULL;

    free(to->sky_path);
    *to = *from;
    to->sky_path = sky_path; /* a copy of its own */
}

static bool has_other_camera(const struct view *a, const struct view *b)
{
    return a->has_camera != b->has_camera ||
           memcmp(a->eye, b->eye, sizeof a->eye) != 0 ||
           memcmp(a->at, b->at, sizeof a->at) != 0 ||
           memcmp(a->up, b->up, sizeof a->up) != 0 ||
           a->fovy_deg != b->fovy_deg || a->aperture != b->aperture ||
           a->focus != b->focus;
}

static bool has_other_sky(const struct view *a, const struct view *b)
{
    return !a->sky_path != !b->sky_path ||
           (a->sky_path && strcmp(a->sky_path, b->sky_path) != 0);
}

static void take_camera(struct view *view, const struct view *from)
{
    memcpy(view->eye, from->eye, sizeof view->eye);
    memcpy(view->at, from->at, sizeof view->at);
    memcpy(view->up, from->up, sizeof view->up);
    view->fovy_deg = from->fovy_deg;
    view->aperture = from->aperture;
    view->focus = from->focus;
    view->has_camera = true;
}

void view_merge(struct view *view, const struct view *before,
                const struct view *after)
{
    /* one that was placed by the program follows the scene, not the file */
    if (after->has_camera && has_other_camera(before, after))
        take_camera(view, after);
    if (before->width_px != after->width_px ||
        before->height_px != after->height_px) {
        view->width_px = after->width_px;
        view->height_px = after->height_px;
        view->has_size = after->has_size;
    }
    if (memcmp(before->background, after->background,
               sizeof after->background) != 0) {
        memcpy(view->background, after->background, sizeof view->background);
        view->has_background = after->has_background;
    }
    if (has_other_sky(before, after)) {
        free(view->sky_path);
        view->sky_path = after->sky_path ? xstrdup(after->sky_path) : NULL;
    }
    if (before->max_bounces != after->max_bounces)
        view->max_bounces = after->max_bounces;
    if (before->sky_strength != after->sky_strength)
        view->sky_strength = after->sky_strength;
    if (before->sky_rotation_deg != after->sky_rotation_deg)
        view->sky_rotation_deg = after->sky_rotation_deg;
    if (before->exposure != after->exposure)
        view->exposure = after->exposure;
}

void view_free(struct view *view)
{
    free(view->sky_path);
    *view = (struct view){0};
}
