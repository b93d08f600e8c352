// SPDX-License-Identifier: MIT
#include "scene/assign.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Copies the text inside the quotes to `name`, which has room for the rest of
 * the file. Returns false if the closing quote is missing. */
static bool read_quoted(struct lexer *lex, char *name)
{
    for (lex->p++; lex->p < lex->end; lex->p++) {
        if (*lex->p == '\n' || *lex->p == '\r')
            return false;
        if (*lex->p == '"') {
            lex->p++;
            if (lex->p == lex->end || *lex->p != '"') {
                *name = '\0';
                return true;
            }
        }
        *name++ = *lex->p;
    }
    return false;
}

/* Reads the next name of the line. *name is for free(), or NULL if there is
 * none or its closing quote is missing. Returns false when memory is out. */
static bool read_name(struct lexer *lex, char **name)
{
    struct word word;

    *name = NULL;
    if (lexer_at_line_end(lex))
        return true;
    if (*lex->p != '"') {
        word = lexer_word(lex);
        *name = strndup(word.start, word.length);
        return *name != NULL;
    }
    *name = malloc((size_t)(lex->end - lex->p));
    if (*name == NULL)
        return false;
    if (!read_quoted(lex, *name)) {
        free(*name);
        *name = NULL;
    }
    return true;
}

bool assigns_read(struct assigns *a, struct lexer *lex, bool *has_names)
{
    char *object, *material = NULL;
    bool ok = read_name(lex, &object) &&
              (object == NULL || read_name(lex, &material));

    *has_names = ok && material != NULL && lexer_at_line_end(lex);
    if (*has_names)
        ok = assigns_set(a, object, material);
    free(object);
    free(material);
    return ok;
}

static void write_name(FILE *to, const char *name)
{
    if (*name != '\0' && strpbrk(name, " \t\v\f\"#\\") == NULL) {
        fputs(name, to);
        return;
    }
    fputc('"', to);
    for (const char *p = name; *p != '\0'; p++) {
        if (*p == '"')
            fputc('"', to);
        fputc(*p, to);
    }
    fputc('"', to);
}

void assigns_write(const struct assigns *a, FILE *to)
{
    for (size_t i = 0; i < a->count; i++) {
        fputs("assign ", to);
        write_name(to, a->items[i].object);
        fputc(' ', to);
        write_name(to, a->items[i].material);
        fputc('\n', to);
    }
}

static void remove_at(struct assigns *a, size_t i)
{
    free(a->items[i].object);
    free(a->items[i].material);
    a->count--;
    memmove(&a->items[i], &a->items[i + 1],
            (a->count - i) * sizeof a->items[0]);
}

/* Adds an assignment at the end. Returns false when memory is out. */
static bool append(struct assigns *a, const char *object, const char *material)
{
    struct assign item = {strdup(object), strdup(material)};
    struct assign *items =
        realloc(a->items, (a->count + 1) * sizeof a->items[0]);

    if (items != NULL)
        a->items = items;
    if (items == NULL || item.object == NULL || item.material == NULL) {
        free(item.object);
        free(item.material);
        return false;
    }
    a->items[a->count++] = item;
    return true;
}

bool assigns_set(struct assigns *a, const char *object, const char *material)
{
    for (size_t i = 0; i < a->count; i++) {
        if (strcmp(a->items[i].object, object) == 0) {
            remove_at(a, i);
            break;
        }
    }
    return material == NULL || append(a, object, material);
}

bool assigns_copy(struct assigns *to, const struct assigns *from)
{
    struct assigns copy = {0};
    bool ok = true;

    for (size_t i = 0; ok && i < from->count; i++)
        ok = append(&copy, from->items[i].object, from->items[i].material);
    if (!ok) {
        assigns_free(&copy);
        return false;
    }
    assigns_free(to);
    *to = copy;
    return true;
}

void assigns_free(struct assigns *a)
{
    while (a->count > 0)
        remove_at(a, a->count - 1);
    free(a->items);
    *a = (struct assigns){0};
}
