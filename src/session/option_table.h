// SPDX-License-Identifier: MIT
/*
 * option_table.h - the table of all options: a row has the name, the commands
 * that take it, the text of --help, and how its value is read
 *
 * An option of a common kind needs a row and a member of struct options.
 * Options with values of the view become lines of a view file, which go over
 * those of the scene's.
 *
 * Units:     as in command_line.h; those of view files
 * Ownership: strings stay the caller's and must outlive the options; the lines
 *            of the view are the options'
 * Threads:   main only
 * Errors:    a wrong value: the option, the value and the expected one
 */
#ifndef GLIM_OPTION_TABLE_H
#define GLIM_OPTION_TABLE_H

#include <stdbool.h>
#include <stddef.h>

#include "read/view_parse.h"
#include "session/command_line.h"

struct option_given;

typedef bool option_setter(struct options *o, const struct option_given *g,
                           struct error *err);

enum option_kind {
    OPTION_TITLE,  /* a row between options: `help` is a title of --help */
    OPTION_FLAG,   /* `given` and `clears` alone; all others have a value */
    OPTION_TEXT,   /* a text that is not empty: const char * */
    OPTION_WHOLE,  /* a whole number: int */
    OPTION_NUMBER, /* a number: double */
    OPTION_WORD,   /* one of several words: an enum, which is its index */
    OPTION_LINE,   /* numbers of a key of the view */
    OPTION_OWN     /* what `set` reads */
};

struct option_rule {
    const char *name;     /* without dashes; one letter is a short option */
    const char *argument; /* the value in --help; NULL: none */
    const char *expected; /* the value in messages; NULL: no value */
    const char *help;     /* NULL: not for people */
    unsigned commands;    /* those that take it: bits 1 << enum sub_command */
    enum option_kind kind;
    size_t to;    /* offset in struct options of the value */
    size_t given; /* offset of a bool that becomes true; 0: none */
    size_t
        clears; /* offset of one that becomes false: the last option counts */
    double min, max;
    const char *const *words;
    int word_count;
    enum view_key_id key;
    option_setter *set;
    bool value_is_optional; /* it then follows a = sign */
    bool is_configurable;   /* in the configuration file: it suits a person or
                               a machine and does not change pictures */
};

/* Option from the command line or a file, with its value. */
struct option_given {
    const struct option_rule *rule;
    char shown[512]; /* "-w", "--seed" or the place in a file, for messages */
    const char *value;
};

/* Returns row i, from 0 on; NULL behind the last. */
const struct option_rule *option_rule(int i);

/* Returns the rule of the option of this name, without dashes; NULL if there is
 * none. */
const struct option_rule *option_rule_named(const char *name, size_t length);

/* Sets an option. The value must be present if the rule wants one and it is not
 * optional. */
bool option_set(struct options *o, const struct option_given *g,
                struct error *err);

/* Sets the scene, which is given without an option. */
bool option_set_scene(struct options *o, const char *path, struct error *err);

/* Returns a hint to append to a message about a wrong value: -h is the height
 * here, but help in other programs. "" if there is none. */
const char *option_hint(const struct option_given *g);

#endif
