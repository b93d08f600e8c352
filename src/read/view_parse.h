// SPDX-License-Identifier: MIT
/*
 * view_parse.h - parses the text of a view file, with its `light` lines
 *
 *     light point X Y Z intensity R G B radius R ies FILE
 *     light spot X Y Z at X Y Z intensity R G B inner A outer A radius R
 *                ies FILE
 *     light directional AZ EL irradiance R G B angle A
 *
 * Units:     as in view.h; those of scene/lamp.h
 * Threads:   one thread at a time
 * Errors:    a malformed or impossible value: file:line; a file of IES
 */
#ifndef GLIM_VIEW_PARSE_H
#define GLIM_VIEW_PARSE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/lexer.h"
#include "base/warnings.h"
#include "scene/view.h"

/* ---- keys ---- */

enum view_key_id {
    KEY_EYE,
    KEY_AT,
    KEY_UP,
    KEY_FOVY,
    KEY_RES,
    KEY_BACKGROUND,
    KEY_MAX_BOUNCES,
    KEY_SKY_STRENGTH,
    KEY_SKY_ROTATION,
    KEY_SUN,
    KEY_TURBIDITY,
    KEY_APERTURE,
    KEY_FOCUS,
    KEY_EXPOSURE,
    KEY_FOG,        /* takes other keys */
    KEY_MEDIUM,     /* takes a name and other keys */
    KEY_SKY,        /* takes a name */
    KEY_TONE,       /* takes a name */
    KEY_ASSIGN,     /* takes two names */
    KEY_LIGHT_UNIT, /* takes a name */
    KEY_LIGHT,      /* takes a kind and other keys */
    KEY_VIEW        /* takes a number and other keys */
};

/* Largest number: squares and differences stay finite. */
#define VIEW_NUMBER_MAX 1e30

#define VIEW_KEYS ((size_t)KEY_VIEW + 1)

struct view_key {
    const char *name;
    enum view_key_id id;
    int count; /* number of numbers */
    bool is_whole;
    double least, greatest;
    const char *expected;
};

/* All keys, in the order in which a new file has them. */
extern const struct view_key view_keys[VIEW_KEYS];

/* Returns the key of this number. */
const struct view_key *view_key(enum view_key_id id);

/* Returns the key of this name, or NULL. background_map, which other programs
 * write, is another name for sky. */
const struct view_key *view_find_key(struct word name);

/* Reads the numbers of a key from a text of its own, where commas separate
 * them. Returns false if they are not what the key expects. */
bool view_key_numbers(const struct view_key *key, const char *text,
                      double values[3]);

/* Context of view_parse_line(). */
struct view_reader {
    struct view *view;
    const char *path;
    bool is_over; /* see view_parse_over() */
    struct lexer *lex;
    struct warnings *report;
    uint64_t eye_line, at_line; /* 0 if not in this file */
};

lexer_take_line view_parse_line;

/* Reads number i of a key and checks its range. */
bool view_read_number(struct view_reader *reader, const struct view_key *key,
                      int i, double *value, struct error *err);

/* Fails with the line, the word found, and the expected value of a key. */
bool view_fail_at(const struct view_reader *reader, struct word found,
                  const char *expected, const char *key, struct error *err);

/* Returns the path of a file as the view file at `path` names it, for free(),
 * or NULL when memory is out. A leading blank gets ./ before it, for the parser
 * skips blanks. */
char *view_name(const char *file, const char *path);

/* Reads the rest of the line as the name of a file. Returns its path, for
 * free(), or NULL after an error; `expected` is part of that. */
char *view_read_path(const struct view_reader *reader, const char *expected,
                     struct error *err);

/* Parses `key value` lines into `view`; values that are not given stay. An
 * unknown key is a warning. `path` is used for messages, and file names in the
 * text are relative to its folder. */
bool view_parse(struct view *view, const char *text, size_t size_bytes,
                const char *path, struct warnings *report, struct error *err);

/* Parses lines that go over those of a view file: a sky or a background
 * replaces its sun, and a background its sky image. File names are relative to
 * the current folder. */
bool view_parse_over(struct view *view, const char *lines,
                     struct warnings *report, struct error *err);

/* ---- lights ---- */

/* Reads the rest of a line after the key `light` into the reader's view. */
bool view_light_read(struct view_reader *reader, struct error *err);

/* Writes a line for each lamp into the file at `path`. Values that equal their
 * default are left out. */
void view_lights_write(const struct lamps *lamps, const char *path, FILE *to);

#endif
