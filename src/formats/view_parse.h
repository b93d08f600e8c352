// SPDX-License-Identifier: MIT
/*
 * view_parse.h - reads the text of a view file: its keys and lines
 *
 * Units:     as view.h
 * Ownership: nothing of the text is kept
 * Threads:   one thread at a time
 * Errors:    a malformed or impossible value: file:line
 */
#ifndef GLIM_VIEW_PARSE_H
#define GLIM_VIEW_PARSE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/lexer.h"
#include "base/warnings.h"
#include "scene/view.h"

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
    KEY_APERTURE,
    KEY_FOCUS,
    KEY_EXPOSURE,
    KEY_SKY,    /* has a name */
    KEY_TONE,   /* has a name */
    KEY_ASSIGN, /* has two names */
    KEY_VIEW    /* has a number and other keys */
};

#define VIEW_KEYS ((size_t)KEY_VIEW + 1)

struct view_key {
    const char *name;
    enum view_key_id id;
    int count; /* of numbers */
    bool is_whole;
    double least, greatest;
    const char *expected;
};

/* In the order in which a new file has them. */
extern const struct view_key view_keys[VIEW_KEYS];

/* NULL: unknown. Other programs write background_map for sky. */
const struct view_key *view_find_key(struct word name);

/* The context of view_parse_line(). */
struct view_reader {
    struct view *view;
    const char *path;
    struct lexer *lex;
    struct warnings *report;
    uint64_t eye_line, at_line; /* 0: not in this file */
};

lexer_take_line view_parse_line;

/* Reads `key value` lines over what `view` holds. An unknown key is a warning.
 * `path` is for messages, and names in the text are seen from its folder. */
bool view_parse(struct view *view, const char *text, size_t size_bytes,
                const char *path, struct warnings *report, struct error *err);

#endif
