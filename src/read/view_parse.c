// SPDX-License-Identifier: MIT
#include "read/view_parse.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/file.h"
#include "base/memory.h"
#include "film/film_file.h"
#include "read/ies.h"
#include "world/light/daylight.h"

/* ---- keys ---- */

/* Limits of fovy, which must be above 0 and below 180 degrees. */
#define FOVY_MIN 1e-6
#define FOVY_MAX 179.999999

/* Least scale of smoke: its inverse stays finite. */
#define SMOKE_SCALE_MIN 1e-30

const struct view_key view_keys[VIEW_KEYS] = {
    {"eye", KEY_EYE, 3, false, -VIEW_NUMBER_MAX, VIEW_NUMBER_MAX,
     "3 numbers from -1e30 to 1e30"},
    {"at", KEY_AT, 3, false, -VIEW_NUMBER_MAX, VIEW_NUMBER_MAX,
     "3 numbers from -1e30 to 1e30"},
    {"up", KEY_UP, 3, false, -VIEW_NUMBER_MAX, VIEW_NUMBER_MAX,
     "3 numbers from -1e30 to 1e30"},
    {"fovy", KEY_FOVY, 1, false, FOVY_MIN, FOVY_MAX,
     "an angle above 0 and below 180 degrees"},
    {"res", KEY_RES, 2, true, 1, VIEW_SIDE_MAX,
     "2 whole numbers from 1 to 65536"},
    {"background", KEY_BACKGROUND, 3, false, 0, VIEW_NUMBER_MAX,
     "3 numbers from 0 to 1e30"},
    {"max_bounces", KEY_MAX_BOUNCES, 1, true, -1, INT_MAX,
     "a whole number, or -1 for no limit"},
    {"sky", KEY_SKY, 0, false, 0, 0, "an image file"},
    {"sky_strength", KEY_SKY_STRENGTH, 1, false, 0, VIEW_NUMBER_MAX,
     "a number from 0 to 1e30"},
    {"sky_rotation", KEY_SKY_ROTATION, 1, false, -1e6, 1e6,
     "an angle from -1e6 to 1e6 degrees"},
    {"sun", KEY_SUN, 2, false, -SUN_AZIMUTH_MAX, SUN_AZIMUTH_MAX,
     "an azimuth from -360 to 360 and an elevation from -90 to 90 degrees"},
    {"turbidity", KEY_TURBIDITY, 1, false, TURBIDITY_MIN, TURBIDITY_MAX,
     "a number from 1.7 to 10"},
    {"fog", KEY_FOG, 0, false, 0, 0,
     "scatter, absorb, anisotropy, height or falloff"},
    {"medium", KEY_MEDIUM, 0, false, 0, 0,
     "grid, scatter, absorb, anisotropy, temperature, kelvin, glow, up, at, "
     "scale or box"},
    {"aperture", KEY_APERTURE, 1, false, 0, VIEW_NUMBER_MAX,
     "a number from 0 to 1e30"},
    {"focus", KEY_FOCUS, 1, false, 0, VIEW_NUMBER_MAX,
     "a number from 0 to 1e30"},
    {"exposure", KEY_EXPOSURE, 1, false, -EXPOSURE_MAX, EXPOSURE_MAX,
     "a number of stops from -100 to 100"},
    {"tone", KEY_TONE, 0, false, 0, 0, "linear, reinhard or aces"},
    {"assign", KEY_ASSIGN, 0, false, 0, 0, "two names"},
    {"light_unit", KEY_LIGHT_UNIT, 0, false, 0, 0, "auto, lumen, watt or none"},
    {"light", KEY_LIGHT, 0, false, 0, 0, "point, spot or directional"},
    {"view", KEY_VIEW, 1, true, 1, VIEW_SHOTS, "a number from 1 to 9"},
};

bool view_fail_at(const struct view_reader *r, struct word found,
                  const char *expected, const char *key, struct error *err)
{
    return fail(err, "%s:%" PRIu64 ": found %s, expected %s for %s", r->path,
                r->lex->line, word_quote(found).text, expected, key);
}

/* Returns true if number i of the key may have this value. */
static bool is_in_range(const struct view_key *key, int i, double value)
{
    if (key->id == KEY_SUN && i == 1)
        return fabs(value) <= SUN_ELEVATION_MAX;
    return value >= key->least && value <= key->greatest &&
           (!key->is_whole || value == floor(value));
}

/* Returns true if the numbers of `up` are no direction. */
static bool is_no_direction(const struct view_key *key, const double *values)
{
    return key->id == KEY_UP && values[0] == 0 && values[1] == 0 &&
           values[2] == 0;
}

bool view_key_numbers(const struct view_key *key, const char *text,
                      double values[3])
{
    const char *p = text, *end = text + strlen(text);

    for (int i = 0; i < key->count; i++) {
        if ((i > 0 && *p++ != ',') || !decimal_parse(&p, end, &values[i]) ||
            !is_in_range(key, i, values[i]))
            return false;
    }
    return *p == '\0' && !is_no_direction(key, values);
}

bool view_read_number(struct view_reader *r, const struct view_key *key, int i,
                      double *value, struct error *err)
{
    struct lexer before = *r->lex;
    bool ok = !lexer_at_line_end(r->lex) && lexer_number(r->lex, value) &&
              is_in_range(key, i, *value);

    if (ok)
        return true;
    struct word found = {.length = 0};
    if (!lexer_at_line_end(&before))
        found = lexer_word(&before);
    return view_fail_at(r, found, key->expected, key->name, err);
}

static void store(struct view *view, enum view_key_id id, const double *v)
{
    switch (id) {
    case KEY_EYE: memcpy(view->pose.eye, v, sizeof view->pose.eye); break;
    case KEY_AT: memcpy(view->pose.at, v, sizeof view->pose.at); break;
    case KEY_UP: memcpy(view->pose.up, v, sizeof view->pose.up); break;
    case KEY_FOVY: view->pose.fovy_deg = v[0]; break;
    case KEY_RES:
        view->width_px = (int)v[0];
        view->height_px = (int)v[1];
        view->has_size = true;
        break;
    case KEY_BACKGROUND:
        memcpy(view->lighting.background, v, sizeof view->lighting.background);
        view->lighting.has_background = true;
        break;
    case KEY_MAX_BOUNCES: view->max_bounces = (int)v[0]; break;
    case KEY_SKY_STRENGTH: view->lighting.sky_strength = v[0]; break;
    case KEY_SKY_ROTATION: view->lighting.sky_rotation_deg = v[0]; break;
    case KEY_SUN:
        view->lighting.sun.is_on = true;
        view->lighting.sun.azimuth_deg = v[0];
        view->lighting.sun.elevation_deg = v[1];
        break;
    case KEY_TURBIDITY: view->lighting.sun.turbidity = v[0]; break;
    case KEY_APERTURE: view->pose.aperture = v[0]; break;
    case KEY_FOCUS: view->pose.focus = v[0]; break;
    case KEY_EXPOSURE: view->lighting.exposure = v[0]; break;
    case KEY_FOG:
    case KEY_MEDIUM:
    case KEY_SKY:
    case KEY_TONE:
    case KEY_ASSIGN:
    case KEY_LIGHT_UNIT:
    case KEY_LIGHT:
    case KEY_VIEW: break;
    }
}

/* Reads the numbers of the key into a view, which may be a copy of the
 * reader's. */
static bool read_numbers(struct view_reader *r, const struct view_key *key,
                         struct view *view, struct error *err)
{
    double values[3] = {0};

    for (int i = 0; i < key->count; i++) {
        if (!view_read_number(r, key, i, &values[i], err))
            return false;
    }
    if (is_no_direction(key, values))
        return fail(err,
                    "%s:%" PRIu64 ": found 0 0 0, expected a direction "
                    "for up",
                    r->path, r->lex->line);
    store(view, key->id, values);
    return true;
}

const struct view_key *view_key(enum view_key_id id)
{
    size_t i = 0;

    while (view_keys[i].id != id)
        i++;
    return &view_keys[i];
}

const struct view_key *view_find_key(struct word name)
{
    for (size_t i = 0; i < VIEW_KEYS; i++) {
        if (word_is(name, view_keys[i].name) ||
            (view_keys[i].id == KEY_SKY && word_is(name, "background_map")))
            return &view_keys[i];
    }
    return NULL;
}

static bool is_of_pose(const struct view_key *key)
{
    return key->id <= KEY_FOVY || key->id == KEY_APERTURE ||
           key->id == KEY_FOCUS;
}

/* Reads view N eye X Y Z at X Y Z ... Keys that are left out have the values of
 * the lines above. */
static bool read_shot(struct view_reader *r, const struct view_key *view_key,
                      struct error *err)
{
    uint64_t line = r->lex->line;
    struct view shot = *r->view;
    bool has_eye = false;
    bool has_at = false;
    char place[512];
    double number;

    if (!view_read_number(r, view_key, 0, &number, err))
        return false;
    while (!lexer_at_line_end(r->lex)) {
        struct word name = lexer_word(r->lex);
        const struct view_key *key = view_find_key(name);

        if (!key || !is_of_pose(key))
            return view_fail_at(r, name, "eye, at, up, fovy, aperture or focus",
                                view_key->name, err);
        if (!read_numbers(r, key, &shot, err))
            return false;
        has_eye |= key->id == KEY_EYE;
        has_at |= key->id == KEY_AT;
    }
    if (!has_eye || !has_at)
        return view_fail_at(r, (struct word){.length = 0}, "eye and at",
                            view_key->name, err);
    snprintf(place, sizeof place, "%s:%" PRIu64, r->path, line);
    if (!pose_check(&shot.pose, place, err))
        return false;
    r->view->shots[(int)number - 1] = shot.pose;
    r->view->has_shot[(int)number - 1] = true;
    return true;
}

/* ---- fog and smoke ---- */

/* Key within a line, and where the line's struct has its numbers. */
struct part_key {
    struct view_key key;
    size_t member;
};

static const struct part_key fog_keys[] = {
    {{"scatter", KEY_FOG, 3, false, 0, VIEW_NUMBER_MAX,
      "3 numbers from 0 to 1e30"},
     offsetof(struct fog, scatter)},
    {{"absorb", KEY_FOG, 3, false, 0, VIEW_NUMBER_MAX,
      "3 numbers from 0 to 1e30"},
     offsetof(struct fog, absorb)},
    {{"anisotropy", KEY_FOG, 1, false, -1, 1, "a number from -1 to 1"},
     offsetof(struct fog, anisotropy)},
    {{"height", KEY_FOG, 1, false, -VIEW_NUMBER_MAX, VIEW_NUMBER_MAX,
      "a number from -1e30 to 1e30"},
     offsetof(struct fog, base)},
    {{"falloff", KEY_FOG, 1, false, 0, VIEW_NUMBER_MAX,
      "a number from 0 to 1e30"},
     offsetof(struct fog, falloff)},
};

static const struct part_key smoke_keys[] = {
    {{"scatter", KEY_MEDIUM, 3, false, 0, VIEW_NUMBER_MAX,
      "3 numbers from 0 to 1e30"},
     offsetof(struct smoke_numbers, scatter)},
    {{"absorb", KEY_MEDIUM, 3, false, 0, VIEW_NUMBER_MAX,
      "3 numbers from 0 to 1e30"},
     offsetof(struct smoke_numbers, absorb)},
    {{"anisotropy", KEY_MEDIUM, 1, false, -1, 1, "a number from -1 to 1"},
     offsetof(struct smoke_numbers, anisotropy)},
    {{"at", KEY_MEDIUM, 3, false, -VIEW_NUMBER_MAX, VIEW_NUMBER_MAX,
      "3 numbers from -1e30 to 1e30"},
     offsetof(struct smoke_numbers, at)},
    {{"scale", KEY_MEDIUM, 1, false, SMOKE_SCALE_MIN, VIEW_NUMBER_MAX,
      "a number from 1e-30 to 1e30"},
     offsetof(struct smoke_numbers, scale)},
    {{"box", KEY_MEDIUM, 6, false, -VIEW_NUMBER_MAX, VIEW_NUMBER_MAX,
      "6 numbers from -1e30 to 1e30: the lowest corner and the highest"},
     offsetof(struct smoke_numbers, box)},
    {{"kelvin", KEY_MEDIUM, 1, false, 0, VIEW_NUMBER_MAX,
      "a number from 0 to 1e30"},
     offsetof(struct smoke_numbers, kelvin)},
    {{"glow", KEY_MEDIUM, 1, false, 0, VIEW_NUMBER_MAX,
      "a number from 0 to 1e30"},
     offsetof(struct smoke_numbers, glow)},
};

/* Keys within a line. */
struct part_list {
    enum view_key_id line;
    const struct part_key *keys;
    size_t count;
};

static const struct part_list fog_list = {KEY_FOG, fog_keys,
                                          sizeof fog_keys / sizeof fog_keys[0]};
static const struct part_list smoke_list = {KEY_MEDIUM, smoke_keys,
                                            sizeof smoke_keys /
                                                sizeof smoke_keys[0]};

/* Reads the numbers of the key of this name into the line's struct. */
static bool read_part(struct view_reader *r, const struct part_list *list,
                      struct word name, void *to, struct error *err)
{
    const struct view_key *line = view_key(list->line);
    const struct part_key *part = list->keys;

    while (part < list->keys + list->count && !word_is(name, part->key.name))
        part++;
    if (part == list->keys + list->count)
        return view_fail_at(r, name, line->expected, line->name, err);
    for (int k = 0; k < part->key.count; k++) {
        double *numbers = (void *)((char *)to + part->member);

        if (!view_read_number(r, &part->key, k, &numbers[k], err))
            return false;
    }
    return true;
}

/* Reads fog scatter R G B absorb R G B ...; what is left out is 0, and so is
 * what has no effect, which is not written. */
static bool read_fog(struct view_reader *r, struct error *err)
{
    struct fog fog = {.falloff = 0};

    while (!lexer_at_line_end(r->lex)) {
        struct word name = lexer_word(r->lex);

        if (!read_part(r, &fog_list, name, &fog, err))
            return false;
    }
    if (!fog_is_there(&fog))
        fog = (struct fog){.falloff = 0};
    if (!(fog.falloff > 0))
        fog.base = fog.falloff = 0;
    r->view->lighting.fog = fog;
    return true;
}

static bool fail_memory(const struct view_reader *r, struct error *err)
{
    return fail(err, "%s: out of memory", r->path);
}

/* Reads a name of a line of smoke, for free(). */
static bool read_smoke_name(struct view_reader *r, const char *expected,
                            char **name, struct error *err)
{
    free(*name);
    if (!quoted_name_read(r->lex, name))
        return fail_memory(r, err);
    return (*name != NULL && **name != '\0') ||
           view_fail_at(r, (struct word){.length = 0}, expected, "medium", err);
}

/* Reads the axis of a grid that points up. */
static bool read_smoke_up(struct view_reader *r, bool *up_is_z,
                          struct error *err)
{
    struct word axis = lexer_word(r->lex);

    *up_is_z = word_is(axis, "z");
    return *up_is_z || word_is(axis, "y") ||
           view_fail_at(r, axis, "y or z behind up", "medium", err);
}

/* Checks that all sides of a box are longer than 0, or that there is none. */
static bool check_box(const struct view_reader *r, const double box[6],
                      struct error *err)
{
    static const double none[6] = {0, 0, 0, 0, 0, 0};
    bool is_box = true;

    for (int a = 0; a < 3; a++)
        is_box = is_box && box[a] < box[a + 3];
    return is_box || memcmp(box, none, sizeof none) == 0 ||
           fail(err,
                "%s:%" PRIu64 ": found a box whose lowest corner is not below "
                "its highest, expected x y z of both",
                r->path, r->lex->line);
}

static bool read_smoke_keys(struct view_reader *r, struct smoke *smoke,
                            struct error *err)
{
    while (!lexer_at_line_end(r->lex)) {
        struct word name = lexer_word(r->lex);

        if (!(word_is(name, "grid")
                  ? read_smoke_name(r, "a name behind grid", &smoke->grid, err)
              : word_is(name, "temperature")
                  ? read_smoke_name(r, "a name behind temperature",
                                    &smoke->temperature, err)
              : word_is(name, "up")
                  ? read_smoke_up(r, &smoke->up_is_z, err)
                  : read_part(r, &smoke_list, name, &smoke->numbers, err)))
            return false;
    }
    return check_box(r, smoke->numbers.box, err);
}

/* Reads medium FILE grid NAME scatter R G B ...; coefficients that are left out
 * are 0. */
static bool read_smoke(struct view_reader *r, struct error *err)
{
    struct smoke smoke = {.grid = strdup(""),
                          .temperature = strdup(""),
                          .numbers = smoke_defaults};
    char *file = NULL;
    bool ok;

    if (r->view->smokes.count == SMOKES_MAX)
        ok = fail(err,
                  "%s:%" PRIu64 ": found another medium, expected %d at most",
                  r->path, r->lex->line, SMOKES_MAX);
    else
        ok = read_smoke_name(r, "a file", &file, err) &&
             read_smoke_keys(r, &smoke, err);
    if (ok) {
        smoke.path = path_beside(r->path, file);
        ok = (smoke.path != NULL && smoke.grid != NULL &&
              smoke.temperature != NULL &&
              smokes_add(&r->view->smokes, &smoke)) ||
             fail_memory(r, err);
    }
    free(file);
    free(smoke.path);
    free(smoke.grid);
    free(smoke.temperature);
    return ok;
}

char *view_name(const char *file, const char *path)
{
    char *name = path_seen_from(path, file);
    if (!name)
        return NULL;
    char *whole = *name == '\0' || lexer_is_blank(*name)
                      ? format_text("./%s", name)
                      : strdup(name);

    free(name);
    return whole;
}

char *view_read_path(const struct view_reader *r, const char *expected,
                     struct error *err)
{
    char *name = lexer_rest(r->lex);
    char *path = NULL;

    if (name && *name == '\0') {
        fail(err, "%s:%" PRIu64 ": found no name, expected %s", r->path,
             r->lex->line, expected);
        free(name);
        return NULL;
    }
    if (name)
        path = path_beside(r->path, name);
    free(name);
    if (!path)
        fail_memory(r, err);
    return path;
}

static bool read_sky(struct view_reader *r, struct error *err)
{
    char *path = view_read_path(r, "an image file for sky", err);

    if (!path)
        return false;
    free(r->view->lighting.sky_path);
    r->view->lighting.sky_path = path;
    return true;
}

static bool read_key(struct view_reader *r, const struct view_key *key,
                     struct error *err)
{
    if (!read_numbers(r, key, r->view, err))
        return false;
    if (!lexer_at_line_end(r->lex))
        return view_fail_at(r, lexer_word(r->lex), key->expected, key->name,
                            err);
    if (key->id == KEY_EYE)
        r->eye_line = r->lex->line;
    if (key->id == KEY_AT)
        r->at_line = r->lex->line;
    return true;
}

/* Reads one of `count` names as its number. */
static bool read_choice(struct view_reader *r, const struct view_key *key,
                        const char *const *names, uint32_t count, uint32_t *to,
                        struct error *err)
{
    struct word name = {.length = 0};

    if (!lexer_at_line_end(r->lex))
        name = lexer_word(r->lex);
    for (uint32_t i = 0; i < count; i++) {
        if (!word_is(name, names[i]) || !lexer_at_line_end(r->lex))
            continue;
        *to = i;
        return true;
    }
    return view_fail_at(r, name, key->expected, key->name, err);
}

static bool read_assign(struct view_reader *r, struct error *err)
{
    uint64_t line = r->lex->line;
    bool has_names;

    if (!assigns_read(&r->view->assigns, r->lex, &has_names))
        return fail_memory(r, err);
    return has_names ||
           fail(err,
                "%s:%" PRIu64
                ": found a malformed line, expected assign OBJECT MATERIAL, "
                "with names that contain blanks in quotes",
                r->path, line);
}

/* Removes what goes before the key that was read in the light of a view. */
static void replace_sky(struct view *view, enum view_key_id id)
{
    if (id == KEY_SKY || id == KEY_BACKGROUND)
        view->lighting.sun.is_on = false;
    if (id == KEY_BACKGROUND) {
        free(view->lighting.sky_path);
        view->lighting.sky_path = NULL;
    }
}

bool view_parse_line(void *context, struct lexer *lex, struct error *err)
{
    struct view_reader *r = context;

    r->lex = lex;
    if (lexer_at_line_end(r->lex))
        return true;
    struct word name = lexer_word(r->lex);
    const struct view_key *key = view_find_key(name);
    if (key && r->is_over)
        replace_sky(r->view, key->id);
    if (key && key->id == KEY_SKY)
        return read_sky(r, err);
    if (key && key->id == KEY_TONE)
        return read_choice(r, key, view_tones, TONES, &r->view->lighting.tone,
                           err);
    if (key && key->id == KEY_LIGHT_UNIT)
        return read_choice(r, key, light_units, LIGHT_UNITS,
                           &r->view->light_unit, err);
    if (key && key->id == KEY_ASSIGN)
        return read_assign(r, err);
    if (key && key->id == KEY_LIGHT)
        return view_light_read(r, err);
    if (key && key->id == KEY_VIEW)
        return read_shot(r, key, err);
    if (key && key->id == KEY_FOG)
        return read_fog(r, err);
    if (key && key->id == KEY_MEDIUM)
        return read_smoke(r, err);
    if (key)
        return read_key(r, key, err);
    warnings_add(r->report, "lines with an unknown key",
                 "%s:%" PRIu64 ": found the unknown key %s: ignored", r->path,
                 r->lex->line, word_quote(name).text);
    return true;
}

/* Checks the camera at the end of the file: it needs both points, from this
 * file or from an earlier one. */
static bool finish_camera(struct view_reader *r, struct error *err)
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
    return pose_check(&r->view->pose, place, err);
}

static bool parse(struct view_reader *r, const char *text, size_t size_bytes,
                  struct error *err)
{
    return lexer_lines(text, size_bytes, view_parse_line, r, err) &&
           finish_camera(r, err);
}

bool view_parse(struct view *view, const char *text, size_t size_bytes,
                const char *path, struct warnings *report, struct error *err)
{
    struct view_reader r = {.view = view, .path = path, .report = report};

    return parse(&r, text, size_bytes, err);
}

bool view_parse_over(struct view *view, const char *lines,
                     struct warnings *report, struct error *err)
{
    struct view_reader r = {.view = view,
                            .path = "view options",
                            .is_over = true,
                            .report = report};

    return parse(&r, lines, strlen(lines), err);
}

/* ---- lights ---- */

#define OF_POINT       (1u << LAMP_POINT)
#define OF_SPOT        (1u << LAMP_SPOT)
#define OF_DIRECTIONAL (1u << LAMP_DIRECTIONAL)

#define TO_MAX "a number from 0 to 1e30"
#define ANGLE  "an angle from 0 to 90 degrees"

/* A word of a line with the numbers behind it. */
struct light_key {
    struct view_key key;
    uint32_t kinds; /* bits 1 << enum lamp_kind */
    size_t member;  /* offset in struct lamp */
};

#define MEMBER(name) offsetof(struct lamp, name)

/* The kinds, with the numbers that follow their names. */
static const struct light_key kinds[LAMP_KINDS] = {
    {{"point", KEY_LIGHT, 3, false, -VIEW_NUMBER_MAX, VIEW_NUMBER_MAX,
      "3 numbers from -1e30 to 1e30"},
     OF_POINT,
     MEMBER(position)},
    {{"spot", KEY_LIGHT, 3, false, -VIEW_NUMBER_MAX, VIEW_NUMBER_MAX,
      "3 numbers from -1e30 to 1e30"},
     OF_SPOT,
     MEMBER(position)},
    {{"directional", KEY_SUN, 2, false, -SUN_AZIMUTH_MAX, SUN_AZIMUTH_MAX,
      "an azimuth from -360 to 360 and an elevation from -90 to 90 degrees"},
     OF_DIRECTIONAL,
     MEMBER(azimuth_deg)},
};

static const struct light_key keys[] = {
    {{"at", KEY_LIGHT, 3, false, -VIEW_NUMBER_MAX, VIEW_NUMBER_MAX,
      "3 numbers from -1e30 to 1e30"},
     OF_SPOT,
     MEMBER(at)},
    {{"intensity", KEY_LIGHT, 3, false, 0, VIEW_NUMBER_MAX,
      "3 numbers from 0 to 1e30"},
     OF_POINT | OF_SPOT,
     MEMBER(rgb)},
    {{"irradiance", KEY_LIGHT, 3, false, 0, VIEW_NUMBER_MAX,
      "3 numbers from 0 to 1e30"},
     OF_DIRECTIONAL,
     MEMBER(rgb)},
    {{"inner", KEY_LIGHT, 1, false, 0, 90, ANGLE}, OF_SPOT, MEMBER(inner_deg)},
    {{"outer", KEY_LIGHT, 1, false, 0, 90, ANGLE}, OF_SPOT, MEMBER(outer_deg)},
    {{"radius", KEY_LIGHT, 1, false, 0, VIEW_NUMBER_MAX, TO_MAX},
     OF_POINT | OF_SPOT,
     MEMBER(radius)},
    {{"angle", KEY_LIGHT, 1, false, 0, 180, "an angle from 0 to 180 degrees"},
     OF_DIRECTIONAL,
     MEMBER(angle_deg)},
};

#define KEY_COUNT (sizeof keys / sizeof keys[0])

static const char *const expected_keys[LAMP_KINDS] = {
    "intensity, radius or ies",
    "at, intensity, inner, outer, radius or ies",
    "irradiance or angle",
};

static const struct light_key *find(const struct light_key *list, size_t count,
                                    struct word name, uint32_t of)
{
    for (size_t i = 0; i < count; i++)
        if ((list[i].kinds & of) != 0 && word_is(name, list[i].key.name))
            return &list[i];
    return NULL;
}

static bool read_light_numbers(struct view_reader *r, const struct light_key *k,
                               struct lamp *lamp, struct error *err)
{
    double *to = (double *)(void *)((char *)lamp + k->member);

    for (int i = 0; i < k->key.count; i++)
        if (!view_read_number(r, &k->key, i, &to[i], err))
            return false;
    return true;
}

/* Returns the next word of the line, empty at its end. */
static struct word next_word(struct view_reader *r)
{
    struct word none = {.length = 0};

    return lexer_at_line_end(r->lex) ? none : lexer_word(r->lex);
}

static bool check_spot(const struct view_reader *r, const struct lamp *lamp,
                       uint64_t line, struct error *err)
{
    if (!(fabs(lamp->at[0] - lamp->position[0]) > 0 ||
          fabs(lamp->at[1] - lamp->position[1]) > 0 ||
          fabs(lamp->at[2] - lamp->position[2]) > 0))
        return fail(err,
                    "%s:%" PRIu64
                    ": found a spot at its own position, expected "
                    "another point for at",
                    r->path, line);
    if (lamp->inner_deg > lamp->outer_deg)
        return fail(err,
                    "%s:%" PRIu64 ": found inner %g above outer %g, expected "
                    "inner within outer",
                    r->path, line, lamp->inner_deg, lamp->outer_deg);
    return true;
}

/* Reads the profile of a file. One that cannot be used is a warning: the lamp
 * shines evenly and keeps the name of the file. */
static bool read_ies(struct view_reader *r, struct lamp *lamp,
                     struct error *err)
{
    char *path = view_read_path(r, "an IES file for ies", err);
    struct error why;

    if (path == NULL)
        return false;
    lamp->profile = ies_read(path, &why);
    if (lamp->profile == NULL) {
        warnings_add(r->report, "unusable profiles of lights",
                     "%s: the light shines evenly", why.text);
        lamp->profile = profile_create_even(path);
    }
    free(path);
    return lamp->profile != NULL ||
           fail(err, "%s: out of memory for its lights", r->path);
}

/* Reads the words behind the kind and its numbers. */
static bool read_keys(struct view_reader *r, struct lamp *lamp, bool *has_at,
                      struct error *err)
{
    while (!lexer_at_line_end(r->lex)) {
        struct word name = lexer_word(r->lex);
        const struct light_key *k =
            find(keys, KEY_COUNT, name, 1u << lamp->kind);

        if (lamp->kind != LAMP_DIRECTIONAL && word_is(name, "ies"))
            return read_ies(r, lamp, err);
        if (k == NULL)
            return view_fail_at(r, name, expected_keys[lamp->kind],
                                kinds[lamp->kind].key.name, err);
        if (!read_light_numbers(r, k, lamp, err))
            return false;
        *has_at |= k->member == MEMBER(at);
    }
    return true;
}

bool view_light_read(struct view_reader *r, struct error *err)
{
    uint64_t line = r->lex->line;
    struct word name = next_word(r);
    const struct light_key *k = find(kinds, LAMP_KINDS, name, UINT32_MAX);
    struct lamp lamp;
    bool has_at = false, ok;

    if (k == NULL)
        return view_fail_at(r, name, "point, spot or directional", "light",
                            err);
    lamp_init(&lamp, (enum lamp_kind)(k - kinds));
    ok = read_light_numbers(r, k, &lamp, err) &&
         read_keys(r, &lamp, &has_at, err);
    if (ok && lamp.kind == LAMP_SPOT)
        ok = has_at ? check_spot(r, &lamp, line, err)
                    : view_fail_at(r, (struct word){.length = 0}, "at", "spot",
                                   err);
    ok = ok && (lamps_add(&r->view->lamps, &lamp) ||
                fail(err, "%s: out of memory", r->path));
    profile_release(lamp.profile);
    return ok;
}

static void write_numbers(FILE *to, const struct light_key *k,
                          const struct lamp *lamp)
{
    const double *from =
        (const double *)(const void *)((const char *)lamp + k->member);

    fprintf(to, " %s", k->key.name);
    for (int i = 0; i < k->key.count; i++) {
        char text[DECIMAL_TEXT_BYTES];

        decimal_format(text, from[i]);
        fprintf(to, " %s", text);
    }
}

static bool is_default(const struct light_key *k, const struct lamp *lamp)
{
    struct lamp fresh;

    lamp_init(&fresh, (enum lamp_kind)lamp->kind);
    return memcmp((const char *)lamp + k->member,
                  (const char *)&fresh + k->member,
                  (size_t)k->key.count * sizeof(double)) == 0;
}

/* Writes the name last, since it is the rest of the line. */
static void write_ies(FILE *to, const struct profile *profile, const char *path)
{
    char *name = view_name(profile->path, path);
    const char *text = name != NULL ? name : profile->path;

    fprintf(to, " ies %s%s", text, lexer_rest_guard(text));
    free(name);
}

void view_lights_write(const struct lamps *lamps, const char *path, FILE *to)
{
    for (uint32_t i = 0; i < lamps->count; i++) {
        const struct lamp *lamp = &lamps->items[i];

        fputs("light", to);
        write_numbers(to, &kinds[lamp->kind], lamp);
        for (size_t k = 0; k < KEY_COUNT; k++)
            if ((keys[k].kinds >> lamp->kind & 1) != 0 &&
                (keys[k].member == MEMBER(at) || !is_default(&keys[k], lamp)))
                write_numbers(to, &keys[k], lamp);
        if (lamp->profile != NULL)
            write_ies(to, lamp->profile, path);
        fputc('\n', to);
    }
}
