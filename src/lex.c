// SPDX-License-Identifier: MIT
#include "glim/lex.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glim/file.h"
#include "glim/number.h"

/* Longer words are cut in messages. */
#define QUOTE_BYTES 40

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

static bool is_line_end(char c)
{
    return c == '\n' || c == '\r';
}

void lex_init(struct lex *lex, const char *text, size_t size_bytes)
{
    lex->p = text;
    lex->end = text + size_bytes;
    lex->line = 1;
    if (size_bytes >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0)
        lex->p += 3;
}

/* Bytes of a line's end at p: 0, 1 or 2. */
static size_t line_end_bytes(const char *p, const char *end)
{
    if (p == end || !is_line_end(*p))
        return 0;
    return *p == '\r' && end - p > 1 && p[1] == '\n' ? 2 : 1;
}

/* Bytes of a backslash and the end of the line or text after it, or 0. */
static size_t join_bytes(const char *p, const char *end)
{
    size_t n;

    if (p == end || *p != '\\')
        return 0;
    n = line_end_bytes(p + 1, end);
    return n == 0 && p + 1 < end ? 0 : n + 1;
}

void lex_skip_blanks(struct lex *lex)
{
    for (;;) {
        size_t n;

        while (lex->p < lex->end && is_blank(*lex->p))
            lex->p++;
        n = join_bytes(lex->p, lex->end);
        if (n == 0)
            return;
        lex->p += n;
        lex->line++;
    }
}

bool lex_at_line_end(struct lex *lex)
{
    lex_skip_blanks(lex);
    return lex->p == lex->end || is_line_end(*lex->p) || *lex->p == '#';
}

void lex_next_line(struct lex *lex)
{
    bool in_comment = false;

    while (lex->p < lex->end && !is_line_end(*lex->p)) {
        size_t n = in_comment ? 0 : join_bytes(lex->p, lex->end);

        in_comment |= *lex->p == '#';
        lex->p += n == 0 ? 1 : n;
        lex->line += n != 0;
    }
    lex->p += line_end_bytes(lex->p, lex->end);
    lex->line++;
}

static bool ends_word(const char *p, const char *end)
{
    return p == end || is_blank(*p) || is_line_end(*p) ||
           (*p == '\\' && join_bytes(p, end) != 0);
}

struct word lex_word(struct lex *lex)
{
    struct word word;

    lex_skip_blanks(lex);
    word.start = lex->p;
    while (!ends_word(lex->p, lex->end))
        lex->p++;
    word.length = (size_t)(lex->p - word.start);
    return word;
}

char *lex_rest(struct lex *lex)
{
    struct lex start;
    char *text;
    size_t length = 0;

    lex_skip_blanks(lex);
    start = *lex;
    while (lex->p < lex->end && !is_line_end(*lex->p)) {
        size_t n = join_bytes(lex->p, lex->end);

        lex->p += n == 0 ? 1 : n;
        lex->line += n != 0;
    }
    text = malloc((size_t)(lex->p - start.p) + 1);
    if (text == NULL)
        return NULL;
    for (const char *p = start.p; p < lex->p; p++) {
        size_t n = join_bytes(p, lex->p);

        /* A NUL would end the name early, and two names could be one. */
        text[length++] = n != 0 || *p == '\0' ? ' ' : *p;
        p += n == 0 ? 0 : n - 1;
    }
    while (length > 0 && is_blank(text[length - 1]))
        length--;
    text[length] = '\0';
    return text;
}

/* What printf() of Microsoft's libraries writes: 1.#INF, 1.#IND, 1.#QNAN and
 * 1.#SNAN, with zeros for the digits that were asked for, or nan(ind). */
static bool microsoft_number(struct word word, double *value)
{
    char text[16];
    const char *p = text;

    if (word.length < 6 || word.length >= sizeof text)
        return false;
    memcpy(text, word.start, word.length);
    text[word.length] = '\0';
    p += *p == '-' || *p == '+';
    if (strncmp(p, "1.#INF", 6) == 0) {
        *value = text[0] == '-' ? -INFINITY : INFINITY;
        return true;
    }
    *value = NAN;
    return strncmp(p, "1.#IND", 6) == 0 || strncmp(p, "1.#QNAN", 7) == 0 ||
           strncmp(p, "1.#SNAN", 7) == 0 || strncmp(p, "nan(", 4) == 0;
}

bool lex_number(struct lex *lex, double *value)
{
    struct lex saved;

    lex_skip_blanks(lex);
    saved = *lex;
    if (number_parse(&lex->p, lex->end, value) && ends_word(lex->p, lex->end))
        return true;
    *lex = saved;
    if (microsoft_number(lex_word(lex), value))
        return true;
    *lex = saved;
    return false;
}

bool lex_file(const char *path,
              bool (*take_line)(void *context, struct lex *lex,
                                struct error *err),
              void *context, struct error *err)
{
    struct lex lex;
    char *text;
    size_t size_bytes;
    bool ok = true;

    if (!file_read(path, &text, &size_bytes, err))
        return false;
    lex_init(&lex, text, size_bytes);
    while (ok && lex.p < lex.end) {
        ok = take_line(context, &lex, err);
        lex_next_line(&lex);
    }
    free(text);
    return ok;
}

bool word_is(struct word word, const char *text)
{
    return strlen(text) == word.length &&
           memcmp(word.start, text, word.length) == 0;
}

struct word_text word_quote(struct word word)
{
    struct word_text quote;
    int length = word.length < QUOTE_BYTES ? (int)word.length : QUOTE_BYTES;

    if (word.length == 0)
        snprintf(quote.text, sizeof quote.text, "the end of the line");
    else
        snprintf(quote.text, sizeof quote.text, "'%.*s%s'", length, word.start,
                 word.length > QUOTE_BYTES ? "..." : "");
    return quote;
}
