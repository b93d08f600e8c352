// SPDX-License-Identifier: MIT
#include "session/state_list.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/print.h"
#include "base/text_stream.h"
#include "base/xdg.h"
#include "terminal/xmalloc.h"

/* ---- lists ---- */

static bool has(const struct state_list *list, const char *key)
{
    for (int i = 0; i < list->count; i++) {
        if (strcmp(list->keys[i], key) == 0)
            return true;
    }
    return false;
}

static void append(struct state_list *list, const struct state_list_file *file,
                   const char *line)
{
    const char *key = file->key(line);
    int i = list->count;

    if (i == file->lines_max || !key || has(list, key))
        return;
    list->lines[i] = xstrdup(line);
    list->keys[i] = list->lines[i] + (key - line);
    list->count++;
}

/* Appends the lines of the file. */
static void append_file(struct state_list *list,
                        const struct state_list_file *file, const char *path)
{
    char *text = NULL;
    size_t size_bytes;
    struct error ignored;

    if (!path || !file_read(path, &text, &size_bytes, &ignored))
        return;
    for (char *line = text, *next; *line != '\0'; line = next) {
        size_t length = strcspn(line, "\n");

        next = line + length + (line[length] == '\n');
        line[length] = '\0';
        append(list, file, line);
    }
    free(text);
}

void state_list_read(struct state_list *list,
                     const struct state_list_file *file)
{
    char *path = xdg_state_path(file->name);

    *list = (struct state_list){.count = 0};
    append_file(list, file, path);
    free(path);
}

void state_list_put(const struct state_list_file *file, const char *line)
{
    char *path = xdg_state_path(file->name);
    struct state_list list = {.count = 0};
    struct text_stream s;
    char *text;
    size_t size_bytes;
    struct error ignored;

    append(&list, file, line);
    append_file(&list, file, path);
    text_stream_open(&s);
    for (int i = 0; i < list.count && s.to != NULL; i++)
        fprintf(s.to, "%s\n", list.lines[i]);
    text = text_stream_close(&s, &size_bytes);
    if (text != NULL && path)
        file_write(path, text, size_bytes, false, NULL, &ignored);
    free(text);
    free(path);
    state_list_free(&list);
}

void state_list_free(struct state_list *list)
{
    for (int i = 0; i < list->count; i++)
        free(list->lines[i]);
    *list = (struct state_list){.count = 0};
}

/* ---- scenes ---- */

/* Returns the whole line if it is the absolute path of a file that exists. */
static const char *existing(const char *line)
{
    return *line == '/' && access(line, R_OK) == 0 ? line : NULL;
}

static const struct state_list_file scenes_file = {"recent", RECENT_MAX,
                                                   existing};

void recent_read(struct state_list *r)
{
    state_list_read(r, &scenes_file);
}

void recent_add(const char *path)
{
    char *whole = realpath(path, NULL);

    if (whole && !strchr(whole, '\n'))
        state_list_put(&scenes_file, whole);
    free(whole);
}

/* ---- glyphs ---- */

/* Returns the name of the terminal, which follows the kind of glyphs. */
static const char *terminal_of(const char *line)
{
    const char *blank = strchr(line, ' ');

    return blank ? blank + 1 : NULL;
}

static const struct state_list_file glyphs_file = {"glyphs", 50, terminal_of};

static enum glyph_mode mode_of(const char *line)
{
    size_t length = strcspn(line, " ");

    for (int i = 0; term_caps_glyph_names[i]; i++) {
        if (strlen(term_caps_glyph_names[i]) == length &&
            strncmp(line, term_caps_glyph_names[i], length) == 0)
            return (enum glyph_mode)i;
    }
    return GLYPH_AUTO;
}

enum glyph_mode glyph_memory_read(const char *terminal)
{
    struct state_list list;
    enum glyph_mode found = GLYPH_AUTO;

    state_list_read(&list, &glyphs_file);
    for (int i = 0; i < list.count; i++) {
        if (strcmp(list.keys[i], terminal) == 0)
            found = mode_of(list.lines[i]);
    }
    state_list_free(&list);
    return found;
}

void glyph_memory_write(const char *terminal, enum glyph_mode mode)
{
    char *line = xformat("%s %s", term_caps_glyph_names[mode], terminal);

    state_list_put(&glyphs_file, line);
    free(line);
}
