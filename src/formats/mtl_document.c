// SPDX-License-Identifier: MIT
#include "formats/mtl_document.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Returns the line end of the first line; a line feed if there is only one
 * line. */
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

bool mtl_document_init(struct mtl_document *t, const char *text,
                       size_t size_bytes)
{
    /* what is appended must not stand behind NULs, which readers drop */
    size_bytes = lexer_text_size(text, size_bytes);
    *t = (struct mtl_document){alloc_array(size_bytes + 1, 1), size_bytes,
                               line_end_of(text, size_bytes)};
    if (t->bytes != NULL)
        memcpy(t->bytes, text, size_bytes);
    return t->bytes != NULL;
}

static bool splice(struct mtl_document *t, size_t at, size_t removed,
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

bool mtl_document_splice(struct mtl_document *t, size_t at, size_t removed,
                         const char *insert)
{
    return splice(t, at, removed, insert, strlen(insert));
}

struct lexer mtl_document_lex(const struct mtl_document *t, size_t at)
{
    struct lexer lex;

    if (at == 0)
        lexer_init(&lex, t->bytes, t->size);
    else
        lex = (struct lexer){t->bytes + at, t->bytes + t->size, 1};
    return lex;
}

/* Finds the value of a statement whose key and end are known. */
static void find_value(const struct mtl_document *t, struct mtl_statement *s)
{
    struct lexer lex = {t->bytes + s->key_end, t->bytes + s->end, 1};
    bool is_option = false;

    s->value = s->value_end = s->key_end;
    while (!lexer_at_line_end(&lex)) {
        struct word word = lexer_word(&lex);

        if (s->value == s->key_end || is_option)
            s->value = (size_t)(word.start - t->bytes);
        s->value_end = (size_t)(lex.p - t->bytes);
        is_option = word_is(word, "-halo");
    }
    s->has_comment = lex.p < lex.end && *lex.p == '#';
}

/* Finds the next statement from *lex on and moves *lex to the line after it. */
static bool next_statement(const struct mtl_document *t, struct lexer *lex,
                           struct mtl_statement *s)
{
    for (; lex->p < lex->end; lexer_next_line(lex)) {
        struct word word;

        s->line = (size_t)(lex->p - t->bytes);
        if (lexer_at_line_end(lex))
            continue;
        word = lexer_word(lex);
        s->key = (size_t)(word.start - t->bytes);
        s->key_end = s->key + word.length;
        s->is_unterminated = !lexer_next_line(lex);
        s->end = (size_t)(lex->p - t->bytes);
        find_value(t, s);
        return true;
    }
    return false;
}

bool mtl_document_has_key(const struct mtl_document *t,
                          const struct mtl_statement *s, mtl_aliases keys)
{
    struct word word = {t->bytes + s->key, s->key_end - s->key};

    for (int i = 0; i < MTL_ALIASES_MAX && keys[i] != NULL; i++)
        if (word_is(word, keys[i]))
            return true;
    return false;
}

/* Returns the value of a statement, joined to one line, for free(). NULL when
 * memory is out. */
static char *rest_of(const struct mtl_document *t,
                     const struct mtl_statement *s)
{
    struct lexer lex = mtl_document_lex(t, s->key_end);

    return lexer_rest(&lex);
}

bool mtl_document_find_block(const struct mtl_document *t, const char *name,
                             struct mtl_block *b)
{
    static mtl_aliases newmtl = {"newmtl"};
    struct lexer lex = mtl_document_lex(t, 0);
    struct mtl_statement s;
    bool is_in = false;
    bool is_found = false;

    while (next_statement(t, &lex, &s)) {
        if (mtl_document_has_key(t, &s, newmtl)) {
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

/* Finds the last statement of a block with one of these keys. */
static bool find_statement(const struct mtl_document *t,
                           const struct mtl_block *b, mtl_aliases keys,
                           struct mtl_statement *found)
{
    struct lexer lex = mtl_document_lex(t, b->newmtl.end);
    struct mtl_statement s;
    bool is_found = false;

    while (next_statement(t, &lex, &s) && s.line < b->end) {
        if (!mtl_document_has_key(t, &s, keys))
            continue;
        *found = s;
        is_found = true;
    }
    return is_found;
}

/* Returns the line ends that an unterminated last line needs, for free(), or
 * NULL if memory is out. A line that ends in a backslash needs two, for the
 * backslash joins the next line. The same holds for a backslash and a carriage
 * return, to which the first line feed belongs. */
static char *final_line_end(const struct mtl_document *t)
{
    char last = t->size > 0 ? t->bytes[t->size - 1] : '\n';
    bool joins = last == '\\' || last == '\r';

    return format_text("%s%s", joins ? t->line_end : "", t->line_end);
}

bool mtl_document_insert(struct mtl_document *t, const struct mtl_block *b,
                         const char *key, const char *value)
{
    const struct mtl_statement *last = &b->last;
    int indent = (int)(last->key - last->line);
    const char *margin = t->bytes + last->line;
    char *closing = last->is_unterminated ? final_line_end(t) : strdup("");
    char *line = closing == NULL
                     ? NULL
                     : format_text("%s%.*s%s %s%s%s", closing, indent, margin,
                                   key, value, lexer_rest_guard(value),
                                   last->is_unterminated ? "" : t->line_end);
    bool ok = line != NULL && mtl_document_splice(t, last->end, 0, line);

    free(line);
    free(closing);
    return ok;
}

bool mtl_document_set(struct mtl_document *t, const char *name,
                      mtl_aliases keys, const char *value)
{
    struct word word;
    struct mtl_statement s;
    struct mtl_block b;
    char *whole;
    bool ok;

    if (!mtl_document_find_block(t, name, &b))
        return false;
    if (!find_statement(t, &b, keys, &s))
        return mtl_document_insert(t, &b, keys[0], value);
    word = (struct word){t->bytes + s.key, s.key_end - s.key};
    if (word_is(word, keys[0]) && s.value > s.key_end)
        return mtl_document_splice(t, s.value, s.value_end - s.value, value);
    whole = format_text("%s %s", keys[0], value);
    ok = whole != NULL &&
         mtl_document_splice(t, s.key, s.value_end - s.key, whole);
    free(whole);
    return ok;
}

bool mtl_document_remove(struct mtl_document *t, const char *name,
                         mtl_aliases keys)
{
    struct mtl_statement s;
    struct mtl_block b;

    while (mtl_document_find_block(t, name, &b) &&
           find_statement(t, &b, keys, &s)) {
        size_t length = s.value_end - s.key;

        if (!s.has_comment)
            mtl_document_splice(t, s.line, s.end - s.line, "");
        else
            mtl_document_splice(t, s.key, length, "");
    }
    return true;
}

bool mtl_document_comment(struct mtl_document *t, const char *name,
                          mtl_aliases keys)
{
    struct mtl_statement s;
    struct mtl_block b;

    while (mtl_document_find_block(t, name, &b) &&
           find_statement(t, &b, keys, &s)) {
        char *rest = rest_of(t, &s);
        struct lexer lex = mtl_document_lex(t, s.key_end);
        size_t end;
        char *line;
        bool ok;

        free(lexer_rest(
            &lex)); /* reads to the end of the line: names may contain '#' */
        end = (size_t)(lex.p - t->bytes);
        if (rest == NULL)
            return false;
        line = format_text("#%.*s %s%s", (int)(s.key_end - s.key),
                           t->bytes + s.key, rest, lexer_rest_guard(rest));
        ok = line != NULL && mtl_document_splice(t, s.key, end - s.key, line);
        free(line);
        free(rest);
        if (!ok)
            return false;
    }
    return true;
}

/* Returns true if the last line of the text has no line end. */
static bool is_unterminated(const struct mtl_document *t)
{
    struct lexer lex = mtl_document_lex(t, 0);
    bool has_end = true;

    while (lex.p < lex.end)
        has_end = lexer_next_line(&lex);
    return !has_end;
}

bool mtl_document_append_block(struct mtl_document *t, const char *name,
                               const char *copied_from)
{
    char *closing = is_unterminated(t) ? final_line_end(t) : strdup("");
    char *head = closing == NULL
                     ? NULL
                     : format_text("%s%snewmtl %s%s%s", closing, t->line_end,
                                   name, lexer_rest_guard(name), t->line_end);
    struct mtl_block b;
    size_t length = 0; /* size of the copied block */
    char *copy = NULL;
    bool ok = head != NULL;

    if (mtl_document_find_block(t, copied_from, &b)) {
        length = b.last.end - b.newmtl.end;
        copy = alloc_array(length, 1);
        ok = ok && copy != NULL;
    }
    if (ok && length > 0)
        memcpy(copy, t->bytes + b.newmtl.end, length);
    ok = ok && mtl_document_splice(t, t->size, 0, head) &&
         splice(t, t->size, 0, copy != NULL ? copy : "", length);
    free(copy);
    free(head);
    free(closing);
    return ok;
}
