// SPDX-License-Identifier: MIT
#include "scene/assign.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* The next name of the line for free(); NULL if there is none, or no end of
 * its quotes. */
static char *read_name(struct lexer *lex)
{
    struct word word;
    char *name;
    size_t length = 0;

    if (lexer_at_line_end(lex))
        return NULL;
    if (*lex->p != '"') {
        word = lexer_word(lex);
        return xformat("%.*s", (int)word.length, word.start);
    }
    name = xmalloc((size_t)(lex->end - lex->p));
    for (lex->p++; lex->p < lex->end; lex->p++) {
        if (*lex->p == '\n' || *lex->p == '\r')
            break;
        if (*lex->p == '"') {
            lex->p++;
            if (lex->p == lex->end || *lex->p != '"') {
                name[length] = '\0';
                return name;
            }
        }
        name[length++] = *lex->p;
    }
    free(name);
    return NULL;
}

bool assigns_read(struct assigns *a, struct lexer *lex)
{
    char *object = read_name(lex);
    char *material = object == NULL ? NULL : read_name(lex);
    bool ok = material != NULL && lexer_at_line_end(lex);

    if (ok)
        assigns_set(a, object, material);
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

void assigns_set(struct assigns *a, const char *object, const char *material)
{
    for (size_t i = 0; i < a->count; i++) {
        if (strcmp(a->items[i].object, object) == 0) {
            remove_at(a, i);
            break;
        }
    }
    if (material == NULL)
        return;
    a->items = xrealloc(a->items, (a->count + 1) * sizeof a->items[0]);
    a->items[a->count++] = (struct assign){xstrdup(object), xstrdup(material)};
}

void assigns_copy(struct assigns *to, const struct assigns *from)
{
    struct assigns copy = {0};

    for (size_t i = 0; i < from->count; i++)
        assigns_set(&copy, from->items[i].object, from->items[i].material);
    assigns_free(to);
    *to = copy;
}

void assigns_free(struct assigns *a)
{
    while (a->count > 0)
        remove_at(a, a->count - 1);
    free(a->items);
    *a = (struct assigns){0};
}
