// SPDX-License-Identifier: MIT
/*
 * lexer.h - words, numbers and lines of OBJ and MTL text
 *
 * Lines end with LF, CRLF or CR. A backslash before the end of a line joins
 * the next line to it, but not in a comment: comments of real files end with
 * paths of folders.
 *
 * Units:     bytes; lines count from 1
 * Ownership: borrows the text, which need not end in NUL; lexer_rest() returns
 *            memory for free()
 * Errors:    by the result; the caller knows what it wanted. Of lexer_file() a
 *            file that cannot be read
 */
#ifndef GLIM_LEXER_H
#define GLIM_LEXER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

struct lexer {
    const char *p, *end;
    uint64_t line;
};

struct word {
    const char *start;
    size_t length;
};

/* Blanks within a line. */
bool lexer_is_blank(char c);

/* Skips a UTF-8 byte order mark. */
void lexer_init(struct lexer *lex, const char *text, size_t size_bytes);

/* Takes the line that begins at lex->p; what it leaves of it is skipped. */
typedef bool lexer_take_line(void *context, struct lexer *lex,
                             struct error *err);

/* Calls `take_line` at the beginning of each line of the text, or of the file.
 * Ends with the first that fails. */
bool lexer_lines(const char *text, size_t size_bytes,
                 lexer_take_line *take_line, void *context, struct error *err);
bool lexer_file(const char *path, lexer_take_line *take_line, void *context,
                struct error *err);

/* Moves over blanks and joined lines. */
void lexer_skip_blanks(struct lexer *lex);

/* True at the end of the line or of the text, or at a comment; skips blanks
 * before it. */
bool lexer_at_line_end(struct lexer *lex);

/* Moves behind the end of the line. A comment is skipped as one. False if the
 * text ended before the line did. */
bool lexer_next_line(struct lexer *lex);

/* The next word of the line; length 0 at its end. */
struct word lexer_word(struct lexer *lex);

/* The rest of the line without blanks around it. A name may hold '#', but no
 * line is joined behind one. NULL when memory is out. */
char *lexer_rest(struct lexer *lex);

/* What is written between such a rest and the end of its line, so that reading
 * gives it back: a blank behind a backslash, which would join the next line. */
const char *lexer_rest_guard(const char *rest);

/* A number that is a word of its own: 1e400 is infinite, and so are the words
 * nan, inf and what Microsoft's libraries write (1.#INF, -nan(ind)). False,
 * with lex->p at the word, if there is something else or nothing. */
bool lexer_number(struct lexer *lex, double *value);

bool word_is(struct word word, const char *text);

/* The word for a message: at most 40 bytes of it; in quotes, or "the end of the
 * line" if empty. */
struct word_text {
    char text[64];
};
struct word_text word_cut(struct word word);
struct word_text word_quote(struct word word);

#endif
