// SPDX-License-Identifier: MIT
#include "base/lexer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/file.h"

/* Bytes of a word that a message quotes; longer words are cut. */
#define QUOTE_BYTES 40

bool lexer_is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

static bool is_line_end(char c)
{
    return c == '\n' || c == '\r';
}

size_t lexer_text_size(const char *text, size_t size_bytes)
{
    while (size_bytes > 0 && text[size_bytes - 1] == '\0')
        size_bytes--;
    return size_bytes;
}

void lexer_trim(const char **text, size_t *size_bytes)
{
    if (*size_bytes >= 3 && memcmp(*text, "\xef\xbb\xbf", 3) == 0) {
        *text += 3;
        *size_bytes -= 3;
    }
    *size_bytes = lexer_text_size(*text, *size_bytes);
}

void lexer_init(struct lexer *lex, const char *text, size_t size_bytes)
{
    lexer_trim(&text, &size_bytes);
    lex->p = text;
    lex->end = text + size_bytes;
    lex->line = 1;
}

/* Pairs of bytes that show UTF-16 without a byte order mark. */
#define UTF16_PAIRS 8

bool lexer_is_utf16(const char *text, size_t size_bytes)
{
    int high = 0, low = 0;

    if (size_bytes < 2)
        return false;
    if (memcmp(text, "\xff\xfe", 2) == 0 || memcmp(text, "\xfe\xff", 2) == 0)
        return true;
    if (size_bytes < (size_t)2 * UTF16_PAIRS)
        return false;
    for (int i = 0; i < 2 * UTF16_PAIRS; i += 2) {
        high += text[i] == '\0' && text[i + 1] != '\0';
        low += text[i] != '\0' && text[i + 1] == '\0';
    }
    return high == UTF16_PAIRS || low == UTF16_PAIRS;
}

/* Returns the size of the line end at p: 0, 1 or 2 bytes. */
static size_t line_end_bytes(const char *p, const char *end)
{
    if (p == end || !is_line_end(*p))
        return 0;
    return *p == '\r' && end - p > 1 && p[1] == '\n' ? 2 : 1;
}

/* Returns the size of the join at p, which is a backslash with the end of the
 * line or text behind it, or 0. */
static size_t join_bytes(const char *p, const char *end)
{
    size_t n;

    if (p == end || *p != '\\')
        return 0;
    n = line_end_bytes(p + 1, end);
    return n == 0 && p + 1 < end ? 0 : n + 1;
}

void lexer_skip_blanks(struct lexer *lex)
{
    for (;;) {
        size_t n;

        while (lex->p < lex->end && lexer_is_blank(*lex->p))
            lex->p++;
        n = join_bytes(lex->p, lex->end);
        if (n == 0)
            return;
        lex->p += n;
        lex->line++;
    }
}

bool lexer_at_line_end(struct lexer *lex)
{
    lexer_skip_blanks(lex);
    return lex->p == lex->end || is_line_end(*lex->p) || *lex->p == '#';
}

bool lexer_next_line(struct lexer *lex)
{
    bool in_comment = false;
    size_t end_bytes;

    while (lex->p < lex->end && !is_line_end(*lex->p)) {
        size_t n = in_comment ? 0 : join_bytes(lex->p, lex->end);

        in_comment |= *lex->p == '#';
        lex->p += n == 0 ? 1 : n;
        lex->line += n != 0;
    }
    end_bytes = line_end_bytes(lex->p, lex->end);
    lex->p += end_bytes;
    lex->line++;
    return end_bytes > 0;
}

static bool ends_word(const char *p, const char *end)
{
    return p == end || lexer_is_blank(*p) || is_line_end(*p) ||
           (*p == '\\' && join_bytes(p, end) != 0);
}

struct word lexer_word(struct lexer *lex)
{
    struct word word;

    lexer_skip_blanks(lex);
    word.start = lex->p;
    while (!ends_word(lex->p, lex->end))
        lex->p++;
    word.length = (size_t)(lex->p - word.start);
    return word;
}

/* Returns the size of the join at p, or 0. There are no joins behind a '#'. */
static size_t rest_join_bytes(const char *p, const char *end, bool *in_comment)
{
    *in_comment |= *p == '#';
    return *in_comment ? 0 : join_bytes(p, end);
}

char *lexer_rest(struct lexer *lex)
{
    bool in_comment = false;
    size_t length = 0;
    const char *start;
    char *text;

    lexer_skip_blanks(lex);
    start = lex->p;
    while (lex->p < lex->end && !is_line_end(*lex->p)) {
        size_t n = rest_join_bytes(lex->p, lex->end, &in_comment);

        lex->p += n == 0 ? 1 : n;
        lex->line += n != 0;
    }
    text = malloc((size_t)(lex->p - start) + 1);
    if (text == NULL)
        return NULL;
    in_comment = false;
    for (const char *p = start; p < lex->p;) {
        size_t n = rest_join_bytes(p, lex->p, &in_comment);
        /* a NUL would end the name early and could make two names equal */
        char c = n != 0 || *p == '\0' ? ' ' : *p;

        if (length > 0 || !lexer_is_blank(c))
            text[length++] = c;
        p += n == 0 ? 1 : n;
    }
    while (length > 0 && lexer_is_blank(text[length - 1]))
        length--;
    text[length] = '\0';
    return text;
}

const char *lexer_rest_guard(const char *rest)
{
    size_t length = strlen(rest);

    return length > 0 && rest[length - 1] == '\\' ? " " : "";
}

/* Reads the special numbers that printf() of Microsoft's libraries writes:
 * 1.#INF, 1.#IND, 1.#QNAN and 1.#SNAN, padded with zeros to the requested
 * digits, or nan(ind). */
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

bool lexer_number(struct lexer *lex, double *value)
{
    struct lexer saved;

    lexer_skip_blanks(lex);
    saved = *lex;
    if (decimal_parse(&lex->p, lex->end, value) && ends_word(lex->p, lex->end))
        return true;
    *lex = saved;
    if (microsoft_number(lexer_word(lex), value))
        return true;
    *lex = saved;
    return false;
}

bool lexer_lines(const char *text, size_t size_bytes,
                 lexer_take_line *take_line, void *context, struct error *err)
{
    struct lexer lex;

    lexer_init(&lex, text, size_bytes);
    while (lex.p < lex.end) {
        if (!take_line(context, &lex, err))
            return false;
        lexer_next_line(&lex);
    }
    return true;
}

bool lexer_file(const char *path, lexer_take_line *take_line, void *context,
                struct error *err)
{
    char *text;
    size_t size_bytes;
    bool ok;

    if (!file_read(path, &text, &size_bytes, err))
        return false;
    ok = lexer_lines(text, size_bytes, take_line, context, err);
    free(text);
    return ok;
}

bool word_is(struct word word, const char *text)
{
    return strlen(text) == word.length &&
           memcmp(word.start, text, word.length) == 0;
}

struct word_text word_cut(struct word word)
{
    struct word_text cut;
    int length = word.length < QUOTE_BYTES ? (int)word.length : QUOTE_BYTES;

    snprintf(cut.text, sizeof cut.text, "%.*s%s", length, word.start,
             word.length > QUOTE_BYTES ? "..." : "");
    return cut;
}

struct word_text word_quote(struct word word)
{
    struct word_text quote = {"the end of the line"};

    if (word.length > 0)
        snprintf(quote.text, sizeof quote.text, "'%.60s'", word_cut(word).text);
    return quote;
}
