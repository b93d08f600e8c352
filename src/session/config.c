// SPDX-License-Identifier: MIT
#include "session/config.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/lexer.h"
#include "base/xdg.h"
#include "terminal/xmalloc.h"

/* Longer than every known word. */
#define WORD_BYTES 64

#define NO_KEY "none"

struct reader {
    struct options *options;
    const char *path;
    struct lexer *lex;
    char place[400]; /* file:line */
};

/* Returns the path of the file, for free(); NULL without a home folder. */
static char *config_path(void)
{
    char *folder = xdg_folder("XDG_CONFIG_HOME", ".config");
    char *path = folder ? xformat("%s/config", folder) : NULL;

    free(folder);
    return path;
}

static bool fail_at(const struct reader *r, struct word found,
                    const char *expected, struct error *err)
{
    return fail(err, "%s: found %s, expected %s", r->place,
                word_quote(found).text, expected);
}

/* Returns the next word of the line; an empty one at its end. */
static struct word next_word(struct reader *r)
{
    struct word none = {.start = ""};

    return lexer_at_line_end(r->lex) ? none : lexer_word(r->lex);
}

static bool read_key(struct reader *r, struct error *err)
{
    struct word name = next_word(r);
    enum action action = keymap_find_action(name.start, name.length);
    struct word word = next_word(r);
    int keys[KEYMAP_MAX] = {0};

    if (action == ACTION_NONE)
        return fail_at(r, name, "an action (man glim lists them)", err);
    if (word_is(word, NO_KEY)) {
        word = next_word(r);
        if (word.length > 0)
            return fail_at(r, word, "nothing after " NO_KEY, err);
    } else if (word.length == 0) {
        return fail_at(r, word, "a key, or " NO_KEY, err);
    }
    for (int i = 0; word.length > 0; i++, word = next_word(r)) {
        if (i == KEYMAP_MAX)
            return fail_at(r, word, "no more than four keys", err);
        keys[i] = keymap_find_key(word.start, word.length);
        if (keys[i] == 0)
            return fail_at(r, word,
                           "a key: a character, ^A to ^_, or a name such as "
                           "Enter, space, PgUp or F1",
                           err);
    }
    keymap_choose(&r->options->keys, action, keys);
    return true;
}

static bool read_option(struct reader *r, struct error *err)
{
    struct word name = next_word(r);
    struct word value = next_word(r);
    struct word surplus = next_word(r);
    char texts[2][WORD_BYTES];

    if (surplus.length > 0)
        return fail_at(r, surplus, "one value for an option", err);
    if (name.length == 0 || name.length >= WORD_BYTES)
        return fail_at(r, name, "the name of an option", err);
    if (value.length >= WORD_BYTES)
        return fail_at(r, value, "a shorter value", err);
    snprintf(texts[0], WORD_BYTES, "%.*s", (int)name.length, name.start);
    snprintf(texts[1], WORD_BYTES, "%.*s", (int)value.length, value.start);
    return options_set_configured(r->options, texts[0],
                                  value.length > 0 ? texts[1] : NULL, r->place,
                                  err);
}

static bool read_line(void *context, struct lexer *lex, struct error *err)
{
    struct reader *r = context;
    struct word word;

    r->lex = lex;
    snprintf(r->place, sizeof r->place, "%s:%" PRIu64, r->path, lex->line);
    word = next_word(r);
    if (word.length == 0)
        return true;
    if (word_is(word, "key"))
        return read_key(r, err);
    if (word_is(word, "option"))
        return read_option(r, err);
    return fail_at(r, word, "key or option", err);
}

bool config_read(struct options *o, struct error *err)
{
    char *path = config_path();
    struct reader r = {.options = o, .path = path};
    bool ok = !path || access(path, F_OK) != 0 ||
              lexer_file(path, read_line, &r, err);

    free(path);
    return ok;
}
