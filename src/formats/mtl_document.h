// SPDX-License-Identifier: MIT
/*
 * mtl_document.h - the text of an MTL file whose statements are changed in place
 *
 * Comments, order, blanks and line ends stay as they are, and so does all that
 * is not named. Of blocks with the same name the last one counts, and of
 * statements that stand for each other, as in reading.
 *
 * Units:     bytes from the start of the text
 * Ownership: the bytes are for free()
 * Threads:   one thread
 * Errors:    false when memory is out
 */
#ifndef GLIM_MTL_DOCUMENT_H
#define GLIM_MTL_DOCUMENT_H

#include "base/lexer.h"

/* Keys that stand for each other. The first is the one that is written. */
#define MTL_ALIASES_MAX 3
typedef const char *const mtl_aliases[MTL_ALIASES_MAX];

struct mtl_text {
    char *bytes;
    size_t size;
    const char *line_end;
};

/* Where a statement stands in the text. */
struct mtl_statement {
    size_t line;             /* its line begins here, */
    size_t key, key_end;     /* the first word, */
    size_t value, value_end; /* the words after it, */
    size_t end;              /* behind the end of its line */
    bool has_comment;
    bool is_open; /* the text ends before its line does */
};

/* A newmtl statement, and its last one (itself if there is no other). */
struct mtl_block {
    struct mtl_statement newmtl, last;
    size_t end; /* the next newmtl, or the end of the text */
};

/* A copy of this text. */
bool mtl_text_init(struct mtl_text *t, const char *text, size_t size_bytes);

/* Puts `insert` in the place of `removed` bytes. */
bool mtl_text_splice(struct mtl_text *t, size_t at, size_t removed,
                     const char *insert);

/* Reads from there on. */
struct lex mtl_text_lex(const struct mtl_text *t, size_t at);

/* True if the statement has one of these keys. */
bool mtl_text_has_key(const struct mtl_text *t, const struct mtl_statement *s,
                      mtl_aliases keys);

/* The last block of this name. False if there is none: one without a name is
 * no material. */
bool mtl_text_find_block(const struct mtl_text *t, const char *name,
                         struct mtl_block *b);

/* A statement of its own behind the last one of the block, as far from the
 * margin as that. */
bool mtl_text_insert(struct mtl_text *t, const struct mtl_block *b,
                     const char *key, const char *value);

/* Gives the statement of the block of this name this value, wherever it is. */
bool mtl_text_set(struct mtl_text *t, const char *name, mtl_aliases keys,
                  const char *value);

/* Removes all such statements of the block, but not the comments behind them;
 * or turns them into comments. */
bool mtl_text_remove(struct mtl_text *t, const char *name, mtl_aliases keys);
bool mtl_text_comment(struct mtl_text *t, const char *name, mtl_aliases keys);

/* A new block at the end of the text, with the statements of the other if there
 * is such a one. */
bool mtl_text_append_block(struct mtl_text *t, const char *name,
                           const char *copied_from);

#endif
