// SPDX-License-Identifier: MIT
/*
 * mtl_document.h - the text of an MTL file whose statements are changed in
 * place
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

#include <stdbool.h>
#include <stddef.h>

#include "base/lexer.h"

/* Keys that stand for each other. The first is the one that is written. */
#define MTL_ALIASES_MAX 3
typedef const char *const mtl_aliases[MTL_ALIASES_MAX];

struct mtl_document {
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
bool mtl_document_init(struct mtl_document *t, const char *text,
                       size_t size_bytes);

/* Puts `insert` in the place of `removed` bytes. */
bool mtl_document_splice(struct mtl_document *t, size_t at, size_t removed,
                         const char *insert);

/* Reads from there on. */
struct lexer mtl_document_lex(const struct mtl_document *t, size_t at);

/* True if the statement has one of these keys. */
bool mtl_document_has_key(const struct mtl_document *t,
                          const struct mtl_statement *s, mtl_aliases keys);

/* The last block of this name. False if there is none: one without a name is
 * no material. */
bool mtl_document_find_block(const struct mtl_document *t, const char *name,
                             struct mtl_block *b);

/* A statement of its own behind the last one of the block, as far from the
 * margin as that. */
bool mtl_document_insert(struct mtl_document *t, const struct mtl_block *b,
                         const char *key, const char *value);

/* Gives the statement of the block of this name this value, wherever it is. */
bool mtl_document_set(struct mtl_document *t, const char *name,
                      mtl_aliases keys, const char *value);

/* Removes all such statements of the block, but not the comments behind them;
 * or turns them into comments. */
bool mtl_document_remove(struct mtl_document *t, const char *name,
                         mtl_aliases keys);
bool mtl_document_comment(struct mtl_document *t, const char *name,
                          mtl_aliases keys);

/* A new block at the end of the text, with the statements of the other if there
 * is such a one. */
bool mtl_document_append_block(struct mtl_document *t, const char *name,
                               const char *copied_from);

#endif
