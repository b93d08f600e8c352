// SPDX-License-Identifier: MIT
#include "render/opencl/cl_source.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/hash.h"
#include "base/lexer.h"
#include "base/memory.h"
#include "base/name_table.h"
#include "base/text_stream.h"

/* Prefix of kernel files in #include lines and messages, wherever they are read
 * from. */
#define PREFIX "kernels/"

static const char *const entries[] = {
    PREFIX "ray_generator.cl",
    PREFIX "pathtracer.cl",
    PREFIX "compositor.cl",
    PREFIX "clear_buffers.cl",
};

struct splice {
    const char *folder; /* NULL: built-in files */
    FILE *out;
    struct name_table seen;
};

/* Returns a copy of the text, for free(), or NULL. */
static char *copied(const char *text, struct error *err)
{
    char *copy = strdup(text);

    if (!copy)
        fail(err, "out of memory for the kernels");
    return copy;
}

static char *read_within(const char *name, struct error *err)
{
    for (const struct cl_source_file *f = cl_source_files; f->name; f++) {
        if (strcmp(f->name, name) == 0)
            return copied(f->text, err);
    }
    fail(err, "found no '%s' within the program", name);
    return NULL;
}

/* Returns the text of a file, for free(), or NULL. */
static char *read_kernel(const char *folder, const char *name,
                         struct error *err)
{
    if (!folder)
        return read_within(name, err);

    char *path = format_text("%s/%s", folder, name + strlen(PREFIX));
    char *text = NULL;
    size_t size_bytes;

    if (path)
        file_read(path, &text, &size_bytes, err);
    else
        fail(err, "out of memory for the kernels");
    free(path);
    return text;
}

/* Finds the name in a line `#include "kernels/x.h"`. Returns false if the line
 * is another one. */
static bool included_name(const char *line, struct word *name)
{
    static const char *const parts[] = {"#", "include", "\""};

    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        line += strspn(line, " \t");
        if (strncmp(line, parts[i], strlen(parts[i])) != 0)
            return false;
        line += strlen(parts[i]);
    }

    size_t length = strcspn(line, "\"\n");
    if (line[length] != '"' || strncmp(line, PREFIX, strlen(PREFIX)) != 0)
        return false;
    *name = (struct word){line, length};
    return true;
}

static bool splice_include(struct splice *s, const char *from, int line,
                           struct word name, struct error *err);

/* Copies the lines of the file `name`. Each included file ends with a #line
 * mark, so that line numbers stay right. */
static bool splice_text(struct splice *s, const char *name, const char *text,
                        struct error *err)
{
    bool ok = true;

    fprintf(s->out, "#line 1 \"%s\"\n", name);
    for (int line = 1; ok && *text != '\0'; line++) {
        size_t length = strcspn(text, "\n");
        struct word included;

        if (included_name(text, &included))
            ok = splice_include(s, name, line, included, err);
        else
            fprintf(s->out, "%.*s\n", (int)length, text);
        text += length + (text[length] == '\n');
    }
    return ok;
}

/* Templates are inserted at each inclusion, other files once. */
static bool is_template(const char *name)
{
    static const char ending[] = "_template.h";
    size_t length = strlen(name), end = sizeof ending - 1;

    return length > end && strcmp(name + length - end, ending) == 0;
}

static bool splice_file(struct splice *s, const char *from, int line,
                        const char *name, struct error *err)
{
    struct error reason;

    if (!is_template(name)) {
        if (name_table_find(&s->seen, name) != NO_NAME) {
            putc('\n', s->out);
            return true;
        }
        if (name_table_add(&s->seen, name) == NO_NAME)
            return fail(err, "out of memory for the kernels");
    }

    char *text = read_kernel(s->folder, name, &reason);
    if (!text)
        return fail(err, "%s:%d: %s", from, line, reason.text);
    bool ok = splice_text(s, name, text, err);
    free(text);
    fprintf(s->out, "#line %d \"%s\"\n", line + 1, from);
    return ok;
}

/* Inserts the file `name`, which line `line` of the file `from` includes. */
static bool splice_include(struct splice *s, const char *from, int line,
                           struct word name, struct error *err)
{
    char *copy = strndup(name.start, name.length);
    bool ok = copy ? splice_file(s, from, line, copy, err)
                   : fail(err, "out of memory for the kernels");

    free(copy);
    return ok;
}

static bool splice_entries(struct splice *s, struct error *err)
{
    for (size_t i = 0; i < sizeof entries / sizeof entries[0]; i++) {
        char *text = read_kernel(s->folder, entries[i], err);

        if (!text)
            return false;
        bool ok = splice_text(s, entries[i], text, err);
        free(text);
        if (!ok)
            return false;
    }
    return true;
}

char *cl_source_text(const char *folder, struct error *err)
{
    struct splice s = {.folder = folder};
    struct text_stream stream;
    bool ok = true;
    char *text;
    size_t size_bytes;

    if (text_stream_open(&stream)) {
        s.out = stream.to;
        ok = splice_entries(&s, err);
    }
    text = text_stream_close(&stream, &size_bytes);
    name_table_free(&s.seen);
    if (ok && text == NULL)
        fail(err, "out of memory for the kernels");
    if (ok)
        return text;
    free(text);
    return NULL;
}

/* Computes the 64-bit FNV-1a hash. Nobody gains from collisions here. */
uint64_t cl_source_hash(const char *text)
{
    return hash_bytes(HASH_BEGIN, text, strlen(text));
}
