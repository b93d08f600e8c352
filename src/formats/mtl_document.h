// SPDX-License-Identifier: MIT
/*
 * mtl_document.h - the text of an MTL file, edited in place
 *
 * Edits keep comments, order, blanks, line ends and all statements that are
 * not named. The last of several blocks with the same name counts, and the
 * last of several statements with the same meaning, as in reading.
 *
 * Units:     bytes from the start of the text
 * Ownership: `bytes` is for free()
 * Threads:   one thread
 * Errors:    false when memory is out
 */
#ifndef GLIM_MTL_DOCUMENT_H
#define GLIM_MTL_DOCUMENT_H

#include <stdbool.h>
#include <stddef.h>

#include "base/lexer.h"

/* Keys with the same meaning. The first is the one that is written. */
#define MTL_ALIASES_MAX 3
typedef const char *const mtl_aliases[MTL_ALIASES_MAX];

struct mtl_document {
    char *bytes;
    size_t size;
    const char *line_end;
};

/* Position of a statement in the text. */
struct mtl_statement {
    size_t line;             /* start of its line */
    size_t key, key_end;     /* the first word */
    size_t value, value_end; /* the words after it */
    size_t end;              /* start of the next line */
    bool has_comment;
    bool is_unterminated; /* the text ends without a line end */
};

/* Block of a material: its newmtl statement and its last statement, which may
 * be the same. */
struct mtl_block {
    struct mtl_statement newmtl, last;
    size_t end; /* start of the next newmtl, or end of the text */
};

/* Initializes the document with a copy of the text. */
bool mtl_document_init(struct mtl_document *t, const char *text,
                       size_t size_bytes);

/* Replaces `removed` bytes at `at` by the text `insert`. */
bool mtl_document_splice(struct mtl_document *t, size_t at, size_t removed,
                         const char *insert);

/* Returns a lexer that starts at `at`. */
struct lexer mtl_document_lex(const struct mtl_document *t, size_t at);

/* Returns true if the statement has one of these keys. */
bool mtl_document_has_key(const struct mtl_document *t,
                          const struct mtl_statement *s, mtl_aliases keys);

/* Finds the last block of this name. Returns false if there is none; blocks
 * without a name are not found. */
bool mtl_document_find_block(const struct mtl_document *t, const char *name,
                             struct mtl_block *b);

/* Inserts a statement after the last one of the block, with the same
 * indentation. */
bool mtl_document_insert(struct mtl_document *t, const struct mtl_block *b,
                         const char *key, const char *value);

/* Sets the value of a statement in the block of this name. Adds the statement
 * if the block does not have it. */
bool mtl_document_set(struct mtl_document *t, const char *name,
                      mtl_aliases keys, const char *value);

/* The first removes all statements with these keys from the block of this name
 * and keeps comments after them. The second turns the statements into
 * comments. */
bool mtl_document_remove(struct mtl_document *t, const char *name,
                         mtl_aliases keys);
bool mtl_document_comment(struct mtl_document *t, const char *name,
                          mtl_aliases keys);

/* Appends a new block with a copy of the statements of the block `copied_from`,
 * if that exists. */
bool mtl_document_append_block(struct mtl_document *t, const char *name,
                               const char *copied_from);

#endif
