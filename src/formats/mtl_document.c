// SPDX-License-Identifier: MIT
#include "formats/mtl_document.h"

#include <stdlib.h>
#include <string.h>

#include "base/util.h"

/* The end of the first line, or a line feed. */
static const char *line_end_of(const char *text, size_t size_bytes)
{
    for (size_t i = 0; i < size_bytes; i++) {
        if (text[i] == '\n')
            return "\n";
        if (text[i] == '\r')
            return i + 1 < size_bytes && text[i + 1] == '\n' ? "\r\n" : "\r";
    }
    return "\n";
}

bool mtl_text_init(struct mtl_text *t, const char *text, size_t size_bytes)
{
    *t = (struct mtl_text){alloc_array(size_bytes + 1, 1), size_bytes,
                           line_end_of(text, size_bytes)};
    if (t->bytes != NULL)
        memcpy(t->bytes, text, size_bytes);
    return t->bytes != NULL;
}

static bool splice(struct mtl_text *t, size_t at, size_t removed,
                   const char *insert, size_t added)
{
    size_t behind = t->size - at - removed;
    char *bytes = t->bytes;

    if (added > removed) {
        bytes = realloc(t->bytes, t->size + added - removed + 1);
        if (bytes == NULL)
            return false;
    }
    t->bytes = bytes;
    memmove(bytes + at + added, bytes + at + removed, behind);
    memcpy(bytes + at, insert, added);
    t->size += added - removed;
    return true;
}

bool mtl_text_splice(struct mtl_text *t, size_t at, size_t removed,
                     const char *insert)
{
    return splice(t, at, removed, insert, strlen(insert));
}

struct lex mtl_text_lex(const struct mtl_text *t, size_t at)
{
    struct lex lex;

    if (at == 0)
        lex_init(&lex, t->bytes, t->size);
    else
        lex = (struct lex){t->bytes + at, t->bytes + t->size, 1};
    return lex;
}

/* Finds the values of a statement whose key and end are known. */
static void find_value(const struct mtl_text *t, struct mtl_statement *s)
{
    struct lex lex = {t->bytes + s->key_end, t->bytes + s->end, 1};
    bool is_option = false;

    s->value = s->value_end = s->key_end;
    while (!lex_at_line_end(&lex)) {
        struct word word = lex_word(&lex);

        if (s->value == s->key_end || is_option)
            s->value = (size_t)(word.start - t->bytes);
        s->value_end = (size_t)(lex.p - t->bytes);
        is_option = word_is(word, "-halo");
    }
    s->has_comment = lex.p < lex.end && *lex.p == '#';
}

/* The next statement from *lex on, which moves behind its line. */
static bool next_statement(const struct mtl_text *t, struct lex *lex,
                           struct mtl_statement *s)
{
    for (; lex->p < lex->end; lex_next_line(lex)) {
        struct word word;

        s->line = (size_t)(lex->p - t->bytes);
        if (lex_at_line_end(lex))
            continue;
        word = lex_word(lex);
        s->key = (size_t)(word.start - t->bytes);
        s->key_end = s->key + word.length;
        s->is_open = !lex_next_line(lex);
        s->end = (size_t)(lex->p - t->bytes);
        find_value(t, s);
        return true;
    }
    return false;
}

bool mtl_text_has_key(const struct mtl_text *t, const struct mtl_statement *s,
                      mtl_aliases keys)
{
    struct word word = {t->bytes + s->key, s->key_end - s->key};

    for (int i = 0; i < MTL_ALIASES_MAX && keys[i] != NULL; i++)
        if (word_is(word, keys[i]))
            return true;
    return false;
}

/* What follows the key, joined to one line. NULL when memory is out. */
static char *rest_of(const struct mtl_text *t, const struct mtl_statement *s)
{
    struct lex lex = mtl_text_lex(t, s->key_end);

    return lex_rest(&lex);
}

bool mtl_text_find_block(const struct mtl_text *t, const char *name,
                         struct mtl_block *b)
{
    static mtl_aliases newmtl = {"newmtl"};
    struct lex lex = mtl_text_lex(t, 0);
    struct mtl_statement s;
    bool is_in = false;
    bool is_found = false;

    while (next_statement(t, &lex, &s)) {
        if (mtl_text_has_key(t, &s, newmtl)) {
            char *found = rest_of(t, &s);

            if (is_in)
                b->end = s.line;
            is_in = found != NULL && *found != '\0' && strcmp(found, name) == 0;
            is_found |= is_in;
            if (is_in)
                *b = (struct mtl_block){s, s, t->size};
            free(found);
        } else if (is_in) {
            b->last = s;
        }
    }
    return is_found;
}

/* The last statement of a block with one of these keys. */
static bool find_statement(const struct mtl_text *t, const struct mtl_block *b,
                           mtl_aliases keys, struct mtl_statement *found)
{
    struct lex lex = mtl_text_lex(t, b->newmtl.end);
    struct mtl_statement s;
    bool is_found = false;

    while (next_statement(t, &lex, &s) && s.line < b->end) {
        if (!mtl_text_has_key(t, &s, keys))
            continue;
        *found = s;
        is_found = true;
    }
    return is_found;
}

/* What closes a text that ends before its last line does. A backslash there has
 * joined nothing: now it joins an empty line. So does a backslash before a
 * carriage return, which the line feed belongs to. */
static char *closing_of(const struct mtl_text *t)
{
    char last = t->size > 0 ? t->bytes[t->size - 1] : '\n';
    bool joins = last == '\\' || last == '\r';

    return xformat("%s%s", joins ? t->line_end : "", t->line_end);
}

bool mtl_text_insert(struct mtl_text *t, const struct mtl_block *b,
                     const char *key, const char *value)
{
    const struct mtl_statement *last = &b->last;
    int indent = (int)(last->key - last->line);
    const char *margin = t->bytes + last->line;
    char *closing = last->is_open ? closing_of(t) : xstrdup("");
    char *line =
        xformat("%s%.*s%s %s%s%s", closing, indent, margin, key, value,
                lex_rest_guard(value), last->is_open ? "" : t->line_end);
    bool ok = mtl_text_splice(t, last->end, 0, line);

    free(line);
    free(closing);
    return ok;
}

bool mtl_text_set(struct mtl_text *t, const char *name, mtl_aliases keys,
                  const char *value)
{
    struct word word;
    struct mtl_statement s;
    struct mtl_block b;
    char *whole;
    bool ok;

    if (!mtl_text_find_block(t, name, &b))
        return false;
    if (!find_statement(t, &b, keys, &s))
        return mtl_text_insert(t, &b, keys[0], value);
    word = (struct word){t->bytes + s.key, s.key_end - s.key};
    if (word_is(word, keys[0]) && s.value > s.key_end)
        return mtl_text_splice(t, s.value, s.value_end - s.value, value);
    whole = xformat("%s %s", keys[0], value);
    ok = mtl_text_splice(t, s.key, s.value_end - s.key, whole);
    free(whole);
    return ok;
}

bool mtl_text_remove(struct mtl_text *t, const char *name, mtl_aliases keys)
{
    struct mtl_statement s;
    struct mtl_block b;

    while (mtl_text_find_block(t, name, &b) &&
           find_statement(t, &b, keys, &s)) {
        size_t length = s.value_end - s.key;

        if (!s.has_comment)
            mtl_text_splice(t, s.line, s.end - s.line, "");
        else
            mtl_text_splice(t, s.key, length, "");
    }
    return true;
}

bool mtl_text_comment(struct mtl_text *t, const char *name, mtl_aliases keys)
{
    struct mtl_statement s;
    struct mtl_block b;

    while (mtl_text_find_block(t, name, &b) &&
           find_statement(t, &b, keys, &s)) {
        char *rest = rest_of(t, &s);
        struct lex lex = mtl_text_lex(t, s.key_end);
        size_t end;
        char *line;
        bool ok;

        free(lex_rest(&lex)); /* a name may hold a '#': the rest is all of it */
        end = (size_t)(lex.p - t->bytes);
        if (rest == NULL)
            return false;
        line = xformat("#%.*s %s%s", (int)(s.key_end - s.key), t->bytes + s.key,
                       rest, lex_rest_guard(rest));
        ok = mtl_text_splice(t, s.key, end - s.key, line);
        free(line);
        free(rest);
        if (!ok)
            return false;
    }
    return true;
}

/* Whether the text ends before its last line does. */
static bool is_open(const struct mtl_text *t)
{
    struct lex lex = mtl_text_lex(t, 0);
    bool has_end = true;

    while (lex.p < lex.end)
        has_end = lex_next_line(&lex);
    return !has_end;
}

bool mtl_text_append_block(struct mtl_text *t, const char *name,
                           const char *copied_from)
{
    char *closing = is_open(t) ? closing_of(t) : xstrdup("");
    char *head = xformat("%s%snewmtl %s%s%s", closing, t->line_end, name,
                         lex_rest_guard(name), t->line_end);
    struct mtl_block b;
    size_t length = 0; /* of what is copied: nothing */
    char *copy = NULL;
    bool ok = true;

    if (mtl_text_find_block(t, copied_from, &b)) {
        length = b.last.end - b.newmtl.end;
        copy = alloc_array(length, 1);
        ok = copy != NULL;
    }
    if (ok && length > 0)
        memcpy(copy, t->bytes + b.newmtl.end, length);
    ok = ok && mtl_text_splice(t, t->size, 0, head) &&
         splice(t, t->size, 0, copy != NULL ? copy : "", length);
    free(copy);
    free(head);
    free(closing);
    return ok;
}
