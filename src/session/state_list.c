// SPDX-License-Identifier: MIT
#include "session/state_list.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"
#include "base/xdg.h"
#include "terminal/xmalloc.h"

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
    char *text = NULL;
    size_t size_bytes;
    struct error ignored;
    FILE *to = open_memstream(&text, &size_bytes);

    append(&list, file, line);
    append_file(&list, file, path);
    for (int i = 0; i < list.count && to; i++)
        fprintf(to, "%s\n", list.lines[i]);
    if (to && fclose(to) == 0 && path)
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
