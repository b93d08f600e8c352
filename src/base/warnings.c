// SPDX-License-Identifier: MIT
#include "base/warnings.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/print.h"

static struct warnings_entry *find(const struct warnings *r, const char *kind)
{
    for (int i = 0; i < r->entry_count; i++) {
        if (strcmp(r->entries[i].kind, kind) == 0)
            return &r->entries[i];
    }
    return NULL;
}

bool warnings_have(const struct warnings *r, const char *kind)
{
    return find(r, kind) != NULL;
}

/* Appends an entry, which takes over both texts. A text that is NULL means that
 * memory was out. */
static void append(struct warnings *r, char *kind, char *text)
{
    void *entries = r->entries;

    if (kind == NULL || text == NULL ||
        !grow_array(&entries, &r->capacity, (size_t)r->entry_count + 1,
                    sizeof *r->entries)) {
        r->has_lost = true;
        free(kind);
        free(text);
        return;
    }
    r->entries = entries;
    r->entries[r->entry_count++] = (struct warnings_entry){kind, text, 1};
}

/* Counts one warning in the entry of this kind, which is made with the text if
 * it does not exist yet. */
__attribute__((format(printf, 3, 0))) static void
add(struct warnings *r, const char *kind, const char *format, va_list args)
{
    struct warnings_entry *entry = find(r, kind);
    char text[1024];

    if (entry != NULL) {
        entry->count++;
        return;
    }
    vsnprintf(text, sizeof text, format, args);
    append(r, strdup(kind), strdup(text));
}

void warnings_add(struct warnings *r, const char *kind, const char *format, ...)
{
    va_list args;

    va_start(args, format);
    add(r, kind, format, args);
    va_end(args);
}

/* Returns the number of entries of this kind with a name behind it. */
static int count_named(const struct warnings *r, const char *kind)
{
    size_t length = strlen(kind);
    int count = 0;

    for (int i = 0; i < r->entry_count; i++)
        count += strncmp(r->entries[i].kind, kind, length) == 0 &&
                 strncmp(r->entries[i].kind + length, " '", 2) == 0;
    return count;
}

void warnings_add_named(struct warnings *r, const char *kind, const char *name,
                        const char *format, ...)
{
    /* long names that begin alike count as one */
    char *named = format_text("%s '%.100s'", kind, name);

    bool is_full =
        named == NULL ||
        (find(r, named) == NULL && count_named(r, kind) >= WARNINGS_NAMES_MAX);
    va_list args;

    va_start(args, format);
    add(r, is_full ? kind : named, format, args);
    va_end(args);
    free(named);
}

char *warnings_line(const struct warnings_entry *entry)
{
    if (entry->count == 1)
        return strdup(entry->text);
    return format_text("%s (in all %" PRIu64 " %s)", entry->text, entry->count,
                       entry->kind);
}

void warnings_print(const struct warnings *r, FILE *to)
{
    for (int i = 0; i < r->entry_count; i++) {
        char *line = warnings_line(&r->entries[i]);

        print_line(to, "glim: warning: %s",
                   line != NULL ? line : r->entries[i].text);
        free(line);
    }
}

void warnings_free(struct warnings *r)
{
    for (int i = 0; i < r->entry_count; i++) {
        free(r->entries[i].kind);
        free(r->entries[i].text);
    }
    free(r->entries);
    memset(r, 0, sizeof *r);
}
