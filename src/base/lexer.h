// SPDX-License-Identifier: MIT
/*
 * lexer.h - words, numbers and lines of OBJ and MTL text
 *
 * Lines end with LF, CRLF or CR. A backslash before the end of a line joins
 * the next line to it, but not in a comment, because comments of real
 * files end with paths of folders.
 *
 * Units:     bytes; lines count from 1
 * Ownership: borrows the text, which need not end in NUL; lexer_rest() returns
 *            memory for free()
 * Errors:    the results, since the caller knows what it expected; lexer_file()
 *            also reports a file that cannot be read
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

/* Returns true for blanks within a line. */
bool lexer_is_blank(char c);

/* Removes a UTF-8 byte order mark at the start of a text and NULs at its end,
 * with which some programs fill a file. */
void lexer_trim(const char **text, size_t *size_bytes);

/* Returns the size of a text without NULs at its end. */
size_t lexer_text_size(const char *text, size_t size_bytes);

/* Begins a text, which is trimmed. */
void lexer_init(struct lexer *lex, const char *text, size_t size_bytes);

/* Returns true for text in UTF-16, with a byte order mark or with a NUL in
 * every second byte, which the lexer cannot read. */
bool lexer_is_utf16(const char *text, size_t size_bytes);

/* Handles the line that begins at lex->p. The rest of the line is skipped. */
typedef bool lexer_take_line(void *context, struct lexer *lex,
                             struct error *err);

/* Calls `take_line` at the beginning of each line of the text, or of the file.
 * Stops at the first failure. */
bool lexer_lines(const char *text, size_t size_bytes,
                 lexer_take_line *take_line, void *context, struct error *err);
bool lexer_file(const char *path, lexer_take_line *take_line, void *context,
                struct error *err);

/* Skips blanks and line joins. */
void lexer_skip_blanks(struct lexer *lex);

/* Skips blanks, and returns true at the end of the line or of the text, or at a
 * comment. */
bool lexer_at_line_end(struct lexer *lex);

/* Moves behind the end of the line, over a comment if there is one. Returns
 * false if the text ended before the line did. */
bool lexer_next_line(struct lexer *lex);

/* Returns the next word of the line; its length is 0 at the line's end. */
struct word lexer_word(struct lexer *lex);

/* Returns the rest of the line without blanks around it, or NULL if memory is
 * out. A name may contain '#', but no line is joined behind one. */
char *lexer_rest(struct lexer *lex);

/* Returns the text to write between a name read by lexer_rest() and the end of
 * its line: a blank if the name ends with a backslash, which would join the
 * next line, and otherwise nothing. */
const char *lexer_rest_guard(const char *rest);

/* Reads a number that is a whole word. 1e400 is infinite, and so are inf and
 * Microsoft's 1.#INF; nan and -nan(ind) are accepted too. Returns false, with
 * lex->p at the word, if the word is no number or there is none. */
bool lexer_number(struct lexer *lex, double *value);

bool word_is(struct word word, const char *text);

/* Quotation of a word for messages: at most 40 bytes of it in quotes, or "the
 * end of the line" if it is empty. */
struct word_text {
    char text[64];
};
struct word_text word_cut(struct word word);
struct word_text word_quote(struct word word);

#endif
