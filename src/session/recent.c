// SPDX-License-Identifier: MIT
#include "session/recent.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/print.h"
#include "base/xdg.h"
#include "terminal/xmalloc.h"

static bool has(const struct recent *r, const char *path)
{
    for (int i = 0; i < r->count; i++) {
        if (strcmp(r->paths[i], path) == 0)
            return true;
    }
    return false;
}

static void append(struct recent *r, const char *path)
{
    if (r->count < RECENT_MAX && *path == '/' && !has(r, path))
        r->paths[r->count++] = xstrdup(path);
}

void recent_read(struct recent *r)
{
    char *name = xdg_state_path("recent");
    char *text = NULL;
    size_t size_bytes;
    struct error ignored;

    *r = (struct recent){.count = 0};
    if (name && file_read(name, &text, &size_bytes, &ignored)) {
        for (char *line = text, *next; *line != '\0'; line = next) {
            size_t length = strcspn(line, "\n");

            next = line + length + (line[length] == '\n');
            line[length] = '\0';
            if (access(line, R_OK) == 0)
                append(r, line);
        }
    }
    free(text);
    free(name);
}

static void write_list(const struct recent *r)
{
    char *name = xdg_state_path("recent");
    char *text = xstrdup("");
    struct error ignored;

    for (int i = 0; i < r->count; i++) {
        char *longer = xformat("%s%s\n", text, r->paths[i]);

        free(text);
        text = longer;
    }
    if (name)
        file_write(name, text, strlen(text), false, NULL, &ignored);
    free(text);
    free(name);
}

void recent_add(const char *path)
{
    char *whole = realpath(path, NULL);
    struct recent before, now = {.count = 0};

    if (!whole || strchr(whole, '\n')) {
        free(whole);
        return;
    }
    recent_read(&before);
    append(&now, whole);
    for (int i = 0; i < before.count; i++)
        append(&now, before.paths[i]);
    write_list(&now);
    recent_free(&before);
    recent_free(&now);
    free(whole);
}

static char *path_of_answer(const struct recent *r, const char *answer)
{
    char *end;
    unsigned long number = strtoul(answer, &end, 10);

    if (*end == '\0' && number >= 1 && number <= (unsigned long)r->count)
        return xstrdup(r->paths[number - 1]);
    return access(answer, F_OK) == 0 ? xstrdup(answer) : NULL;
}

char *recent_choose(const struct recent *r, FILE *in, FILE *out)
{
    char *answer = NULL, *path = NULL;
    size_t capacity = 0;

    for (int i = 0; i < r->count; i++)
        print_line(out, "%3d  %s", i + 1, r->paths[i]);
    while (!path) {
        print_text(out, "number or file of a scene (Enter: 1, q: quit): ");
        fflush(out);
        if (getline(&answer, &capacity, in) < 0)
            break;
        answer[strcspn(answer, "\n")] = '\0';
        if (strcmp(answer, "q") == 0)
            break;
        path = path_of_answer(r, *answer == '\0' ? "1" : answer);
        if (!path)
            print_line(out, "%s: no such scene", answer);
    }
    free(answer);
    return path;
}

void recent_free(struct recent *r)
{
    for (int i = 0; i < r->count; i++)
        free(r->paths[i]);
    *r = (struct recent){.count = 0};
}
