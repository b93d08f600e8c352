// SPDX-License-Identifier: MIT
#include "read/view_light.h"

#include <inttypes.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "read/ies.h"

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

static bool read_numbers(struct view_reader *r, const struct light_key *k,
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
        if (!read_numbers(r, k, lamp, err))
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
    ok = read_numbers(r, k, &lamp, err) && read_keys(r, &lamp, &has_at, err);
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
